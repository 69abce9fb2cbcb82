"""Results on standard output: text for people, or JSON for programs."""

import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import Any

import click

from raceway.console.ending import printable


def as_json(facts: Any) -> None:
    """Print a value as JSON; NaN and infinity become null."""
    click.echo(json.dumps(plain(facts), indent=1, allow_nan=False))


def plain(value: Any) -> Any:
    """Value in the types of JSON.

    >>> plain({"rms": float("nan"), "where": Path("a/b"), "counts": (1, 2)})
    {'rms': None, 'where': 'a/b', 'counts': [1, 2]}
    """
    if is_dataclass(value) and not isinstance(value, type):
        return plain(asdict(value))
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return str(value) if isinstance(value, Path) else value


def text(*paragraphs: str) -> None:
    """Print sentences."""
    for paragraph in paragraphs:
        click.echo(printable(paragraph))


def facts(pairs: Mapping[str, Any]) -> None:
    """Print names and values, one pair per line; a pair with an empty value is left out."""
    from gen.support.display import lines  # not at the top: help needs no gen

    text(*lines(pairs))


def definitions(meanings: Mapping[str, str]) -> None:
    """Print names with their meanings beside them; long meanings are wrapped."""
    formatter = click.HelpFormatter(max_width=100)
    formatter.write_dl([(name, printable(meaning)) for name, meaning in meanings.items()])
    click.echo(formatter.getvalue(), nl=False)


def table(header: Sequence[str], rows: Iterable[Sequence[Any]]) -> None:
    """Print columns under a header: the first aligned left, the others aligned right."""
    _print([header, *rows], str.rjust)


def columns(rows: Iterable[Sequence[Any]]) -> None:
    """Print columns that are aligned left."""
    _print(rows, str.ljust)


def _print(rows: Iterable[Sequence[Any]], justify: Callable[[str, int], str]) -> None:
    lines = [[str(cell) for cell in row] for row in rows]
    first, *widths = (max(map(len, column)) for column in zip(*lines, strict=True))
    for name, *cells in lines:
        text("  ".join([name.ljust(first), *map(justify, cells, widths)]).rstrip())


def counts(numbers: Mapping[str, int]) -> str:
    """Counts on one line.

    >>> counts({"healthy": 3, "inner": 1200})
    'healthy 3, inner 1,200'
    """
    return ", ".join(f"{name} {number:,}" for name, number in numbers.items())


def count_text(number: int, noun: str) -> str:
    """Number and noun, in the plural unless the number is 1.

    >>> count_text(1, "part"), count_text(1200, "record")
    ('1 part', '1,200 records')
    """
    return f"{number:,} {noun}{'' if number == 1 else 's'}"


def size(n_bytes: float) -> str:
    """Size of a file.

    >>> size(999), size(1_234_567)
    ('999 B', '1.2 MB')
    """
    units = iter(("B", "kB", "MB", "GB", "TB"))
    while n_bytes >= 999.5:
        n_bytes /= 1000
        next(units)
    return f"{n_bytes:.2g} {next(units)}" if n_bytes < 10 else f"{n_bytes:.0f} {next(units)}"


def duration(seconds: float) -> str:
    """Time for people, rounded to two digits or to seconds.

    >>> duration(0.31), duration(42.4), duration(150), duration(9000)
    ('1 s', '42 s', '2.5 min', '2.5 h')
    """
    if seconds < 100:
        return f"{max(round(seconds), 1)} s"
    return f"{seconds / 60:.2g} min" if seconds < 5940 else f"{seconds / 3600:.2g} h"
