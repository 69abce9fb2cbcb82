"""Recordings of the user, described by a mapping file: paths, variables, units, bearing, speed and fault.

``mapping file -> sections -> files with the facts of their paths -> recordings -> corpus``
"""

import math
from collections.abc import Hashable, Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from pydantic import ValidationError

from gen.corpus import UNKNOWN
from gen.errors import CorpusError
from gen.importers.assemble import Collection, Import, import_recordings
from gen.importers.assumptions import assumptions
from gen.importers.conversion import accelerations, doubts
from gen.importers.entry import Entry, bearing_of, sensors
from gen.importers.files import FloatArray, UnusableError, one_column
from gen.importers.listing import File, listed_recordings, name_of_recording
from gen.importers.mapping import MappingFile, read_mapping, sentence_of
from gen.importers.matlab import read_matlab
from gen.importers.recordings import Candidate, Recording
from gen.importers.resampling import resampled
from gen.importers.signals import read_values, stated_rate
from gen.progress import Progress
from gen.units import rpm_to_hertz, to_si

_NO_RATE = 10_000.0  # Hz, if no file tells a rate: each is then refused with its own reason
_SPALLS = {"healthy": 0, "cage": 0, "compound": 2, UNKNOWN: -1}
_SAME_SPEED = 0.02  # relative; files of one recording can differ by less, and the record has the speed of the first


class _Target(NamedTuple):
    """Sample rate of the corpus [Hz], and whether recordings at other rates are resampled."""

    fs: float
    resample: bool


def import_generic(
    source: Path,
    output: Path,
    *,
    window: float = 0.5,
    folder: Path | None = None,
    progress: Progress | None = None,
) -> Import:
    """Bring the recordings that the mapping file ``source`` describes into a corpus.

    Rigs and specimens are numbered in the order in which they are found.

    Parameters
    ----------
    source : Path
        The mapping file (YAML).
    output : Path
        Folder of the new corpus.
    window : float
        Length of a record [s].
    folder : Path, optional
        Folder of the recordings, which paths are relative to; by default that of the mapping file.
    progress : callable, optional
        Called with the number of recordings done and the number of all.

    Raises
    ------
    CorpusError
        If the mapping file is in error, nothing can be imported, the output is taken, or the window is out of
        range.
    """
    mapping = read_mapping(source)
    found, skipped = listed_recordings(source, source.parent if folder is None else folder, mapping)
    fs = _common_rate(source, mapping, found)
    target = _Target(fs, resample=mapping.resample is not None)
    rigs = _numbered(files[0].entry.rig for files in found)
    specimens = _numbered((files[0].entry.rig, files[0].entry.specimen) for files in found)
    candidates = []
    for number, files in enumerate(found):
        entry = files[0].entry
        places = number, rigs[entry.rig], specimens[entry.rig, entry.specimen]
        read = partial(_read, files, target, *places)
        candidates.append(Candidate(files[0].path, name_of_recording(files), read))
    collection = Collection(
        "generic", mapping.title, mapping.origin, fs, mapping.channels, facts=assumptions(mapping.sections, fs)
    )
    return import_recordings(collection, candidates, output, window=window, skipped=skipped, progress=progress)


def _numbered(keys: Iterable[Hashable]) -> dict[Hashable, int]:
    """Number of each distinct key, in order of appearance."""
    return {key: number for number, key in enumerate(dict.fromkeys(keys))}


def _common_rate(source: Path, mapping: MappingFile, recordings: list[tuple[File, ...]]) -> float:
    """Sample rate of the corpus [Hz]: the one asked for, or that of all recordings; any if no file tells one, and so none can be used.

    Raises
    ------
    CorpusError
        If the mapping gives different rates and asks for none.
    """
    if mapping.resample is not None:
        return mapping.resample
    given = list(_given_rates(mapping, recordings))
    for place, rate in given:
        if rate != given[0][1]:
            message = (
                f"{source}: {place} is at {rate:g} Hz and {given[0][0]} at {given[0][1]:g} Hz; a corpus has one sample rate: "
                f"give resample_hz at the top, or make a corpus of each."
            )
            raise CorpusError(message)
    if given:
        return given[0][1]
    for file, *_ in recordings:
        try:
            return _measured(file).get("sample_rate_hz") or stated_rate(file.path) or _NO_RATE
        except (UnusableError, OSError):
            continue
    return _NO_RATE


def _given_rates(mapping: MappingFile, recordings: list[tuple[File, ...]]) -> Iterator[tuple[str, float]]:
    """Sample rates in the mapping and in the paths of files, with the places where they are given."""
    for section in mapping.sections:
        rate = next(section.examples()).sample_rate_hz
        if rate is not None and "sample_rate_hz" in section.given:
            yield f"files[{section.position}] ({section.pattern.text})", rate
    for file, *_ in recordings:
        if file.entry.sample_rate_hz is not None and "sample_rate_hz" in file.section.from_path:
            yield file.name, file.entry.sample_rate_hz


