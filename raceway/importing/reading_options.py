"""Options of commands that say how recordings of the user are read."""

import math
from pathlib import Path
from typing import Any, NamedTuple

import click

from raceway.console.options import Decorator, finite, gathered, names

UNITS = ("g", "mg", "m/s2", "mm/s2", "V", "mV")
MARKS = {"comma": ",", "semicolon": ";", "tab": "\t", "blank": " "}
DECIMAL_MARKS = (".", ",")


class _Unit(click.Choice[str]):
    """One of ``UNITS``, in any spelling that a header may have."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        from raceway.importing.header import known_unit  # not at the top: help needs no reader of files

        return super().convert(known_unit(value) or value, param, ctx)


class Reading(NamedTuple):
    """How the files are read: options of the same names."""

    channels: tuple[str, ...]
    variable: str | None
    unit: Any
    sensitivity: float | None
    rate: float | None
    delimiter: str | None
    decimal: str | None = None
    speed_column: str | None = None
    speed_unit: str | None = None


Speeds = tuple[float, float]
"""Lowest and highest speed [rpm]; equal for one number."""


def speeds_in(text: str) -> Speeds:
    """Speed, or range of speeds, in a text.

    Raises
    ------
    ValueError
        If it is neither, or out of range.
    """
    from raceway.importing.speed_course import FASTEST, SLOWEST  # not at the top: help needs nothing of numpy

    low, dash, high = text.partition("-")
    try:
        first, last = float(low), float(high if dash else low)
    except ValueError:
        first, last = math.nan, math.nan
    if not SLOWEST <= first <= last <= FASTEST:
        raise ValueError(
            f"{text!r:.40} is no speed and no range such as 1400-1900, the lower first, of {SLOWEST:g} to {FASTEST:,.0f} rpm"
        )
    return first, last


def _speeds(_context: click.Context, _option: click.Parameter, text: str | None) -> Speeds | None:
    try:
        return None if text is None else speeds_in(text)
    except ValueError as error:
        raise click.BadParameter(str(error)) from None


def check_speed(speeds: Speeds | None, reading: Reading, table: Path | None = None) -> None:
    """Refuse options that tell the speed twice, or the unit of none."""
    options = {"--rpm": speeds, "--speed-column": reading.speed_column, "--speed-table": table}
    told = [option for option, value in options.items() if value is not None]
    if len(told) > 1:
        raise click.UsageError(f"{told[0]} and {told[1]} both tell the speed; leave one of the two out")
    if reading.speed_unit is not None and reading.speed_column is None:
        raise click.UsageError("--speed-unit is that of --speed-column, which is missing; give it, or leave both out")


def mark_of(_context: click.Context, _option: click.Parameter, name: str | None) -> str | None:
    """Mark between columns by its name."""
    return MARKS.get(name or "")


def rpm_option(without: str) -> Decorator:
    """Make the option of the speed; ``without`` says what holds without it."""
    what = f"Speed of the shaft during the recording, or a range such as 1400-1900; {without}."
    return click.option("--rpm", "speeds", callback=_speeds, metavar="RPM", help=what)


_rate: Decorator = click.option(
    "--rate",
    type=click.FloatRange(1, 1e8),
    callback=finite,
    metavar="HZ",
    help="Sample rate, unless the file states it in one of the forms of docs/importing.md.",
)
_unit: Decorator = click.option(
    "--unit",
    type=_Unit(UNITS),
    help="Unit of the values; by default that in the header. If there is none, m/s2 is assumed, with a warning. V and mV need "
    "--sensitivity.",
)
_sensitivity: Decorator = click.option(
    "--sensitivity",
    type=click.FloatRange(1e-6, 1e6),
    callback=finite,
    metavar="MV_PER_G",
    help="Of the sensor [mV per g], if the values are voltages.",
)
_PLACE = (
    "Column of a table by name or number from 0, channel of a WAV file, or variable of a MATLAB or .npz file, also by a pattern such as "
    "'*_DE_time'"
)
_AXES = (
    "; several are the axes of one housing. By default all axes of one sensor, as names or their absence tell: x, y, z, ch1, ch2, ch3, or "
    "three columns."
)


def _channels(metavar: str, what: str) -> Decorator:
    return click.option(
        "--channel",
        "channels",
        callback=lambda *arguments: names(*arguments) or (),
        metavar=metavar,
        help=f"{_PLACE}{what}",
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


_decimal: Decorator = click.option(
    "--decimal",
    type=click.Choice(DECIMAL_MARKS),
    help="Decimal mark of a text, if its numbers can be read in two ways, such as 1.234.",
)
_speed_column: Decorator = click.option(
    "--speed-column",
    metavar="NAME",
    help="Column, by name or number from 0, or variable of a MATLAB or .npz file with the speed at each sample or a tacho: the recording "
    "is sampled again at equal angles of its shaft.",
)
_speed_unit: Decorator = click.option(
    "--speed-unit",
    metavar="UNIT",
    help="Unit of --speed-column: rpm or Hz, by default that in the header; or the pulses of a tacho in a turn, such as 1.",
)
_values = (_rate, _unit, _sensitivity)
_places = (_variable, _delimiter, _decimal, _speed_column, _speed_unit)
reading_options = gathered("reading", Reading, *_values, _channels("A,B,C", _AXES), *_places)
drawing_options = gathered(
    "reading",
    Reading,
    *_values,
    _channels("NAME", ", or of a corpus by name. Needed if a recording has several; of a corpus by default the first."),
    *_places,
)
"""Options of how one channel is read, of a recording or of a corpus."""
