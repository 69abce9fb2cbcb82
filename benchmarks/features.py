"""Time to compute the features of a record, compared with TSFEL.

Our features are levels at fault orders in six envelope spectra; the spectral and statistical domains of TSFEL are not specific to
bearings. The row states the number of features of each. Its signals have one second at 12.8 kHz, and one core computes them.
"""

import importlib
import importlib.util
import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchmarks.pairs import Line, Skipped, interleaved, row, seconds
from features.table.indicators import Orders, feature_names, indicators
from gen.corpus import SCHEMA, Codec, finish_corpus, make_dataset, part_name, write_part
from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE

FS, SAMPLES, SHAFT_RATE = 12_800.0, 12_800, 29.95
PER_PART = 250


def rows(pairs: int = 3, *, records: int = 128, theirs: int = 16) -> Iterator[Line]:
    """Lines of the table; ``records`` per call for our features, ``theirs`` for TSFEL."""
    if not importlib.util.find_spec("tsfel"):
        yield Skipped("features tsfel", "tsfel is not installed; pip install tsfel.")
        return
    tsfel = importlib.import_module("tsfel")
    domains = tsfel.get_features_by_domain(["spectral", "statistical"])
    x = np.random.default_rng(0).standard_normal((records, SAMPLES))
    rates, nominal = _known(records)

    def extract(record: np.ndarray) -> int:
        return tsfel.time_series_features_extractor(domains, record, fs=FS, verbose=0).shape[1]

    measured = interleaved(
        pairs,
        ours=lambda: records / seconds(indicators, x, FS, rates, nominal),
        tsfel=lambda: theirs / seconds(lambda: [extract(record) for record in x[:theirs]]),
    )
    alternative = f"TSFEL, spectral and statistical ({extract(x[0])})"
    yield row(
        "features tsfel",
        f"all groups ({len(feature_names())})",
        "records/s",
        measured["ours"],
        alternative,
        measured["tsfel"],
    )


def noise_corpus(folder: Path, records: int, samples: int, codec: Codec = "zlib") -> Path:
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
    written = write_part(dataset, first, codec)
    parts = [written._replace(name=part_name(number)) for number in range(records // PER_PART)]
    for part in parts[1:]:
        shutil.copy(first, first.with_name(part.name))
    finish_corpus(folder, parts, title="noise")
    return folder


def _known(records: int) -> tuple[np.ndarray, Orders]:
    """Shaft rates and fault orders of some records."""
    return np.full(records, SHAFT_RATE), Orders(*(np.full(records, order) for order in orders(CATALOGUE["6205"])))
