"""Recordings of the user, described by a mapping file: paths, variables, units, bearing, speed and fault.

``mapping file -> sections -> files with the facts of their paths -> recordings -> corpus``
"""

import math
from collections.abc import Hashable, Iterable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from pydantic import ValidationError

from gen.corpus import UNKNOWN
from gen.importers.assemble import Collection, Import, import_recordings
from gen.importers.assumptions import assumptions
from gen.importers.conversion import accelerations, doubts
from gen.importers.files import FloatArray, UnusableError
from gen.importers.listing import File, listed_recordings, name_of_recording
from gen.importers.mapping import MappingFile, read_mapping
from gen.importers.mapping_keys import Facts
from gen.importers.mapping_values import bearing_of
from gen.importers.matlab import read_number
from gen.importers.recordings import Candidate, Recording
from gen.importers.resampling import resample
from gen.importers.signals import read_values
from gen.support.errors import CorpusError
from gen.support.progress import Progress
from gen.support.sentences import sentences
from gen.support.units import rpm_to_hertz, to_si

_NO_RATE = 10_000.0  # Hz, if no file states one: each is then skipped with its own reason
_SPALLS = {"inner": 1, "outer": 1, "ball": 1, "compound": 2, UNKNOWN: -1}
_SAME_SPEED = 0.02  # relative; files of one recording can differ by less, and the record has the speed of the first


class _Target(NamedTuple):
    """Sample rate of the corpus [Hz], and whether recordings at other rates are resampled."""

    fs: float
    resample: bool


class _Joined(NamedTuple):
    """Values of each channel in the unit of the files, shape (time,), and their sample rate [Hz].

    ``absolute`` tells whether the values have a unit; ``facts`` are those of the first file; ``notes`` are sentences without their end.
    """

    values: list[FloatArray]
    fs: float
    absolute: bool
    facts: Facts
    notes: list[str]


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
        New corpus: a file if the name ends in ``.nc``, else a folder that is empty or does not exist.
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
    recordings, skipped = listed_recordings(source, source.parent if folder is None else folder, mapping)
    fs = _common_rate(source, mapping, recordings)
    target = _Target(fs, resample=mapping.resample_hz is not None)
    rigs = _numbers(files[0].facts.rig for files in recordings)
    specimens = _numbers((files[0].facts.rig, files[0].facts.specimen) for files in recordings)
    candidates = []
    for number, files in enumerate(recordings):
        facts = files[0].facts
        places = number, rigs[facts.rig], specimens[facts.rig, facts.specimen]
        read = partial(_read, files, target, *places)
        candidates.append(Candidate(name_of_recording(files), read))
    collection = Collection(
        "generic", mapping.title, mapping.origin, fs, mapping.channel_names, facts=assumptions(mapping.sections, fs)
    )
    return import_recordings(collection, candidates, output, window=window, skipped=skipped, progress=progress)


def _numbers(keys: Iterable[Hashable]) -> dict[Hashable, int]:
    """Number of each distinct key, in order of appearance."""
    return {key: number for number, key in enumerate(dict.fromkeys(keys))}


def _common_rate(source: Path, mapping: MappingFile, recordings: list[tuple[File, ...]]) -> float:
    """Sample rate of the corpus [Hz]: the one asked for, or that of all recordings.

    It is 10 kHz if no file states one; every file is then skipped.

    Raises
    ------
    CorpusError
        If the mapping gives different rates and asks for none.
    """
    if mapping.resample_hz is not None:
        return mapping.resample_hz
    given = [(file.facts.sample_rate_hz, file.name) for file, *_ in recordings if file.facts.sample_rate_hz is not None]
    for rate, name in given:
        if rate != given[0][0]:
            message = (
                f"{source}: {name} is at {rate:g} Hz and {given[0][1]} at {given[0][0]:g} Hz; a corpus has one sample rate: "
                f"give resample_hz at the top, or make a corpus of each."
            )
            raise CorpusError(message)
    if given:
        return given[0][0]
    for files in recordings:
        with suppress(UnusableError, OSError, MemoryError):
            return _join(files).fs
    return _NO_RATE


