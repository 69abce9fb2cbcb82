"""Names, units and sample rate that the lines before the numbers of a table state, in the forms that docs/importing.md lists.

A unit in another form, or another unit, is kept as it is written: it is then no unit of ``UNITS``, and has to be given.
"""

import math
import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from typing import NamedTuple

from raceway.importing.conversion import UNITS, Unit
from raceway.importing.numerals import is_number, number_in

SECONDS = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "us": 1e-6, "μs": 1e-6, "min": 60.0, "h": 3600.0}
_NO_ACCELERATION = re.compile(
    r"velocity|displacement|temperature|speed|tacho|db|ips|[mc]?m/s|in/s|[uμ]m|mm|mils?|rpm|k?hz|°c|k?pa|bar",
    re.IGNORECASE,
)
_OTHERS = re.compile(r"counts?|lsb|adc|raw|gal|volts?|k?n|%", re.IGNORECASE)  # both as last word of a name
_NARROW = str.maketrans("（）［］：／", "()[]:/")  # marks of East Asia
_COARSE = 1e-3  # of a rate, relative
_LONGEST_UNIT = 12
_UNIT_ROWS = 3  # last lines in which a row of units is searched: names, units, comments
_COMMENT = re.compile(r"^(?:#|%|//)\s*")
_IN_BRACKETS = re.compile(r"\[([^\]]*)\][^\[\]()]*$|\(((?:[^()]|\([^()]*\))*)\)[^\[\]()]*$")
_CHANNEL = re.compile(r"[a-z]+_?\d+", re.IGNORECASE)  # cDAQ1Mod1/ai0
_TIMES = re.compile(r"(?i:(?:x_value|time(?:stamp)?|zeit|temps|tiempo|tempo)(?![a-z]))|t\b")
_SPECTRUM = re.compile(r"(?:fr[eé][qc]|order|ordnung)", re.IGNORECASE)
_COMMON = re.compile(r"units?\b[\s:=]*(.+)", re.IGNORECASE)
_RATE_WORDS = r"(?:(?i:sampl(?:e|ing)[ _-]rate|sampling[ _-]frequency)|[fF]s)"
_HERTZ = r"([kK]?[hH][zZ]|MHz|[kKM]?S/s|[kKM]?Sa/s|[kKM]?SPS)"
_RATE = re.compile(rf"{_RATE_WORDS}\s*(?:[\[(]\s*{_HERTZ}\s*[\])])?[\s:=;,]*([\d.,eE+-]+)\s*{_HERTZ}?[\s;,]*")


class Header(NamedTuple):
    """What the lines before the numbers state.

    ``names`` are those of all columns, and ``units`` their units as written, empty if they are not stated; both are empty without names.
    ``unit`` is that of all columns; ``rates`` are sample rates [Hz], and ``rates_of`` those of single columns;
    ``samples`` are the most that one states, if any.
    """

    names: tuple[str, ...] = ()
    units: tuple[str, ...] = ()
    unit: str = ""
    rates: tuple[float, ...] = ()
    rates_of: Mapping[int, float] = {}
    samples: int = 0

    def name(self, column: int) -> str:
        """Number and name of a column."""
        return f"{column} {self.names[column][:60]}".rstrip() if self.names else f"{column}"

    def unit_of(self, column: int) -> str:
        """Unit of a column as it is written."""
        return self.units[column] if self.units else ""

    def is_of_time(self, column: int) -> bool:
        """Whether name or unit of a column are those of times."""
        named = self.names and _TIMES.match(self.names[column]) is not None
        return bool(named) or key_of(self.unit_of(column)) in SECONDS

    def is_of_spectrum(self, column: int) -> bool:
        """Whether name or unit of a column are those of frequencies or orders."""
        named = self.names and _SPECTRUM.match(self.names[column]) is not None
        return bool(named) or key_of(self.unit_of(column)).casefold() in ("hz", "khz")

    def places(self, column: int | str) -> list[int]:
        """Numbers of the columns that a number or a name means; the unit of a name can be left out."""
        if isinstance(column, int):
            return [column]
        column = column.translate(_NARROW)
        exact = [n for n, name in enumerate(self.names) if name == column]
        return exact or [n for n, name in enumerate(map(_without_unit, self.names)) if name == column]

    def widened(self, width: int) -> "Header":
        """Header of a table whose rows have more fields than its names."""
        more = [""] * (width - len(self.names))
        return self._replace(names=(*self.names, *more), units=(*self.units, *more)) if self.names else self

    def key(self, column: int) -> str:
        """Shortest text that means a column and no other: its name without or with the unit, or its number."""
        names = (_without_unit(self.names[column]), self.names[column]) if self.names else ()
        return next((name for name in names if name and self.places(name) == [column]), f"{column}")


