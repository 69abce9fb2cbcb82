"""Progress of a long call: one renewed line on a terminal or in a notebook, else a line every ten seconds on standard error."""

import sys
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from raceway.console import show

if TYPE_CHECKING:
    from gen.support.progress import Progress

SECONDS_BETWEEN_LINES = 10.0
SECONDS_BETWEEN_RENEWALS = 0.5
BURST_S = 1.0  # records of a batch are reported together, and parts that were kept from before are too
BURSTS_IN_SPEED = 32
UNEVEN = ("scores", "corpora", "curves and classifiers")  # units of very different times, which tell no time left


@contextmanager
def progress(doing: str, unit: str) -> "Iterator[Progress]":
    """Show progress; yields a function to call with the number of units done and of all units.

    ``doing`` is the activity, such as "generating"; ``unit`` is the unit that is counted, such as "records".
    """
    if _quiet():
        yield lambda _done, _total: None
        return
    try:
        yield show_progress(doing, unit)
    finally:
        _clear_line()  # of a call that has failed


def show_progress(doing: str = "done", unit: str = "") -> "Progress":
    """Progress in lines, for the argument ``progress`` of calls such as ``gen.generate``; a notebook renews one line.

    ``doing`` is the activity, such as "generating"; ``unit`` is the unit that the call counts, such as "records".
    """
    start = last = time.monotonic()
    pace = _pace(unit)
    on_terminal = sys.stderr.isatty()
    renew = _notebook_line() or (_renew_line if on_terminal else None)
    between = SECONDS_BETWEEN_LINES if renew is None else SECONDS_BETWEEN_RENEWALS

    def report(done: int, total: int) -> None:
        nonlocal last
        current, now = pace(done, total), time.monotonic()
        # the last report is always shown
        if done == total or now - last >= between:
            last = now
            ending = f"in {show.duration(now - start)}" if done == total else current
            sentence = f"{doing}: {f'{done:,} of {total:,} {unit}'.rstrip()}, {ending}"
            (notice if renew is None or (on_terminal and done == total) else renew)(sentence)

    return report


def _renew_line(sentence: str) -> None:
    """Write a line of the terminal that the next one replaces."""
    click.echo(f"{sentence}\x1b[K\r", nl=False, err=True)


def _clear_line() -> None:
    if sys.stderr.isatty():
        _renew_line("")


def _notebook_line() -> Callable[[str], None] | None:
    """Function that shows a sentence below the cell of a notebook, in place of the one before; None elsewhere."""
    ipython = sys.modules.get("IPython")
    if ipython is None or not hasattr(ipython.get_ipython(), "kernel"):
        return None
    line = ipython.display.display({"text/plain": ""}, raw=True, display_id=True)
    return lambda sentence: line.update({"text/plain": sentence}, raw=True)


def _pace(unit: str) -> Callable[[int, int], str]:
    """Speed between the first and the last of the latest bursts of reports, and time left at that speed if units take about the same."""
    bursts: deque[tuple[float, int]] = deque(maxlen=BURSTS_IN_SPEED)

    def pace(done: int, total: int) -> str:
        now = time.monotonic()
        if bursts and now - bursts[-1][0] < BURST_S:
            bursts[-1] = (bursts[-1][0], done)
        elif not bursts or done > bursts[-1][1]:
            bursts.append((now, done))
        (then, before), (latest, after) = bursts[0], bursts[-1]
        if after == before:
            return "speed not known yet" if done < total else ""
        rate = (after - before) / (latest - then)
        left = f", {show.duration((total - done) / rate)} left" if done < total and unit not in UNEVEN else ""
        return f"{f'{rate:,.3g} {unit}'.rstrip()}/s{left}"

    return pace


def _quiet() -> bool:
    """Whether ``raceway --quiet`` was called."""
    context = click.get_current_context(silent=True)
    return context is not None and context.find_root().params.get("quiet", False)


def notice(sentence: str) -> None:
    """Print a sentence on standard error, in place of the progress if that is shown; none with ``--quiet``."""
    if not _quiet():
        _write(sentence)


def warn(sentence: str) -> None:
    """Print a warning on standard error, with ``--quiet`` too."""
    _write(f"warning: {sentence}")


def _write(sentence: str) -> None:
    _clear_line()
    sys.stderr.write(show.printable(sentence) + "\n")


def next_step(step: str) -> None:
    """Print what can be done with a result on standard output; nothing with ``--quiet``."""
    if not _quiet():
        show.text(f"Next: {step}")


@contextmanager
def notice_compilation() -> Iterator[None]:
    """Print a sentence when numba starts to compile a kernel, which happens once per installation."""
    from numba.core import event

    class Once(event.Listener):
        """Prints the sentence at the first compilation only."""

        said = False

        def on_start(self, event: Any) -> None:
            # only kernels that are kept take long enough to tell
            cached = event.data["dispatcher"].stats.cache_path is not None  # other functions compile in milliseconds
            if cached and not self.said:
                self.said = True
                notice("compiling kernels for this machine; they are kept for the next time.")

        def on_end(self, event: Any) -> None:
            """Do nothing."""

    with event.install_listener("numba:compile", Once()):
        yield
