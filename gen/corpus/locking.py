"""A lock on the folder of a corpus: one call at a time writes into it."""

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from gen.support.errors import CorpusError


@contextmanager
def lock(directory: Path) -> Iterator[None]:
    """Lock a folder against other calls that write into it; a file system without locks is left as it is.

    Raises
    ------
    CorpusError
        If another call holds the lock, or the folder cannot be opened.
    """
    try:
        handle = os.open(directory, os.O_RDONLY)
    except OSError as error:
        raise CorpusError(f"{directory}: cannot be opened ({error.strerror}); give the folder of a corpus.") from None
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise CorpusError(
                f"{directory}: another raceway command is writing into it; wait until it ends, or choose another folder."
            ) from None
        except OSError:  # a file system without locks
            pass
        yield
    finally:
        os.close(handle)
