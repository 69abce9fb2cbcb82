"""One recording of the user: a column of a text, Excel, MATLAB, NumPy or WAV file, in m/s^2."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from gen.support.errors import CorpusError
from raceway.importing.columns import Values, table_signal
from raceway.importing.conversion import (
    Scale,
    Unit,
    accelerations,
    doubts,
    unit_problem,
    volts_per_acceleration,
)
from raceway.importing.files import (
    ContradictionError,
    FloatArray,
    NoneChosenError,
    UnusableError,
    read_numpy,
    read_wav,
    reason_of,
)
from raceway.importing.header import known_unit
from raceway.importing.matlab import read_matlab
from raceway.importing.sheets import read_sheet
from raceway.importing.text import read_text

TEXT = (".csv", ".txt", ".tsv", ".dat")
SHEETS = (".xlsx",)
STATING_RATES = (".wav", *TEXT, *SHEETS)
SUFFIXES = (".mat", ".npy", *STATING_RATES)
_AS_HERE: Mapping[str, str] = MappingProxyType({})


class StatedOtherwiseError(CorpusError):
    """A file that states another value than the one that is given as ``option``: rate, unit or sensitivity."""

    def __init__(self, message: str, option: str) -> None:
        super().__init__(message)
        self.option = option


class SeveralSignalsError(CorpusError):
    """A file with several signals of which none is chosen; ``axes`` are the columns or variables that are axes of one sensor, if any."""

    def __init__(self, message: str, axes: tuple[str, ...]) -> None:
        super().__init__(message)
        self.axes = axes


class Place(NamedTuple):
    """Place of a signal in a file.

    ``variable`` is the name in a MATLAB file, by default that of the only signal in it, or the sheet of an Excel file, by default the
    active one; ``column`` the name in the header of a text or sheet, or a number from 0; ``delimiter`` that of a text, detected by default.
    """

    variable: str | None = None
    column: int | str | None = None
    delimiter: str | None = None


class Signal(NamedTuple):
    """A recording in m s-2, shape (time,), its sample rate [Hz] or None if it is not known, and a sentence for each assumption.

    ``unit`` is the unit in which the file was read.
    """

    values: FloatArray
    fs: float | None
    warnings: tuple[str, ...]
    unit: Unit


def read_signal(
    path: Path,
    *,
    variable: str | None = None,
    column: int | str | None = None,
    delimiter: str | None = None,
    unit: Unit | None = None,
    sensitivity: float | None = None,
    rate: float | None = None,
    options: Mapping[str, str] = _AS_HERE,
) -> Signal:
    """Read a recording from a file of the user.

    Parameters
    ----------
    path : Path
        A ``.csv``, ``.txt``, ``.tsv``, ``.dat``, ``.xlsx``, ``.mat``, ``.npy`` or ``.wav`` file.
    variable : str, optional
        Name of the variable in a MATLAB file; ``run.x`` is a field of a structure. By default the only signal in the file. Of an Excel
        file the sheet, by default the visible one that is active, or else the first visible one.
    column : int or str, optional
        Column of a table, from 0, or its name in the header; also the channel of a WAV file. Needed if there are several beside times.
    delimiter : str, optional
        Of a text; detected by default.
    unit : {"m/s2", "mm/s2", "g", "mg", "V", "mV"}
        Unit of the values; by default that in the header, or else m/s2.
    sensitivity : float, optional
        Of the sensor [mV/g], for a voltage.
    rate : float, optional
        Sample rate [Hz]; by default that of the times or the header. It is used even if a WAV file states another.
    options : mapping, optional
        Names of the options that give ``variable``, ``column``, ``delimiter``, ``unit`` and ``rate``, for error messages.

    Returns
    -------
    Signal
        Values in m s-2, the sample rate if it is known, and sentences on what was assumed.

    Raises
    ------
    CorpusError
        If the file cannot be read or holds no such signal, or unit and sensitivity do not belong together.
    SeveralSignalsError
        If the file has several signals and none is chosen.
    StatedOtherwiseError
        If the file states another rate, unit or kind of unit than the given rate, unit or sensitivity.
    """
    with _as_sentences(path, options):
        content = read_values(path, Place(variable, column, delimiter))
        fs, notes = content.rate(rate, "rate")
        used, of_unit = content.stated_unit(unit)
        scale = _scale(used, sensitivity, stated=unit is None and known_unit(content.unit) is not None)
        signal = accelerations(content.values, scale)
        notes = [*content.notes, *notes, *of_unit, *doubts(content.values, signal, scale, absolute=content.absolute)]
    return Signal(signal, fs, tuple(f"{path.name}: {note}." for note in notes), used)


def read_shape(path: Path, place: Place, rate: float | None, options: Mapping[str, str] = _AS_HERE) -> Signal:
    """Recording in the unit of its file, for uses in which the unit does not matter; otherwise as :func:`read_signal`."""
    with _as_sentences(path, options):
        content = read_values(path, place)
        fs, notes = content.rate(rate, "rate")
    return Signal(content.values, fs, tuple(f"{path.name}: {note}." for note in (*content.notes, *notes)), "m/s2")


@contextmanager
def _as_sentences(path: Path, options: Mapping[str, str]) -> Iterator[None]:
    """Turn the reason why a file cannot be used into a sentence."""
    try:
        yield
    except UnusableError as reason:
        message = f"{path}: {reason.told(options)}."
        match reason:
            case ContradictionError():
                raise StatedOtherwiseError(message, reason.option) from None
            case NoneChosenError():
                raise SeveralSignalsError(message, reason.axes) from None
        raise CorpusError(message) from None
    except (OSError, MemoryError) as error:
        message = f"{path}: {reason_of(error)}."
        raise CorpusError(message) from None


def _scale(unit: Unit, sensitivity: float | None, *, stated: bool) -> Scale:
    problem = unit_problem(unit, sensitivity)
    if problem is not None and stated and sensitivity is not None:
        raise ContradictionError(problem, "sensitivity")
    if problem is not None:
        raise UnusableError(problem)
    return Scale(unit, volts_per_acceleration(sensitivity, None))


def read_values(path: Path, place: Place) -> Values:
    """Values of a signal in the unit of its file.

    Raises
    ------
    UnusableError
        If the file is empty, of an unknown type, damaged or has no such signal.
    OSError
        If the file cannot be opened.
    """
    found = _read(path, place)
    wrong = np.flatnonzero(~np.isfinite(found.values))
    if wrong.size:
        count = f"{wrong.size} samples of {found.values.size}"
        message = f"has {count} that are not finite numbers, the first is number {wrong[0] + 1}; export it again"
        raise UnusableError(message)
    return found


def _read(path: Path, place: Place) -> Values:
    suffix = path.suffix.lower()
    if suffix in TEXT:
        return read_text(path, place.column, place.delimiter)
    if suffix in SHEETS:
        return read_sheet(path, place.variable, place.column)
    if suffix not in SUFFIXES:
        message = f"is of no known type; known are {', '.join(SUFFIXES)}"
        raise UnusableError(message)
    column = place.column
    if isinstance(column, str):
        message = f"has columns without names, so none is called {column}; give a number from 0"
        raise UnusableError(message, "column")
    if suffix == ".npy":
        return table_signal(read_numpy(path), column)
    if suffix == ".mat":
        return table_signal(read_matlab(path, place.variable), column)
    samples, full_scale, fs = read_wav(path)
    found = table_signal(samples, column)
    return found._replace(values=found.values / full_scale, playback=fs or None, absolute=full_scale == 1)
