"""Recordings of the user: the files of a folder, and the channels of each."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from features.diagnosis import Recorded

OPTIONS = {"column": "--channel", "variable": "--channel", "rate": "--rate", "unit": "--unit"}


class Reading(NamedTuple):
    """How the files are read: options of the same names."""

    channels: tuple[str, ...]
    variable: str | None
    unit: Any
    sensitivity: float | None
    rate: float | None


def recordings_in(folder: Path, without: Iterable[Path]) -> list[Path]:
    """Files of recordings in a folder, not below it, except some files.

    Raises
    ------
    CorpusError
        If there is none.
    """
    from gen.importers.signals import SUFFIXES
    from gen.support.errors import CorpusError

    left_out = {path.resolve() for path in without}
    files = (path for path in folder.iterdir() if path.is_file() and not path.name.startswith("."))
    found = sorted(path for path in files if path.suffix.lower() in SUFFIXES and path.resolve() not in left_out)
    if not found:
        message = f"{folder}: has no recording in it ({', '.join(SUFFIXES)}); give a recording, or the folder that holds them."
        raise CorpusError(message)
    return found


def readings_of(
    paths: Sequence[Path], reading: Reading, unusable: dict[Path, str] | None
) -> "Iterator[tuple[Path, Recorded, str, tuple[str, ...]]]":
    """Recordings that can be read, one after the other."""
    for path in paths:
        found = None
        with set_aside(path, unusable):
            found = read_recording(path, reading)
        if found is not None:
            yield path, *found


@contextmanager
def set_aside(path: Path, unusable: dict[Path, str] | None) -> Iterator[None]:
    """Keep the sentence on a file that cannot be used, and go on; a recording on its own ends the command."""
    from gen.support.errors import CorpusError

    try:
        yield
    except CorpusError as error:
        if unusable is None:
            raise
        unusable[path] = str(error)


def read_recording(path: Path, reading: Reading) -> tuple["Recorded", str, tuple[str, ...]]:
    """Channels of a file, their unit, and sentences on what was assumed; the diagnosis itself warns of an implausible rms."""
    from gen.importers.signals import read_signal
    from gen.support.errors import CorpusError

    signals = {}
    notes: list[str] = []
    for channel in reading.channels or (None,):
        number = int(channel) if channel is not None and channel.isdecimal() else channel
        named = path.suffix.lower() == ".mat" and isinstance(number, str)
        place = {"variable": number, "column": None} if named else {"variable": reading.variable, "column": number}
        how = place | {"unit": reading.unit, "sensitivity": reading.sensitivity, "rate": reading.rate}
        signal = read_signal(path, **how, options=OPTIONS)  # type: ignore[arg-type]
        if signal.fs is None:
            raise CorpusError(f"{path}: does not state its sample rate; give it with --rate HZ.")
        signals[channel or ""] = signal
        notes += [note for note in signal.warnings if "its rms" not in note]
    from features.diagnosis import (
        ACCELERATION,
        Recorded,
    )  # it takes seconds, and a file that cannot be used is told before

    shortest = min(signal.values.size for signal in signals.values())
    cut = {name: signal.values[:shortest] for name, signal in signals.items()}
    unit = "unit of the file" if reading.unit is None and path.suffix.lower() == ".wav" else ACCELERATION
    units = " and ".join(dict.fromkeys(signal.unit for signal in signals.values()))
    return Recorded(cut, next(iter(signals.values())).fs, str(path), unit), units, tuple(notes)
