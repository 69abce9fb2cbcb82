"""Numbers in text, which have one reading or none.

A number has a decimal point or comma, and perhaps marks between its thousands. ``1.234`` alone can be read in two ways; beside ``0.5`` or
``1.000,5`` one way is left.
"""

import re
from collections.abc import Iterable, Mapping

_BETWEEN = "'’ \xa0\u202f"  # thousands, beside the other decimal mark
_THOUSANDS = {".": "," + _BETWEEN, ",": "." + _BETWEEN}


def _patterns(point: str) -> tuple[str, str]:
    exponent = r"(?:[eEdD][-+]?\d+)?"  # 1.2D-01 is one of Fortran
    grouped = rf"[1-9]\d{{0,2}}([{_THOUSANDS[point]}])\d{{3}}(?:\1\d{{3}})*(?:[{point}]\d+)?"
    return (
        rf"[-+]?(?:\d+(?:[{point}]\d*)?|[{point}]\d+){exponent}",
        rf"[-+]?(?:{grouped}|\d{{1,3}}(?:[{point}]\d+)?{exponent})",
    )


PATTERNS: Mapping[str, tuple[str, str]] = {point: _patterns(point) for point in ".,"}
"""Regular expressions of numbers without and with marks between thousands, by their decimal mark."""
_NUMBERS = {point: re.compile("|".join(PATTERNS[point]), re.ASCII) for point in ".,"}
AS_PYTHON: Mapping[str, Mapping[int, str | None]] = {
    point: str.maketrans({**dict.fromkeys(_THOUSANDS[point]), point: ".", "d": "e", "D": "e"}) for point in ".,"
}
"""Letters to be replaced in a number, by its decimal mark, to make one that Python reads."""
IN_THOUSANDS = "may be in thousands; write it without marks between them, or with four decimals"


def is_number(text: str) -> bool:
    """Whether a text is a number with a decimal point or comma.

    >>> [is_number(text) for text in ("0,5", "1'000.5", "1.2D-01", "1,2,3", "nan", "")]
    [True, True, True, False, False, False]
    """
    return (_NUMBERS["."].fullmatch(text) or _NUMBERS[","].fullmatch(text)) is not None


def decimal_marks(numbers: Iterable[str]) -> str:
    """Decimal marks with which all of some numbers can be read: one, both if that makes others of them, or none.

    >>> [decimal_marks(texts) for texts in (["999,5", "1.000,0"], ["0.512", "1.024"], ["-1.234", "567"], ["0,5", "0.7"], ["5"])]
    [',', '.', '.,', '', '.']
    """
    texts = [*numbers]
    fitting = [
        point
        for point, forms in PATTERNS.items()
        if any(all(re.fullmatch(form, text, re.ASCII) for text in texts) for form in forms)
    ]
    return "".join(fitting) if any("." in text or "," in text for text in texts) else "."


def in_doubt(numbers: Iterable[str]) -> bool:
    """Whether a number of a column may be in thousands, such as ``1.480``; no, if all have decimals that show the mark.

    >>> [in_doubt(texts) for texts in (["1.480", "1480"], ["1.480"], ["1.480", "999.5"], ["1480", "999.5"])]
    [True, True, False, False]
    """
    texts = [*numbers]
    mark = decimal_marks(texts)
    shown = len(mark) == 1 and all(mark in text for text in texts)
    return not shown and any(len(decimal_marks([text])) > 1 for text in texts)


def number_in(text: str, marks: str = "") -> float | None:
    """Number in a text, with one of some decimal marks; None if it is none, or can be read in two ways.

    >>> number_in("12,8"), number_in("12800.0"), number_in("12,800"), number_in("12,800", "."), number_in("12.8 Hz")
    (12.8, 12800.0, None, 12800.0, None)
    """
    marks = marks or decimal_marks([text])
    if len(marks) != 1 or not _NUMBERS[marks].fullmatch(text):
        return None
    return float(text.translate(AS_PYTHON[marks]))
