"""Time to compute the features of a record, compared with TSFEL, and memory for the features of a large corpus, compared with a small one.

Our features are levels at fault orders in six envelope spectra; the spectral and statistical domains of TSFEL are not specific to
bearings. The row states the number of features of each. Its signals have one second at 12.8 kHz, and one core computes them.
"""

import importlib
import importlib.util
import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchmarks.pairs import Line, Skipped, interleaved, row, seconds
from features.indicators import Orders, feature_names, indicators
from gen.corpus import SCHEMA, Codec, finish_corpus, make_dataset, part_name, write_part
from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE

FS, SAMPLES, SHAFT_RATE = 12_800.0, 12_800, 29.95
SCALES = (1_000, 20_000)
SHORT = 1_280  # samples of a record: memory does not depend on the length of the signals of other parts
PER_PART = 250

# VmHWM is the largest memory that the process had; texts of the table are 60 bytes each
_PEAK = """
import json, sys
import numpy as np
from features import feature_table
from features.indicators import Orders, indicators

def peak():
    status = open("/proc/self/status").read().split()
    return int(status[status.index("VmHWM:") + 1]) / 1e3

one = np.ones(2)
indicators(np.random.default_rng(0).standard_normal((2, 1280)), 12_800.0, 30 * one, Orders(0.4 * one, 3.6 * one, 5.4 * one, 2.4 * one))
before = peak()
table = feature_table(sys.argv[1])
texts = sum(60 * known.size for known in table.variables.values() if known.dtype.kind == "O")
print(json.dumps(peak() - before - (table.nbytes + texts) / 1e6))
"""


def rows(pairs: int = 5, *, records: int = 128, theirs: int = 16, scales: tuple[int, int] = SCALES) -> Iterator[Line]:
    """Lines of the table; ``records`` per call for our features, ``theirs`` for TSFEL, ``scales`` of the two corpora."""
    yield from memory_rows(pairs, scales)
    if not importlib.util.find_spec("tsfel"):
        yield Skipped("features tsfel", "tsfel is not installed; pip install 'raceway[bench]'.")
        return
    tsfel = importlib.import_module("tsfel")
    domains = tsfel.get_features_by_domain(["spectral", "statistical"])
    x = np.random.default_rng(0).standard_normal((records, SAMPLES))
    rates, nominal = _known(records)

    def extract(record: np.ndarray) -> int:
        return tsfel.time_series_features_extractor(domains, record, fs=FS, verbose=0).shape[1]

    found = interleaved(
        pairs,
        ours=lambda: records / seconds(indicators, x, FS, rates, nominal),
        tsfel=lambda: theirs / seconds(lambda: [extract(record) for record in x[:theirs]]),
    )
    alternative = f"TSFEL, spectral and statistical ({extract(x[0])})"
    yield row(
        "features tsfel",
        f"all groups ({len(feature_names())})",
        "records/s",
        found["ours"],
        alternative,
        found["tsfel"],
    )


def memory_rows(pairs: int, scales: tuple[int, int]) -> Iterator[Line]:
    """Peak memory beyond the feature table of a large corpus and of a small one, each in its own process."""
    small, large = (f"{scale:,} records" for scale in scales)
    with tempfile.TemporaryDirectory() as temporary:
        corpora = [noise_corpus(Path(temporary) / f"{scale}", scale) for scale in scales]
        found = interleaved(pairs, small=lambda: _peak_beyond(corpora[0]), large=lambda: _peak_beyond(corpora[1]))
    yield row("features memory", f"peak beyond the table, {large}", "MB", found["large"], small, found["small"])


def noise_corpus(folder: Path, records: int, samples: int = SHORT, codec: Codec = "zlib") -> Path:
    """Write a corpus whose parts are copies of one part with records of noise."""
    rates, nominal = _known(PER_PART)
    counts = np.random.default_rng(0).integers(-9999, 9999, (PER_PART, 1, samples)).astype(np.int16)
    columns = {variable.name: np.zeros(PER_PART) for variable in SCHEMA}
    columns |= {variable.name: ["noise"] * PER_PART for variable in SCHEMA if variable.dtype == "str"}
    columns |= {"shaft_rate": rates, "sample_rate": np.full(PER_PART, FS), **nominal._asdict()}
    texts = {"title": "noise", "history": "made by a benchmark"}
    (folder / "parts").mkdir(parents=True)
    first = folder / "parts" / part_name(0)
    dataset = make_dataset(counts, FS, ("a",), columns, counts_per_unit=1e3, attributes=texts)
    made = write_part(dataset, first, codec)
    parts = [made._replace(name=part_name(number)) for number in range(records // PER_PART)]
    for part in parts[1:]:
        shutil.copy(first, first.with_name(part.name))
    finish_corpus(folder, parts, title="noise")
    return folder


def _known(records: int) -> tuple[np.ndarray, Orders]:
    """Shaft rates and fault orders of some records."""
    return np.full(records, SHAFT_RATE), Orders(*(np.full(records, order) for order in orders(CATALOGUE["6205"])))


def _peak_beyond(corpus: Path) -> float:
    """Growth of the peak memory of a process that computes the features of a corpus, less the size of the table [MB]."""
    command = [sys.executable, "-c", _PEAK, str(corpus)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
