"""Files on disk: atomic writing, hashes, and refusal of anything but plain files inside the folder of a corpus.

A file is written under a temporary name, flushed to disk and renamed, so that a killed writer leaves no partial file under the final name.
"""

import hashlib
import os
import re
import shutil
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from gen.errors import CorpusError

Stamp = tuple[int, int]
"""Size and time of the last change [ns]; a file with a different stamp has changed."""

_CLOCK_TICK = 1_000_000_000  # ns; two changes within one tick of the clock of the file system can have the same stamp
_MOST_HASHES = 100_000
_hashes: dict[tuple[str, Stamp], str] = {}
_unfinished: set[Path] = set()


def stamp(path: Path | str) -> Stamp:
    """Stamp of a file; OSError if there is no file."""
    found = Path(path).stat()
    return found.st_size, found.st_mtime_ns


def sha256(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal; kept in this process until the stamp of the file changes."""
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
    """Forget all kept hashes."""
    _hashes.clear()


def plain_file(directory: Path, name: str) -> Path:
    """Path of a file of a corpus: a plain file inside the folder.

    Raises
    ------
    CorpusError
        If the file is missing, is not a plain file (a folder, a pipe, a device), or is a link that leads out of the folder.
    """
    path = directory / name
    # links are rare, and resolving every path takes ten times as long
    linked = path.is_symlink() or (path.parent != directory and path.parent.is_symlink())
    if linked and path.exists() and not path.resolve().is_relative_to(directory.resolve()):
        raise CorpusError(f"{path}: is a link that leads out of the corpus; replace it with a copy of the file.")
    if not path.is_file():
        reason = "is not a plain file" if path.exists() else "is missing"
        raise CorpusError(f"{path}: {reason}; copy it again, or run the command that made the corpus again.")
    return path


def check_name(path: Path) -> None:
    """Refuse a name that netCDF cannot open."""
    try:
        str(path).encode()
    except UnicodeEncodeError:
        raise CorpusError(f"{path}: the name is not UTF-8, and netCDF needs UTF-8; choose another.") from None


def check_new_folder(path: Path) -> None:
    """Refuse a folder that holds something, and a name that netCDF cannot open."""
    check_name(path)
    if path.is_symlink() or (path.exists() and not (path.is_dir() and not any(path.iterdir()))):
        raise CorpusError(f"{path}: exists and is not an empty folder; give a new folder, or remove this one first.")


@contextmanager
def whole_or_not_at_all(path: Path) -> Iterator[Path]:
    """Temporary path to write to: it is flushed to disk and then replaces ``path`` in one step, or is removed if anything fails.

    Raises
    ------
    CorpusError
        If writing fails, with the reason that the system gives.
    """
    check_name(path)
    if path.exists() and not path.is_file():
        raise CorpusError(f"{path}: exists and is not a plain file, so it cannot be replaced; choose another name.")
    with _written(path), temporary_beside(path) as temporary:
        yield temporary
        with temporary.open("rb+") as stream:
            os.fsync(stream.fileno())
        temporary.replace(path)
        _flush(path.parent)


@contextmanager
def whole_folder_or_none(path: Path) -> Iterator[Path]:
    """New folder under a temporary name to write to: it is flushed to disk and then gets the name ``path`` in one step, or is removed.

    Raises
    ------
    CorpusError
        If ``path`` exists and is not an empty folder, or if writing fails, with the reason that the system gives.
    """
    check_new_folder(path)
    path = path.absolute()  # "." has no name
    with _written(path), temporary_beside(path) as temporary:
        remove_left_behind_of(path)
        temporary.mkdir(parents=True)
        yield temporary
        for written in (*temporary.rglob("*"), temporary):
            _flush(written)
        temporary.replace(path)
        _flush(path.parent)


@contextmanager
def new_corpus_folder(path: Path) -> Iterator[Path]:
    """New folder of a corpus with an empty folder ``parts``, there as a whole or not at all (:func:`whole_folder_or_none`)."""
    with whole_folder_or_none(path) as folder:
        (folder / "parts").mkdir()
        yield folder


@contextmanager
def _written(path: Path) -> Iterator[None]:
    """CorpusError about ``path`` in place of an error of the system or of a library that writes."""
    try:
        yield
    except (OSError, RuntimeError) as error:
        raise CorpusError(
            f"{path}: could not be written ({_reason(error)}); free some space or choose another folder."
        ) from error


def remove_left_behind_of(path: Path) -> None:
    """Remove what killed processes have left of a file or folder; those of running processes, and of longer names, are kept."""
    own = re.compile(rf"\.{re.escape(path.name)}\.(\d+)\.\d+\.tmp")
    for found in path.parent.glob(".*.tmp"):
        match = own.fullmatch(found.name)
        if match is not None and not _is_being_written(found, int(match[1])):
            _remove(found)


def _is_being_written(temporary: Path, process: int) -> bool:
    """Whether a running process of this machine may be writing a temporary file; numbers of processes are given again."""
    if process == os.getpid():
        return temporary in _unfinished
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        pass
    return True


def _flush(path: Path) -> None:
    """Flush a file or a folder to disk."""
    opened = os.open(path, os.O_RDONLY)
    try:
        os.fsync(opened)
    finally:
        os.close(opened)


@contextmanager
def temporary_beside(path: Path) -> Iterator[Path]:
    """Hidden path in the folder of ``path`` for an unfinished file or folder; it is removed at the end if it still exists."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}.{threading.get_native_id()}.tmp")
    _unfinished.add(temporary)
    try:
        yield temporary
    finally:
        _remove(temporary)
        _unfinished.discard(temporary)


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """New folder among the temporary files of the system; it is removed at the end, also if a signal ends the process."""
    folder = Path(tempfile.mkdtemp(prefix="raceway-"))
    _unfinished.add(folder)
    try:
        yield folder
    finally:
        _remove(folder)
        _unfinished.discard(folder)


def remove_unfinished() -> None:
    """Remove all temporary files and folders of this process, just before it ends."""
    for temporary in tuple(_unfinished):
        _remove(temporary)


def remove_left_behind(directory: Path, pattern: str) -> None:
    """Remove temporary files that killed processes have left, by a pattern of names; no other process may be writing them."""
    for temporary in directory.glob(f".{pattern}.*.*.tmp"):
        _remove(temporary)


def _remove(temporary: Path) -> None:
    if temporary.is_dir() and not temporary.is_symlink():
        shutil.rmtree(temporary, ignore_errors=True)
        return
    with suppress(OSError):
        temporary.unlink()


def write_durably(content: bytes, path: Path) -> None:
    """Write a file atomically; CorpusError if writing fails."""
    with whole_or_not_at_all(path) as temporary:
        temporary.write_bytes(content)


def write_text_durably(text: str, path: Path) -> None:
    """Write a text file atomically; CorpusError if writing fails."""
    write_durably(text.encode(), path)


def _reason(error: OSError | RuntimeError) -> str:
    """Why the system refused to write. HDF5 puts the error number into a text with addresses and line breaks.

    >>> _reason(RuntimeError("write failed (errno = 28, error message = 'No space left on device', buf = 0x7fafb143fe10)"))
    'No space left on device'
    """
    in_text = re.search(r"errno = (\d+)", str(error))
    code = getattr(error, "errno", None) or (in_text and int(in_text[1]))
    return os.strerror(code) if code else " ".join(str(error).split())
