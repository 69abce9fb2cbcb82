"""How far a long command has come, on standard error: a bar on a terminal, else a plain line now and then."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import click

from raceway import show

Progress = Callable[[int, int], None]

SECONDS_BETWEEN_LINES = 10.0


@contextmanager
def progress(doing: str, unit: str) -> Iterator[Progress]:
    """Something to call with the number of units done and of all.

    ``doing`` is what goes on, such as "generating"; ``unit`` what is counted, such as "records".
    """
    if sys.stderr.isatty():
        with _bar(doing, unit) as report:
            yield report
    else:
        yield _lines(doing, unit)


@contextmanager
def _bar(doing: str, unit: str) -> Iterator[Progress]:
    from rich import progress as rich  # not above: raceway --help is to answer at once
    from rich.console import Console
    from rich.text import Text

    class Rate(rich.ProgressColumn):
        """Units per second."""

        def render(self, task: Any) -> Text:
            speed = task.finished_speed or task.speed
            return Text("" if speed is None else f"{speed:,.3g} {unit}/s")

    columns = (
        rich.TextColumn("{task.description}"),
        rich.BarColumn(),
        rich.MofNCompleteColumn(),
        Rate(),
        rich.TimeRemainingColumn(elapsed_when_finished=True),
    )
    with rich.Progress(*columns, console=Console(stderr=True)) as bars:
        task = bars.add_task(doing, total=None)
        yield lambda done, total: bars.update(task, completed=done, total=total)


def _lines(doing: str, unit: str) -> Progress:
    start = last = time.monotonic()

    def report(done: int, total: int) -> None:
        nonlocal last
        now = time.monotonic()
        if done < total and now - last < SECONDS_BETWEEN_LINES:
            return
        last, took = now, max(now - start, 1e-9)
        rate = done / took
        rest = f"{show.duration((total - done) / rate)} left" if 0 < done < total else f"in {show.duration(took)}"
        notice(f"{doing}: {done:,} of {total:,} {unit}, {rate:,.3g} {unit}/s, {rest}")

    return report


def notice(sentence: str) -> None:
    """Print a sentence on standard error."""
    click.echo(show.printable(sentence), err=True)


@contextmanager
def compilation_noticed() -> Iterator[None]:
    """Say so when numba starts to compile a kernel, which keeps one waiting once per machine."""
    from numba.core import event

    class Once(event.Listener):
        """Speaks at the first compilation only."""

        said = False

        def on_start(self, event: Any) -> None:
            for_keeps = event.data["dispatcher"].stats.cache_path is not None  # the others are small, and compiled each time
            if for_keeps and not self.said:
                self.said = True
                notice("compiling kernels for this machine: some seconds each, and kept for the next time.")

        def on_end(self, event: Any) -> None:
            """Nothing to say."""

    with event.install_listener("numba:compile", Once()):
        yield