def _without_unit(name: str) -> str:
    return _IN_BRACKETS.sub("", name).partition("/")[0].strip()


def header_of(rows: Sequence[Sequence[str]], least: int, most: int) -> Header:
    """Header in rows of texts before rows of ``least`` to ``most`` fields."""
    lines = [*filter(None, map(_uncommented, rows))]
    names, units = _names(lines, least, most)
    if lines and lines[0][0].startswith("LabVIEW"):
        return _of_labview(lines, names, units)
    rates = dict.fromkeys(rate for fields in lines for rate in _rates(" ".join(fields)))
    return Header(names, units, _common_unit(lines, names), tuple(rates))


def _of_labview(lines: Sequence[list[str]], names: tuple[str, ...], units: tuple[str, ...]) -> Header:
    """Header whose lines state unit, step and samples of each column, in the place of the column."""
    said = {fields[0]: fields for fields in lines}
    samples = max((int(field) for field in said.get("Samples", ()) if re.fullmatch(r"\d{1,9}", field)), default=0)
    if "Time" not in said.get("X_Dimension", ()):
        return Header(names, units, samples=samples)
    labels = [*said.get("Y_Unit_Label", ()), *[""] * len(names)]
    units = tuple(
        "s" if name == "X_Value" else unit if not label or known_unit(unit) else label
        for name, unit, label in zip(names, units, labels, strict=False)
    )
    steps = enumerate(said.get("Delta_X", ())[1:], 1)
    rates = {n: rate for n, step in steps if (rate := rate_of_step(step))}
    return Header(names, units, rates_of=rates, samples=samples)


def _uncommented(fields: Sequence[str]) -> list[str]:
    """Fields without the mark of a comment, and without empty ones at the end."""
    first = _COMMENT.sub("", fields[0])
    kept = [field.translate(_NARROW) for field in ([first] if first or not fields[0] else []) + [*fields[1:]]]
    return kept[: max((n for n, field in enumerate(kept, 1) if field), default=0)]


