"""Places of results: a result replaces an earlier result of its kind and nothing else, and no file of a corpus."""

from pathlib import Path

import h5py

from gen.errors import CorpusError

_HDF5, _PARQUET, _ZIP = b"\x89HDF", b"PAR1", b"PK"
KINDS: dict[str, tuple[bytes, ...]] = {
    "feature table": (_HDF5, _PARQUET),
    "model": (_ZIP,),
    "page": (b"<!doctype html",),
    "picture": (b"\x89PNG", b"<?xml", b"%PDF"),
}
"""First bytes of the files of each kind of result."""


def check_result_file(path: Path, kind: str | None) -> None:
    """Refuse a file for a result that lies in a corpus, or exists and is no result of the same kind.

    Parameters
    ----------
    path
        The file.
    kind
        One of ``KINDS``; None if no file is replaced.

    Raises
    ------
    CorpusError
        With the path, and what to do.
    """
    _check_outside(path, path.parent)
    if path.is_file() and path.stat().st_size and (kind is None or not _is_of_kind(path, kind)):
        is_none = "" if kind is None else f" and is no {kind}"
        raise CorpusError(f"{path}: exists{is_none}; give another name, or remove it first.")


def check_result_folder(path: Path) -> None:
    """Refuse a folder for results that is a corpus, or lies in one."""
    _check_outside(path, path)


def check_new_corpus(path: Path) -> None:
    """Refuse a corpus within another."""
    _check_outside(path, path.parent)


def _check_outside(path: Path, folder: Path) -> None:
    real = folder.resolve()
    for corpus in (real, *real.parents):
        if (corpus / "manifest.json").is_file() and (corpus / "parts").is_dir():
            raise CorpusError(f"{path}: is in the corpus {corpus}; choose a place outside it.")


def _is_of_kind(path: Path, kind: str) -> bool:
    with path.open("rb") as file:
        start = file.read(16)
    if not start.startswith(KINDS[kind]):
        return False
    if not start.startswith(_HDF5):
        return True
    try:
        with h5py.File(path, "r", locking=False) as content:
            return "features" in content
    except OSError:
        return False
