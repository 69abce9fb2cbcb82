"""A whole corpus written into one netCDF-4 file.

A packed file has the layout of one part with all records: the same variables, one chunk per record and channel. Deflated chunks are copied
as they are. It also holds the small files of the corpus, the forms of the parts and a SHA-256 per record, so that
:mod:`gen.sharing.unpacking` writes the same parts again, byte for byte. :mod:`gen.corpus.packed` reads it.
"""

import hashlib
import json
from collections.abc import Callable, Iterator
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import netCDF4
import numpy as np

from gen.corpus.codecs import CODECS, Codec
from gen.corpus.files import whole_or_not_at_all
from gen.corpus.hdf5 import LIBRARY_LOCK
from gen.corpus.index import corpus_attributes, write_variables
from gen.corpus.manifest import INDEX_NAME, Manifest, part_paths, read_manifest
from gen.corpus.packed import (
    CONTENTS,
    FILE_NAME,
    FILES,
    PACKED,
    PACKED_VERSION,
    RECORD_HASH,
)
from gen.corpus.part import deflated
from gen.corpus.part_forms import form_of
from gen.corpus.reading import StoredBlock, open_part
from gen.corpus.record_checks import hashed_blocks
from gen.corpus.record_hashes import axes_sha256
from gen.corpus.schema import SIGNAL, SIGNAL_DIMS
from gen.corpus.unicode_text import set_attributes, write_unicode
from gen.errors import CorpusError
from gen.progress import Progress, counter

_COMMENT = (
    "A whole corpus in one file. Variables and units are those of every record; the group files holds manifest, recipe and data card. "
    "Python: gen.open_corpus(FILE), or any netCDF-4 reader. raceway validate FILE checks it, raceway unpack FILE -o DIR makes the folder."
)
_MOST_BYTES = 5_000_000  # of one of the small files; a longer one is left out


class PackedFile(NamedTuple):
    """A packed file that was written."""

    file: Path
    records: int
    parts: int
    bytes: int


def pack_whole(directory: Path, file: Path, codec: Codec, progress: Progress | None) -> PackedFile:
    """Write all records of a corpus folder into one file, after a check of every file of the corpus.

    Raises
    ------
    CorpusError
        If the corpus is unfinished or damaged, its parts differ in their variables, or writing fails.
    """
    paths, manifest = part_paths(directory), read_manifest(directory)
    forms = _forms(paths)
    with whole_or_not_at_all(file) as temporary:
        with LIBRARY_LOCK:
            write_variables(directory, manifest.parts, temporary, {"comment": _COMMENT})
            _declare(temporary, directory, paths[0], codec)
            _write_files(temporary, small_files(directory), _contents(manifest, forms, paths[0]))
        direct = codec == "zlib" == json.loads(forms[0][1])["codec"]
        _copy_records(paths, temporary, direct, codec, counter(progress, manifest.records))
        if file.exists():
            raise CorpusError(f"{file}: exists now, made by another command; give another name, or remove it first.")
    return PackedFile(file, manifest.records, len(paths), file.stat().st_size)


def _forms(paths: list[Path]) -> list[tuple[str, str]]:
    """Attributes and form of each part as JSON; equal texts are kept once.

    Parts with other variables or another packing than the first are refused: the file would give them wrong values.
    """
    kept: dict[str, str] = {}
    found: list[tuple[str, str]] = []
    first: list[str] = []
    for path in paths:
        attributes, form = form_of(path)
        text = json.dumps(form)
        if text not in kept:
            first = first or _storage(form)
            if _storage(form) != first:
                raise CorpusError(
                    f"{path}: has other variables or another scale than {paths[0].name}; the corpus cannot be one file."
                )
        attribute = json.dumps(attributes)
        found.append((kept.setdefault(attribute, attribute), kept.setdefault(text, text)))
    return found


def _storage(form: dict[str, Any]) -> list[str]:
    """Names and types of the variables of a part, with the attributes of the signal; as text, in which two NaN are equal."""
    return sorted(
        json.dumps([item["name"], item["type"], item["attributes"] if item["name"] == SIGNAL else None])
        for item in form["variables"]
    )