def _names(lines: Sequence[list[str]], least: int, most: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names and units of the columns: of a row of units and the row above it, or else of the last row."""

    def fits(fields: Sequence[str]) -> bool:
        commented = fields[-1:] == ["Comment"] and len(fields) == least + 1
        return (least <= len(fields) <= most or commented) and not any(map(is_number, fields))

    for number in range(len(lines) - 1, max(len(lines) - 1 - _UNIT_ROWS, 0), -1):
        units = [field.strip("[]()") for field in lines[number]]
        above = lines[number - 1]
        if fits(above) and len(units) <= len(above) and _are_units(units) and not any(map(unit_said, above)):
            more = [""] * (len(above) - len(units))
            return tuple(above), (*units, *more)
    if not lines or not fits(lines[-1]) or (len(lines[-1]) == 1 and re.search("[:=]", lines[-1][0])):
        return (), ()
    return tuple(lines[-1]), tuple(map(unit_said, lines[-1]))


def _are_units(fields: Sequence[str]) -> bool:
    has_unit = any(key_of(field) in UNITS or field in SECONDS for field in fields)
    return has_unit and all(len(field) <= _LONGEST_UNIT for field in fields)


def unit_said(name: str) -> str:
    """Unit that the name of a column states, or the name if it states one in another form; empty if it states none.

    >>> unit_said("DE [g]"), unit_said("a/(m/s²)"), unit_said("a/g"), unit_said("V"), unit_said("Dev1/ai0")
    ('g', 'm/s²', 'g', 'V', '')
    >>> unit_said("DE (counts)"), unit_said("accel_g"), unit_said("time_s"), unit_said("Acceleration")
    ('counts', 'accel_g', 's', '')
    """
    bracketed = _IN_BRACKETS.search(name)
    if bracketed and bracketed[2] not in ("X", "Y"):  # Origin numbers its columns A(X), B(Y)
        return (bracketed[1] or bracketed[2] or "").strip() or name
    before, slash, after = name.partition("/")
    if slash:
        plain = _is_unit(after.strip()) and not unit_said(before.strip())
        return after.strip() if plain else "" if _CHANNEL.fullmatch(after) else name
    last = re.split(r"[\s_,;]+", name)[-1]
    if _TIMES.match(name) and key_of(last) in SECONDS:
        return last
    return name if _is_unit(last) else ""


def key_of(unit: str) -> str:
    """Unit as the tables have it, without blanks, ``^`` and ``*``."""
    return re.sub(r"[\s^*·⋅]", "", unicodedata.normalize("NFKC", unit)).replace("\u2212", "-")


def known_unit(unit: str) -> Unit | None:
    """Unit that values can be converted from."""
    return UNITS.get(key_of(unit))


def is_other_quantity(unit: str) -> bool:
    """Whether a unit, as `unit_said` gives it, is one of a velocity, a displacement or another quantity that no acceleration has.

    >>> is_other_quantity("mm/s"), is_other_quantity("x/in/s"), is_other_quantity("counts"), is_other_quantity("mm/s2")
    (True, True, False, False)
    """
    last = re.split(r"[\s_,;]+", unit)[-1]
    return any(_NO_ACCELERATION.fullmatch(key_of(text)) for text in (unit, last, last.partition("/")[2]))


def _is_unit(text: str) -> bool:
    key = key_of(text)
    return key in UNITS or key in SECONDS or any(units.fullmatch(key) for units in (_NO_ACCELERATION, _OTHERS))


def _common_unit(lines: Sequence[list[str]], names: tuple[str, ...]) -> str:
    """Unit of all columns, or the line that states it in another form."""
    said: dict[str, str] = {}
    for fields in lines:
        line = " ".join(fields)
        match = _COMMON.fullmatch(line)
        units = match[1].split() if match else [line] if any(map(_says_unit, fields)) else []
        if tuple(fields) != names:
            said |= {key_of(unit): unit for unit in units if key_of(unit) not in SECONDS}
    return next(iter(said.values()), "") if len(said) < 2 else " and ".join(said.values())


def _says_unit(text: str) -> bool:
    """Whether a field names a unit of acceleration or voltage in any way."""
    words = re.split(r"[\s\[\]():=,;]+|(?<![ms])/", text)
    return any(known_unit(word) or word.casefold() in ("volt", "volts", "counts") for word in words)


def _rates(line: str) -> Iterator[float]:
    """Sample rates [Hz] that a line states."""
    match = _RATE.fullmatch(line)
    if match:
        before, number, after = match.groups()
        value, unit = number_in(number), before or after
        if value is not None and unit and (before or after) == (after or before):
            yield value * {"k": 1e3, "K": 1e3, "M": 1e6}.get(unit[0], 1.0)


def rate_of_step(text: str) -> float | None:
    """Sample rate [Hz] of a step [s], None if its decimals do not tell it.

    >>> rate_of_step("0.000977"), rate_of_step("7,8125E-5"), rate_of_step("0.000156")
    (1024.0, 12800.0, None)
    """
    step = number_in(text)
    if not step or math.isinf(step):
        return None
    exponent = Decimal(text.replace(",", ".")).as_tuple().exponent
    return rounded_rate(1 / step, max(0.5 * 10.0 ** int(exponent) / step, 1e-9))


def rounded_rate(rate: float, doubt: float) -> float | None:
    """Number with as few digits as a relative doubt allows; None above 0.1 %."""
    if doubt > _COARSE:
        return None
    shorter = (float(f"{rate:.{digits}g}") for digits in range(2, 12))
    return next((number for number in shorter if math.isclose(number, rate, rel_tol=doubt)), rate)
