"""The folder of a packed corpus, made again from its one file.

Each record is compared with its hash before it is written. Deflated chunks go back into their parts as they are.
"""

import json
from collections.abc import Mapping
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.corpus.files import new_corpus_folder
from gen.corpus.finishing import publish
from gen.corpus.index import corpus_attributes, write_index
from gen.corpus.journal import listed
from gen.corpus.manifest import INDEX_NAME, listed_file, read_manifest, write_content
from gen.corpus.packed import packed_contents, packed_part
from gen.corpus.part import PartRow, write_part
from gen.corpus.part_forms import dataset_of
from gen.corpus.record_checks import axes_problem, damage_of, hashed_blocks, listed_hashes, per_record
from gen.corpus.schema import SIGNAL
from gen.errors import CorpusError
from gen.progress import Progress, counter


class Unpacked(NamedTuple):
    """A corpus that was unpacked."""

    directory: Path
    records: int
    parts: int
    same_bytes: bool
    """Whether every part has the bytes of the part that was packed; with other versions of the libraries only the records are the same."""


def unpack(file: Path | str, directory: Path | str, *, progress: Progress | None = None) -> Unpacked:
    """Write the corpus of a packed file as a folder again, after a check of every record.

    Parameters
    ----------
    file : path
        A file that :func:`pack` made.
    directory : path
        Folder of the corpus: new or empty.
    progress : callable, optional
        Called with the number of records done and of all records.

    Raises
    ------
    CorpusError
        If the file is not a packed corpus or a record is damaged, the folder is not empty, or writing fails.
    """
    file, output = Path(file), Path(directory)
    if not file.is_file():
        raise CorpusError(f"{file}: is no file; give a file that raceway pack made.")
    manifest, files = read_manifest(file), packed_contents(file).files
    if (problem := axes_problem(file)) is not None:
        raise CorpusError(problem)
    rows: list[PartRow] = []
    done = counter(progress, manifest.records)
    with new_corpus_folder(output) as folder:
        for row in manifest.parts:
            rows.append(_written_again(file / "parts" / row.name, folder / "parts" / row.name))
            done(row.records)
        finish_again(folder, rows, files, corpus_attributes(file))
    return Unpacked(output, manifest.records, len(rows), rows == manifest.parts)


def _written_again(packed: Path, path: Path) -> PartRow:
    """Write one part of a packed file; CorpusError if a record is damaged."""
    place = packed_part(packed)[1]
    own = per_record(packed)[1]
    blocks, hashes = zip(*hashed_blocks(packed), strict=True)
    problem = damage_of(packed, listed_hashes(packed), list(chain.from_iterable(hashes)))
    if problem is not None:
        raise CorpusError(problem)
    values: dict[str, NDArray[Any]] = {name: variable.values for name, variable in own.items()}
    values[SIGNAL] = np.concatenate([block.values for block in blocks])
    try:
        dataset = dataset_of(place.form, place.attributes, values)
    except (KeyError, TypeError, ValueError) as error:
        raise CorpusError(
            f"{packed}: its list of variables does not fit them ({error}); do not trust this file."
        ) from None
    codec, chunks = place.form["codec"], None
    if codec == "zlib" and blocks[0].chunks is not None:
        stored = chain.from_iterable(block.chunks for block in blocks)
        chunks = dict(zip(np.ndindex(values[SIGNAL].shape[:2]), stored, strict=True))
    return write_part(dataset, path, codec, chunks)


def finish_again(
    directory: Path, rows: list[PartRow], files: Mapping[str, bytes], attributes: Mapping[str, Any]
) -> None:
    """Write index and small files beside parts; if these have other hashes than before, all that lists hashes is made anew."""
    for name, content in files.items():
        (directory / name).parent.mkdir(exist_ok=True)
        (directory / name).write_bytes(content)
    written = json.loads(files["manifest.json"]) | {"parts": [listed(row) for row in rows]}
    written.pop("next_index", None)
    write_index(directory, rows, attributes)
    written["index"] = listed_file(directory / INDEX_NAME)
    write_content(directory, written)
    if (directory / "manifest.json").read_bytes() != files["manifest.json"]:
        publish(directory, read_manifest(directory).publication)
