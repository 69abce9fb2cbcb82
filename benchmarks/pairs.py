"""Rows of the benchmark table: a value, that of a named alternative in the same run, and the median over the ratios of their pairs.

A temporary load of the machine slows both members of a pair down; values of different runs are never compared.
"""

import os
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
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
    """A row that this machine cannot measure, and a sentence with the reason."""

    name: str
    why: str


Line = Row | Skipped
Series = list[float]


def interleaved(pairs: int, **measures: Callable[[], float]) -> dict[str, Series]:
    """Call the measures in turn, ``pairs`` times: A B A B.

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


def seconds(work: Callable[..., Any], *arguments: Any) -> float:
    """Wall time of a call [s]."""
    start = time.perf_counter()
    work(*arguments)
    return time.perf_counter() - start


def cpu_seconds(work: Callable[..., Any], *arguments: Any) -> float:
    """CPU time of all threads of this process in a call [s]; unlike wall time, it does not count other processes on the machine."""
    start = time.process_time()
    work(*arguments)
    return time.process_time() - start


def process_seconds(*arguments: object, check: bool = True, cwd: Path | None = None, **environment: str) -> float:
    """CPU time of a Python process and its children [s], user and system; ``cwd`` is where it runs.

    Raises
    ------
    CalledProcessError
        If the process fails and ``check`` is true.
    """
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run_python(*arguments, check=check, cwd=cwd, **environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def run_python(*arguments: object, check: bool = True, cwd: Path | None = None, **environment: str) -> str:
    """Standard output of a Python process."""
    command = [sys.executable, *map(str, arguments)]
    done = subprocess.run(command, cwd=cwd, env=os.environ | environment, check=check, capture_output=True, text=True)
    return done.stdout
