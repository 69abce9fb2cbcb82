"""Ctrl-C and SIGTERM end a command with one line and exit code 130, without a word from its workers.

A terminal sends Ctrl-C to every process of a command, and each worker of a dask cluster would show a traceback. So both signals are
blocked, which threads and processes started later inherit, and one thread waits for them. It removes the files under way, says its sentence
and ends the process at once, and its workers before. The main thread is not interrupted: an exception raised in it at any moment could
crash compiled code, and nothing is left for it to do, since finished files have their names already.
"""

import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing import resource_tracker

INTERRUPTED = 130

_PATIENCE_S = 1.0
_came = threading.Event()
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
    threading.Thread(target=_end, args=(awaited,), daemon=True).start()


def leave_if_interrupted() -> None:
    """Let the thread that waits for signals end this process, if one has come: whatever went wrong is its doing."""
    if _came.is_set():
        threading.Event().wait()


def _end(awaited: set[signal.Signals]) -> None:
    signal.sigwait(awaited)
    _came.set()
    terminal = os.dup(2)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    for worker in multiprocessing.active_children():
        worker.kill()
        worker.join(_PATIENCE_S)
    sentence = _sentences[-1]()
    files = sys.modules.get("gen.corpus.files")  # not imported before anything is written
    remove = (lambda: None) if files is None else files.remove_unfinished
    remove()
    below_the_bar = "\n\x1b[?25h" if os.isatty(terminal) else ""  # where a cursor is shown again
    os.write(terminal, f"{below_the_bar}{sentence}\n".encode())
    remove()  # the main thread may have begun another file meanwhile
    os._exit(INTERRUPTED)
