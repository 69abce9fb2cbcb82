"""Check of every record of a packed file against its SHA-256."""

import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from pathlib import Path

import h5py
import numpy as np
import xarray as xr

from gen.corpus.files import Stamp, stamp
from gen.corpus.hdf5 import LIBRARY_LOCK, own_dataset
from gen.corpus.packed import RECORD_HASH, packed_contents, packed_part
from gen.corpus.reading import StoredBlock, blocks_with_chunks, open_part, open_records
from gen.corpus.record_hashes import axes_sha256, hashes_of, packing_scale
from gen.corpus.schema import SIGNAL
from gen.errors import CorpusError

_BLOCK_SAMPLES = 2_000_000  # samples of the records that are read at a time: larger blocks are no faster
_MOST_THREADS = 4  # the check of one part holds 20 to 60 MB


def record_problems(file: Path) -> list[str]:
    """Records of a packed file whose hash differs, one sentence for each part, and damaged axes.

    They are kept in this process until the stamp of the file changes.
    """
    return list(_problems(file, stamp(file)))


@lru_cache(maxsize=64)
def _problems(file: Path, _stamp: Stamp) -> tuple[str, ...]:
    paths = [file / "parts" / name for name in packed_contents(file).parts]
    with ThreadPoolExecutor(min(_MOST_THREADS, len(os.sched_getaffinity(0)))) as pool:
        return tuple(filter(None, [axes_problem(file), *pool.map(_part_problem, paths)]))


def axes_problem(file: Path) -> str | None:
    """Sentence about channels or times of a packed file whose hash differs; None if they are whole."""
    try:
        with open_records(file, [file]) as records:
            found = axes_sha256(records)
    except CorpusError as error:
        return str(error)
    if found == packed_contents(file).axes_sha256:
        return None
    return f"{file}: its channels or times are damaged: their hash differs; copy the file again, or pack again."


def _part_problem(path: Path) -> str | None:
    try:
        listed, found = listed_hashes(path), [digest for _, hashes in hashed_blocks(path) for digest in hashes]
    except CorpusError as error:
        return str(error)
    return damage_of(path, listed, found)


def damage_of(path: Path, listed: list[str], found: list[str]) -> str | None:
    """Sentence about the first record of a part in a packed file whose hash is not the listed one; None if there is none."""
    wrong = [number for number, (one, other) in enumerate(zip(listed, found, strict=True)) if one != other]
    if not wrong:
        return None
    file, place = packed_part(path)
    more = f", and {len(wrong) - 1} more of {path.name}" if len(wrong) > 1 else ""
    return f"{file}: record {place.first + wrong[0]} is damaged{more}: its hash differs; copy the file again, or pack again."


def hashed_blocks(path: Path) -> Iterator[tuple[StoredBlock, list[str]]]:
    """Stored records of a part, some at a time, with their hashes."""
    scale, own = per_record(path)
    first = 0
    for block in blocks_with_chunks(path, _BLOCK_SAMPLES):
        rows = slice(first, first + len(block.values))
        yield block, hashes_of(block.values, scale, {name: variable[rows] for name, variable in own.items()})
        first = rows.stop


def per_record(path: Path) -> tuple[float | None, dict[str, xr.Variable]]:
    """Scale of the signal of a part, and its other variables, in memory."""
    with open_part(path) as part:
        found = {str(name): variable.load() for name, variable in part.variables.items() if name != SIGNAL}
        return packing_scale(part[SIGNAL].variable), found


def listed_hashes(path: Path) -> list[str]:
    """Hashes that a packed file lists for the records of a part."""
    home, place = packed_part(path)
    with LIBRARY_LOCK, h5py.File(home, "r", locking=False) as file:
        try:
            stored = own_dataset(file, RECORD_HASH)
            letters = np.asarray(stored[place.first : place.first + place.records])
            return [bytes(row).decode() for row in letters.view("S64").reshape(place.records)]
        except (KeyError, OSError, TypeError, ValueError) as error:
            raise CorpusError(
                f"{home}: has no readable {RECORD_HASH} ({error}); copy the file again, or pack again."
            ) from None
