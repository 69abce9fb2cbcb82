"""Types of the values in a mapping file, and the bearing that is not in the catalogue.

Text from strangers reaches data cards, messages and the names of variables: control characters are refused.
"""

import math
import unicodedata
from typing import Annotated, Any, Self

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, model_validator

_MOST_COLUMNS = 1_000_000
Millimetres = Annotated[float, Field(gt=0, le=10_000, allow_inf_nan=False)]
Micrometres = Annotated[float, Field(gt=0, le=10_000_000, allow_inf_nan=False)]
Sensitivity = Annotated[float, Field(ge=1e-6, le=1e6, allow_inf_nan=False)]


def _checked(text: str) -> str:
    """Return text without control characters; ValueError if it has one."""
    odd = next(
        (letter for letter in text if unicodedata.category(letter) in ("Cc", "Cs") and letter not in "\t\n\r"), None
    )
    if odd is not None:
        message = f"{odd!r} is a control character; leave it out"
        raise ValueError(message)
    return text


def _on_one_line(text: str) -> str:
    if set(text) & set("\t\n\r"):
        message = f"{text[:60]!r} has a tab or a line break; write it on one line"
        raise ValueError(message)
    return text


def _as_text(value: Any) -> Any:
    return str(value) if type(value) is int else value


def _column(column: int | str | None) -> int | str | None:
    if isinstance(column, int) and not 0 <= column < _MOST_COLUMNS:
        message = f"is not in 0 to {_MOST_COLUMNS - 1}"
        raise ValueError(message)
    return _on_one_line(_checked(column)) if isinstance(column, str) else column


Text = Annotated[str, BeforeValidator(_as_text), Field(min_length=1, max_length=5000), AfterValidator(_checked)]
Line = Annotated[str, BeforeValidator(_as_text), AfterValidator(_checked), AfterValidator(_on_one_line)]
Name = Annotated[Line, Field(min_length=1, max_length=200)]
Pattern = Annotated[Line, Field(min_length=1, max_length=1000)]


def _separates(mark: str) -> str:
    if mark in '\r\n#"' or mark.isalnum() or mark in "+-." or unicodedata.category(mark) == "Cs":
        message = f"{mark!r} cannot separate columns; give one character such as a comma, a semicolon or a tab"
        raise ValueError(message)
    return mark


Delimiter = Annotated[str, Field(min_length=1, max_length=1), AfterValidator(_separates)]
Column = Annotated[int | str | None, AfterValidator(_column)]


class Geometry(BaseModel):
    """A bearing that is not in the catalogue."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    designation: Name = "own"
    n_balls: Annotated[int, Field(ge=3, le=1000)]
    pitch_diameter_mm: Annotated[Millimetres, Field(ge=1)]
    ball_diameter_mm: Annotated[Millimetres, Field(ge=0.01)]
    contact_angle_deg: Annotated[float, Field(ge=0, lt=90)] = 0.0

    @model_validator(mode="after")
    def _balls_fit(self) -> Self:
        if self.ball_diameter_mm >= self.pitch_diameter_mm * math.sin(math.pi / self.n_balls):
            message = f"{self.n_balls} balls of {self.ball_diameter_mm:g} mm do not fit on the pitch circle"
            raise ValueError(message)
        return self
