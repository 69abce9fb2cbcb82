"""Recordings of the user, described by a mapping file: paths, variables, units, bearing, speed and fault.

Files are MATLAB, delimited text or NumPy. Paths are relative to the folder of the mapping file and cannot leave it.
"""

import math
from collections.abc import Hashable, Iterable
from functools import partial
from pathlib import Path

from gen.corpus import UNKNOWN
from gen.errors import CorpusError
from gen.importers.assemble import Collection, Import, Progress, import_recordings
from gen.importers.conversion import Scale, accelerations
from gen.importers.mapping import Entry, bearing_of, read_mapping
from gen.importers.recordings import Candidate, Recording, name_of, some_files
from gen.importers.signals import Place, read_values
from gen.units import rpm_to_hertz, to_si


def import_generic(source: Path, output: Path, *, window: float = 0.5, progress: Progress | None = None) -> Import:
    """Bring the recordings that the mapping file ``source`` describes into a corpus at their sample rate.

    Rigs and specimens are numbered in the order in which the mapping names them.

    Parameters
    ----------
    source : Path
        The mapping file (YAML).
    output : Path
        Folder of the new corpus.
    window : float
        Length of a record [s].
    progress : callable, optional
        Called with the number of files done and the number of all.

    Raises
    ------
    CorpusError
        If the mapping file is in error, nothing can be imported, the output is taken, or the window is out of
        range.
    """
    mapping = read_mapping(source)
    fs = _common_sample_rate(source, mapping.entries)
    rigs = _numbered(entry.rig for entry in mapping.entries)
    specimens = _numbered((entry.rig, entry.specimen) for entry in mapping.entries)
    candidates: dict[str, Candidate] = {}
    skipped: list[str] = []
    looked_at = 0
    for position, entry in enumerate(mapping.entries):
        paths = _matches(source, position, entry.path, looked_at)
        looked_at += len(paths)
        if not paths:
            skipped.append(f"{entry.path}: no file beside {source.name} matches; skipped.")
        for path in paths:
            name = _name(name_of(path, source.parent), entry)
            if name in candidates:
                skipped.append(f"{name}: is listed again by files[{position}]; skipped.")
                continue
            places = len(candidates), rigs[entry.rig], specimens[entry.rig, entry.specimen]
            candidates[name] = Candidate(path, name, partial(_read, path, entry, *places))
    collection = Collection("generic", mapping.title, mapping.origin, fs, mapping.channel)
    return import_recordings(
        collection, list(candidates.values()), output, window=window, skipped=skipped, progress=progress
    )


def _common_sample_rate(source: Path, entries: tuple[Entry, ...]) -> float:
    first = entries[0]
    for position, other in enumerate(entries):
        if other.sample_rate_hz != first.sample_rate_hz:
            message = (
                f"{source}: files[{position}] ({other.path}) is at {other.sample_rate_hz:g} Hz and files[0] "
                f"({first.path}) at {first.sample_rate_hz:g} Hz; a corpus has one sample rate: make a corpus of each."
            )
            raise CorpusError(message)
    return first.sample_rate_hz


def _numbered(keys: Iterable[Hashable]) -> dict[Hashable, int]:
    """Number of each distinct key, in order of appearance."""
    return {key: number for number, key in enumerate(dict.fromkeys(keys))}


def _matches(source: Path, position: int, pattern: str, looked_at: int) -> list[Path]:
    """Files that a pattern names, sorted; none may lie outside the folder of the mapping file."""
    folder, where = source.parent, f"{source}: files[{position}].path: {pattern}"
    parts = Path(pattern).parts
    if Path(pattern).is_absolute() or ".." in parts:
        message = (
            f"{where} leads out of the folder of the mapping file; put the mapping file in a folder above the data."
        )
        raise CorpusError(message)
    beside_names = any("**" in part for part in parts if part != "**")  # Python 3.13 takes it for a single *
    if not parts or parts.count("**") > 1 or beside_names:  # each further ** looks at every folder once more
        message = f"{where} is not a pattern of file names; write it like data/*.mat, with ** at most once."
        raise CorpusError(message)
    exact = folder / pattern
    try:
        found = [exact] if exact.is_file() else filter(Path.is_file, folder.glob(pattern))
        paths = some_files(found, looked_at, f"{where} and the patterns before match")
    except (ValueError, OSError) as error:
        message = f"{where} is not a pattern of file names ({error}); write it like data/*.mat."
        raise CorpusError(message) from None
    root = folder.resolve()
    for path in paths:
        if not path.resolve().is_relative_to(root):
            message = f"{where} matches a link that leads out of the folder; copy the files into it."
            raise CorpusError(message)
    return paths


def _name(path: str, entry: Entry) -> str:
    """Name of a recording: its file, and its variable and column where the mapping names them."""
    return ":".join([path, *(str(part) for part in (entry.variable, entry.column) if part is not None)])


def _read(path: Path, entry: Entry, number: int, rig: int, specimen: int) -> Recording:
    found = read_values(path, Place(entry.variable, entry.column, entry.delimiter))
    spalled = entry.fault not in ("healthy", "cage")
    unknown = math.nan if spalled else 0.0
    count = {"healthy": 0, "cage": 0, "compound": 2, UNKNOWN: -1}.get(entry.fault, 1)
    return Recording(
        number=number,
        rig=rig,
        specimen=specimen,
        bearing=bearing_of(entry),
        shaft_rate=rpm_to_hertz(entry.shaft_rpm),
        fault=entry.fault,
        signal=accelerations(found.values, Scale(entry.unit)),
        load=math.nan if entry.load_n is None else entry.load_n,
        n_spalls=entry.n_spalls or count,
        width=unknown if entry.width_mm is None else to_si(entry.width_mm, "mm"),
        depth=unknown if entry.depth_um is None else to_si(entry.depth_um, "um"),
        angle=math.nan if entry.angle_deg is None else to_si(entry.angle_deg, "deg"),
    )
