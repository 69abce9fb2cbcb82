"""Run benchmarks and print a table of ratios; a run of all benchmarks writes ``benchmarks/results.json``.

``python -m benchmarks [NAME...]``. Each row compares a value with that of a named alternative: medians over interleaved pairs, and the
median of the ratios. Small values in s, ms or MB are good, large rates are good. All benchmarks take ten minutes.
"""

import argparse
import json
import os
import sys
from collections.abc import Callable, Iterator
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from benchmarks import features, growth, kernel, opening, pipeline, reading, rivals, roofline, starting, truth
from benchmarks.pairs import Line, Row, Skipped
from raceway.studies.timing import machine

SUBJECTS: dict[str, Callable[[], Iterator[Line]]] = {
    "roofline": roofline.rows,
    "kernel": kernel.rows,
    "rivals": rivals.rows,
    "pipeline": pipeline.rows,
    "features": features.rows,
    "opening": opening.rows,
    "reading": reading.rows,
    "starting": starting.rows,
    "truth": truth.rows,
    "growth": growth.rows,
}
RESULTS = Path(__file__).with_name("results.json")
HEADS = ("", "what", "value", "alternative", "its value", "ratio", "pairs")


def facts() -> dict[str, Any]:
    """Processor, versions and settings that the values depend on."""
    found = machine() | {"OMP_NUM_THREADS": os.environ.get("OMP_NUM_THREADS")}
    for name in ("xarray", "netCDF4", "h5py", "dask", "jax", "tsfel"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = None
    return found


def table(lines: list[Line]) -> str:
    """Text table of all rows, and below it a sentence for each skipped row."""
    cells = [HEADS, *(_cells(line) for line in lines if isinstance(line, Row))]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    rows = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in cells]
    return "\n".join(rows + [f"{line.name}: {line.why}" for line in lines if isinstance(line, Skipped)])


def _cells(row: Row) -> tuple[str, ...]:
    value, other = (f"{number:,.4g} {row.unit}" for number in (row.value, row.alternative_value))
    return row.name, row.what, value, row.alternative, other, f"{row.ratio:.3g}", str(row.pairs)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__.partition("\n")[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"any of {', '.join(SUBJECTS)}; by default all")
    names = parser.parse_args().names or list(SUBJECTS)
    if unknown := set(names) - set(SUBJECTS):
        parser.error(f"{', '.join(sorted(unknown))}: no such benchmark; choose from {', '.join(SUBJECTS)}.")
    lines: list[Line] = []
    for name in names:
        for line in SUBJECTS[name]():
            print(f"{line.name}: {line.ratio:.3g}" if isinstance(line, Row) else line.why, file=sys.stderr)
            lines.append(line)
    print(table(lines))
    if set(names) == set(SUBJECTS):
        rows = [line._asdict() for line in lines if isinstance(line, Row)]
        skipped = [line._asdict() for line in lines if isinstance(line, Skipped)]
        RESULTS.write_text(
            json.dumps({"machine": facts(), "rows": rows, "skipped": skipped}, indent=1) + "\n", encoding="utf-8"
        )


if __name__ == "__main__":
    main()
