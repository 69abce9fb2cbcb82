"""Packed files: a whole corpus as one netCDF-4 file with the layout of one part.

Beside the records, the group ``files`` holds the small files of the corpus, and ``contents.json`` lists them with the parts: a part is a
range of records. The path ``FILE.nc/parts/part-00003.nc`` names such a range, so that code that reads parts reads packed files too.
"""

import hashlib
import json
import re
from functools import lru_cache
from itertools import accumulate
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import h5py
import numpy as np
from pydantic import StringConstraints, TypeAdapter, ValidationError

from gen.corpus.files import Stamp, stamp
from gen.corpus.hdf5 import LIBRARY_LOCK, own_dataset
from gen.corpus.journal import Strict, first_problem, name_problem
from gen.errors import CorpusError
from gen.limits import check_limit

PACKED, PACKED_VERSION = "raceway_packed", 1
"""Global attribute of a packed file, and the version of its layout."""

FILES, CONTENTS = "files", "contents.json"
RECORD_HASH = "record_sha256"
"""Variable with the SHA-256 of each record."""

FILE_NAME = re.compile(
    r"README\.md|(?:card|croissant|manifest)\.json|recipe\.yaml|recipes/\d{5}\.yaml|pictures/[\w-]+\.png"
)
"""Names of the small files of a corpus."""


_Type = Annotated[str, StringConstraints(pattern=r"^[<|>](i[1248]|u[1248]|f[48]|S1)$")]


class _Number(Strict):
    """Attribute that is no text."""

    type: _Type
    value: int | float | list[int | float]


_Attributes = dict[Annotated[str, StringConstraints(pattern=r"^\w+$")], str | _Number]


class _Variable(Strict):
    name: Annotated[str, StringConstraints(pattern=r"^\w+$")]
    type: Literal["text"] | _Type
    label: bool
    attributes: _Attributes


class _Form(Strict):
    codec: Literal["zlib", "zstd", "none"]
    variables: list[_Variable]


_FORMS, _ATTRIBUTES = TypeAdapter(list[_Form]), TypeAdapter(list[_Attributes])


class PackedPart(NamedTuple):
    """Place of a part in a packed file, and its form: attributes and variables, by which its file can be written again."""

    first: int
    records: int
    attributes: dict[str, Any]
    form: dict[str, Any]


class Packed(NamedTuple):
    """Contents of a packed file beside its records: the small files by name, and the parts by name in the order of their records."""

    files: dict[str, bytes]
    parts: dict[str, PackedPart]
    axes_sha256: str
    """SHA-256 of channels and times."""


def home_of(part: Path) -> Path | None:
    """Packed file that a path of a part leads through; None for the path of an ordinary part.

    >>> home_of(Path("no_such_file.nc/parts/part-00000.nc"))
    """
    home = part.parent.parent
    return home if part.parent.name == "parts" and home.is_file() else None


def is_packed(path: Path) -> bool:
    """Whether a path is a packed file."""
    if not path.is_file():
        return False
    try:
        with LIBRARY_LOCK, h5py.File(path, "r", locking=False) as file:
            return PACKED in file.attrs
    except (OSError, RuntimeError, KeyError):  # h5py raises KeyError if the attributes are damaged
        return False


def packed_contents(path: Path) -> Packed:
    """Small files and parts of a packed file, after a check of their hashes.

    Raises
    ------
    CorpusError
        If the file is not a packed file of this version, or is damaged.
    """
    return _contents(str(path.absolute()), stamp(path))


@lru_cache(maxsize=4)
def _contents(path: str, _stamp: Stamp) -> Packed:
    try:
        with LIBRARY_LOCK, h5py.File(path, "r", locking=False) as file:
            _check_version(file)
            digest: Any = own_dataset(file, f"{FILES}/{CONTENTS}").attrs["sha256"]
            content = json.loads(_file(file, CONTENTS, digest.decode()))
            files = {name: _file(file, name, digest) for name, digest in content["files"].items()}
            return Packed(files, _parts(content), str(content["axes_sha256"]))
    except CorpusError:
        raise
    except Exception as error:  # noqa: BLE001 - h5py raises a dozen unrelated types on damaged bytes
        reason = (str(error) or type(error).__name__).splitlines()[0]
        raise CorpusError(
            f"{path}: not a whole packed corpus ({reason}); copy the file again, or pack again."
        ) from None


def _check_version(file: h5py.File) -> None:
    version = np.ravel(file.attrs.get(PACKED, "unknown"))[0]
    if version != PACKED_VERSION:
        raise CorpusError(
            f"{file.filename}: packed in layout {version}, this version of raceway reads {PACKED_VERSION}; pack the corpus again."
        )


def _file(file: h5py.File, name: str, digest: str) -> bytes:
    """Content of a small file; ValueError if its name is not allowed or it is altered."""
    if name != CONTENTS and not FILE_NAME.fullmatch(name):
        raise ValueError(f"{name!r} is not the name of a file of a corpus")
    stored = own_dataset(file, f"{FILES}/{name}")
    check_limit("manifest_bytes", stored.size or 0, f"{file.filename}: {name} has", CorpusError)
    content = np.asarray(stored[:]).tobytes()
    if hashlib.sha256(content).hexdigest() != digest:
        raise ValueError(f"{name} is altered: its hash differs")
    return content


def _parts(content: dict[str, Any]) -> dict[str, PackedPart]:
    rows = content["parts"]
    try:
        _FORMS.validate_python(content["forms"])
        _ATTRIBUTES.validate_python(content["attributes"])
    except ValidationError as error:
        raise ValueError(f"its list of variables is altered: {first_problem(error)}") from None
    problem = next(filter(None, (name_problem(row[0]) for row in rows)), None)
    if problem is not None or any(not isinstance(row[1], int) or row[1] < 1 for row in rows):
        raise ValueError(problem or "a part has no records")
    starts = accumulate((row[1] for row in rows), initial=0)
    return {
        name: PackedPart(first, records, content["attributes"][attributes], content["forms"][form])
        for first, (name, records, attributes, form) in zip(starts, rows, strict=False)
    }


def packed_part(path: Path) -> tuple[Path, PackedPart]:
    """Packed file and place of a part by its path ``FILE.nc/parts/NAME``; CorpusError if the file has no such part."""
    home = path.parent.parent
    parts = packed_contents(home).parts
    if path.name not in parts:
        raise CorpusError(f"{home}: has no part {path.name}; it has {next(iter(parts))} to {next(reversed(parts))}.")
    return home, parts[path.name]
