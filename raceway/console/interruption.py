"""Ctrl-C and SIGTERM end a command with one line and exit code 130, without output of its workers.

A terminal sends Ctrl-C to every process of a command, and each worker of a dask cluster would print a traceback. So both signals are
blocked, also in threads and processes that start later, and one thread waits for them. It kills the workers, removes unfinished files,
prints its sentence and ends the process at once. The main thread is not interrupted: an exception raised in it at any moment could crash
compiled code, and it has nothing to clean up, since a file gets its name only when it is complete.
"""

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

INTERRUPTED = 130

_PATIENCE_S = 1.0
_came = threading.Event()
_sentences: list[Callable[[], str]] = [
    lambda: "interrupted; no unfinished file is left; the same command starts again."
]


@contextmanager
def if_interrupted(sentence: Callable[[], str]) -> Iterator[None]:
    """If a signal comes meanwhile, print the result of ``sentence``: the state of the work, and how to continue."""
    _sentences.append(sentence)
    try:
        yield
    finally:
        _sentences.remove(sentence)


def listen_for_signals() -> None:
    """Start to wait for signals."""
    awaited = {signal.SIGTERM}
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:  # a script ignores it for commands in the background
        awaited.add(signal.SIGINT)
    signal.pthread_sigmask(signal.SIG_BLOCK, awaited)
    threading.Thread(target=_end, args=(awaited,), daemon=True).start()


def leave_if_interrupted() -> None:
    """If a signal has come, wait until its thread ends the process: the signal is the cause of any error in this thread."""
    if _came.is_set():
        threading.Event().wait()


def _end(awaited: set[signal.Signals]) -> None:
    signal.sigwait(awaited)
    _came.set()
    sentence_of = _sentences[
        -1
    ]  # before the main thread meets the end of the workers, and leaves what the sentence is about
    terminal = os.dup(2)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    _kill_workers()
    sentence = sentence_of()
    files = sys.modules.get("gen.corpus.disk")  # loaded only if a file was written
    remove = (lambda: None) if files is None else files.remove_unfinished
    remove()
    below_progress = "\n" if os.isatty(terminal) else ""
    os.write(terminal, f"{below_progress}{sentence}\n".encode())
    remove()  # the main thread may have started another file meanwhile
    os._exit(INTERRUPTED)


def _kill_workers() -> None:
    """Kill the processes that this one has started, and wait until they are gone."""
    if "distributed" not in sys.modules:  # nothing else starts any
        return
    import psutil

    workers = psutil.Process().children(recursive=True)
    for worker in workers:
        with suppress(psutil.NoSuchProcess):
            worker.kill()
    psutil.wait_procs(workers, _PATIENCE_S)
