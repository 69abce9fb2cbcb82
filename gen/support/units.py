"""Units of recipes and labels, and the operations that turn them into SI.

A key ends in its unit: ``width_mm`` is a width in millimetres. The last bit of a converted value reaches the stored signals, and
``x / 100`` differs from ``x * 1e-2`` in the last bit. So each conversion is one operation, and it must not be replaced by an equal one:
drawn values, lengths and angles are multiplied by the factor of their unit; percentages of profiles and modes are divided by 100;
a labelled speed is divided by 60.
"""

import functools
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

if TYPE_CHECKING:
    from numpy.typing import NDArray

Quantity = TypeVar("Quantity", float, "NDArray[Any]")


class Unit(NamedTuple):
    """A unit that a key can end in: its symbol, and the factor that turns it into SI."""

    symbol: str
    factor: float


UNITS: Mapping[str, Unit] = {
    "mm": Unit("mm", 1e-3),
    "um": Unit("um", 1e-6),
    "nm": Unit("nm", 1e-9),
    "rpm": Unit("rpm", 1 / 60),
    "deg": Unit("degree", math.pi / 180),
    "percent": Unit("%", 1e-2),
    "mm_s": Unit("mm/s", 1e-3),
    "mm2_s": Unit("mm2/s", 1e-6),
    "hz": Unit("Hz", 1.0),
    "khz": Unit("kHz", 1e3),
    "s": Unit("s", 1.0),
    "kg": Unit("kg", 1.0),
    "n": Unit("N", 1.0),
    "m_s2": Unit("m/s2", 1.0),
    "n_m": Unit("N/m", 1.0),
    "n_s_m": Unit("N s/m", 1.0),
    "db": Unit("dB", 1.0),
    "celsius": Unit("degC", 1.0),
    "k": Unit("K", 1.0),
    "kg_m3": Unit("kg/m3", 1.0),
    "per_gpa": Unit("1/GPa", 1e-9),
    "h": Unit("h", 3600.0),
    "mm_per_mrev": Unit("mm/10^6 turns", 1e-9),
    "um_per_mrev": Unit("um/10^6 turns", 1e-12),
    "nm_per_mrev": Unit("nm/10^6 turns", 1e-15),
}
"""Units by the suffix of a key. Temperatures stay in degrees Celsius and levels in decibels: they have no SI factor."""

READABLE: Mapping[str, Mapping[str, float]] = {
    "m": {"m": 1.0, "mm": 1e-3, "um": 1e-6},
    "Hz": {"Hz": 1.0, "kHz": 1e3, "rpm": 1 / 60},
    "rad": {"rad": 1.0, "deg": math.pi / 180},
    "N": {"N": 1.0, "kN": 1e3},
    "s": {"s": 1.0, "h": 3600.0},
}
"""Units in which a stored quantity can be given and shown, with their factors, by its stored unit."""

STANDARD_GRAVITY = 9.80665  # m s-2, by definition


def unit_suffix(key: str) -> str:
    """Suffix of a key that is a unit, empty if it has none.

    >>> unit_suffix("width_mm"), unit_suffix("balance_mm_s"), unit_suffix("direct")
    ('mm', 'mm_s', '')
    """
    words = key.split("_")
    suffixes = ("_".join(words[-length:]) for length in (3, 2, 1) if len(words) > length)
    return next((suffix for suffix in suffixes if suffix in UNITS), "")


@functools.cache
def split_unit(key: str) -> tuple[str, float]:
    """Key without its unit, and the factor that turns that unit into SI; a speed in rpm becomes a rate in Hz.

    >>> split_unit("width_mm"), split_unit("shaft_rpm"), split_unit("direct")
    (('width', 0.001), ('shaft_rate', 0.016666666666666666), ('direct', 1.0))
    """
    suffix = unit_suffix(key)
    name = key.removesuffix(f"_{suffix}") if suffix else key
    return (
        (f"{name}_rate", UNITS[suffix].factor) if suffix == "rpm" else (name, UNITS[suffix].factor if suffix else 1.0)
    )


