"""Places of corpora and results: nothing is written into a corpus, and nothing replaced but an earlier result of the same kind."""

import json
import zipfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

from gen.corpus.disk import (
    INDEX_NAME,
    check_name,
    corpus_around,
    place_of,
    removed_if_empty,
    write_text_durably,
    writing,
)
from gen.corpus.locking import lock
from gen.support.errors import CorpusError

GENERATOR = "Raceway"
"""Name that pages, pictures and numbers have among their facts."""
_MARKS = tuple(
    mark.encode()
    for mark in (
        f'<meta name="generator" content="{GENERATOR}">',
        f'"generator": "{GENERATOR}"',
        f"Software\0{GENERATOR}",  # PNG
        f"<dc:title>{GENERATOR}</dc:title>",  # SVG
        f"/Creator ({GENERATOR})",  # PDF
    )
)
_HEAD, _TAIL = 4096, 65_536  # bytes with the facts of a file; those of PDF are before the list of objects at its end
_OF_PAGES = (".html", ".json", ".png")
FILE_SUFFIXES = (
    *(
        ".h5",
        ".hdf5",
        ".hdf",
        ".nc4",
        ".cdf",
        ".netcdf",
        ".zarr",
        ".mat",
        ".csv",
        ".tsv",
        ".txt",
        ".xlsx",
        ".npy",
        ".npz",
        ".wav",
        ".tdms",
    ),
    *(".zip", ".tar", ".gz", ".json", ".yaml", ".html"),
)
"""Ends of names that promise a file of another kind than a corpus; other names with a dot, such as ``corpus_0.5``, are folders."""


def check_place(path: Path) -> None:
    """Refuse a place that no corpus can have: one in another corpus, a name that netCDF cannot open, and that of another kind of file."""
    check_name(path)
    if path.suffix.lower() in FILE_SUFFIXES:
        raise CorpusError(
            f"{path}: no corpus is a {path.suffix} file; name a folder, or a file that ends in .nc, which MATLAB, R, Julia and Octave "
            f"read; docs/sharing.md writes CSV, Zarr and Parquet."
        )
    _check_outside(path, path.parent)
    if path.name == INDEX_NAME:
        raise CorpusError(f"{path}: {INDEX_NAME} is the name of the index in a corpus; choose another name.")


def check_new(path: Path) -> None:
    """Refuse a target that is neither absent nor an empty folder, and a place that no corpus can have."""
    check_place(path)
    is_file = path.suffix in (".nc", ".parquet")
    place = path.parent.resolve() / path.name  # new/../old does not exist, and is old once new does
    if place.is_symlink() or (place.exists() and (is_file or not place.is_dir() or any(place.iterdir()))):
        raise CorpusError(
            f"{path}: exists{'' if is_file else ' and is not an empty folder'}; give a new name, or remove it first."
        )


def check_result(path: Path, kind: str | None) -> None:
    """Refuse a file for a result that lies in a corpus, or exists and is no earlier result of the same kind.

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
    _check_outside(path, place_of(path).parent)
    if path.is_file() and path.stat().st_size and (kind is None or not _is_of_kind(path, kind)):
        is_none = "" if kind is None else f" and is no {kind} of raceway"
        raise CorpusError(f"{path}: exists{is_none}; give another name, or remove it first.")


def check_result_folder(path: Path) -> None:
    """Refuse a folder for pages that is a corpus, lies in one, or holds a page, picture or JSON file that Raceway did not make."""
    _check_outside(path, path)
    for file in sorted(path.glob("*")):
        if file.suffix in _OF_PAGES and file.is_file() and not _is_of_kind(file, "page"):
            raise CorpusError(f"{file}: was not made by raceway; choose another folder, or move it first.")


def make_result_folder(path: Path) -> None:
    """Create the folder of a page if it does not exist; CorpusError if it is refused, or cannot be written."""
    check_result_folder(path)
    with writing(path):
        path.mkdir(parents=True, exist_ok=True)


@contextmanager
def result_folder(path: Path) -> Iterator[None]:
    """Create the folder of a page and lock it against other calls; a new one in which nothing is written is removed again.

    Raises
    ------
    CorpusError
        If it is refused, cannot be written, or another call holds its lock.
    """
    is_new = not path.exists()
    make_result_folder(path)
    with lock(path), removed_if_empty(path) if is_new else nullcontext():
        yield


def write_numbers(content: Mapping[str, Any], path: Path) -> None:
    """Write results as JSON, whole or not at all."""
    text = json.dumps({"generator": GENERATOR, **content}, indent=1, allow_nan=False)
    write_text_durably(f"{text}\n", path)


def _check_outside(path: Path, folder: Path) -> None:
    if (corpus := corpus_around(folder)) is not None:
        raise CorpusError(f"{path}: is in the corpus {corpus}; choose a place outside it.")


def _is_of_kind(path: Path, kind: str) -> bool:
    try:
        return KINDS[kind](path)
    except Exception:  # noqa: BLE001  the readers of zip, HDF5 and Parquet raise many unrelated types for other files
        return False


def _is_table(path: Path) -> bool:
    if path.suffix == ".parquet":
        from pyarrow import parquet

        return b"records_with_missing_features" in parquet.read_metadata(path).metadata
    import h5py  # not at the top: a command that is refused needs no HDF5

    with h5py.File(path, "r", locking=False) as content:
        return "features" in content and "records_with_missing_features" in content.attrs


def _is_model(path: Path) -> bool:
    with zipfile.ZipFile(path) as archive:
        return b'"raceway_model"' in archive.read("schema.json")


def _is_marked(path: Path) -> bool:
    with path.open("rb") as file:
        head = file.read(_HEAD)
        file.seek(max(0, path.stat().st_size - _TAIL))
        ends = head + file.read()
    return any(mark in ends for mark in _MARKS)


def _is_list(path: Path) -> bool:
    with path.open("rb") as file:
        return file.readline().startswith(b"recording,verdict,likeliest,probability,")


KINDS: Mapping[str, Callable[[Path], bool]] = {
    "feature table": _is_table,
    "list of diagnoses": _is_list,
    "model": _is_model,
    "page": _is_marked,
    "picture": _is_marked,
}
"""Kinds of files that a result replaces, and whether Raceway wrote a file of this kind."""