def _declare(path: Path, directory: Path, part: Path, codec: Codec) -> None:
    """Declare signal and hashes in the new file, and copy the attributes of the signal and of the corpus."""
    attributes = corpus_attributes(directory / INDEX_NAME)
    with netCDF4.Dataset(part) as like, netCDF4.Dataset(path, "a") as file:
        texts = set_attributes(file, attributes | {PACKED: np.int32(PACKED_VERSION)})
        model = like[SIGNAL]
        signal = {name: model.getncattr(name) for name in model.ncattrs()}
        storage = {
            "fill_value": signal.pop("_FillValue"),
            "chunksizes": (1, 1, model.shape[2]),
            **CODECS[codec].options,
        }
        stored = file.createVariable(SIGNAL, model.dtype, SIGNAL_DIMS, **storage)
        stored.set_auto_maskandscale(False)
        stored.setncatts(signal)
        file.createDimension(f"{RECORD_HASH}_length", 64)
        hashes = file.createVariable(RECORD_HASH, "S1", ("record", f"{RECORD_HASH}_length"), fill_value=False)
        hashes.setncatts({"units": "1", "long_name": "SHA-256 of the record, in hexadecimal", "role": "provenance"})
    with h5py.File(path, "r+") as file:
        write_unicode(file, texts)


def small_files(directory: Path) -> dict[str, bytes]:
    """Manifest, recipes, data card and pictures of a corpus, by name."""
    places = chain(directory.iterdir(), directory.glob("recipes/*"), directory.glob("pictures/*"))
    names = sorted(
        path.relative_to(directory).as_posix() for path in places if path.is_file() and not path.is_symlink()
    )
    kept = [name for name in names if FILE_NAME.fullmatch(name) and (directory / name).stat().st_size <= _MOST_BYTES]
    return {name: (directory / name).read_bytes() for name in kept}


def _contents(manifest: Manifest, forms: list[tuple[str, str]], first: Path) -> dict[str, Any]:
    """Hash of the axes of the ``first`` part, and parts with their records and the numbers of their attributes and forms.

    Equal attributes and forms are listed once.
    """
    attributes, shapes = (
        {text: number for number, text in enumerate(dict.fromkeys(texts))} for texts in zip(*forms, strict=True)
    )
    parts = [
        [row.name, row.records, attributes[attribute], shapes[shape]]
        for row, (attribute, shape) in zip(manifest.parts, forms, strict=True)
    ]
    listed = {"attributes": attributes, "forms": shapes}
    with open_part(first) as part:
        axes = axes_sha256(part)
    return (
        {"axes_sha256": axes}
        | {name: [json.loads(text) for text in texts] for name, texts in listed.items()}
        | {"parts": parts}
    )


def _write_files(path: Path, files: dict[str, bytes], contents: dict[str, Any]) -> None:
    """Write the small files as characters, pictures as bytes, each with its hash in ``contents``."""
    hashes = {name: hashlib.sha256(content).hexdigest() for name, content in files.items()}
    listing = json.dumps({"files": hashes, **contents}, separators=(",", ":")).encode()
    with netCDF4.Dataset(path, "a") as file:
        for name, content in {CONTENTS: listing, **files}.items():
            folder, _, last = f"{FILES}/{name}".rpartition("/")
            group = file.createGroup(folder)
            group.createDimension(f"{last}_length", len(content))
            kind = "u1" if name.endswith(".png") else "S1"
            stored = group.createVariable(last, kind, (f"{last}_length",), zlib=True, complevel=4, fill_value=False)
            stored.set_auto_chartostring(False)
            stored[:] = np.frombuffer(content, kind)
            stored.setncatts({"long_name": f"file {name} of the corpus", "sha256": hashlib.sha256(content).hexdigest()})


def _copy_records(paths: list[Path], target: Path, direct: bool, codec: Codec, report: Callable[[int], None]) -> None:
    """Copy the signals of all parts, with the hash of each record."""
    first = 0
    with LIBRARY_LOCK, h5py.File(target, "r+") as file:
        signal: Any = file[SIGNAL]
        for path in paths:
            for block, hashes in hashed_blocks(path):
                n = len(hashes)
                _write_hashes(file, first, hashes)
                if codec != "zlib":
                    signal[first : first + n] = block.values
                else:
                    for place, chunk in zip(np.ndindex(block.values.shape[:2]), _deflated(block, direct), strict=True):
                        signal.id.write_direct_chunk((first + place[0], place[1], 0), chunk)
                first += n
                report(n)


def _write_hashes(file: h5py.File, first: int, hashes: list[str]) -> None:
    """Write hashes as characters in the type of the file: h5py would convert each into an empty text."""
    stored = h5py.h5d.open(file.id, RECORD_HASH.encode())
    letters = np.array(hashes, "S64").view("S1").reshape(len(hashes), 64)
    space = stored.get_space()
    space.select_hyperslab((first, 0), letters.shape)
    stored.write(h5py.h5s.create_simple(letters.shape), space, letters, stored.get_type())


def _deflated(block: StoredBlock, direct: bool) -> Iterator[bytes]:
    """Chunks of a block, by record and channel."""
    if direct and block.chunks is not None:
        return iter(block.chunks)
    return (deflated(samples) for samples in block.values.reshape(-1, block.values.shape[2]))
