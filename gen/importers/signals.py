"""One recording of the user: a column of a MATLAB, text, NumPy or WAV file, in m/s^2."""

from pathlib import Path
from typing import NamedTuple

from gen.importers.conversion import Scale, Unit, accelerations, doubts, unit_problem, volts_per_acceleration
from gen.importers.files import FloatArray, UnusableError, one_column, read_numpy, read_text, read_wav, reason_of
from gen.importers.matlab import read_matlab
from gen.support.errors import CorpusError

TEXT = (".csv", ".txt", ".tsv", ".dat")
SUFFIXES = (".mat", ".npy", ".wav", *TEXT)


class Place(NamedTuple):
    """Place of a signal in a file.

    ``variable`` is the name in a MATLAB file, by default that of the only signal in it; ``column`` the name in the header of a text, or a
    number from 0; ``delimiter`` that of a text, detected by default.
    """

    variable: str | None = None
    column: int | str | None = None
    delimiter: str | None = None


class Values(NamedTuple):
    """Values of a file in its own unit, shape (time,), its sample rate [Hz] or None, and whether they have a unit or are shares."""

    values: FloatArray
    fs: float | None
    absolute: bool = True


class Signal(NamedTuple):
    """A recording in m s-2, shape (time,), its sample rate [Hz] or None if it is not known, and a sentence for each assumption."""

    values: FloatArray
    fs: float | None
    warnings: tuple[str, ...]


def read_signal(
    path: Path,
    *,
    variable: str | None = None,
    column: int | str | None = None,
    delimiter: str | None = None,
    unit: Unit = "m/s2",
    sensitivity: float | None = None,
    rate: float | None = None,
) -> Signal:
    """Read a recording from a file of the user.

    Parameters
    ----------
    path : Path
        A ``.mat``, ``.csv``, ``.txt``, ``.tsv``, ``.dat``, ``.npy`` or ``.wav`` file.
    variable : str, optional
        Name of the variable in a MATLAB file; ``run.x`` is a field of a structure. By default the only signal in the file.
    column : int or str, optional
        Column of a table, from 0, or its name in the header of a text; also the channel of a WAV file.
    delimiter : str, optional
        Of a text; detected by default.
    unit : {"m/s2", "g", "V", "mV"}
        Unit of the values.
    sensitivity : float, optional
        Of the sensor [mV/g], for a voltage.
    rate : float, optional
        Sample rate [Hz], which is used even if a WAV file states another.

    Returns
    -------
    Signal
        Values in m s-2, the sample rate if it is known, and sentences on what was assumed.

    Raises
    ------
    CorpusError
        If the file cannot be read or holds no such signal, or unit and sensitivity do not belong together.
    """
    scale = Scale(unit, volts_per_acceleration(sensitivity, None))
    problem = unit_problem(unit, sensitivity)
    if problem is not None:
        message = f"{path}: {problem}."
        raise CorpusError(message)
    try:
        content = read_values(path, Place(variable, column, delimiter))
        signal = accelerations(content.values, scale)
        notes = doubts(content.values, signal, scale, absolute=content.absolute)
    except UnusableError as reason:
        message = f"{path}: {reason}."
        raise CorpusError(message) from None
    except (OSError, MemoryError) as error:
        message = f"{path}: {reason_of(error)}."
        raise CorpusError(message) from None
    if rate is not None and content.fs not in (None, rate):
        notes.append(f"states a sample rate of {content.fs:g} Hz; the given {rate:g} Hz are used")
    return Signal(signal, content.fs if rate is None else rate, tuple(f"{path.name}: {note}." for note in notes))


def read_values(path: Path, place: Place) -> Values:
    """Values of a signal in the unit of its file.

    Raises
    ------
    UnusableError
        If the file is empty, of an unknown type, damaged or has no such signal.
    OSError
        If the file cannot be opened.
    """
    suffix = path.suffix.lower()
    if suffix in TEXT:
        return Values(one_column(read_text(path, place.column, place.delimiter)), None)
    if suffix not in SUFFIXES:
        message = f"is of no known type; known are {', '.join(SUFFIXES)}"
        raise UnusableError(message)
    column = place.column
    if isinstance(column, str):
        message = f"has columns without names, so none is called {column}; give column as a number from 0"
        raise UnusableError(message)
    if suffix == ".npy":
        return Values(one_column(read_numpy(path), column), None)
    if suffix == ".mat":
        return Values(one_column(read_matlab(path, place.variable), column), None)
    samples, full_scale, fs = read_wav(path)
    return Values(one_column(samples, column) / full_scale, fs or None, absolute=full_scale == 1)
