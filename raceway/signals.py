"""Ctrl-C and SIGTERM: one KeyboardInterrupt in this process, and silence in those it has started.

A terminal sends Ctrl-C to every process of a command, and each worker of a dask cluster would show a traceback. So SIGINT is blocked,
which threads and processes started later inherit, and one thread waits for it and wakes the main thread by another signal.
"""

import os
import signal
import sys
import threading
from multiprocessing import resource_tracker

INTERRUPTED = 130

_PATIENCE_S = 3.0
_came = threading.Event()


def listen_for_signals() -> None:
    """Let Ctrl-C and SIGTERM raise KeyboardInterrupt in the main thread; the second ends the process at once."""
    resource_tracker.ensure_running()  # first: it unblocks SIGINT in the thread that starts it
    awaited = {signal.SIGUSR2}
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:  # ignored in the background of a script
        awaited.add(signal.SIGINT)
    signal.pthread_sigmask(signal.SIG_BLOCK, awaited)
    signal.signal(signal.SIGTERM, lambda *_: os.kill(os.getpid(), signal.SIGUSR2))
    signal.signal(signal.SIGUSR1, _interrupt)
    threading.Thread(target=_pass_on, args=(awaited,), daemon=True).start()


def interrupted() -> bool:
    """Whether a signal has come; then whatever else goes wrong is its doing."""
    return _came.is_set()


def _pass_on(awaited: set[signal.Signals]) -> None:
    signal.sigwait(awaited)
    while True:
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGUSR1)
        # again after a while, since an exception raised inside a callback of a library is lost
        if signal.sigtimedwait(awaited, _PATIENCE_S) is not None:
            _leave()


def _interrupt(*_: object) -> None:
    _came.set()
    raise KeyboardInterrupt


def _leave() -> None:
    show_cursor = "\x1b[?25h" if sys.stderr.isatty() else ""
    os.write(2, f"{show_cursor}interrupted.\n".encode())
    os._exit(INTERRUPTED)
