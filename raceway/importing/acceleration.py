"""One recording of the user: a column of a text, Excel, MATLAB, NumPy or WAV file, in m/s^2."""

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from gen.support.errors import CorpusError
from raceway.importing.array_files import read_numpy, read_parquet, read_tdms, read_uff, read_wav
from raceway.importing.columns import Values, signal_of
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
from raceway.importing.refused_files import FloatArray, UnusableError, reason_of
from raceway.importing.sheets import read_sheet
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
_AS_HERE: Mapping[str, str] = MappingProxyType({})


class RefusedError(CorpusError):
    """A sentence on a file, and the reason, which tells what is contradicted and which signals are axes of one sensor."""

    def __init__(self, message: str, reason: UnusableError) -> None:
        super().__init__(message)
        self.reason = reason


class Place(NamedTuple):
    """Place of a signal in a file.

    ``variable`` is the name in a MATLAB file, by default that of the only signal in it, or the sheet of an Excel file, by default the
    active one; ``column`` the name in the header of a text or sheet, or a number from 0; ``delimiter`` and ``decimal`` are the mark between
    the columns of a text and its decimal mark, detected by default.
    """

    variable: str | None = None
    column: int | str | None = None
    delimiter: str | None = None
    decimal: str | None = None


class Signal(NamedTuple):
    """A recording in m s-2, shape (time,), its sample rate [Hz] or None if it is not known, and a sentence for each assumption.

    ``unit`` is the unit in which the file was read; ``rpm`` the speed of the shaft, if the file states it.
    """

    values: FloatArray
    fs: float | None
    warnings: tuple[str, ...]
    unit: Unit
    rpm: float | None = None


Reader = Callable[[Place], Values]
"""Values of a signal in the unit of its file, by its place."""


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
    read: Reader | None = None,
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
    read : callable, optional
        The :func:`reader` of the file, for several signals of it; by default a new one.
    options : mapping, optional
        Names of the options that give ``variable``, ``column``, ``delimiter``, ``decimal``, ``unit`` and ``rate``, for error messages.

    Returns
    -------
    Signal
        Values in m s-2, the sample rate if it is known, and sentences on what was assumed.

    Raises
    ------
    CorpusError
        If the file cannot be read or holds no such signal, or unit and sensitivity do not belong together; a :class:`RefusedError`, which
        is one, if the file states another rate, unit or kind of unit than is given, or none of its signals is chosen.
    """
    try:
        values = (read or reader(path))(Place(variable, column, delimiter, decimal))
        signal = acceleration(values, unit, volts_per_acceleration(sensitivity, None), rate)
    except UnusableError as reason:
        raise RefusedError(f"{path}: {reason.told(options)}.", reason) from None
    except (OSError, MemoryError) as error:
        raise CorpusError(f"{path}: {reason_of(error)}.") from None
    return signal._replace(warnings=tuple(f"{path.name}: {note}." for note in signal.warnings))


def acceleration(
    content: Values, unit: Unit | None, sensitivity: float | None, rate: float | None, key: str = "rate"
) -> Signal:
    """Signal of values in the unit of their file; the sensitivity is in V per m s-2, and ``key`` gives the rate."""
    fs, notes = content.rate(rate, key)
    used, of_unit = content.stated_unit(unit)
    problem = unit_problem(used, sensitivity)
    if problem is not None:
        of_file = unit is None and sensitivity is not None and known_unit(content.unit) is not None
        raise UnusableError(problem, contradicted="sensitivity" if of_file else "")
    scale = Scale(used, sensitivity)
    signal = accelerations(content.values, scale)
    table = content.table
    told = *table.notes, *notes, *of_unit, *doubts(content.values, signal, scale, absolute=table.absolute)
    return Signal(signal, fs, told, used, table.rpm)


def reader(path: Path) -> Reader:
    """Reader of signals of a file, which parses each of its tables once.

    It raises an :class:`UnusableError` if the file is empty, of an unknown type, damaged or has no such signal, and an :class:`OSError`
    if it cannot be opened.
    """
    tables: dict[Place, NumberTable] = {}

    def read(place: Place) -> Values:
        which = place._replace(column=None)
        if which not in tables:
            tables[which] = _table(path, place)
        content = signal_of(tables[which], place.column)
        wrong = np.flatnonzero(~np.isfinite(content.values))
        if wrong.size:
            count = f"{wrong.size} samples of {content.values.size}"
            message = f"has {count} that are not finite numbers, the first is number {wrong[0] + 1}; export it again"
            raise UnusableError(message)
        return content

    return read


def _table(path: Path, place: Place) -> NumberTable:
    suffix = path.suffix.lower()
    if path.is_file():
        with path.open("rb") as stream:
            start = stream.read(12)
        kinds = (kind for begin, kind in _SIGNATURES.items() if re.match(begin, start, re.DOTALL))
        # content goes before the suffix, but an archive does not tell its kind, and a text may have any
        kind = next(kinds, ".txt" if suffix == ".xls" or suffix[1:].isdecimal() else suffix)
        suffix = suffix if kind == ".xlsx" and suffix in _ZIPPED else kind
    if suffix in _ARRAYS:
        return _ARRAYS[suffix](path)
    if suffix in _OF_PARTS:
        return _OF_PARTS[suffix](path, place.variable)
    if not is_known(suffix):
        raise UnusableError(f"is of no known type; known are {', '.join(SUFFIXES)}")
    return read_text(path, place.delimiter, place.decimal)


def is_known(suffix: str) -> bool:
    """Whether files with a suffix can be recordings; a date at the end of a name is one, too."""
    return suffix.lower() in SUFFIXES or suffix[1:].isdecimal()
