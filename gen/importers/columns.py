"""Choice of a column in a table, and the sample rate that a column of times tells."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.importers.conversion import Unit
from gen.importers.files import FloatArray, UnusableError
from gen.importers.header import LEAST_RATE, OTHERS, SECONDS, UNITS, Head, key_of, unit_in

_SAME_RATE = 0.01  # relative
_MOST_NAMED = 12
_SIX_DIGITS = 1e-5  # resolution of times, relative to the last one


class Values(NamedTuple):
    """Values of a signal in the unit of its file, shape (time,), with what the file states of them.

    ``fs`` is the sample rate [Hz] or None; ``rate_source`` tells where it is stated, and is empty for a rate of playback, in whose place
    another one can be given; ``named`` is the column whose name or header states ``unit``; ``absolute`` is False for shares of the full
    scale of a converter.
    """

    values: FloatArray
    fs: float | None = None
    rate_source: str = ""
    unit: Unit | None = None
    named: str = ""
    absolute: bool = True

    def rate(self, given: float | None, key: str) -> tuple[float | None, list[str]]:
        """Sample rate to be used, and a sentence without its end if another one is stated; UnusableError if they contradict each other."""
        if given is None or self.fs is None or math.isclose(given, self.fs, rel_tol=1e-3):
            return given or self.fs, []
        if self.rate_source and not math.isclose(given, self.fs, rel_tol=_SAME_RATE):
            message = (
                f"is at {self.fs:g} Hz by its {self.rate_source}, and {given:g} Hz are given; correct what is given"
            )
            raise UnusableError(message, key)
        return given, [f"states a sample rate of {self.fs:g} Hz; the given {given:g} Hz are used"]

    def stated_unit(self, given: Unit | None) -> tuple[Unit, list[str]]:
        """Unit to be used, and a sentence without its end if it is that of the header; UnusableError if they contradict each other."""
        if self.unit is None or given == self.unit:
            return given or "m/s2", []
        if given is not None:
            message = f"states {self.named} in its header, and the unit {given} is given; correct what is given"
            raise UnusableError(message, "unit")
        return self.unit, [f"its unit is taken as {self.unit}, from {self.named} in its header"]


def columns_to_read(head: Head, column: int | str | None) -> tuple[int | None, int]:
    """Column that may hold times, if there is one beside the signal, and column of the signal.

    Raises
    ------
    UnusableError
        If there is no such column, or several and none is chosen.
    """
    times = next((n for n in head.numbers if _unit_in(head, n) in SECONDS), head.numbers[0])
    if column is None:
        others = [n for n in head.numbers if n != times]
        if len(others) > 1:
            raise _none_chosen(head)
        return (times, others[0]) if others else (None, times)
    chosen = _number(head, column)
    if chosen not in head.numbers:
        message = f"has the columns {_listed(head)}, and no numbers in {column}; choose one"
        raise UnusableError(message, "column")
    return (times if len(head.numbers) > 1 else None), chosen


def signal_of(head: Head, column: int | str | None, times: FloatArray | None, values: FloatArray) -> Values:
    """Values of the chosen column with sample rate and unit, if its table tells them; ``times`` is the column that may hold them.

    Raises
    ------
    UnusableError
        If times and header contradict each other, the chosen column holds the times, or the unit is not of an acceleration.
    """
    of_times, chosen = columns_to_read(head, column)
    unit, named = _unit_of(head, chosen)
    if times is None or of_times is None or not _are_times(head, of_times, times):
        if times is not None and column is None:
            raise _none_chosen(head)
        return Values(values, head.fs, "header" if head.fs else "", unit, named)
    if chosen == of_times:
        message = f"has times in column {head.name(of_times)}, not a signal; choose another"
        raise UnusableError(message, "column")
    told = _rate_of(times, SECONDS.get(_unit_in(head, of_times)))
    source = f"times in column {head.name(of_times)}" if told else "header" if head.fs else ""
    if head.fs is not None and told is not None and not math.isclose(head.fs, told, rel_tol=_SAME_RATE):
        message = f"states {head.fs:g} Hz in its header, and its {source} are at {told:g} Hz; correct the file"
        raise UnusableError(message)
    return Values(values, told or head.fs, source, unit, named)


def table_signal(table: NDArray[Any], column: int | str | None) -> Values:
    """Signal in a table without names, whose longer axis is time."""
    columns = as_columns(table)
    head = Head(0, (True,) * len(columns), ())
    times, chosen = columns_to_read(head, column)
    picked = [None if n is None else columns[n].astype(np.float64, copy=False) for n in (times, chosen)]
    assert picked[1] is not None  # noqa: S101
    return signal_of(head, column, picked[0], picked[1])


def as_columns(values: NDArray[Any]) -> NDArray[Any]:
    """Table with its longer axis last.

    Raises
    ------
    UnusableError
        If the values are not real numbers, or not a table.
    """
    if values.dtype.kind not in "iuf" or values.size == 0 or values.ndim > 2:
        message = f"holds {values.dtype} of shape {values.shape}, not one column of real numbers"
        raise UnusableError(message)
    columns = np.atleast_2d(values)
    return columns.T if columns.shape[0] > columns.shape[1] else columns


def _are_times(head: Head, column: int, values: FloatArray) -> bool:
    """Whether a column holds times or counts; UnusableError if it holds uneven times, or frequencies."""
    name, unit, even = head.name(column), _unit_in(head, column), is_even(values)
    if unit in SECONDS and not even:
        raise UnusableError(f"has times in column {name} that are not evenly spaced; export it at one sample rate")
    if even and (unit == "hz" or name.partition(" ")[2].casefold().startswith("freq")):
        raise UnusableError(f"has frequencies in column {name}; export the waveform, not its spectrum")
    return even


def is_even(values: FloatArray) -> bool:
    """Whether values rise by a constant step within their rounding, as times and counters do.

    >>> is_even(np.round(np.arange(1000) / 12800, 4)), is_even(np.array([0.0, 0.1, 0.2, 0.9, 1.0]))
    (True, False)
    """
    steps = np.diff(values)
    if values.size < 3 or not np.all(steps >= 0) or values[-1] <= values[0]:  # NaN fails the comparison
        return False
    line = np.linspace(values[0], values[-1], values.size)
    usual = np.quantile(steps[steps > 0], 0.99, method="lower")  # the rounding of most steps, without a gap
    resolution = max(float(usual), _SIX_DIGITS * float(values[-1] - values[0]))
    return float(np.abs(values - line).max()) <= resolution


def _rate_of(times: FloatArray, unit: float | None) -> float | None:
    """Sample rate [Hz] that times tell, the roundest number that their rounding allows; None for a counter.

    >>> _rate_of(np.round(np.arange(1000) / 12800, 6), None), _rate_of(np.arange(1000) / 12.8, 1e-3), _rate_of(np.arange(9.0), None)
    (12800.0, 12800.0, None)
    """
    span, steps = times[-1] - times[0], np.diff(times)
    rate = (times.size - 1) / span / (unit or 1.0)
    if unit is None and rate <= LEAST_RATE:
        return None
    resolution = max(float(np.ptp(steps)), _SIX_DIGITS * 0.1 * span)
    round_ones = (step * round(rate / step) for step in (1000.0, 100.0, 10.0, 1.0))
    return next((one for one in round_ones if abs(one / rate - 1) <= resolution / span), rate)


def _number(head: Head, column: int | str) -> int | None:
    """Number of a column that is named in full, or without its unit."""
    if isinstance(column, int):
        return column
    for names in (head.names, [name.rpartition(" ")[0] if unit_in(name) else name for name in head.names]):
        if column in names:
            return names.index(column)
    return None


def _none_chosen(head: Head) -> UnusableError:
    return UnusableError(f"has {len(head.numbers)} columns ({_listed(head)}) and none is chosen; choose one", "column")


def _listed(head: Head) -> str:
    """Numbers and names of the columns that hold numbers."""
    shown = [head.name(n)[:60] for n in head.numbers[:_MOST_NAMED]]
    more = len(head.numbers) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more else "")


def _unit_in(head: Head, column: int) -> str:
    return unit_in(head.names[column]) if head.names else ""


def _unit_of(head: Head, column: int) -> tuple[Unit | None, str]:
    """Unit of a column, and where the head states it."""
    own, common = _unit_in(head, column), key_of(head.unit)
    unit, named = (own, head.names[column]) if own else (common, f"unit {head.unit}")
    if unit in OTHERS:
        message = f"states {named} in its header, {OTHERS[unit]}; export the acceleration in m/s2 or g, or choose another column"
        raise UnusableError(message, "column")
    return (UNITS.get(unit), named) if unit in UNITS else (None, "")
