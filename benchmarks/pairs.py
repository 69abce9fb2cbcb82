"""Rows of the benchmark table: a value, the same of a named alternative in the same run, and the median of their ratios pair by pair.

Whatever slows a machine down for a while slows both members of a pair down; figures of different runs are not compared.
"""

import statistics
import time
from collections.abc import Callable
from typing import Any, NamedTuple


class Row(NamedTuple):
    """One line of the table."""

    name: str
    what: str
    value: float
    unit: str
    alternative: str
    alternative_value: float
    ratio: float
    """Median over the pairs of value over alternative."""
    pairs: int


class Skipped(NamedTuple):
    """A line that this machine cannot fill, and the sentence that says why."""

    name: str
    why: str


Line = Row | Skipped
Series = list[float]


def interleaved(pairs: int, **measures: Callable[[], float]) -> dict[str, Series]:
    """Measure one after the other, and all of it ``pairs`` times: A B A B.

    >>> numbers = iter(range(4))
    >>> interleaved(2, a=lambda: next(numbers), b=lambda: next(numbers))
    {'a': [0, 2], 'b': [1, 3]}
    """
    series: dict[str, Series] = {name: [] for name in measures}
    for _ in range(pairs):
        for name, measure in measures.items():
            series[name].append(measure())
    return series


def row(name: str, what: str, unit: str, values: Series, alternative: str, others: Series) -> Row:
    """Medians of two interleaved series and of their ratios.

    >>> row("kernel", "speed", "1/s", [2.0, 9.0, 4.0], "rival", [1.0, 3.0, 4.0]).ratio
    2.0
    """
    ratios = [value / other for value, other in zip(values, others, strict=True)]
    medians = statistics.median(values), statistics.median(others)
    return Row(name, what, medians[0], unit, alternative, medians[1], statistics.median(ratios), len(ratios))


def seconds(work: Callable[..., Any], *given: Any) -> float:
    """Wall time of a call [s]."""
    start = time.perf_counter()
    work(*given)
    return time.perf_counter() - start
