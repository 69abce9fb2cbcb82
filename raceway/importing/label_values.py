"""Types of the values in a table of labels."""

import unicodedata
from pathlib import Path, PureWindowsPath
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field

from gen.corpus import FAULTS, UNKNOWN
from gen.support.key_types import as_text, on_one_line

if TYPE_CHECKING:
    FaultClass = str
else:
    FaultClass = Literal[(*FAULTS, UNKNOWN)]
_MOST_COLUMNS = 1_000_000


def _inside(text: str) -> str:
    path = Path(on_one_line(text).replace("\\", "/"))  # Windows has backslashes
    if path.is_absolute() or PureWindowsPath(text).drive or ".." in path.parts:
        raise ValueError(f"{text} leads out of the folder of the recordings; put the table into a folder above them.")
    return path.as_posix()


def _column(column: Any) -> Any:
    if isinstance(column, str):
        return on_one_line(column)
    if type(column) is int and 0 <= column < _MOST_COLUMNS:
        return column
    raise ValueError(f"is not a column; give its number, 0 to {_MOST_COLUMNS - 1}, or its name in the header.")


def _separates(mark: str) -> str:
    if mark in '\r\n#"' or mark.isalnum() or mark in "+-." or unicodedata.category(mark) == "Cs":
        raise ValueError(f"{mark!r} cannot separate columns; give one character such as a comma, a semicolon or a tab.")
    return mark


Inside = Annotated[str, Field(min_length=1, max_length=1000), BeforeValidator(as_text), AfterValidator(_inside)]
Column = Annotated[int | str, BeforeValidator(_column)]
Delimiter = Annotated[str, Field(min_length=1, max_length=1), AfterValidator(_separates)]
Micrometres = Annotated[float, Field(gt=0, le=10_000_000)]
Degrees = Annotated[float, Field(ge=-360, le=360)]
Newtons = Annotated[float, Field(ge=0, le=1e9)]
Rpm = Annotated[float, Field(ge=0.001, le=1e7)]
Hertz = Annotated[float, Field(ge=1, le=1e8)]
Count = Annotated[int, Field(ge=1, le=1000)]
Sensitivity = Annotated[float, Field(ge=1e-6, le=1e6)]