def _measured_numbers(file: File) -> dict[str, float]:
    """Numbers that a file holds for keys of the mapping, in the units of the keys."""
    numbers = {}
    for key, reading in file.section.in_file.items():
        if file.path.suffix.lower() != ".mat":
            message = f"has no variables, and {key} is to be read from {reading.variable}; give {key} as a number"
            raise UnusableError(message)
        number = read_number(file.path, reading.variable)
        if not math.isfinite(number):
            message = f"holds {reading.variable}, which is no number for {key}"
            raise UnusableError(message)
        numbers[key] = number * reading.times
    return numbers


def _read(files: tuple[File, ...], target: _Target, number: int, rig: int, specimen: int) -> Recording:
    values, rate, absolute, facts, warnings = _join(files)
    signals: list[FloatArray] = []
    for sensor, column in zip(files[0].section.sensors(), values, strict=True):
        signals.append(accelerations(column, sensor.scale))
        told = doubts(column, signals[-1], sensor.scale, absolute=absolute)
        warnings += [f"channel {sensor.name}: {doubt}" if sensor.name else doubt for doubt in told]
    if len({signal.size for signal in signals}) > 1:
        sizes = " and ".join(str(signal.size) for signal in signals)
        message = f"has channels of {sizes} samples; give channels of one length"
        raise UnusableError(message)
    signal = np.stack(signals)
    if rate != target.fs:
        if not target.resample:
            message = f"is at {rate:g} Hz and the corpus at {target.fs:g} Hz; give resample_hz at the top, or make a corpus of each"
            raise UnusableError(message)
        signal, sentence = resample(signal, rate, target.fs)
        warnings.append(sentence)
    return _recording(facts, signal, number, rig, specimen)._replace(warnings=tuple(warnings))


def _join(files: tuple[File, ...]) -> _Joined:
    parts: list[list[FloatArray]] = []
    rates: set[float] = set()
    speeds: list[float] = []
    notes: list[str] = []
    absolute = True
    every = [_facts(file) for file in files]
    for file, facts in zip(files, every, strict=True):
        sensors = [*file.section.sensors(file.groups)]
        columns = [read_values(file.path, sensor.place) for sensor in sensors]
        rate, doubt = columns[0].rate(facts.sample_rate_hz, "sample_rate_hz")
        for column, sensor in zip(columns, sensors, strict=True):
            doubt += [*column.notes, *column.stated_unit(sensor.scale.unit)[1]]
        if rate is None:
            raise UnusableError("states no sample rate; give it", "sample_rate_hz")
        notes += [sentence for sentence in doubt if sentence not in notes]
        rates.add(rate)
        speeds.append(facts.shaft_rpm or math.nan)
        parts.append([values.values for values in columns])
        absolute = absolute and columns[0].absolute
    if len(rates) > 1:
        raise UnusableError("is joined of files at different sample rates; give each recording a name of its own")
    if max(speeds) > (1 + _SAME_SPEED) * min(speeds):
        message = f"is joined of files at {min(speeds):g} to {max(speeds):g} rpm; give each recording a name of its own"
        raise UnusableError(message)
    joined = [np.concatenate(column) for column in zip(*parts, strict=True)]
    return _Joined(joined, rates.pop(), absolute, every[0], notes)


def _facts(file: File) -> Facts:
    """Facts of a file with the numbers that it holds."""
    if not file.section.in_file:
        return file.facts
    try:
        return file.section.facts(file.groups, _measured_numbers(file))
    except ValidationError as error:
        raise UnusableError(sentences(error, Facts)[0]) from None


def _recording(facts: Facts, signal: FloatArray, number: int, rig: int, specimen: int) -> Recording:
    unknown = 0.0 if facts.fault in ("healthy", "cage") else math.nan
    return Recording(
        number=number,
        rig=rig,
        specimen=specimen,
        bearing=bearing_of(facts.bearing),
        shaft_rate=rpm_to_hertz(facts.shaft_rpm or math.nan),
        fault=facts.fault,
        signal=signal,
        load=math.nan if facts.load_n is None else facts.load_n,
        n_spalls=facts.n_spalls or _SPALLS.get(facts.fault, 0),
        width=unknown if facts.width_mm is None else to_si(facts.width_mm, "mm"),
        depth=unknown if facts.depth_um is None else to_si(facts.depth_um, "um"),
        angle=math.nan if facts.angle_deg is None else to_si(facts.angle_deg, "deg"),
    )
