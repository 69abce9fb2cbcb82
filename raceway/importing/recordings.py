"""Recordings: their facts, the checks of their signals, and their division into records.

A recording is refused if it is shorter than a window, constant, not finite or beyond the range of accelerometers. Otherwise it is cut
into consecutive windows of equal length; the last incomplete one is dropped.
"""

import unicodedata
from collections.abc import Callable, Mapping
from fnmatch import fnmatchcase
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.corpus import FAULTS, SPLITS, UNKNOWN, UNKNOWN_CODE
from gen.physics.bearing import Bearing, orders
from gen.support.errors import CorpusError
from gen.support.limits import check_limit, limit
from raceway.importing.refused_files import FloatArray, UnusableError, reason_of

_LARGEST_ACCELERATION = 1e7  # m s-2, ten times the range of shock accelerometers
_AS_RECORDED = ("rig", "specimen", "shaft_rate", "load", "n_spalls", "width", "depth", "angle")


class Recording(NamedTuple):
    """A recording with its facts, in SI units; NaN stands for an unknown value.

    ``signal`` is of shape (time,) or (channel, time) [m s-2]; ``number`` identifies the recording in its set; ``extra`` holds
    variables beyond the schema;
    ``warnings`` has a sentence for each assumption and each change of the signal.
    """

    number: int
    rig: int
    specimen: int
    bearing: Bearing
    shaft_rate: float
    fault: str
    signal: FloatArray
    load: float = np.nan
    n_spalls: int = 0
    width: float = 0.0
    depth: float = 0.0
    angle: float = np.nan
    extra: Mapping[str, float] = {}
    warnings: tuple[str, ...] = ()


class Candidate(NamedTuple):
    """A file that should hold a recording: its name in messages, and a function that reads it."""

    source: str
    read: Callable[[], Recording]


Record = tuple[NDArray[np.float32], dict[str, Any]]
"""A window of a recording, shape (channel, elapsed_time) [m s-2], and the values of its per-record variables."""


def read_recording(candidate: Candidate, length: int, fs: float, channels: tuple[str, ...]) -> Recording:
    """Read a candidate that must hold at least ``length`` samples at ``fs`` [Hz]; the signal is then of shape (channel, time).

    Raises
    ------
    UnusableError
        If the file cannot be read, or its signal fails a check.
    """
    try:
        with np.errstate(over="ignore", invalid="ignore"):
            recording = candidate.read()
    except (OSError, MemoryError) as error:
        raise UnusableError(reason_of(error)) from error
    if recording.fault not in (*FAULTS, UNKNOWN):
        raise UnusableError(f"is of class {recording.fault!r}, and not one of {', '.join((*FAULTS, UNKNOWN))}")
    signal = np.atleast_2d(recording.signal)
    for name, channel in zip(channels, signal, strict=True):
        flaw = _flaw(channel, length, fs)
        if flaw is not None:
            raise UnusableError(f"{flaw} (channel {name})" if len(channels) > 1 else flaw)
    return recording._replace(signal=signal)


def _flaw(signal: FloatArray, length: int, fs: float) -> str | None:
    """Reason why a signal cannot be used; None if it can."""
    wrong = np.count_nonzero(~np.isfinite(signal))
    if wrong:
        return f"has {wrong} samples of {signal.size} that are not finite numbers"
    if signal.size < length:
        return f"holds {signal.size / fs:.3g} s, less than one window of {length / fs:g} s"
    largest, limit = np.abs(signal).max(), _LARGEST_ACCELERATION
    if largest > limit:
        return f"reaches {largest:.3g} m/s^2, and accelerometers end at {limit:g} m/s^2; check its unit"
    if np.ptp(signal) == 0:
        return f"is constant, each sample is {signal[0]:g} m/s^2"
    return None


def cut(recording: Recording, source: str, length: int, fs: float) -> list[Record]:
    """Consecutive windows of ``length`` samples; the ``source`` of each ends in ``#`` and the number of its first sample."""
    facts = {
        **{name: getattr(recording, name) for name in _AS_RECORDED},
        **orders(recording.bearing)._asdict(),
        **recording.extra,
        "bearing": recording.bearing.designation,
        "fault": UNKNOWN_CODE if recording.fault == UNKNOWN else FAULTS.index(recording.fault),
        "recording": recording.number,
        "sample_rate": fs,
        "split": SPLITS.index("test"),
    }
    signal = np.atleast_2d(recording.signal).astype(np.float32)
    starts = range(0, signal.shape[-1] - length + 1, length)
    return [(signal[:, start : start + length], facts | {"source": f"{source}#{start}"}) for start in starts]


def name_of(path: Path, folder: Path) -> str:
    r"""Name of a file relative to a folder, as text that can be stored, with ? for other characters.

    >>> name_of(Path("set/Pr\udcfcfstand/1.mat"), Path("set"))
    'Pr?fstand/1.mat'
    """
    name = path.relative_to(folder).as_posix()
    return "".join(letter if unicodedata.category(letter) not in ("Cc", "Cs") else "?" for letter in name)


def files_below(folder: Path, pattern: str) -> list[Path]:
    """Files with names such as ``*.mat`` in a folder and its subfolders, sorted by path.

    Raises
    ------
    CorpusError
        If there is no such folder or no such file, or there are more files than the limit.
    """
    what = pattern.removeprefix("*")
    if not folder.is_dir():
        reason = "is not a folder" if folder.exists() else "no such folder"
        raise CorpusError(f"{folder}: {reason}; give the folder that holds the {what} files.")
    files = (path for path in folder.rglob("*") if fnmatchcase(path.name.lower(), pattern) and path.is_file())
    paths = sorted(islice(files, limit("recording_files") + 1))
    check_limit("recording_files", len(paths), f"{folder}: holds", CorpusError)
    if not paths:
        raise CorpusError(f"{folder}: has no {what} file in it or below; give the folder that holds the recordings.")
    return paths
