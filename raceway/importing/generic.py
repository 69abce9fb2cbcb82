"""Recordings described by a table of labels: paths, variables, units, bearing, speed and fault.

``table -> labels of each file -> recordings of one or more files -> corpus``
"""

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from gen.corpus import LIFE, Variable
from gen.corpus.fault_classes import fault_class
from gen.support.errors import CorpusError
from gen.support.progress import Progress
from gen.support.units import rpm_to_hertz, to_si
from raceway.importing.acceleration import reader
from raceway.importing.assemble import Collection, Import, import_recordings
from raceway.importing.assumptions import assumptions
from raceway.importing.label_keys import Labels, SensorKeys
from raceway.importing.label_tables import read_table_of_labels
from raceway.importing.recordings import Candidate, Recording
from raceway.importing.refused_files import FloatArray, UnusableError
from raceway.importing.resampling import resample

_NO_RATE = 10_000.0  # Hz, if no file states one: each is then skipped with its own reason
_OF_A_FILE = {"path", "delimiter", "decimal", "channels", "note", *SensorKeys.model_fields}
_EVENTS = {"censored": 0, "failed": 1}
_MOTOR_LOAD = Variable("motor_load", "f8", "W", "operating", "labelled power of the motor")

LabelledFile = tuple[str, Path, Labels]
"""Place of a file in its table, its path, and its labels."""


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

    Rigs, specimens and recordings whose names are whole numbers keep them; others are numbered in the order in which they are found.

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
    files: list[LabelledFile] = []
    for place, labels in read_table_of_labels(source, common or {}):
        path = (root / labels.path).resolve()
        if not path.is_relative_to(root.resolve()):
            raise CorpusError(f"{place}: {labels.path} is a link that leads out of the folder; copy the file into it.")
        files.append((place, path, labels))
    return import_labelled("generic", files, output, window=window, progress=progress)


def import_labelled(
    importer: str,
    files: Sequence[LabelledFile],
    output: Path,
    *,
    window: float,
    skipped: Sequence[str] = (),
    warnings: Sequence[str] = (),
    facts: Sequence[str] = (),
    progress: Progress | None = None,
) -> Import:
    """Bring labelled files into a corpus; otherwise as :func:`~raceway.importing.assemble.import_recordings`."""
    recordings, again = _recordings(files)
    every = [labels for _, _, labels in files]
    fs = every[0].resample_hz or _common_rate([*recordings.values()])
    rigs = _numbers((labels.rig,) for labels in every)
    specimens = _numbers((labels.rig, labels.specimen) for labels in every)
    ends = defaultdict[tuple[str, str], float](float)
    for labels in every:
        ends[labels.rig, labels.specimen] = max(ends[labels.rig, labels.specimen], labels.age_s or 0.0)
    candidates = []
    for (_, number), parts in zip(_numbers(recordings).items(), recordings.values(), strict=True):
        (_, first), (_, last) = parts[0], parts[-1]
        specimen = first.rig, first.specimen
        places = number, rigs[first.rig,], specimens[specimen]
        name = first.name if last is first else f"{first.name}..{last.name.rpartition('/')[2]}"
        candidates.append(Candidate(name, partial(_read, parts, fs, places, ends[specimen])))
    extra = LIFE if every[0].age_s is not None else ()
    extra += () if every[0].motor_load_w is None else (_MOTOR_LOAD,)
    told = (*facts, *assumptions(every, fs))
    collection = Collection(importer, every[0].title, every[0].origin, fs, every[0].channel_names, told, extra)
    return import_recordings(
        collection, candidates, output, window=window, skipped=(*skipped, *again), warnings=warnings, progress=progress
    )


def _recordings(
    files: Sequence[LabelledFile],
) -> tuple[dict[tuple[str, ...], list[tuple[Path, Labels]]], list[str]]:
    """Files of each recording, and a sentence for each skipped file.

    Files with the same rig, specimen and ``recording`` are one recording, in their order.

    Raises
    ------
    CorpusError
        If files that are to be joined have different labels.
    """
    skipped: list[str] = []
    recordings: dict[tuple[str, ...], list[tuple[Path, Labels]]] = {}
    listed: dict[tuple[Any, ...], tuple[str, Labels]] = {}
    for place, path, labels in files:
        first_place, first = listed.setdefault(
            (path, tuple((sensor.variable, sensor.column) for sensor in labels.sensors)), (place, labels)
        )
        if first is not labels:
            _check_alike(place, labels, first, f"is the file of {first_place}; remove one of the two rows")
            skipped.append(f"{labels.name}: is listed again in {place}; skipped.")
            continue
        key = (labels.rig, labels.specimen, labels.recording) if labels.recording else (labels.name,)
        parts = recordings.setdefault(key, [])
        if parts:
            first = parts[0][1]
            told = (
                f"belongs to recording {labels.recording} as {first.name} does; give each recording a name of its own"
            )
            _check_alike(place, labels, first, told)
        parts.append((path, labels))
    return recordings, skipped


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


