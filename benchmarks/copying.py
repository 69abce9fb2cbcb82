"""Size, CPU time and memory of ``raceway copy`` for every form: ``python -m benchmarks.copying [RECORDS [SAMPLES]]``.

The corpus is made without a simulation: noise of 11 bits and one tone, 10,000 records of 4096 samples if not told otherwise, with all
labels of a simulated corpus. Every copy runs in a process of its own. The first line is the corpus itself.
"""

import json
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from benchmarks.pairs import run_python
from gen.corpus import DRAWS, FAULTS, SCHEMA, SIMULATED, identity, make_dataset, new_corpus
from gen.exporting import FORMS

FS = 12_800.0
_COPY = """
import json, re, sys, time
import gen
gen.copy(json.loads(sys.argv[1]), sys.argv[2], **json.loads(sys.argv[3]))
peak = re.search(r"VmHWM:\\s+(\\d+)", open("/proc/self/status").read())[1]  # ru_maxrss counts the parent process too
print(json.dumps({"seconds": time.process_time(), "memory": int(peak) / 1e3}))
"""
IN_PART = 500
COUNTS_PER_UNIT = 65.534


class Cost(NamedTuple):
    """Cost of one form."""

    form: str
    files: int
    megabytes: float
    seconds: float
    """CPU time of the process, its start included [s]."""
    memory: float
    """Peak memory of the process [MB]."""


def make_corpus(folder: Path, records: int, samples: int, seed: int = 0) -> Path:
    """Write a corpus of noise, so many samples a record."""
    with new_corpus(folder, title="Noise of a benchmark") as corpus:
        for first in range(0, records, IN_PART):
            corpus.write(_records(first, min(IN_PART, records - first), samples, seed))
    return folder


def costs(records: int = 10_000, samples: int = 4096) -> Iterator[Cost]:
    """Cost of each form for a corpus of so many records and samples a record."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        corpus, other = (make_corpus(folder / name, records, samples, seed) for seed, name in enumerate(("a", "b")))
        yield Cost("corpus", *_size(corpus), np.nan, np.nan)
        yield _cost([corpus], folder / "copy", "folder")
        yield _cost([corpus], folder / "one.nc", "one file")
        yield _cost([corpus], folder / "sixth", "a sixth of the records", where="fault == 'inner'")
        yield _cost([corpus, other], folder / "joined", "two corpora joined")
        for form in FORMS:
            yield _cost([corpus], folder / form, form, to=form)


def table(found: Iterator[Cost]) -> Iterator[str]:
    """Lines of a table in Markdown."""
    yield from ("| form | files | size [MB] | CPU time [s] | peak memory [MB] |", "|---|---:|---:|---:|---:|")
    for cost in found:
        numbers = ("" if np.isnan(number) else f"{number:.0f}" for number in cost[2:])
        yield f"| {cost.form} | {cost.files} | " + " | ".join(numbers) + " |"


def _records(first: int, n: int, samples: int, seed: int) -> xr.Dataset:
    rng = np.random.default_rng([seed, first])
    number = np.arange(first, first + n)
    specimen, variables = number // 10, SCHEMA + SIMULATED
    columns: dict[str, Any] = {v.name: np.full(n, "made up") if v.dtype == "str" else np.zeros(n) for v in variables}
    columns |= {"specimen": specimen, "rig": specimen // 8, "recording": number, "fault": specimen % len(FAULTS)}
    columns |= {"split": specimen % 3, "sample_rate": np.full(n, FS), "shaft_rate": rng.uniform(20, 40, n)}
    columns["identity"] = [
        identity(f"noise-{seed}", *some)
        for some in zip(*(each.tolist() for each in (specimen // 8, specimen, number)), strict=True)
    ]
    columns[DRAWS] = [
        json.dumps({f"value_{place}": value for place, value in enumerate(row)}) for row in rng.random((n, 60))
    ]
    tone = np.sin(2 * np.pi * columns["shaft_rate"][:, None] * 4 * np.arange(samples) / FS)
    counts = np.rint(1000 * (tone + rng.standard_normal(tone.shape))).astype(np.int16)[:, None]
    facts = {"title": "Noise of a benchmark", "source": "made up", "history": ""}
    return make_dataset(
        counts, FS, ("housing",), columns, extra=SIMULATED, counts_per_unit=COUNTS_PER_UNIT, attributes=facts
    )


def _cost(sources: list[Path], target: Path, form: str, **options: str) -> Cost:
    """Copy in a process of its own."""
    told = json.loads(run_python("-c", _COPY, json.dumps([*map(str, sources)]), target, json.dumps(options)))
    return Cost(form, *_size(target), told["seconds"], told["memory"])


def _size(made: Path) -> tuple[int, float]:
    """Number and size [MB] of the files in a folder, or of one file."""
    files = [made] if made.is_file() else [path for path in made.rglob("*") if path.is_file()]
    return len(files), sum(path.stat().st_size for path in files) / 1e6


if __name__ == "__main__":
    for line in table(costs(*map(int, sys.argv[1:]))):
        print(line, flush=True)
