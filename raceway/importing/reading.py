"""Recordings of the user: options that say how they are read, the files of a folder, and the channels of each."""

import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import click

from raceway.console.options import Decorator, gathered, names
from raceway.importing.recorded import ACCELERATION, Recorded

UNITS = ("g", "mg", "m/s2", "mm/s2", "V", "mV")
MARKS = {"comma": ",", "semicolon": ";", "tab": "\t", "blank": " "}
SLOWEST, FASTEST = 0.001, 1e7  # rpm
OPTIONS = {
    "column": "--channel",
    "variable": "--channel",
    "rate": "--rate",
    "unit": "--unit",
    "delimiter": "--delimiter",
}


class Reading(NamedTuple):
    """How the files are read: options of the same names."""

    channels: tuple[str, ...]
    variable: str | None
    unit: Any
    sensitivity: float | None
    rate: float | None
    delimiter: str | None


def _speeds(_context: click.Context, _option: click.Parameter, text: str | None) -> tuple[float, float] | None:
    """Lowest and highest speed [rpm]; equal for one number."""
    if text is None:
        return None
    low, dash, high = text.partition("-")
    try:
        first, last = float(low), float(high if dash else low)
    except ValueError:
        first, last = math.nan, math.nan
    if not SLOWEST <= first <= last <= FASTEST:
        raise click.BadParameter(
            f"{text!r} is no speed and no range such as 1400-1900, of {SLOWEST:g} to {FASTEST:,.0f} rpm"
        )
    return first, last


def _a_number(_context: click.Context, _option: click.Parameter, value: float | None) -> float | None:
    if value is not None and math.isnan(value):  # it passes every range
        raise click.BadParameter("nan is not a number")
    return value


def mark_of(_context: click.Context, _option: click.Parameter, name: str | None) -> str | None:
    """Mark between columns by its name."""
    return MARKS.get(name or "")


rpm_option: Decorator = click.option(
    "--rpm",
    "speeds",
    callback=_speeds,
    metavar="RPM",
    help="Speed of the shaft during the recording, or a range such as 1400-1900; without it, 300 to 6,000 rpm are searched.",
)
_rate: Decorator = click.option(
    "--rate",
    type=click.FloatRange(1, 1e8),
    callback=_a_number,
    metavar="HZ",
    help="Sample rate, unless the file states it in one of the forms of docs/importing.md.",
)
_unit: Decorator = click.option(
    "--unit",
    type=click.Choice(UNITS),
    help="Unit of the values; by default that in the header. If there is none, m/s2 is assumed, with a warning. V and mV need "
    "--sensitivity.",
)
_sensitivity: Decorator = click.option(
    "--sensitivity",
    type=click.FloatRange(1e-6, 1e6),
    callback=_a_number,
    metavar="MV_PER_G",
    help="Of the sensor [mV per g], if the values are voltages.",
)
_channels: Decorator = click.option(
    "--channel",
    "channels",
    callback=lambda *given: names(*given) or (),
    metavar="A,B,C",
    help="Column of a table by name or number from 0, channel of a WAV file, or variable of a MATLAB file; several are the axes "
    "of one housing. By default all axes of one sensor, as names or their absence tell: x, y, z, ch1, ch2, ch3, or three columns.",
)
_variable: Decorator = click.option(
    "--variable",
    metavar="NAME",
    help="Variable of a MATLAB file whose columns --channel counts, or sheet of an Excel file, by default the visible one "
    "that is active, or else the first.",
)
_delimiter: Decorator = click.option(
    "--delimiter",
    type=click.Choice([*MARKS]),
    callback=mark_of,
    help="Mark between the columns of a text, if it is not plain; commas are decimal ones unless it is comma.",
)


reading_options = gathered("reading", Reading, _rate, _unit, _sensitivity, _channels, _variable, _delimiter)