def _numbers(keys: Iterable[tuple[str, ...]]) -> dict[tuple[str, ...], int]:
    """Number of each distinct key: that which is its last name if all are whole numbers, or else in order of appearance.

    >>> _numbers([("0", "105"), ("0", "97"), ("0", "105")]), _numbers([("new",), ("7",)])
    ({('0', '105'): 105, ('0', '97'): 97}, {('new',): 0, ('7',): 1})
    """
    distinct = [*dict.fromkeys(keys)]
    if all(key[-1].isdecimal() and len(key[-1]) < 10 for key in distinct):
        written = {key: int(key[-1]) for key in distinct}
        if len({(*key[:-1], number) for key, number in written.items()}) == len(distinct):
            return written
    return {key: number for number, key in enumerate(distinct)}


def _common_rate(recordings: Sequence[Sequence[tuple[Path, Labels]]]) -> float:
    """Sample rate [Hz] of the first recording that tells it; 10 kHz if none does, and every file is then skipped."""
    every = [labels for parts in recordings for _, labels in parts]
    labelled = next(
        (labels.sample_rate_hz for labels in every if labels.sample_rate_hz and not labels.long_rate_hz), None
    )
    for parts in recordings if labelled is None else ():
        with suppress(UnusableError, OSError, MemoryError):
            return _join(parts)[1]
    return labelled or _NO_RATE


def _read(parts: Sequence[tuple[Path, Labels]], fs: float, places: tuple[int, int, int], end: float) -> Recording:
    signals, rate, stated, notes = _join(parts)
    labels = parts[0][1]
    if len({signal.size for signal in signals}) > 1:
        sizes = " and ".join(str(signal.size) for signal in signals)
        raise UnusableError(f"has channels of {sizes} samples; give channels of one length")
    signal = np.stack(signals)
    if rate != fs:
        if labels.resample_hz is None:
            raise UnusableError(
                f"is at {rate:g} Hz and the corpus at {fs:g} Hz; give resample_hz for all files, or make a corpus of each"
            )
        signal, sentence = resample(signal, rate, fs)
        notes.append(sentence)
    rpm, told = labels.speed(stated)
    return _recording(labels, signal, rpm_to_hertz(rpm), places, end)._replace(warnings=(*notes, *told))


def _join(parts: Sequence[tuple[Path, Labels]]) -> tuple[list[FloatArray], float, float | None, list[str]]:
    """Each channel in m s-2, shape (time,), sample rate [Hz], speed that the first file states [rpm], and sentences without their end."""
    read_parts: list[list[FloatArray]] = []
    rates: set[float] = set()
    speeds: list[float | None] = []
    notes: dict[str, None] = {}
    for path, labels in parts:
        read = reader(path, None)
        signals = [read(sensor) for sensor in labels.sensors]
        read_parts.append([signal.values for signal in signals])
        notes |= {labels.note: None} if labels.note else {}
        for sensor, signal in zip(labels.sensors, signals, strict=True):
            if signal.fs is None:
                advice = f"write {signal.bare} [s] over its times, or " if signal.bare else ""
                raise UnusableError(f"states no sample rate; {advice}give it", "sample_rate_hz")
            rates.add(signal.fs)
            speeds.append(signal.rpm)
            notes |= dict.fromkeys(
                f"channel {sensor.name}: {note}" if labels.channels else note for note in signal.warnings
            )
    if len(rates) > 1:
        raise UnusableError("is joined of files at different sample rates; give each recording a name of its own")
    return [np.concatenate(channel) for channel in zip(*read_parts, strict=True)], rates.pop(), speeds[0], [*notes]


def _recording(
    labels: Labels, signal: FloatArray, shaft_rate: float, places: tuple[int, int, int], end: float
) -> Recording:
    """Facts of a recording in SI units; the course of its specimen ends at an age [s]."""
    spalls = fault_class(labels.fault).n_spalls
    unknown = math.nan if spalls else 0.0
    bearing, load = labels.bearing, math.nan if labels.load_n is None else labels.load_n
    extra = {} if labels.motor_load_w is None else {"motor_load": labels.motor_load_w}
    if labels.age_s is not None:
        left = end - labels.age_s if labels.rul_s is None and labels.event == "failed" else labels.rul_s
        left = math.nan if left is None else left
        rated = bearing.dynamic_rating if math.isfinite(load) else None
        extra |= dict.fromkeys((variable.name for variable in LIFE), math.nan) | {
            "age": labels.age_s,
            "rul": left,
            "rul_revolutions": left * shaft_rate,
            "event": _EVENTS.get(labels.event or "", 2),
            "stage": 3,
            "overloaded": 2 if rated is None else int(load > rated / 2),
        }
        # lives are told apart by the name of their bearing
        bearing = replace(bearing, designation=f"{bearing.designation} {labels.specimen}")
    return Recording(
        *places,
        bearing=bearing,
        shaft_rate=shaft_rate,
        fault=labels.fault,
        signal=signal,
        load=load,
        n_spalls=labels.n_spalls or spalls,
        width=unknown if labels.width_mm is None else to_si(labels.width_mm, "mm"),
        depth=unknown if labels.depth_um is None else to_si(labels.depth_um, "um"),
        angle=math.nan if labels.angle_deg is None else to_si(labels.angle_deg, "deg"),
        extra=extra,
    )
