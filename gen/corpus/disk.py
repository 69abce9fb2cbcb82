"""Files on disk: atomic writing, checksums, and refusal of anything but plain files inside the folder of a corpus.

A file is written under a temporary name, flushed to disk and renamed, so that a killed writer leaves no partial file under the final name.
Every netCDF file of a corpus ends with a line that holds the SHA-256 of all bytes before it. HDF5 ignores bytes behind its own, so all
readers open the file; a changed byte is found before any library opens it.
"""

import errno
import hashlib
import os
import platform
import re
import shutil
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

from gen.support.errors import CorpusError

INDEX_NAME, MANIFEST_NAME, RECIPE_NAME = "index.nc", "manifest.json", "recipe.yaml"
CARD_NAME, CROISSANT_NAME = "README.md", "croissant.json"  # written by ``raceway.describe``
CARD_SUFFIX = ".card"
"""Suffix of the folder of the data card beside a corpus in a single file."""
Stamp = tuple[int, int, int]
"""Size of a file, time of its last change, and that of the last change of what the system knows of it [ns]."""

_ADVICE = dict.fromkeys(
    (0, errno.ENOSPC, errno.EDQUOT, errno.EFBIG), "free some space or choose another folder"
) | dict.fromkeys((errno.EACCES, errno.EPERM), "get permission to write there or choose another folder")
_CHECKSUM_BYTES = 73
_HOST = re.sub(r"[^\w-]", "-", platform.node())
_READ_BYTES = 1_000_000
_unfinished: set[Path] = set()
_perhaps_empty: set[Path] = set()


def stamp(path: Path | str) -> Stamp:
    """Stamp of a file; OSError if there is no file."""
    status = Path(path).stat()
    # a program can put the time of the last change back, but not st_ctime
    return status.st_size, status.st_mtime_ns, status.st_ctime_ns


