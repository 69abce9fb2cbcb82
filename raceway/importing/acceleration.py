"""One recording of the user: a column of a text, Excel, MATLAB, NumPy or WAV file, in m/s^2."""

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from raceway.importing.array_files import read_numpy, read_parquet, read_tdms, read_uff, read_wav
from raceway.importing.columns import place_of, signal_of
from raceway.importing.conversion import (
    Scale,
    Unit,
    accelerations,
    doubts,
    unit_problem,
    volts_per_acceleration,
)
from raceway.importing.header import known_unit
from raceway.importing.matlab import read_variable
from raceway.importing.refused_files import FloatArray, UnusableError, told_of
from raceway.importing.sheets import read_sheet
from raceway.importing.speed_course import at_equal_angles
from raceway.importing.table import NumberTable, read_text

WITHOUT_UNITS = (".mat", ".npz", ".npy", ".wav")
_SHEETS = (".xlsx", ".xls", ".ods")
_TEXTS = (".csv", ".txt", ".tsv", ".dat", ".lvm", ".asc", ".prn")
_ARRAYS = {
    ".npy": read_numpy,
    ".wav": read_wav,
    ".parquet": read_parquet,
    ".tdms": read_tdms,
    ".uff": read_uff,
    ".unv": read_uff,
}
_OF_PARTS = {".mat": read_variable, ".npz": read_variable, **dict.fromkeys(_SHEETS, read_sheet)}
SUFFIXES = (*_TEXTS, *_OF_PARTS, *_ARRAYS)
_SIGNATURES = {
    rb"\x93NUMPY": ".npy",
    rb"MATLAB|\x89HDF": ".mat",
    rb"RIFF.{4}WAVE": ".wav",
    rb"PK\x03\x04": ".xlsx",
    rb"\xd0\xcf\x11\xe0": ".xls",
    rb"PAR1": ".parquet",
    rb"TDSm": ".tdms",
}
_ZIPPED = (".npz", ".ods")
_AS_HERE: Mapping[str, str] = MappingProxyType({"sample_rate_hz": "rate"})


class Sensor(NamedTuple):
    """A channel and how it is read; None stands for what the file states.

    ``variable`` is the name in a MATLAB file, by default that of the only signal in it, or the sheet of a spreadsheet, by default the
    active one; ``column`` the name in the header of a table, or a number from 0; ``delimiter`` and ``decimal`` are the mark between the
    columns of a text and its decimal mark; ``rate`` is the sample rate [Hz], and ``long_rate`` that of files of more than
    ``long_samples`` samples.
    ``speed_column`` holds the speed of the shaft in a ``speed_unit``, which for a tacho is the number of its pulses in a
    turn; in a MATLAB file its name is that of a variable.
    """

    name: str = ""
    variable: str | None = None
    column: int | str | None = None
    delimiter: str | None = None
    decimal: str | None = None
    scale: Scale = Scale(None)
    rate: float | None = None
    speed_column: int | str | None = None
    speed_unit: str | None = None
    long_rate: float | None = None
    long_samples: int = 0


class Signal(NamedTuple):
    """A recording in m s-2, shape (time,), its sample rate [Hz] or None if it is not known, and a sentence for each assumption.

    ``unit`` is the unit in which the file was read; ``rpm`` the speed of the shaft, if the file states it;
    ``variable`` its name in a MATLAB file; ``bare`` the name of a column of times without a unit.
    """

    values: FloatArray
    fs: float | None
    warnings: tuple[str, ...]
    unit: Unit
    rpm: float | None = None
    variable: str = ""
    bare: str = ""


def read_signal(
    path: Path,
    *,
    variable: str | None = None,
    column: int | str | None = None,
    delimiter: str | None = None,
    decimal: str | None = None,
    unit: Unit | None = None,
    sensitivity: float | None = None,
    rate: float | None = None,
    speed_column: int | str | None = None,
    speed_unit: str | None = None,
    options: Mapping[str, str] = _AS_HERE,
) -> Signal:
    """Read a recording from a file of the user.

    Parameters
    ----------
    path : Path
        A ``.csv``, ``.txt``, ``.tsv``, ``.dat``, ``.lvm``, ``.xlsx``, ``.mat``, ``.npy`` or ``.wav`` file.
    variable : str, optional
        Name of the variable in a MATLAB file; ``run.x`` is a field of a structure. By default the only signal in the file. Of an Excel
        file the sheet, by default the visible one that is active, or else the first visible one.
    column : int or str, optional
        Column of a table, from 0, or its name in the header; also the channel of a WAV file. Needed if there are several beside times.
    delimiter : str, optional
        Of a text; detected by default.
    decimal : {".", ","}, optional
        Decimal mark of a text; detected by default.
    unit : {"m/s2", "mm/s2", "g", "mg", "V", "mV"}
        Unit of the values; by default that in the header, or else m/s2.
    sensitivity : float, optional
        Of the sensor [mV/g], for a voltage.
    rate : float, optional
        Sample rate [Hz]; by default that of the times or the header. It is used even if a WAV file states another.
    speed_column : int or str, optional
        Column with the speed of the shaft at each sample, or a tacho, by its number or name; of a MATLAB file a variable. The recording is
        then sampled again at equal angles of the shaft, at its mean speed.
    speed_unit : str, optional
        ``"rpm"`` or ``"Hz"``; by default that in the header. Of a tacho the number of its pulses in a turn, such as ``"1"``.
    options : mapping, optional
        Names of the options that give ``variable``, ``column``, ``delimiter``, ``decimal``, ``unit`` and ``rate``, for error messages.

    Returns
    -------
    Signal
        Values in m s-2, the sample rate if it is known, and sentences on what was assumed.

    Raises
    ------
    CorpusError
        If the file cannot be read or holds no such signal, states another rate or unit than is given, or unit and sensitivity do not
        belong together.
    """
    scale = Scale(unit, volts_per_acceleration(sensitivity, None))
    with told_of(path, options):
        signal = reader(path, "m/s2")(
            Sensor("", variable, column, delimiter, decimal, scale, rate, speed_column, speed_unit)
        )
    return signal._replace(warnings=tuple(f"{path.name}: {note}." for note in signal.warnings))


