"""Size, CPU time and memory of a corpus in every form of ``raceway export``: ``python -m benchmarks.exports [RECORDS [SAMPLES]]``.

The corpus is made without a simulation: noise of 11 bits and one tone, 10,000 records of 4096 samples if not told otherwise, with all
labels of a simulated corpus. Every export runs in a process of its own. The first line is the corpus itself, the second a packed file.
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
from gen.corpus import (
    DRAWS,
    FAULTS,
    SCHEMA,
    SIMULATED,
    make_dataset,
    part_name,
    write_index,
    write_manifest,
    write_part,
)
from gen.sharing.exporting import FORMS

FS = 12_800.0
_EXPORT = """
import json, re, sys, time
import gen
if sys.argv[3] == "packed file":
    gen.pack(*sys.argv[1:3])
else:
    gen.export(*sys.argv[1:])
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


def make_corpus(folder: Path, records: int, samples: int) -> Path:
    """Write a corpus of noise, so many samples a record."""
    (folder / "parts").mkdir(parents=True)
    starts = range(0, records, IN_PART)
    rows = []
    for number, first in enumerate(starts):
        dataset = _records(first, min(IN_PART, records - first), samples)
        rows.append(write_part(dataset, folder / "parts" / part_name(number)))
    write_index(folder, rows)
    write_manifest(folder, rows, complete=True)
    return folder


def costs(records: int = 10_000, samples: int = 4096) -> Iterator[Cost]:
    """Cost of each form for a corpus of so many records and samples a record."""
    with tempfile.TemporaryDirectory() as temporary:
        corpus = make_corpus(Path(temporary) / "corpus", records, samples)
        yield Cost("corpus", *_size(corpus), np.nan, np.nan)
        for form in ("packed file", *FORMS):
            yield _cost(corpus, Path(temporary) / form, form)


def table(found: Iterator[Cost]) -> Iterator[str]:
    """Lines of a table in Markdown."""
    yield from ("| form | files | size [MB] | CPU time [s] | peak memory [MB] |", "|---|---:|---:|---:|---:|")
    for cost in found:
        numbers = ("" if np.isnan(number) else f"{number:.0f}" for number in cost[2:])
        yield f"| {cost.form} | {cost.files} | " + " | ".join(numbers) + " |"


def _records(first: int, n: int, samples: int) -> xr.Dataset:
    rng = np.random.default_rng(first)
    number = np.arange(first, first + n)
    specimen, variables = number // 10, SCHEMA + SIMULATED
    columns: dict[str, Any] = {v.name: np.full(n, "made up") if v.dtype == "str" else np.zeros(n) for v in variables}
    columns |= {"specimen": specimen, "rig": specimen // 8, "recording": number, "fault": specimen % len(FAULTS)}
    columns |= {"split": specimen % 3, "sample_rate": np.full(n, FS), "shaft_rate": rng.uniform(20, 40, n)}
    columns[DRAWS] = [
        json.dumps({f"value_{place}": value for place, value in enumerate(row)}) for row in rng.random((n, 60))
    ]
    tone = np.sin(2 * np.pi * columns["shaft_rate"][:, None] * 4 * np.arange(samples) / FS)
    counts = np.rint(1000 * (tone + rng.standard_normal(tone.shape))).astype(np.int16)[:, None]
    facts = {"title": "Noise of a benchmark", "source": "made up", "history": ""}
    return make_dataset(
        counts, FS, ("housing",), columns, extra=SIMULATED, counts_per_unit=COUNTS_PER_UNIT, attributes=facts
    )


def _cost(corpus: Path, output: Path, form: str) -> Cost:
    """Export in a process of its own."""
    told = json.loads(run_python("-c", _EXPORT, corpus, output, form))
    return Cost(form, *_size(output), told["seconds"], told["memory"])


def _size(made: Path) -> tuple[int, float]:
    """Number and size [MB] of the files in a folder, or of one file."""
    files = [made] if made.is_file() else [path for path in made.rglob("*") if path.is_file()]
    return len(files), sum(path.stat().st_size for path in files) / 1e6


if __name__ == "__main__":
    for line in table(costs(*map(int, sys.argv[1:]))):
        print(line, flush=True)
