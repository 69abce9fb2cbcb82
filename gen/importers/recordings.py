"""What a recording is, what it must be to be used, and how it is cut into records.

A recording is refused if it is shorter than a window, constant, not finite or beyond what accelerometers
take; else it is cut into consecutive windows of one length, and the last incomplete one is dropped.
"""

import unicodedata
from collections.abc import Callable, Iterable, Mapping
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.corpus import FAULTS, SPLITS
from gen.errors import CorpusError
from gen.importers.files import FloatArray, UnusableError
from gen.limits import check_limit, limit
from gen.physics.bearing import Bearing, orders

STANDARD_GRAVITY = 9.80665  # m s-2, by definition

_LARGEST_ACCELERATION = 1e7  # m s-2, ten times what shock accelerometers are made for
_AS_RECORDED = ("rig", "specimen", "shaft_rate", "load", "n_spalls", "width", "depth", "angle")


class Recording(NamedTuple):
    """One recording and what is known of it, in SI units; NaN is what is not known.

    ``signal`` is of shape (time,) [m s-2]; ``number`` tells the recording from the others of its set;
    ``extra`` holds variables beyond the schema; ``warnings`` says what was done or assumed beyond reading
    the file.
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
    """A file that should hold a recording: where it is, its name as the user knows it, and how to read it."""

    path: Path
    source: str
    read: Callable[[], Recording]


class Record(NamedTuple):
    """A window of a recording, shape (elapsed_time,) [m s-2], and its value of every per-record variable."""

    signal: NDArray[np.float32]
    columns: dict[str, Any]


def read_recording(candidate: Candidate, length: int, fs: float) -> Recording:
    """Read a candidate that must hold at least ``length`` samples at ``fs`` [Hz].

    Raises
    ------
    UnusableError
        If the file cannot be read or holds what no accelerometer records.
    """
    try:
        if candidate.path.stat().st_size == 0:
            raise UnusableError("is empty (0 bytes), copy it again")
        with np.errstate(over="ignore", invalid="ignore"):
            recording = candidate.read()
    except OSError as error:
        message = f"could not be read ({error.strerror or error})"
        raise UnusableError(message) from error
    flaw = _flaw(recording.signal, length, fs)
    if flaw is not None:
        raise UnusableError(flaw)
    return recording


def _flaw(signal: FloatArray, length: int, fs: float) -> str | None:
    """Say what is wrong with a signal, if anything is."""
    wrong = np.count_nonzero(~np.isfinite(signal))
    if wrong:
        return f"has {wrong} samples of {signal.size} that are not finite numbers"
    if signal.size < length:
        return f"holds {signal.size / fs:.3g} s, less than one window of {length / fs:g} s"
    largest, limit = np.abs(signal).max(), _LARGEST_ACCELERATION
    if largest > limit:
        return f"reaches {largest:.3g} m/s^2, more than the {limit:g} m/s^2 of any accelerometer; check its unit"
    if np.ptp(signal) == 0:
        return f"is constant, each sample is {signal[0]:g} m/s^2"
    return None


def cut(recording: Recording, source: str, length: int, fs: float) -> list[Record]:
    """Cut consecutive windows of ``length`` samples, whose sources end in ``#`` and their first sample."""
    known = {
        **{name: getattr(recording, name) for name in _AS_RECORDED},
        **orders(recording.bearing)._asdict(),
        **recording.extra,
        "bearing": recording.bearing.designation,
        "fault": FAULTS.index(recording.fault),
        "recording": recording.number,
        "sample_rate": fs,
        "split": SPLITS.index("test"),
    }
    signal = recording.signal.astype(np.float32)
    starts = range(0, signal.size - length + 1, length)
    return [Record(signal[start : start + length], known | {"source": f"{source}#{start}"}) for start in starts]


def some_files(found: Iterable[Path], already: int, what: str) -> list[Path]:
    """Files found, sorted; CorpusError, which begins with ``what``, if they and those found ``already`` are too many."""
    paths = list(islice(found, limit("recording_files") + 1))
    check_limit("recording_files", already + len(paths), what, CorpusError)
    return sorted(paths)


def name_of(path: Path, folder: Path) -> str:
    r"""Name of a file relative to a folder, as text that can be stored: bytes that are no UTF-8 are written out.

    >>> name_of(Path("set/Pr\udcfcfstand/1.mat"), Path("set"))
    'Pr\\xfcfstand/1.mat'
    """
    name = path.relative_to(folder).as_posix()
    name = name.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")
    return "".join(letter if unicodedata.category(letter) != "Cc" else "?" for letter in name)


def files_below(folder: Path, suffix: str) -> list[Path]:
    """Files of one kind in a folder and below it, sorted by path.

    Raises
    ------
    CorpusError
        If there is no such folder or no such file.
    """
    if not folder.is_dir():
        message = f"{folder}: no such folder; give the folder that holds the {suffix} files."
        raise CorpusError(message)
    found = (path for path in folder.rglob("*") if path.suffix.lower() == suffix and path.is_file())
    paths = some_files(found, 0, f"{folder}: holds")
    if not paths:
        message = f"{folder}: no {suffix} file in it or below; give the folder that holds the recordings."
        raise CorpusError(message)
    return paths
