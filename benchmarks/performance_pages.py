"""Tables of docs/running.md, made from the results of every processor.

A test compares the page with the files.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.page_tables import filled, markdown
from benchmarks.results import FOLDER, Rows, every_result

PAGE = FOLDER.parent / "docs" / "running.md"

Results = Mapping[str, Rows]

GROUPS = {
    "kernel": ("kernel",),
    "pipeline": ("pipeline", "growth", "start"),
    "million": ("million",),
    "features": ("features",),
    "reading": ("opening", "training"),
    "truth": ("truth",),
}
"""First words of the names of the rows in each table."""
UNLISTED = ("analysis", "starting")
"""First words of rows that stand in the files of results alone."""


class Target(NamedTuple):
    """A figure of a row that has a limit."""

    what: str
    row: str
    figure: str
    """``ratio`` or ``value``."""
    must: Mapping[str, float]
    """Limit by vendor; the empty vendor is every other one."""
    aim: float | None
    small: bool = False
    """Whether small figures are good."""


TARGETS = (
    Target("seed model over plain C, same outputs", "kernel plain", "ratio", {"amd": 1.3, "intel": 1.5}, 1.8),
    Target("full model over seed model", "kernel full", "ratio", {"": 0.5}, 0.6),
    Target("recipe to parts over the kernel alone, full model", "pipeline parts", "ratio", {"": 0.8}, 0.9),
    Target("two workers over one, 1,024 records, start included", "pipeline workers", "ratio", {"": 1.6}, 1.9),
    Target("first record, nothing compiled, CPU [s]", "start cold", "value", {"": 15}, 10, small=True),
    Target("first record, kernels in the cache, CPU [s]", "start warm", "value", {"": 2.5}, 1.5, small=True),
    Target("a record of 20,000 over one of 1,000, CPU", "growth cost", "ratio", {"": 1.02}, None, small=True),
    Target("memory of a process, 20,000 records [MB]", "growth memory", "value", {"": 500}, None, small=True),
    Target(
        "memory, `domain_randomised` [MB]", "million domain_randomised memory", "value", {"": 500}, None, small=True
    ),
    Target("CPU of the driver per part, 1,000 parts over 100", "growth driver", "ratio", {"": 1.5}, 1.1, small=True),
)


def _targets(results: Results) -> str:
    rows = []
    for target in TARGETS:
        must = ", ".join(f"{limit:g} ({vendor})" if vendor else f"{limit:g}" for vendor, limit in target.must.items())
        aim = "-" if target.aim is None else f"{target.aim:g}"
        cells = [_reached(target, name, measured.get(target.row)) for name, measured in results.items()]
        rows.append([target.what, must, aim, *cells])
    return markdown(["", "must", "aim", *results], rows)


def _reached(target: Target, processor: str, row: Mapping[str, Any] | None) -> str:
    if row is None:
        return "-"
    vendor = processor.partition("-")[0]
    figure, limit = row[target.figure], target.must.get(vendor, target.must.get("", None))
    missed = limit is not None and (figure > limit if target.small else figure < limit)
    return f"{short(figure)}{' (missed)' if missed else ''}"


def _rows(results: Results, words: Sequence[str]) -> str:
    """Rows whose names begin with one of some words: the figures of every processor."""
    names = dict.fromkeys(
        name for word in words for rows in results.values() for name in rows if name.split()[0] == word
    )
    lines = []
    for name in names:
        first = next(rows[name] for rows in results.values() if name in rows)
        cells = [_cell(rows.get(name)) for rows in results.values()]
        lines.append([f"{name}: {first['what']}", first["alternative"], *cells])
    return markdown(["", "compared with", *results], lines)


def _cell(row: Mapping[str, Any] | None) -> str:
    if row is None:
        return "-"
    value, other = short(row["value"]), short(row["alternative_value"])
    return f"{short(row['ratio'])} ({value} against {other} {row['unit']})"


def _machines(results: Results) -> str:
    """Processor and versions of every group of rows that were measured together."""
    lines = []
    for name, rows in results.items():
        counts: dict[tuple[str, ...], int] = {}
        for row in rows.values():
            computer = tuple(str(row["facts"][key]) for key in ("processor", "cores", "python", "numba", "numpy"))
            counts[computer] = counts.get(computer, 0) + 1
        lines += [[name, *computer, str(count)] for computer, count in counts.items()]
    return markdown(["", "processor", "cores", "Python", "numba", "NumPy", "rows"], lines)


def short(value: float) -> str:
    """Number with three digits.

    >>> short(29_431_015.9), short(1234.5), short(0.7851), short(15.0)
    ('29.4 M', '1,234', '0.785', '15')
    """
    for factor, letter in ((1e9, " G"), (1e6, " M")):
        if value >= factor:
            return f"{value / factor:.3g}{letter}"
    return f"{value:,.0f}" if value >= 1000 else f"{value:.3g}"


def tables(results: Results) -> Iterator[tuple[str, Callable[[], str]]]:
    """Name and maker of every table."""
    yield "targets", lambda: _targets(results)
    yield "machines", lambda: _machines(results)
    for name, words in GROUPS.items():
        yield name, lambda words=words: _rows(results, words)


def with_tables(page: str, results: Results) -> str:
    """A page with its tables made again."""
    makers = dict(tables(results))
    return filled(page, lambda name: makers[name]())


def write_page(page: Path = PAGE) -> None:
    """Make the tables of the page again."""
    page.write_text(with_tables(page.read_text(encoding="utf-8"), every_result()), encoding="utf-8")
