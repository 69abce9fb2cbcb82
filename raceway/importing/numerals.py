"""Numbers in text, which have one reading or none.

A number has a decimal point or comma, and perhaps marks between its thousands. ``1.234`` alone can be read in two ways; beside ``0.5`` or
``1.000,5`` one way is left. A block is a text of numbers with a line break after each.
"""

import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Form(NamedTuple):
    """A way to write numbers: the mark between thousands, empty for none, and the decimal mark."""

    thousands: str
    point: str

    @property
    def pattern(self) -> str:
        """Regular expression of a number; 1.2D-01 is one of Fortran."""
        mark, point, exponent = re.escape(self.thousands), re.escape(self.point), r"(?:[eEdD][-+]?\d+)?"
        if not mark:
            return rf"[-+]?(?:\d+(?:{point}\d*)?|{point}\d+){exponent}"
        return rf"[-+]?(?:[1-9]\d{{0,2}}(?:{mark}\d{{3}})+(?:{point}\d+)?|\d{{1,3}}(?:{point}\d+)?{exponent})"


POINT = Form("", ".")
FORMS = (
    POINT,
    Form("", ","),
    Form(".", ","),
    Form(",", "."),
    *(Form(mark, point) for mark in "'’ \xa0\u202f" for point in ".,"),
)
_NUMBER = "|".join(form.pattern for form in FORMS)
_ONE = re.compile(_NUMBER, re.ASCII)
_BLOCK = re.compile(rf"(?:(?:{_NUMBER})\n)*+", re.ASCII)
_BLOCKS = {form: re.compile(rf"(?:{form.pattern}\n)*+", re.ASCII) for form in FORMS}
_THOUSANDS = {form.thousands for form in FORMS[2:]}


def is_number(text: str) -> bool:
    """Whether a text is a number in one of the forms.

    >>> [is_number(text) for text in ("0,5", "1'000.5", "1.2D-01", "1,2,3", "nan", "")]
    [True, True, True, False, False, False]
    """
    return _ONE.fullmatch(text) is not None


def block_of(texts: Iterable[str]) -> str | None:
    """Texts as a block; None if one is no number."""
    block = "".join([f"{text}\n" for text in texts])
    return block if _BLOCK.fullmatch(block) else None


def readings(blocks: Sequence[str]) -> list[Form]:
    r"""One form for each way to read all numbers of some blocks: one, none, or several that differ.

    >>> readings(["999,5\n1.000,0\n"]), readings(["0.512\n1.024\n"]), len(readings(["-1.234\n567\n"])), readings(["0,5\n0.7\n"])
    ([Form(thousands='.', point=',')], [Form(thousands='', point='.')], 2, [])
    """
    used = {mark for mark in _THOUSANDS if any(mark in block for block in blocks)}
    tried = [form for form in FORMS if form.thousands in used or not form.thousands]
    suiting = [form for form in tried if all(_BLOCKS[form].fullmatch(block) for block in blocks)]
    return [*{form.thousands: form for form in suiting}.values()]


def numbers_in(blocks: Iterable[str], form: Form) -> NDArray[np.float64]:
    """Numbers of some blocks that are written in a form."""
    marks = str.maketrans({"d": "e", "D": "e"} | {form.point: "."} | dict.fromkeys(form.thousands))
    return np.concatenate([np.array(block.translate(marks).split("\n")[:-1], dtype=np.float64) for block in blocks])


def number_in(text: str) -> float | None:
    """Number in a text; None if it is none, or can be read in two ways.

    >>> number_in("12,8"), number_in("12800.0"), number_in("12,800"), number_in("12.8 Hz")
    (12.8, 12800.0, None, None)
    """
    forms = readings([f"{text}\n"])
    return float(numbers_in([f"{text}\n"], forms[0])[0]) if len(forms) == 1 else None