def reader(path: Path, assumed: Unit | None) -> Callable[[Sensor], Signal]:
    """Function that reads a signal of a file; it parses each table once. ``assumed`` is the unit where none is stated; None refuses.

    It raises an :class:`UnusableError` if the file is empty, of an unknown type, damaged or has no such signal, or states otherwise than
    is given, and an :class:`OSError` if it cannot be opened.
    """
    tables: dict[tuple[str | None, ...], NumberTable] = {}

    def table_at(variable: str | None, sensor: Sensor) -> NumberTable:
        which = variable, sensor.delimiter, sensor.decimal
        if which not in tables:
            tables[which] = _table(path, *which)
        return tables[which]

    def course_at(speed: int | str, table: NumberTable, sensor: Sensor) -> tuple[NumberTable, int]:
        """Table that holds the speed, and its column there."""
        if isinstance(speed, int) or not has_variables(path):
            return table, place_of(table, speed, "speed_column")
        try:
            beside = table_at(speed, sensor)
        except UnusableError as reason:
            text, key = reason.args
            raise UnusableError(text, key and "speed_column") from None
        if len(beside.columns) > 1:
            raise UnusableError(
                f"has {len(beside.columns)} columns in {speed}; choose a variable of one", "speed_column"
            )
        return beside, place_of(beside, 0, "speed_column")

    @np.errstate(all="ignore")
    def read(sensor: Sensor) -> Signal:
        table, speed = table_at(sensor.variable, sensor), sensor.speed_column
        beside, place = table, 0
        if speed is not None:
            beside, place = course_at(speed, table, sensor)
            if beside is table:
                table = table.without(place)
                if not table.columns or (sensor.column is not None and place in table.header.places(sensor.column)):
                    raise UnusableError(
                        f"has its speed and its signal in column {table.header.name(place)}; choose another",
                        "speed_column",
                    )
        content = signal_of(table, sensor.column)
        size = content.values.size
        fs, of_rate = content.rate(sensor.long_rate if sensor.long_rate and size > sensor.long_samples else sensor.rate)
        if sensor.long_rate and fs:
            of_rate = [*of_rate, f"its {size} samples are taken as recorded at {fs:g} Hz"]
        unit, of_unit = content.stated_unit(sensor.scale.unit, assumed)
        scale = sensor.scale._replace(unit=unit)
        problem = unit_problem(*scale)
        if problem is not None:
            of_file = (
                sensor.scale.unit is None and scale.sensitivity is not None and known_unit(content.unit) is not None
            )
            raise UnusableError(problem, contradicted="sensitivity" if of_file else "")
        signal = accelerations(content.values, scale)
        doubtful = doubts(content.values, signal, scale, absolute=table.absolute)
        told = *table.notes, *of_rate, *of_unit, *doubtful
        rpm = table.rpm
        if speed is not None:
            if fs is None:
                raise UnusableError("states no sample rate; give it", "sample_rate_hz")
            course, stated = beside.columns[place], beside.header.unit_of(place)
            signal, rpm, of_course = at_equal_angles(
                signal, fs, course, sensor.speed_unit, stated, absolute=beside.absolute
            )
            told = *told, of_course
        if not np.isfinite(signal).all():
            raise UnusableError("has values beyond the range of numbers; check its unit")
        return Signal(signal, fs, told, unit, rpm, table.variable, content.bare)

    return read


def has_variables(path: Path) -> bool:
    """Whether a file holds variables by name, each a table of its own."""
    return _kind(path) in (".mat", ".npz")


def _kind(path: Path) -> str:
    """Suffix of the files that are read as this one."""
    suffix = path.suffix.lower()
    if not path.is_file():
        return suffix
    with path.open("rb") as stream:
        start = stream.read(12)
    kinds = (kind for begin, kind in _SIGNATURES.items() if re.match(begin, start, re.DOTALL))
    # content goes before the suffix, but an archive does not tell its kind, and a text may have any
    kind = next(kinds, ".txt" if suffix == ".xls" or suffix[1:].isdecimal() else suffix)
    return suffix if kind == ".xlsx" and suffix in _ZIPPED else kind


def _table(path: Path, variable: str | None, delimiter: str | None, decimal: str | None) -> NumberTable:
    suffix = _kind(path)
    if suffix in _ARRAYS:
        return _ARRAYS[suffix](path)
    if suffix in _OF_PARTS:
        return _OF_PARTS[suffix](path, variable)
    if not is_known(suffix):
        raise UnusableError(f"is of no known type; known are {', '.join(SUFFIXES)}")
    return read_text(path, delimiter, decimal)


def is_known(suffix: str) -> bool:
    """Whether files with a suffix can be recordings; a date at the end of a name is one, too."""
    return suffix.lower() in SUFFIXES or suffix[1:].isdecimal()
