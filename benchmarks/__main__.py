"""Run benchmarks and print a table of ratios.

``python -m benchmarks [NAME...]`` runs all or some benchmarks; with ``--keep`` the rows go to the file of this processor,
``benchmarks/results-....json``. ``python -m benchmarks --pages`` makes the tables of docs/running.md from these files, and
``python -m benchmarks against CHECKOUT`` compares with another checkout (:mod:`benchmarks.against`). Each row compares a value with that
of a named alternative: medians over interleaved pairs, and the median of the ratios. Small values in s, ms, MB, GB or core hours are
good, large rates are good. All benchmarks take about five minutes.
"""

import argparse
import sys
from collections.abc import Callable, Iterator

from benchmarks import (
    against,
    analysis,
    features,
    growth,
    kernel,
    million,
    opening,
    performance_pages,
    pipeline,
    rivals,
    starting,
    training,
    truth,
)
from benchmarks.pairs import Line, Row, Skipped
from benchmarks.results import facts, keep, processor_key, results_file

SUBJECTS: dict[str, Callable[[], Iterator[Line]]] = {
    "kernel": kernel.rows,
    "rivals": rivals.rows,
    "pipeline": pipeline.rows,
    "million": million.rows,
    "features": features.rows,
    "analysis": analysis.rows,
    "opening": opening.rows,
    "training": training.rows,
    "starting": starting.rows,
    "truth": truth.rows,
    "growth": growth.rows,
}
HEADS = ("", "what", "value", "alternative", "its value", "ratio", "pairs")


def table(lines: list[Line]) -> str:
    """Text table of all rows, and below it a sentence for each skipped row."""
    cells = [HEADS, *(_cells(line) for line in lines if isinstance(line, Row))]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    rows = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in cells]
    return "\n".join(rows + [f"{line.name}: {line.why}" for line in lines if isinstance(line, Skipped)])


def _cells(row: Row) -> tuple[str, ...]:
    value, other = (f"{number:,.4g} {row.unit}" for number in (row.value, row.alternative_value))
    return row.name, row.what, value, row.alternative, other, f"{row.ratio:.3g}", str(row.pairs)


def main(arguments: list[str]) -> None:
    if arguments[:1] == ["against"]:
        against.main(arguments[1:])
        return
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__.partition("\n")[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"any of {', '.join(SUBJECTS)}; by default all")
    parser.add_argument(
        "--keep", action="store_true", help="keep the rows for docs/running.md, in the file of this processor"
    )
    parser.add_argument("--pages", action="store_true", help="only make the tables of docs/running.md again")
    options = parser.parse_args(arguments)
    if unknown := set(options.names) - set(SUBJECTS):
        parser.error(f"{', '.join(sorted(unknown))}: no such benchmark; choose from {', '.join(SUBJECTS)}, against.")
    if options.pages:
        performance_pages.write_page()
        return
    lines: list[Line] = []
    for name in options.names or SUBJECTS:
        for line in SUBJECTS[name]():
            print(f"{line.name}: {line.ratio:.3g}" if isinstance(line, Row) else line.why, file=sys.stderr)
            lines.append(line)
            if options.keep:
                keep([line], results_file(processor_key()), facts())
    print(table(lines))


if __name__ == "__main__":
    main(sys.argv[1:])
