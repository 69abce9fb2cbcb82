"""Columns that hold the axes of one sensor, by their names and units.

The names differ in one word, which is a direction, or in the number of a channel. Two numbered channels may as well be two
bearings, or a sensor and a tachometer, and more than three are several sensors: then the user has to choose.
"""

import re
from collections.abc import Sequence

from raceway.importing.conversion import VOLTAGES
from raceway.importing.header import Header, known_unit

_MOST = 3
_WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+|\d+")  # accX has two
_DIRECTIONS = (
    {"x", "y", "z"},
    {"ax", "ay", "az"},
    {"h", "v", "a"},
    {"horizontal", "vertical", "vertikal", "radial", "axial", "tangential", "lateral", "transverse", "longitudinal"},
)
_NUMBERED = ("ch", "chan", "channel", "kanal", "ai")


def axes_of(header: Header, columns: Sequence[int]) -> tuple[int, ...]:
    """Those of some columns, none of times, that hold acceleration, if they are one or the axes of one sensor; else none.

    Columns that state no unit may hold acceleration, and voltages do if no other column may.

    >>> axes_of(Header(("x [g]", "y [g]", "rpm"), ("g", "g", "rpm")), (0, 1, 2)), axes_of(Header(), (0, 1, 2))
    ((0, 1), (0, 1, 2))
    >>> axes_of(Header(("DE", "FE"), ("", "")), (0, 1)), axes_of(Header(), (0, 1))
    ((), ())
    """
    units = {n: known_unit(header.unit_of(n)) for n in columns}
    voltages = tuple(n for n in columns if units[n] in VOLTAGES)
    held = tuple(n for n in columns if n not in voltages and (units[n] or not header.unit_of(n))) or voltages
    if len(held) == 1:
        return held
    named = _are_axes([header.names[n] for n in held]) if header.names else len(held) == _MOST
    return held if named else ()


def _are_axes(names: Sequence[str]) -> bool:
    words = [[word.casefold() for word in _WORD.findall(name)] for name in names]
    if not 1 < len(names) <= _MOST or len({*map(len, words)}) > 1:
        return False
    differing = [place for place, each in enumerate(zip(*words, strict=True)) if len({*each}) > 1]
    if len(differing) != 1:
        return False
    place = differing[0]
    said = {each[place] for each in words}
    if len(said) < len(names):
        return False
    if all(word.isdecimal() for word in said):
        return len(said) == _MOST and words[0][place - 1] in _NUMBERED
    return said != {"v", "a"} and any(
        said <= directions for directions in _DIRECTIONS
    )  # may be velocity and acceleration
