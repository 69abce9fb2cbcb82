"""A lock on the folder of a corpus or of results: one call at a time writes into it."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NoReturn

from gen.support.errors import CorpusError
from gen.support.locking import hold_lock


@contextmanager
def lock(directory: Path) -> Iterator[None]:
    """Lock a folder against other calls that write into it.

    Raises
    ------
    CorpusError
        If another call holds the lock, or the folder cannot be opened.
    """

    def refuse() -> NoReturn:
        raise CorpusError(
            f"{directory}: another raceway command is writing into it; wait until it ends, or choose another folder."
        )

    with ExitStack() as stack:
        try:
            stack.enter_context(hold_lock(f"{directory}/.", refuse))
        except OSError as error:
            raise CorpusError(f"{directory}: cannot be opened ({error.strerror}); give a folder.") from None
        yield
