"""Locks of files and folders between processes; the system releases a lock when its process ends, however it ends."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress


@contextmanager
def hold_lock(path: os.PathLike[str] | str, if_held: Callable[[], object] = lambda: None) -> Iterator[None]:
    """Hold the lock of a folder, or of a file, which is made if there is none.

    ``if_held`` is called if another call holds the lock; it raises, or this call waits. Where the system or the file system has no locks,
    none is held. OSError if the path can be neither made nor opened.
    """
    try:
        import fcntl
    except ImportError:  # Windows
        yield
        return
    try:
        handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    except IsADirectoryError:
        handle = os.open(path, os.O_RDONLY)
    try:
        with suppress(OSError):  # a file system without locks
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                if_held()
                fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)