def keys_of(name: str, stored: str) -> dict[str, float]:
    """Keys of a quantity in each unit of ``READABLE``, with the stored value of 1 in that unit; the inverse of `split_unit`.

    >>> keys_of("load", "N"), keys_of("first_shaft_rate", "Hz")["first_shaft_rpm"]
    ({'load_n': 1.0, 'load_kn': 1000.0}, 0.016666666666666666)
    """
    return {
        f"{name.removesuffix('_rate') if unit == 'rpm' else name}_{unit.lower()}": factor
        for unit, factor in READABLE.get(stored, {}).items()
    }


def shown_unit(name: str, stored: str) -> tuple[str, float]:
    """Unit in which a quantity of a corpus is shown, and its factor.

    Speeds are shown in rpm, widths in mm, other lengths in um, angles in deg, and times, which are ages and lives, in h.

    >>> shown_unit("shaft_rate", "Hz"), shown_unit("depth", "m"), shown_unit("load", "N"), shown_unit("rul", "s")
    (('rpm', 0.016666666666666666), ('um', 1e-06), ('N', 1.0), ('h', 3600.0))
    """
    if name.endswith("shaft_rate"):
        unit = "rpm"
    elif stored == "m":
        unit = "mm" if name.endswith("width") else "um"
    else:
        unit = {"rad": "deg", "s": "h"}.get(stored, stored)
    return unit, READABLE.get(stored, {}).get(unit, 1.0)


def range_text(name: str, low: float, high: float, stored: str) -> str:
    """Range of a quantity in the unit in which people read it, with the stored one in brackets beside it if that differs.

    >>> range_text("shaft_rate", 20, 40, "Hz"), range_text("load", 5, 5, "N")
    ('1,200 to 2,400 rpm (20 to 40 Hz)', '5 N')
    """
    unit, factor = shown_unit(name, stored)
    shown, in_stored = (
        f"{_number(lowest)} {of}" if lowest == other else f"{_number(lowest)} to {_number(other)} {of}"
        for lowest, other, of in ((low / factor, high / factor, unit), (low, high, stored))
    )
    return shown if unit == stored else f"{shown} ({in_stored})"


def _number(value: float) -> str:
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def to_si(value: float, unit: str) -> float:
    """Value of a quantity given in the unit with a suffix of ``UNITS``.

    >>> to_si(2.0, "mm"), to_si(180.0, "deg") == math.pi
    (0.002, True)
    """
    return value * UNITS[unit].factor


def from_si(value: Quantity, unit: str) -> Quantity:
    """Value of an SI quantity in the unit with a suffix of ``UNITS``; a rate in Hz becomes a speed in rpm.

    >>> from_si(0.002, "mm"), from_si(30.0, "rpm"), from_si(5400.0, "h")
    (2.0, 1800.0, 1.5)
    """
    # 1 / (1 / 60) is exactly 60, and dividing by 1 / 60 would not be the inverse of dividing by 60
    return value * (1 / UNITS[unit].factor)


def percent_to_share(percent: float) -> float:
    """Share of one [1].

    >>> percent_to_share(25)
    0.25
    """
    return percent / 100


def decibel_to_ratio(level: Quantity) -> Quantity:
    """Ratio of two amplitudes, of each level [1].

    >>> decibel_to_ratio(40)
    100.0
    """
    if isinstance(level, float | int):
        return 10 ** (level / 20)
    ratios = level.copy()  # one by one: powers of arrays have other last bits on other processors
    ratios[:] = [10 ** (decibel / 20) for decibel in level.tolist()]
    return ratios


def rpm_to_hertz(speed: float) -> float:
    """Shaft rate of a labelled speed [Hz].

    >>> rpm_to_hertz(1800)
    30.0
    """
    return speed / 60
