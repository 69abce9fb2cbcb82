"""Files on disk: written whole or not at all, known by their hash, and plain files inside the folder they belong to.

A file is written to a temporary name, flushed to disk and renamed, so that a killed writer leaves no half file under the wanted name.
"""

import hashlib
import os
import shutil
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from gen.errors import CorpusError

Stamp = tuple[int, int]
"""Size and time of the last change [ns]: a file with another stamp is another file."""

_CLOCK_TICK = 1_000_000_000  # ns; two changes within a tick of the file system's clock can leave one stamp
_MOST_HASHES = 100_000
_hashes: dict[tuple[str, Stamp], str] = {}
_unfinished: set[Path] = set()


def stamp(path: Path | str) -> Stamp:
    """Stamp of a file; OSError if there is none."""
    found = Path(path).stat()
    return found.st_size, found.st_mtime_ns


def sha256(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal; a file of the same stamp is not hashed again in this process."""
    key = (str(path.absolute()), stamp(path))
    known = _hashes.get(key)
    if known is not None:
        return known
    with path.open("rb") as stream:
        found = hashlib.file_digest(stream, "sha256").hexdigest()
    if stamp(path) == key[1] and time.time_ns() - key[1][1] > _CLOCK_TICK:
        if len(_hashes) >= _MOST_HASHES:
            _hashes.clear()
        _hashes[key] = found
    return found


def forget_hashes() -> None:
    """Hash every file again when it is asked for."""
    _hashes.clear()


def plain_file(directory: Path, name: str) -> Path:
    """Path of a file of a corpus: a plain file that lies in the folder itself.

    Raises
    ------
    CorpusError
        If there is no such file, it is no plain file (a folder, a pipe, a device), or a link leads out of the folder.
    """
    path = directory / name
    # links are rare, and to resolve every path takes ten times as long
    linked = path.is_symlink() or (path.parent != directory and path.parent.is_symlink())
    if linked and path.exists() and not path.resolve().is_relative_to(directory.resolve()):
        raise CorpusError(f"{path}: is a link out of the corpus; copy the file itself to its place.")
    if not path.is_file():
        reason = "is no plain file" if path.exists() else "missing"
        raise CorpusError(f"{path}: {reason}; copy it again, or run the command that made the corpus again.")
    return path


def check_name(path: Path) -> None:
    """Refuse a name that cannot be given to netCDF."""
    try:
        str(path).encode()
    except UnicodeEncodeError:
        raise CorpusError(f"{path}: the name is not UTF-8, which netCDF needs; choose another.") from None


@contextmanager
def whole_or_not_at_all(path: Path) -> Iterator[Path]:
    """Temporary path to write to; flushed to disk it takes the place of ``path`` in one step, or is removed if anything fails.

    Raises
    ------
    CorpusError
        If the disk refuses the file, with the reason it gives.
    """
    check_name(path)
    if path.exists() and not path.is_file():
        raise CorpusError(f"{path}: is no plain file, which would be replaced; choose another name.")
    try:
        with temporary_beside(path) as temporary:
            yield temporary
            with temporary.open("rb+") as stream:
                os.fsync(stream.fileno())
            temporary.replace(path)
            folder = os.open(path.parent, os.O_RDONLY)
            try:
                os.fsync(folder)
            finally:
                os.close(folder)
    except (OSError, RuntimeError) as error:
        code = getattr(error, "errno", None)  # HDF5 adds addresses and line breaks to its own text
        reason = os.strerror(code) if code else " ".join(str(error).split())
        raise CorpusError(
            f"{path}: could not be written ({reason}); free some space or choose another folder."
        ) from error


@contextmanager
def temporary_beside(path: Path) -> Iterator[Path]:
    """Hidden path in the folder of ``path`` for a file or folder under way; whatever is there at the end is removed."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}.{threading.get_native_id()}.tmp")
    _unfinished.add(temporary)
    try:
        yield temporary
    finally:
        _remove(temporary)
        _unfinished.discard(temporary)


def remove_unfinished() -> None:
    """Remove every temporary file and folder of this process: it is about to end at once."""
    for temporary in tuple(_unfinished):
        _remove(temporary)


def remove_left_behind(directory: Path, pattern: str) -> None:
    """Remove what killed processes have left of files whose names match; no other process may be writing them."""
    for temporary in directory.glob(f".{pattern}.*.*.tmp"):
        _remove(temporary)


def _remove(temporary: Path) -> None:
    if temporary.is_dir() and not temporary.is_symlink():
        shutil.rmtree(temporary, ignore_errors=True)
        return
    with suppress(OSError):
        temporary.unlink()


def write_durably(content: bytes, path: Path) -> None:
    """Write a file, whole or not at all; CorpusError if the disk refuses it."""
    with whole_or_not_at_all(path) as temporary:
        temporary.write_bytes(content)


def write_text_durably(text: str, path: Path) -> None:
    """Write a text file, whole or not at all; CorpusError if the disk refuses it."""
    write_durably(text.encode(), path)
