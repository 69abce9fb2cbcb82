"""Recordings of the user, described by a table of labels: paths, variables, units, bearing, speed and fault.

``table -> labels of each file -> recordings of one or more files -> corpus``
"""

import math
from collections.abc import Hashable, Iterable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from gen.corpus.fault_classes import fault_class
from gen.support.errors import CorpusError
from gen.support.progress import Progress
from gen.support.units import rpm_to_hertz, to_si
from raceway.importing.acceleration import acceleration, reader
from raceway.importing.array_files import FloatArray, UnusableError
from raceway.importing.assemble import Collection, Import, import_recordings
from raceway.importing.assumptions import assumptions
from raceway.importing.label_keys import Labels, SensorKeys
from raceway.importing.label_tables import read_table_of_labels
from raceway.importing.recordings import Candidate, Recording
from raceway.importing.resampling import resample

_NO_RATE = 10_000.0  # Hz, if no file states one: each is then skipped with its own reason
_OF_A_FILE = {"path", "delimiter", "decimal", "channels", *SensorKeys.model_fields}


def import_generic(
    source: Path,
    output: Path,
    *,
    window: float = 0.5,
    folder: Path | None = None,
    common: Mapping[str, Any] | None = None,
    progress: Progress | None = None,
) -> Import:
    """Bring the recordings that a table of labels names into a corpus.

    Rigs and specimens are numbered in the order in which they are found.

    Parameters
    ----------
    source : Path
        The table (CSV), one row for each file.
    output : Path
        New corpus: a file if the name ends in ``.nc``, else a folder that is empty or does not exist.
    window : float
        Length of a record [s].
    folder : Path, optional
        Folder of the recordings, which paths are relative to; by default that of the table.
    common : mapping, optional
        Keys of all files, such as ``{"unit": "g"}``; they go before those of the YAML file beside the table.
    progress : callable, optional
        Called with the number of recordings done and the number of all.

    Raises
    ------
    CorpusError
        If the table is in error, nothing can be imported, the output is taken, or the window is out of range.
    """
    if not source.is_file():
        what = "is a folder" if source.is_dir() else "no such file"
        raise CorpusError(f"{source}: {what}; give the table of labels, such as labels.csv.")
    root = source.parent if folder is None else folder
    found = read_table_of_labels(source, common or {})
    recordings, skipped = _recordings(found, root)
    every = [labels for _, labels in found]
    fs = every[0].resample_hz or _common_rate(recordings, root)
    rigs = _numbers(files[0].rig for files in recordings)
    specimens = _numbers((files[0].rig, files[0].specimen) for files in recordings)
    candidates = []
    for number, files in enumerate(recordings):
        first, last = files[0], files[-1]
        places = number, rigs[first.rig], specimens[first.rig, first.specimen]
        name = first.name if last is first else f"{first.name}..{last.name.rpartition('/')[2]}"
        candidates.append(Candidate(name, partial(_read, files, root, fs, *places)))
    collection = Collection(
        "generic", every[0].title, every[0].origin, fs, every[0].channel_names, facts=assumptions(every, fs)
    )
    return import_recordings(collection, candidates, output, window=window, skipped=skipped, progress=progress)


def _recordings(found: Sequence[tuple[str, Labels]], folder: Path) -> tuple[list[list[Labels]], list[str]]:
    """Files of each recording, and a sentence for each skipped file.

    Files with the same rig, specimen and ``recording`` are one recording, in their order.

    Raises
    ------
    CorpusError
        If a link leads out of the folder, or files that are to be joined have different labels.
    """
    skipped: list[str] = []
    recordings: dict[tuple[str, ...], list[Labels]] = {}
    files: dict[tuple[Any, ...], tuple[str, Labels]] = {}
    root = folder.resolve()
    for place, labels in found:
        path = (folder / labels.path).resolve()
        if not path.is_relative_to(root):
            raise CorpusError(f"{place}: {labels.path} is a link that leads out of the folder; copy the file into it.")
        first_place, first = files.setdefault((path, tuple(sensor.place for sensor in labels.sensors)), (place, labels))
        if first is not labels:
            _check_alike(place, labels, first, f"is the file of {first_place}; remove one of the two rows")
            skipped.append(f"{labels.name}: is listed again in {place}; skipped.")
            continue
        key = ("", labels.rig, labels.specimen, labels.recording) if labels.recording else (labels.name,)
        parts = recordings.setdefault(key, [])
        if parts:
            told = f"belongs to recording {labels.recording} as {parts[0].name} does; give each recording a name of its own"
            _check_alike(place, labels, parts[0], told)
        parts.append(labels)
    return [*recordings.values()], skipped


