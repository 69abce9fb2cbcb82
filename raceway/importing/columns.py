"""Choice of a column in a table, and the sample rate that a column of times tells."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gen.support.display import first_few
from raceway.importing.axes import axes_of
from raceway.importing.conversion import Unit
from raceway.importing.header import SECONDS, Header, is_other_quantity, key_of, known_unit, rounded_rate
from raceway.importing.refused_files import FloatArray, UnusableError
from raceway.importing.table import NumberTable

SLOWEST, FASTEST = 500.0, 1e6  # Hz; a rate beyond them is rather another number
_SAME_RATE = 0.01  # relative
_SOUND = 11_025.0  # Hz; sound cards and phones record at its multiples
_JITTER = 0.05  # of a step
_FEW, _MANY = 0.01, 0.1  # of the steps
_MOST_NAMED = 12
_MOST_DIGITS = 6


class Values(NamedTuple):
    """Values of a signal in the unit of its file, shape (time,), with what the file states of them.

    ``rates`` are sample rates [Hz] and where they are stated; ``unit`` is as the file writes it, and ``named`` tells where. ``bare`` is
    the name of a column of times without a unit.
    """

    values: FloatArray
    rates: tuple[tuple[float, str], ...]
    unit: str
    named: str
    table: NumberTable
    bare: str = ""

    def rate(self, wanted: float | None) -> tuple[float | None, list[str]]:
        """Sample rate to be used, or None; and a sentence without its end if another one is stated.

        Raises
        ------
        UnusableError
            If statements contradict each other or what is given, or the rate is beyond 500 Hz to 1 MHz and is not given.
        """
        stated = self.rates or (() if self.table.playback is None else ((self.table.playback, "header"),))
        told = " and ".join(f"{rate:g} Hz by its {source}" for rate, source in stated)
        fitting = [rate for rate, _ in stated if wanted is not None and math.isclose(wanted, rate, rel_tol=_SAME_RATE)]
        if wanted is not None:
            if fitting or not stated:
                return wanted, []
            if self.table.playback is None and any(SLOWEST <= rate <= FASTEST for rate, _ in stated):
                raise UnusableError(
                    f"is at {told}, and {wanted:g} Hz are given; correct what is given",
                    "sample_rate_hz",
                    contradicted="rate",
                )
            return wanted, [f"is at {told}; the given {wanted:g} Hz are used"]
        if not stated:
            return None, []
        rates = [rate for rate, _ in stated]
        if max(rates) > (1 + _SAME_RATE) * min(rates) or not SLOWEST <= rates[0] <= FASTEST:
            beyond = "" if SLOWEST <= min(rates) <= max(rates) <= FASTEST else f", beyond {SLOWEST:g} Hz to 1 MHz"
            raise UnusableError(f"is at {told}{beyond}; give the sample rate", "sample_rate_hz")
        of_sound = not self.rates and rates[0] % _SOUND == 0
        return rates[0], [
            f"its header states {rates[0]:g} Hz, as for sound; give the rate of the recording if it is another"
        ] if of_sound else []

    def stated_unit(self, wanted: Unit | None, assumed: Unit | None) -> tuple[Unit, list[str]]:
        """Unit to be used, and a sentence without its end if none or another one is stated; ``assumed`` if none is, None refuses.

        Raises
        ------
        UnusableError
            If the file states another known unit than the given one, a unit that is not known and none is given, or the unit of another
            quantity such as a velocity.
        """
        stated = known_unit(self.unit)
        # no option makes an acceleration of a velocity
        if stated is None and is_other_quantity(self.unit):
            raise UnusableError(
                f"states {self.named} in its header, which is no acceleration and cannot be used; correct the header if it is "
                "wrong, or choose another column",
                "column",
            )
        if wanted is None and self.unit and stated is None:
            raise UnusableError(
                f"states {self.named} in its header, which is no unit that is read; give the unit of the values", "unit"
            )
        if wanted is not None and stated not in (None, wanted):
            raise UnusableError(
                f"states {self.named} in its header, and the unit {wanted} is given; correct what is given",
                "unit",
                contradicted="unit",
            )
        if wanted is not None:
            said = self.unit and stated is None
            return wanted, [f"states {self.named} in its header; the given unit {wanted} is used"] if said else []
        if stated is not None:
            return stated, []
        if assumed is None:
            raise UnusableError("states no unit; give it", "unit")
        return assumed, [f"it states no unit, and {assumed} is assumed"] if self.table.absolute else []


def signal_of(table: NumberTable, column: int | str | None) -> Values:
    """Values of the chosen column, or of the only one that holds no times.

    Raises
    ------
    UnusableError
        If there is none or several, if its numbers are flawed or have two readings, or if times are not evenly spaced, or frequencies.
    """
    header, columns = table.header, table.columns
    times = [n for n, values in columns.items() if header.is_of_time(n) or is_even(values) or is_nearly_even(values)]
    signals = [n for n in columns if n not in times] if column is None else [place_of(table, column, "column")]
    if len(signals) > 1:
        raise UnusableError(
            f"has {len(columns)} columns ({_listed(header, [*columns])}) and none is chosen; choose one",
            "column",
            axes=tuple(map(header.key, axes_of(header, signals))),
        )
    if not signals or signals[0] in times:
        raise UnusableError(
            f"has times or a counter in column {_listed(header, signals or times)}, and no signal; choose another",
            "column",
        )
    # times are checked also where the signal is chosen: a gap in them is one in the signal
    _check_numbers(table, [*signals, *times])
    own_rate = header.rates_of.get(signals[0])
    rates = [(rate, "header") for rate in (header.rates if own_rate is None else (own_rate,))]
    for place in times:
        name = header.name(place)
        if header.is_of_spectrum(place):
            raise UnusableError(f"has frequencies in column {name}; export the waveform, not its spectrum")
        if not is_even(columns[place]):
            raise UnusableError(f"has times in column {name} that are not evenly spaced; export it at one sample rate")
        unit = SECONDS.get(key_of(header.unit_of(place)))
        rate = unit and _rate_of(columns[place] * unit)
        rates += [(rate, f"times in column {name}")] if rate else []
    bare = next((header.names[n] for n in times if header.is_of_time(n) and not header.unit_of(n)), "")
    own = header.unit_of(signals[0])
    name = header.name(signals[0])
    named = f"column {name if own in name else f'{name} in {own:.60}'}" if own else header.unit[:60]
    return Values(columns[signals[0]], tuple(rates), own or header.unit, named, table, bare)


def column_of(text: str) -> int | str:
    """Number of a column, which has at most six digits, or its name.

    >>> column_of("3"), column_of("x"), column_of("20261127")
    (3, 'x', '20261127')
    """
    return int(text) if text.isdecimal() and len(text) <= _MOST_DIGITS else text


def place_of(table: NumberTable, column: int | str, key: str) -> int:
    """Number of the column of numbers that a ``key`` names.

    Raises
    ------
    UnusableError
        If there is none or several, or if its numbers are flawed or have two readings.
    """
    places = table.header.places(column)
    if len(places) > 1:
        raise UnusableError(
            f"has several columns {column} ({_listed(table.header, places)}); choose one by its number", key
        )
    if not places or places[0] not in table.columns:
        raise UnusableError(
            f"has the columns {_listed(table.header, [*table.columns])}, and no numbers in {column!s:.60}; choose one",
            key,
        )
    _check_numbers(table, places)
    return places[0]


def _check_numbers(table: NumberTable, used: Sequence[int]) -> None:
    """Refuse columns that are flawed, or whose numbers have two readings."""
    flaw = next((table.flaws[n] for n in used if n in table.flaws), None)
    if flaw is not None:
        raise flaw
    if {table.marks[n] for n in used if n in table.marks} == {".,"}:
        raise UnusableError("has numbers that can be read in two ways, such as 1.234; give the decimal mark", "decimal")
    for n in used:
        wrong = np.flatnonzero(~np.isfinite(table.columns[n]))
        if wrong.size:
            count = f"{wrong.size} samples of {table.columns[n].size}"
            raise UnusableError(
                f"has {count} that are not finite numbers, the first is number {wrong[0] + 1}; export it again"
            )


def is_even(values: FloatArray) -> bool:
    """Whether values rise by a constant step within their rounding, as times and counters do.

    >>> is_even(np.round(np.arange(1000) / 12800, 4)), is_even(np.array([0.0, 0.1, 0.3, 0.4, 0.5]))
    (True, False)
    """
    steps = np.diff(values)
    if values.size < 3 or not values[-1] > values[0] or not np.all(steps >= 0):  # NaN fails the comparison
        return False
    usual = float(np.median(steps))
    odd = np.count_nonzero(np.abs(steps - usual) > 0.1 * usual) if usual else 0
    if 0 < odd < max(_FEW * steps.size, 3):  # a gap; where times are rounded, more steps are longer
        return False
    line = np.linspace(values[0], values[-1], values.size)
    return float(np.abs(values - line).max()) <= max(_resolution(values), _JITTER * (line[1] - line[0]))


def is_nearly_even(values: FloatArray) -> bool:
    """Whether nearly all steps are alike, as in a counter or times where samples are lost.

    >>> is_nearly_even(np.delete(np.arange(100), 40)), is_nearly_even(np.array([0, 1, 3, 9, 10, 17, 18, 19]))
    (True, False)
    """
    steps = np.diff(values)
    usual = float(np.median(steps)) if steps.size else 0.0
    alike = np.count_nonzero(np.abs(steps - usual) < _JITTER * usual)
    return usual > 0 and bool(np.all(steps >= 0)) and bool(alike > (1 - _MANY) * steps.size)


def _resolution(values: FloatArray) -> float:
    """Place of the last decimal of the last values, or of the bits of a floating-point number.

    >>> _resolution(np.array([0.1, 0.23, 0.35])), _resolution(np.arange(9.0) / 7) < 1e-14
    (0.01, True)
    """
    last = values[-max(values.size // 10, 2) :] - values[0]
    bits = 4 * float(np.spacing(np.abs(values).max()))
    units = (10.0**-place for place in range(-2, 12) if 10.0**-place <= last.max())
    close = (unit for unit in units if np.all(np.abs(last - unit * np.round(last / unit)) < max(1e-3 * unit, bits)))
    return next(close, bits)


def _rate_of(times: FloatArray) -> float | None:
    """Sample rate [Hz] of even times [s], with as few digits as their rounding allows; None if they are too coarse.

    >>> _rate_of(np.round(np.arange(1000) / 12800, 6)), _rate_of(np.arange(1000) / 97656.25)
    (12800.0, 97656.25)
    """
    span, steps = float(times[-1] - times[0]), np.diff(times)
    rate, doubt = (times.size - 1) / span, _resolution(times) / span
    return rounded_rate(rate, 1e-9 if np.ptp(steps) <= 1e-6 * steps[0] else doubt)


def _listed(header: Header, columns: Sequence[int]) -> str:
    """Numbers and names of columns."""
    return first_few(map(header.name, columns), _MOST_NAMED)