def recordings_in(folder: Path, without: Iterable[Path]) -> list[Path]:
    """Files of recordings in a folder, not below it, except some files.

    Raises
    ------
    CorpusError
        If there is none.
    """
    from gen.support.errors import CorpusError
    from raceway.importing.signals import SUFFIXES

    left_out = {path.resolve() for path in without}
    files = (path for path in folder.iterdir() if path.is_file() and not path.name.startswith("."))
    found = sorted(path for path in files if path.suffix.lower() in SUFFIXES and path.resolve() not in left_out)
    if not found:
        message = f"{folder}: has no recording in it ({', '.join(SUFFIXES)}); give a recording, or the folder that holds them."
        raise CorpusError(message)
    return found


def readings_of(
    paths: Sequence[Path], reading: Reading, unusable: dict[Path, str] | None
) -> Iterator[tuple[Path, Recorded, Reading, tuple[str, ...]]]:
    """Recordings that can be read, one after the other; those of a folder as they state."""
    read = read_recording if unusable is None else read_as_stated
    for path in paths:
        found = None
        with set_aside(path, unusable):
            found = read(path, reading)
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


def read_as_stated(path: Path, reading: Reading) -> tuple[Recorded, Reading, tuple[str, ...]]:
    """Read one of several recordings: as `read_recording`, without the options that the file contradicts."""
    from raceway.importing.signals import StatedOtherwiseError

    try:
        return read_recording(path, reading)
    except StatedOtherwiseError as error:
        option = error.option
    recorded, used, notes = read_as_stated(path, reading._replace(**{option: None}))
    value = getattr(reading, option)
    told = value if isinstance(value, str) else f"{value:g}"
    note = f"{path.name}: it states otherwise than --{option} {told}, and is read as it states."
    return recorded, used, (*notes, note)


def read_recording(path: Path, reading: Reading) -> tuple[Recorded, Reading, tuple[str, ...]]:
    """Channels of a file, how they were read, with the unit, and sentences on what was assumed.

    Without a choice the axes of one sensor are all read. The diagnosis itself warns of an implausible rms.
    """
    from raceway.importing.signals import SeveralSignalsError

    try:
        return _read(path, reading)
    except SeveralSignalsError as error:
        if reading.channels or not error.axes:
            raise
        axes = error.axes
    recorded, used, notes = _read(path, reading._replace(channels=axes))
    name, *others = axes
    if others:
        return recorded, used, notes
    note = f"{path.name}: {name} is read, which alone may be acceleration."
    return recorded._replace(signals={"": recorded.signals[name]}), used, (note, *notes)


def _read(path: Path, reading: Reading) -> tuple[Recorded, Reading, tuple[str, ...]]:
    from gen.support.errors import CorpusError
    from raceway.importing.signals import read_signal

    signals = {}
    notes: list[str] = []
    for channel in reading.channels or (None,):
        number = int(channel) if channel is not None and channel.isdecimal() else channel
        named = path.suffix.lower() == ".mat" and isinstance(number, str)
        place = {"variable": number, "column": None} if named else {"variable": reading.variable, "column": number}
        how = place | {name: getattr(reading, name) for name in ("unit", "sensitivity", "rate", "delimiter")}
        signal = read_signal(path, **how, options=OPTIONS)  # type: ignore[arg-type]
        if signal.fs is None:
            raise CorpusError(f"{path}: does not state its sample rate; give it with --rate HZ.")
        signals[channel or ""] = signal
        notes += [note for note in signal.warnings if "its rms" not in note]
    shortest = min(signal.values.size for signal in signals.values())
    cut = {name: signal.values[:shortest] for name, signal in signals.items()}
    unit = "unit of the file" if reading.unit is None and path.suffix.lower() == ".wav" else ACCELERATION
    units = " and ".join(dict.fromkeys(signal.unit for signal in signals.values()))
    return (
        Recorded(cut, next(iter(signals.values())).fs, str(path), unit),
        reading._replace(unit=units),
        tuple(dict.fromkeys(notes)),
    )