def _check_alike(place: str, labels: Labels, first: Labels, told: str) -> None:
    """Refuse labels that differ from those of an earlier row for the same recording."""
    here, there = _shared(labels), _shared(first)
    different = next((key for key in here if here[key] != there[key]), None)
    if different is not None:
        reason, advice = told.split("; ")
        what = f"{different} is {here[different]} here and {there[different]} there"
        raise CorpusError(f"{place}: {labels.name} {reason}, and {what}; {advice}.")


def _shared(labels: Labels) -> dict[str, Any]:
    """Labels that all files of a recording share."""
    units = ", ".join(str(sensor.scale) for sensor in labels.sensors)
    return {**labels.model_dump(exclude=_OF_A_FILE), "unit": units}


def _numbers(keys: Iterable[Hashable]) -> dict[Hashable, int]:
    """Number of each distinct key, in order of appearance."""
    return {key: number for number, key in enumerate(dict.fromkeys(keys))}


def _common_rate(recordings: Sequence[Sequence[Labels]], folder: Path) -> float:
    """Sample rate [Hz] of the first recording that tells it; 10 kHz if none does, and every file is then skipped."""
    given = next((labels.sample_rate_hz for files in recordings for labels in files if labels.sample_rate_hz), None)
    for files in recordings if given is None else ():
        with suppress(UnusableError, OSError, MemoryError):
            return _join(files, folder)[1]
    return given or _NO_RATE


def _read(files: Sequence[Labels], folder: Path, fs: float, number: int, rig: int, specimen: int) -> Recording:
    signals, rate, notes = _join(files, folder)
    labels = files[0]
    if len({signal.size for signal in signals}) > 1:
        sizes = " and ".join(str(signal.size) for signal in signals)
        message = f"has channels of {sizes} samples; give channels of one length"
        raise UnusableError(message)
    signal = np.stack(signals)
    if rate != fs:
        if labels.resample_hz is None:
            message = f"is at {rate:g} Hz and the corpus at {fs:g} Hz; give resample_hz for all files, or make a corpus of each"
            raise UnusableError(message)
        signal, sentence = resample(signal, rate, fs)
        notes.append(sentence)
    return _recording(labels, signal, number, rig, specimen)._replace(warnings=tuple(notes))


def _join(files: Sequence[Labels], folder: Path) -> tuple[list[FloatArray], float, list[str]]:
    """Each channel in m s-2, shape (time,), the sample rate [Hz], and notes, which are sentences without their end."""
    parts: list[list[FloatArray]] = []
    rates: set[float] = set()
    notes: dict[str, None] = {}
    for labels in files:
        read = reader(folder / labels.path)
        parts.append([])
        for sensor in labels.sensors:
            content = read(sensor.place)
            if sensor.scale.unit is None and not content.unit:
                raise UnusableError("states no unit; give it", "unit")
            signal = acceleration(content, *sensor.scale, labels.sample_rate_hz, "sample_rate_hz")
            if signal.fs is None:
                raise UnusableError("states no sample rate; give it", "sample_rate_hz")
            parts[-1].append(signal.values)
            rates.add(signal.fs)
            notes |= dict.fromkeys(
                f"channel {sensor.name}: {note}" if labels.channels else note for note in signal.warnings
            )
    if len(rates) > 1:
        raise UnusableError("is joined of files at different sample rates; give each recording a name of its own")
    return [np.concatenate(channel) for channel in zip(*parts, strict=True)], rates.pop(), [*notes]


def _recording(labels: Labels, signal: FloatArray, number: int, rig: int, specimen: int) -> Recording:
    spalls = fault_class(labels.fault).n_spalls
    unknown = math.nan if spalls else 0.0
    return Recording(
        number=number,
        rig=rig,
        specimen=specimen,
        bearing=labels.bearing,
        shaft_rate=rpm_to_hertz(labels.shaft_rpm),
        fault=labels.fault,
        signal=signal,
        load=math.nan if labels.load_n is None else labels.load_n,
        n_spalls=labels.n_spalls or spalls,
        width=unknown if labels.width_mm is None else to_si(labels.width_mm, "mm"),
        depth=unknown if labels.depth_um is None else to_si(labels.depth_um, "um"),
        angle=math.nan if labels.angle_deg is None else to_si(labels.angle_deg, "deg"),
    )
