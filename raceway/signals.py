"""Ctrl-C and SIGTERM end a command with one line and exit code 130, without a word from its workers.

A terminal sends Ctrl-C to every process of a command, and each worker of a dask cluster would show a traceback. So both signals are
blocked, which threads and processes started later inherit, and one thread waits for them. It wakes the main thread to clean up behind
itself, unless a cluster is at work: closing that takes seconds and is loud, and its workers end by themselves when this process does.
"""

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing import resource_tracker

INTERRUPTED = 130

_PATIENCE_S = 3.0  # for the main thread; an exception raised inside a callback of a library is lost
_came, _cleaned = threading.Event(), threading.Event()
_sentences: list[Callable[[], str]] = [lambda: "interrupted; nothing is left half done, the same command starts again."]


@contextmanager
def if_interrupted(sentence: Callable[[], str]) -> Iterator[None]:
    """Say what ``sentence`` returns, such as what is kept and how to go on, if a signal comes meanwhile."""
    _sentences.append(sentence)
    try:
        yield
    finally:
        _sentences.remove(sentence)


def listen_for_signals() -> None:
    """Be ready for signals from here on."""
    os.environ["PYTHONWARNINGS"] = "ignore:resource_tracker"  # it cleans up behind workers, and complains of it
    resource_tracker.ensure_running()  # first: it unblocks SIGINT in the thread that starts it
    del os.environ["PYTHONWARNINGS"]
    awaited = {signal.SIGTERM}
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:  # as it is in the background of a script
        awaited.add(signal.SIGINT)
    signal.pthread_sigmask(signal.SIG_BLOCK, awaited)
    signal.signal(signal.SIGUSR1, signal.default_int_handler)
    threading.Thread(target=_end, args=(awaited,), daemon=True).start()


def leave_if_interrupted() -> None:
    """Let the thread that waits for signals end this process, if one has come: whatever went wrong is its doing."""
    if _came.is_set():
        _cleaned.set()
        threading.Event().wait()


def _end(awaited: set[signal.Signals]) -> None:
    signal.sigwait(awaited)
    _came.set()
    sentence, terminal = _sentences[-1], os.dup(2)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    if not multiprocessing.active_children():
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGUSR1)
        _cleaned.wait(_PATIENCE_S)
    below_the_bar = "\n\x1b[?25h" if os.isatty(terminal) else ""  # where a cursor is shown again
    os.write(terminal, f"{below_the_bar}{sentence()}\n".encode())
    os._exit(INTERRUPTED)
