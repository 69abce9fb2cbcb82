"""Recordings of the user: the files of a folder, and the channels of each.

A recording of several is read as its file states, where an option contradicts it; one alone is refused.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from gen.support.errors import CorpusError
from raceway.importing.acceleration import SUFFIXES, Sensor, Signal, has_variables, is_known, reader
from raceway.importing.columns import column_of
from raceway.importing.conversion import Scale, volts_per_acceleration
from raceway.importing.recorded import ACCELERATION, Recorded
from raceway.importing.refused_files import UnusableError, told_of
from raceway.importing.speed_tables import is_speed_table

if TYPE_CHECKING:
    from raceway.importing.reading_options import Reading

_FEWEST = 8  # samples of a spectrum
OPTIONS = {
    "column": "--channel",
    "variable": "--channel",
    "sample_rate_hz": "--rate",
    "unit": "--unit",
    "delimiter": "--delimiter",
    "decimal": "--decimal",
    "speed_column": "--speed-column",
    "speed_unit": "--speed-unit",
}


def recordings_in(folder: Path, without: Iterable[Path]) -> list[Path]:
    """Files of recordings in a folder, not below it, except tables of speeds and some files, sorted by the numbers in their names.

    Raises
    ------
    CorpusError
        If there is none.
    """
    left_out = {path.resolve() for path in without}
    files = (path for path in folder.iterdir() if path.is_file() and not path.name.startswith("."))
    recordings = [path for path in files if is_known(path.suffix) and path.resolve() not in left_out]
    recordings = [path for path in recordings if not is_speed_table(path)]
    if not recordings:
        raise CorpusError(
            f"{folder}: has no recording in it ({', '.join(SUFFIXES)}); give a recording, or the folder that holds them."
        )
    return sorted(recordings, key=_place)


def _place(path: Path) -> list[tuple[int, str]]:
    """Key that sorts 2 before 10: numbers by their number of digits and then their digits, beside the text between them."""
    parts = re.split(r"0*([0-9]+)", path.name)
    return [(len(part) * (number % 2), part) for number, part in enumerate(parts)] + [(0, path.name)]


def readings_of(
    paths: Sequence[Path], reading: "Reading", unusable: dict[Path, str] | None, *, needs_speed: bool
) -> "Iterator[tuple[Path, Recorded, Reading, tuple[str, ...]]]":
    """Recordings that can be read, one after the other; those of a folder as they state.

    Where the file ``needs_speed``, one that states none is refused.
    """
    read = read_recording if unusable is None else read_as_stated
    for path in paths:
        with set_aside(path, unusable):
            recorded, used, notes = read(path, reading)
            if needs_speed and not recorded.rpm:
                raise CorpusError(f"{path}: states no speed; give --bearing, --rpm or both.")
            yield path, recorded, used, notes


@contextmanager
def set_aside(path: Path, unusable: dict[Path, str] | None) -> Iterator[None]:
    """Keep the sentence on a file that cannot be used, and go on; a recording on its own ends the command."""
    try:
        yield
    except CorpusError as error:
        if unusable is None:
            raise
        unusable[path] = str(error)


def read_as_stated(path: Path, reading: "Reading") -> "tuple[Recorded, Reading, tuple[str, ...]]":
    """Read one of several recordings: as `read_recording`, without the options that the file contradicts."""
    return read_recording(path, reading, ("rate", "unit", "sensitivity"))


def read_recording(
    path: Path, reading: "Reading", given_up: Sequence[str] = ()
) -> "tuple[Recorded, Reading, tuple[str, ...]]":
    """Channels of a file, how they were read, with the unit, and sentences on what was assumed.

    Without a choice the axes of one sensor are all read. Options that are ``given_up`` are left out if the file contradicts them. The
    diagnosis itself warns of an implausible rms.
    """
    with told_of(path, OPTIONS):
        return _read(path, reading, given_up)


def _read(path: Path, reading: "Reading", given_up: Sequence[str]) -> "tuple[Recorded, Reading, tuple[str, ...]]":
    read, asked, notes = reader(path, "m/s2"), reading.channels, list[str]()
    signals: dict[str, Signal] = {}
    while not signals:
        try:
            signals = {channel or "": read(_sensor(path, reading, channel)) for channel in reading.channels or (None,)}
        except UnusableError as reason:
            option = reason.contradicted
            if reason.axes and not reading.channels:
                reading = reading._replace(channels=reason.axes)
            elif option in given_up:
                value = getattr(reading, option)
                said = value if isinstance(value, str) else f"{value:g}"
                notes.append(f"it states otherwise than --{option} {said}, and is read as it states")
                reading = reading._replace(**{option: None})
            else:
                raise
    if not asked and len(signals) == 1 and reading.channels:
        notes.append(f"{reading.channels[0]} is read, which alone may be acceleration")
        signals = {"": signals[reading.channels[0]]}
    first, shortest = next(iter(signals.values())), min(signal.values.size for signal in signals.values())
    if first.fs is None:
        advice = f"write {first.bare} [s] over its times, or " if first.bare else ""
        raise UnusableError(f"does not state its sample rate; {advice}give it with --rate HZ")
    if shortest < _FEWEST:
        raise UnusableError(f"holds {shortest} samples, and a diagnosis needs {_FEWEST} at least; record 10 s")
    cut = {name: signal.values[:shortest] for name, signal in signals.items()}
    matched = {name: signal.variable for name, signal in signals.items() if "*" in name and signal.variable}
    unit = "unit of the file" if reading.unit is None and path.suffix.lower() == ".wav" else ACCELERATION
    units = " and ".join(dict.fromkeys(signal.unit for signal in signals.values()))
    told = [note for signal in signals.values() for note in signal.warnings if "its rms" not in note] + notes[::-1]
    return (
        Recorded(cut, first.fs, str(path), unit, first.rpm, matched),
        reading._replace(unit=units),
        tuple(f"{path.name}: {note}." for note in dict.fromkeys(told)),
    )


def _sensor(path: Path, reading: "Reading", channel: str | None) -> Sensor:
    """How a channel is read; a name is a variable where a file has some, and else a column."""
    number = channel and column_of(channel)
    named = isinstance(number, str) and has_variables(path)
    variable, column = (channel, None) if named else (reading.variable, number)
    scale = Scale(reading.unit, volts_per_acceleration(reading.sensitivity, None))
    place = channel or "", variable, column, reading.delimiter, reading.decimal
    speed = reading.speed_column and column_of(reading.speed_column)
    return Sensor(*place, scale, reading.rate, speed, reading.speed_unit)