def sha256(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal; kept in this process until the stamp of the file changes. CorpusError if it cannot be read."""
    with reading(path):
        return _hashes(path.absolute(), stamp(path))[0]


@lru_cache(100_000)
def _hashes(path: Path, stamp: Stamp) -> tuple[str, bool]:
    """SHA-256 of a file, and whether its last line is that of all bytes before."""
    digest, left = hashlib.sha256(), stamp[0] - _CHECKSUM_BYTES
    # one reading gives both
    with path.open("rb", buffering=0) as stream:
        while left > 0 and (block := stream.read(min(left, _READ_BYTES))):
            digest.update(block)
            left -= len(block)
        last, expected = stream.read(), _checksum_line(digest)
    digest.update(last)
    return digest.hexdigest(), last == expected


def _checksum_line(digest: Any) -> bytes:
    return f"\nsha256:{digest.hexdigest()}\n".encode()


def append_checksum(path: Path) -> str:
    """Append the line with the SHA-256 of a file to it; returns the SHA-256 of the file with that line, in hexadecimal."""
    with path.open("rb+") as stream:
        digest = hashlib.file_digest(stream, "sha256")
        line = _checksum_line(digest)
        stream.seek(0, os.SEEK_END)
        stream.write(line)
    digest.update(line)
    return digest.hexdigest()


def remove_checksum(path: Path) -> None:
    """Cut the line with the checksum off a file that is going to be changed."""
    os.truncate(path, path.stat().st_size - _CHECKSUM_BYTES)


def has_whole_bytes(path: Path) -> bool:
    """Whether a file ends with the SHA-256 of all its other bytes; CorpusError if it cannot be read."""
    with reading(path):
        return _hashes(path.absolute(), stamp(path))[1]


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Raise CorpusError about ``path`` in place of an error of the system."""
    try:
        yield
    except OSError as error:
        advice = "get permission to read it, or copy it again"
        raise CorpusError(f"{path}: could not be read ({system_reason(error)}); {advice}.") from error


def system_reason(error: Exception) -> str:
    """Reason of the system for an error, without the numbers and addresses with which HDF5 and netCDF give it; else its first line."""
    code = _code_of(error)
    text = os.strerror(code) if code else str(getattr(error, "strerror", None) or error) or type(error).__name__
    first = next(filter(None, map(str.strip, text.splitlines())), type(error).__name__)
    return re.sub(r": \S+ = [^)]*", "", first) if isinstance(error, OSError) else first


def _code_of(error: Exception) -> int:
    """Number of the system; 0 without."""
    # HDF5 puts the number of the system into a text with addresses; netCDF has numbers of its own, which are negative
    in_text = re.search(r"errno = (\d+)", str(error))
    return int(in_text[1]) if in_text else max(0, getattr(error, "errno", None) or 0)


def plain_file(directory: Path, name: str) -> Path:
    """Path of a file of a corpus: a plain file inside the folder.

    Raises
    ------
    CorpusError
        If the file is missing, is not a plain file (a folder, a pipe, a device), or is a link that leads out of the folder.
    """
    path = directory / name
    with reading(path):
        # links are rare, and resolving every path takes ten times as long
        linked = path.is_symlink() or (path.parent != directory and path.parent.is_symlink())
        if linked and path.exists() and not path.resolve().is_relative_to(directory.resolve()):
            raise CorpusError(f"{path}: is a link that leads out of the corpus; replace it with a copy of the file.")
        if not path.is_file():
            reason = "is not a plain file" if path.exists() else "is missing"
            raise CorpusError(f"{path}: {reason}; copy it again, or run the command that made the corpus again.")
    return path


def corpus_around(folder: Path) -> Path | None:
    """Corpus that a folder is, or lies in; None without."""
    real = folder.resolve()
    around = (real, *real.parents)
    return next((it for it in around if (it / MANIFEST_NAME).is_file() and (it / "parts").is_dir()), None)


def place_of(path: Path) -> Path:
    """Place that is written: the target of a link, but the link itself in a corpus or a data card, which may come from a stranger."""
    folder = path.parent.resolve()
    if not path.is_symlink() or CARD_SUFFIX in (it.suffix for it in (folder, *folder.parents)) or corpus_around(folder):
        return path
    return Path(os.path.realpath(path))  # of a circle of links, one of them


def check_name(path: Path) -> None:
    """Refuse a name that netCDF cannot open."""
    try:
        str(path).encode()
    except UnicodeEncodeError:
        raise CorpusError(f"{path}: the name is not UTF-8, and netCDF needs UTF-8; choose another.") from None


@contextmanager
def whole_or_not_at_all(path: Path) -> Iterator[Path]:
    """Temporary path to write to: it is flushed to disk and then replaces ``path`` in one step, or is removed if anything fails.

    What killed writers of the same file have left is removed. The file is that of :func:`place_of`.

    Raises
    ------
    CorpusError
        If writing fails, with the reason that the system gives.
    """
    check_name(path)
    if path.exists() and not path.is_file():
        raise CorpusError(f"{path}: exists and is not a plain file, so it cannot be replaced; choose another name.")
    place = place_of(path)
    # in the same folder, since a rename across file systems copies
    with temporary_beside(place) as temporary, writing(path, temporary):
        remove_left_behind_of(place)
        yield temporary
        with temporary.open("rb+") as stream:
            # on disk before it has its name, so that a name stands for a whole file
            os.fsync(stream.fileno())
        temporary.replace(place)
        _flush(place.parent)


@contextmanager
def whole_folder_or_none(path: Path) -> Iterator[Path]:
    """New folder under a temporary name to write to: it is flushed to disk and then gets the name ``path`` in one step, or is removed.

    Raises
    ------
    CorpusError
        If writing fails, with the reason that the system gives; also if ``path`` exists by then and is not an empty folder.
    """
    check_name(path)
    path = path.absolute()  # "." has no name
    with temporary_beside(path) as temporary, writing(path, temporary):
        remove_left_behind_of(path)
        temporary.mkdir(parents=True)
        yield temporary
        for written in (*temporary.rglob("*"), temporary):
            _flush(written)
        temporary.replace(path)
        _flush(path.parent)


@contextmanager
def writing(path: Path, temporary: Path | None = None) -> Iterator[None]:
    """Raise CorpusError about ``path`` in place of an error of the system or of a library that writes; ``temporary`` is never named."""
    hidden = str(temporary or path)
    try:
        yield
    # users know the name that they gave, not the temporary one
    except CorpusError as error:
        if hidden not in str(error):
            raise
        raise CorpusError(str(error).replace(hidden, str(path))) from error
    except (OSError, RuntimeError) as error:
        # HDF5 loses the number on a full disk, so without one the advice is that for a full disk
        advice = _ADVICE.get(_code_of(error), "choose another folder")
        reason = system_reason(error).replace(hidden, str(path))
        raise CorpusError(f"{path}: could not be written ({reason}); {advice}.") from error


def remove_left_behind_of(path: Path) -> None:
    """Remove what killed processes of this machine have left of a file or folder; those of running ones, and of longer names, are kept."""
    own = re.compile(rf"\.{re.escape(path.name)}\.{_HOST}\.(\d+)\.\d+\.tmp")
    for other in path.parent.glob(".*.tmp"):
        match = own.fullmatch(other.name)
        if match is not None and not _is_being_written(other, int(match[1])):
            _remove(other)


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
    temporary = path.with_name(f".{path.name}.{_HOST}.{os.getpid()}.{threading.get_native_id()}.tmp")
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


@contextmanager
def removed_if_empty(folder: Path) -> Iterator[None]:
    """Remove a folder at the end if nothing is in it, also if a signal ends the process."""
    _perhaps_empty.add(folder)
    try:
        yield
    finally:
        with suppress(OSError):
            folder.rmdir()
        _perhaps_empty.discard(folder)


def remove_unfinished() -> None:
    """Remove all temporary files and folders of this process, and those without content, just before it ends."""
    for temporary in tuple(_unfinished):
        _remove(temporary)
    for folder in tuple(_perhaps_empty):
        with suppress(OSError):
            folder.rmdir()


def remove_temporary_files(directory: Path) -> None:
    """Remove temporary files that killed calls have left beside the files of a corpus; no other process may be writing into it."""
    for folder in (directory, directory / "parts", directory / "pictures"):
        for temporary in folder.glob(".*.*.*.*.tmp"):
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
