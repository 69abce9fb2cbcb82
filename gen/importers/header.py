"""Names of columns, units and sample rate that the rows before the numbers of a table state."""

import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from gen.importers.conversion import Unit

LEAST_RATE = 100.0  # Hz; vibrations of machines are sampled faster, so that a smaller number is not a sample rate
UNITS: dict[str, Unit] = {
    "g": "g", "m/s2": "m/s2", "ms-2": "m/s2", "m/s/s": "m/s2", "m/sec2": "m/s2", "v": "V", "volt": "V", "volts": "V", "mv": "mV",
}  # fmt: skip
SECONDS = {"s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "msec": 1e-3, "us": 1e-6, "μs": 1e-6}
OTHERS = {
    **dict.fromkeys(("mm/s", "m/s", "cm/s", "in/s", "ips", "mm/sec"), "a velocity"),
    **dict.fromkeys(("um", "μm", "mm", "mil", "mils"), "a displacement"),
    **dict.fromkeys(("mm/s2", "cm/s2", "in/s2", "ft/s2"), "an acceleration in another unit"),
    **dict.fromkeys(("rpm", "1/min", "u/min", "hz", "°c", "bar", "pa"), "another quantity"),
}
"""Units that people write in headers, without blanks, ``^`` and ``*``, in lower case."""

_FACTORS = {"hz": 1.0, "khz": 1e3, "s/s": 1.0, "": 1.0, **SECONDS}
_UNIT_OF_RATE = "|".join(unit for unit in sorted(_FACTORS, key=len, reverse=True) if unit)
_NUMBER = r"((?:\d+(?:,\d{3})*(?:[.,]\d+)?|\.\d+)(?:e[-+]?\d{1,2})?)(?!\d)"
_VALUE = rf"(?![a-z])[\W_]*?(?:({_UNIT_OF_RATE})(?![a-z])[\W_]*?)?{_NUMBER}(?:[\W_]*({_UNIT_OF_RATE})(?![a-z]))?"
_RATE = re.compile(
    r"(?<![a-z])(?:sampl\w*?[ _-]*(?:rate|freq\w*?)|scan[ _-]*rate|abtast(?:rate|frequenz)|fs|f_s)" + _VALUE
)
_STEP = re.compile(
    r"(?<![a-z])(?:dt|delta[ _-]*[tx]|sampl\w*?[ _-]*(?:interval|period)|(?:time|x)[ _-]*(?:step|interval|increment))"
    + _VALUE
)
_UNIT = re.compile(r"(?<![a-z])(?:units?|einheit)[\W_]+(\S.*?)[\W_]*$")
_IN_BRACKETS = re.compile(r"[\[(]([^\])]*)[\])]\s*$")
_THOUSANDS = re.compile(r"[1-9]\d{0,2}(,\d{3})+(\.\d+)?")


class Head(NamedTuple):
    """What is known of a table before its numbers are read.

    ``first`` is the number of the first row of numbers, from 0; ``mask`` tells which columns hold numbers; ``names`` are those of all
    columns, empty if there are none; ``fs`` [Hz] and ``unit`` are what the rows before state.
    """

    first: int
    mask: tuple[bool, ...]
    names: tuple[str, ...]
    fs: float | None = None
    unit: str = ""

    @property
    def numbers(self) -> tuple[int, ...]:
        """Columns that hold numbers."""
        return tuple(number for number, is_one in enumerate(self.mask) if is_one)

    def name(self, column: int) -> str:
        """Number and name of a column."""
        return f"{column} {self.names[column]}".rstrip() if self.names else f"{column}"


def head_of(lines: Sequence[str], rows: Sequence[Sequence[str]], mask: tuple[bool, ...]) -> Head:
    """Head of a table by its first lines, their fields, and the columns that hold numbers in most of them."""
    first = next(number for number, fields in enumerate(rows) if numbers_in(fields) == mask)
    stated = [_plain(line) for line in lines[:first]]
    unit = next((found[1] for line in stated if (found := _UNIT.search(line))), "")
    return Head(first, mask, _names([fields for fields in rows[:first] if any(fields)], len(mask)), _rate(stated), unit)


def pattern_of(rows: Iterable[Sequence[str]]) -> tuple[int, tuple[bool, ...]]:
    """Columns that hold numbers in the rows of a table, and in how many rows: rows of numbers alone count ten times."""
    seen = Counter(mask for fields in rows if any(mask := numbers_in(fields)))
    weights = {mask: count * (10 if all(mask) else 1) for mask, count in seen.items()}
    best = max(weights, key=lambda mask: weights[mask], default=())
    return weights.get(best, 0), best


def numbers_in(fields: Sequence[str]) -> tuple[bool, ...]:
    """Whether each field is a number, with a decimal point or comma; empty fields at the end do not count.

    >>> numbers_in(["a", "0,5", "-1e3", ""])
    (False, True, True)
    """
    found = [is_number(field) for field in fields]
    while found and not fields[len(found) - 1]:
        found.pop()
    return tuple(found)


def is_number(field: str) -> bool:
    """Whether a field is a number, with a decimal point or comma."""
    try:
        float(field.replace(",", ".", 1))
    except ValueError:
        return False
    return True


def unit_in(name: str) -> str:
    """Unit in brackets or after a stroke at the end of the name of a column, or its last word; empty if it is not known.

    >>> unit_in("DE [g]"), unit_in("Beschl. m/s²"), unit_in("acc/g"), unit_in("Time"), unit_in("sensor g")
    ('g', 'm/s2', 'g', '', '')
    """
    bracketed = _IN_BRACKETS.search(name)
    word = name.rpartition(" ")[2]
    found = [bracketed[1]] if bracketed else [word if len(word) > 1 or word == name else "", word.partition("/")[2]]
    return next((unit for unit in map(key_of, found) if unit in UNITS or unit in OTHERS or unit in SECONDS), "")


def key_of(unit: str) -> str:
    """Unit as the tables above have it."""
    return re.sub(r"[\s^*·]", "", _plain(unit))


def _plain(text: str) -> str:
    return unicodedata.normalize("NFKC", text).casefold()


def _names(rows: Sequence[Sequence[str]], count: int) -> tuple[str, ...]:
    """Names in the last row before the numbers; a row of units stands below that of the names."""
    suited = [len(fields) >= count and not any(map(is_number, fields)) for fields in rows[-2:]]
    if not suited or not suited[-1]:
        return ()
    names, above = rows[-1][:count], rows[-2][:count] if len(rows) > 1 and suited[0] else ()
    if above and all(not name or unit_in(f"({name.strip('[]()')})") for name in names):
        return tuple(
            f"{name} [{unit.strip('[]()')}]" if unit else name for name, unit in zip(above, names, strict=True)
        )
    return tuple(names)


def _rate(lines: Sequence[str]) -> float | None:
    """Sample rate [Hz] that a line before the numbers states, directly or as a step of time."""
    for pattern in (_RATE, _STEP):
        for line in lines:
            found = pattern.search(line)
            if found is None:
                continue
            before, number, after = found.groups()
            value = float(number.replace(",", "" if _THOUSANDS.fullmatch(number) else "."))
            value *= _FACTORS[before or after or ""]
            rate = value if pattern is _RATE else 1 / value if value else 0.0
            if rate >= LEAST_RATE:
                return rate
    return None
