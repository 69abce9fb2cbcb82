"""A lock on the folder of a corpus or of results: one call at a time writes into it."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import lock_descriptor

from gen.support.errors import CorpusError


@contextmanager
def lock(directory: Path) -> Iterator[None]:
    """Lock a folder against other calls that write into it; the system releases the lock when the process ends, however it ends.

    Where the file system has no locks, none is held.

    Raises
    ------
    CorpusError
        If another call holds the lock, or the folder cannot be opened.
    """
    try:
        handle = os.open(f"{directory}/.", os.O_RDONLY)
    except OSError as error:
        raise CorpusError(f"{directory}: cannot be opened ({error.strerror}); give a folder.") from None
    try:
        try:
            free = lock_descriptor(handle, blocking=False)
        except OSError:
            # a file system without locks must not keep anybody from writing
            free = True
        if not free:
            raise CorpusError(
                f"{directory}: another raceway command is writing into it; wait until it ends, or choose another folder."
            )
        yield
    finally:
        os.close(handle)