def _measured(file: File) -> dict[str, float]:
    """Numbers that a file holds for keys of the mapping, in the units of the keys."""
    found = {}
    for key, reading in file.section.in_file.items():
        if file.path.suffix.lower() != ".mat":
            message = f"has no variables, and {key} is to be read from {reading.variable}; give {key} as a number"
            raise UnusableError(message)
        value = read_matlab(file.path, reading.variable)
        try:
            number = float(value.item() if value.size == 1 else one_column(value)[0])
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            message = f"holds {reading.variable}, which is no number for {key}"
            raise UnusableError(message)
        found[key] = number * reading.times
    return found


def _read(files: tuple[File, ...], target: _Target, number: int, rig: int, specimen: int) -> Recording:
    entry = _entry_of(files[0])
    values, rate, absolute = _joined(files)
    warnings: list[str] = []
    signals: list[FloatArray] = []
    for sensor, column in zip(sensors(entry, ""), values, strict=True):
        signals.append(accelerations(column, sensor.scale))
        told = doubts(column, signals[-1], sensor.scale, absolute=absolute)
        warnings += [f"channel {sensor.name}: {doubt}" if sensor.name else doubt for doubt in told]
    if len({signal.size for signal in signals}) > 1:
        sizes = " and ".join(str(signal.size) for signal in signals)
        message = f"has channels of {sizes} samples; give channels of one length"
        raise UnusableError(message)
    signal = np.stack(signals)
    stated = stated_rate(files[0].path) if entry.sample_rate_hz is not None else None
    if stated not in (None, rate):
        warnings.append(f"states a sample rate of {stated:g} Hz; the given {rate:g} Hz are used")
    if rate != target.fs:
        if not target.resample:
            message = f"is at {rate:g} Hz and the corpus at {target.fs:g} Hz; give resample_hz at the top, or make a corpus of each"
            raise UnusableError(message)
        signal, sentence = resampled(signal, rate, target.fs)
        warnings.append(sentence)
    return _recording(entry, signal, number, rig, specimen)._replace(warnings=tuple(warnings))


def _joined(files: tuple[File, ...]) -> tuple[list[FloatArray], float, bool]:
    """Values of each channel in the unit of the files, shape (time,), their sample rate [Hz], and whether they have a unit."""
    parts: list[list[FloatArray]] = []
    rates: set[float] = set()
    speeds: list[float] = []
    absolute = True
    for file in files:
        entry = _entry_of(file)
        found = [read_values(file.path, sensor.place) for sensor in sensors(entry, "")]
        rate = entry.sample_rate_hz or found[0].fs
        if rate is None:
            raise UnusableError("states no sample rate; give sample_rate_hz")
        rates.add(rate)
        speeds.append(entry.shaft_rpm)
        parts.append([values.values for values in found])
        absolute = absolute and found[0].absolute
    if len(rates) > 1:
        raise UnusableError("is joined of files at different sample rates; give each recording a name of its own")
    if max(speeds) > (1 + _SAME_SPEED) * min(speeds):
        message = f"is joined of files at {min(speeds):g} to {max(speeds):g} rpm; give each recording a name of its own"
        raise UnusableError(message)
    return [np.concatenate(column) for column in zip(*parts, strict=True)], rates.pop(), absolute


def _entry_of(file: File) -> Entry:
    """Description of a file with the numbers that it holds."""
    if not file.section.in_file:
        return file.entry
    try:
        return file.section.entry(file.groups, _measured(file))
    except ValidationError as error:
        raise UnusableError(sentence_of(error, "", {}, None).removesuffix(".")) from None


def _recording(entry: Entry, signal: FloatArray, number: int, rig: int, specimen: int) -> Recording:
    unknown = 0.0 if entry.fault in ("healthy", "cage") else math.nan
    return Recording(
        number=number,
        rig=rig,
        specimen=specimen,
        bearing=bearing_of(entry),
        shaft_rate=rpm_to_hertz(entry.shaft_rpm),
        fault=entry.fault,
        signal=signal,
        load=math.nan if entry.load_n is None else entry.load_n,
        n_spalls=entry.n_spalls or _SPALLS.get(entry.fault, 1),
        width=unknown if entry.width_mm is None else to_si(entry.width_mm, "mm"),
        depth=unknown if entry.depth_um is None else to_si(entry.depth_um, "um"),
        angle=math.nan if entry.angle_deg is None else to_si(entry.angle_deg, "deg"),
    )
