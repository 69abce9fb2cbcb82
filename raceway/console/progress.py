"""Progress of a long command on standard error: a bar on a terminal, else a plain line every ten seconds."""

import sys
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from raceway.console import show

if TYPE_CHECKING:
    from gen.support.progress import Progress

SECONDS_BETWEEN_LINES = 10.0
REPORTS_IN_SPEED = 32


@contextmanager
def progress(doing: str, unit: str) -> "Iterator[Progress]":
    """Show progress; yields a function to call with the number of units done and of all units.

    ``doing`` is the activity, such as "generating"; ``unit`` is the unit that is counted, such as "records".
    """
    if sys.stderr.isatty():
        with _bar(doing, unit) as report:
            yield report
    else:
        yield _lines(doing, unit)


@contextmanager
def _bar(doing: str, unit: str) -> "Iterator[Progress]":
    from rich import progress as rich  # not at the top: help needs no rich
    from rich.console import Console

    columns = (
        rich.TextColumn("{task.description}"),
        rich.BarColumn(),
        rich.MofNCompleteColumn(),
        rich.TimeElapsedColumn(),
        rich.TextColumn("{task.fields[pace]}"),
    )
    pace = _pace(unit)
    with rich.Progress(*columns, console=Console(stderr=True)) as bars:
        task = bars.add_task(doing, total=None, pace="")
        yield lambda done, total: bars.update(task, completed=done, total=total, pace=pace(done, total))


def _lines(doing: str, unit: str) -> "Progress":
    last, pace = time.monotonic(), _pace(unit)

    def report(done: int, total: int) -> None:
        nonlocal last
        current = pace(done, total)
        if done == total or time.monotonic() - last >= SECONDS_BETWEEN_LINES:
            last = time.monotonic()
            notice(f"{doing}: {done:,} of {total:,} {unit}, {current}")

    return report


def _pace(unit: str) -> Callable[[int, int], str]:
    """Speed over the last reports, and time left at that speed; parts that were kept from before soon leave the window."""
    marks = deque([(time.monotonic(), 0)], maxlen=REPORTS_IN_SPEED)

    def pace(done: int, total: int) -> str:
        if done > marks[-1][1]:
            marks.append((time.monotonic(), done))
        (then, before), (now, latest) = marks[0], marks[-1]
        if latest == before:
            return "speed not known yet"
        rate = (latest - before) / max(now - then, 1e-9)
        left = f", {show.duration((total - done) / rate)} left" if done < total else ""
        return f"{rate:,.3g} {unit}/s{left}"

    return pace


def notice(sentence: str) -> None:
    """Print a sentence on standard error, above the bar if there is one."""
    sys.stderr.write(show.printable(sentence) + "\n")


@contextmanager
def notice_compilation() -> Iterator[None]:
    """Print a sentence when numba starts to compile a kernel, which happens once per machine."""
    from numba.core import event

    class Once(event.Listener):
        """Prints the sentence at the first compilation only."""

        said = False

        def on_start(self, event: Any) -> None:
            cached = event.data["dispatcher"].stats.cache_path is not None  # other functions compile in milliseconds
            if cached and not self.said:
                self.said = True
                notice("compiling kernels for this machine; they are kept for the next time.")

        def on_end(self, event: Any) -> None:
            """Do nothing."""

    with event.install_listener("numba:compile", Once()):
        yield
