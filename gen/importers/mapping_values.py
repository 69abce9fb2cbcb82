"""Types of the values in a mapping file, and the bearing that is not in the catalogue.

Text from strangers reaches data cards, messages and the names of variables: control characters are refused.
"""

import math
import unicodedata
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Discriminator, Field, Tag, model_validator

from gen.corpus import FAULTS, UNKNOWN
from gen.physics.bearing import Bearing
from gen.physics.catalogue import CATALOGUE, known_designation
from gen.support.units import to_si

if TYPE_CHECKING:
    FaultClass = str
else:
    FaultClass = Literal[(*FAULTS, UNKNOWN)]
_MOST_COLUMNS = 1_000_000


class Keys(BaseModel):
    """Keys that belong together; frozen, and other keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


def _as_text(value: Any) -> Any:
    return str(value) if type(value) is int else value


def _printable(text: str) -> str:
    """Return text without control characters; ValueError if it has one."""
    for letter in text:
        if unicodedata.category(letter) in ("Cc", "Cs") and letter not in "\t\n\r":
            raise ValueError(f"{letter!r} is a control character; leave it out.")
    return text


def _on_one_line(text: str) -> str:
    if set(text) & set("\t\n\r"):
        raise ValueError(f"{text[:60]!r} has a tab or a line break; write it on one line.")
    return _printable(text)


def _column(column: Any) -> Any:
    if isinstance(column, str):
        return _on_one_line(column)
    if type(column) is int and 0 <= column < _MOST_COLUMNS:
        return column
    raise ValueError(f"is not a column; give its number, 0 to {_MOST_COLUMNS - 1}, or its name in the header.")


def _separates(mark: str) -> str:
    if mark in '\r\n#"' or mark.isalnum() or mark in "+-." or unicodedata.category(mark) == "Cs":
        raise ValueError(f"{mark!r} cannot separate columns; give one character such as a comma, a semicolon or a tab.")
    return mark


def _in_catalogue(name: str) -> str:
    known = known_designation(name)
    if known is None:
        raise ValueError(f"{name} is not in the catalogue ({', '.join(CATALOGUE)}); give its geometry instead.")
    return known


Text = Annotated[str, Field(min_length=1, max_length=5000), BeforeValidator(_as_text), AfterValidator(_printable)]
Line = Annotated[str, Field(min_length=1, max_length=1000), BeforeValidator(_as_text), AfterValidator(_on_one_line)]
Name = Annotated[str, Field(min_length=1, max_length=200), BeforeValidator(_as_text), AfterValidator(_on_one_line)]
Column = Annotated[int | str, BeforeValidator(_column)]
Delimiter = Annotated[str, Field(min_length=1, max_length=1), AfterValidator(_separates)]
Millimetres = Annotated[float, Field(gt=0, le=10_000)]
Micrometres = Annotated[float, Field(gt=0, le=10_000_000)]
Degrees = Annotated[float, Field(ge=-360, le=360)]
Newtons = Annotated[float, Field(ge=0, le=1e9)]
Rpm = Annotated[float, Field(ge=0.001, le=1e7)]
Hertz = Annotated[float, Field(ge=1, le=1e8)]
Count = Annotated[int, Field(ge=1, le=1000)]
Sensitivity = Annotated[float, Field(ge=1e-6, le=1e6)]


class Geometry(Keys):
    """A bearing that is not in the catalogue."""

    designation: Name = "own"
    n_balls: Annotated[int, Field(ge=3, le=1000)]
    pitch_diameter_mm: Annotated[Millimetres, Field(ge=1)]
    ball_diameter_mm: Annotated[Millimetres, Field(ge=0.01)]
    contact_angle_deg: Annotated[float, Field(ge=0, lt=90)] = 0.0

    @model_validator(mode="after")
    def _balls_fit(self) -> Self:
        if self.ball_diameter_mm >= self.pitch_diameter_mm * math.sin(math.pi / self.n_balls):
            raise ValueError(f"{self.n_balls} balls of {self.ball_diameter_mm:g} mm do not fit on the pitch circle.")
        return self


AnyBearing = Annotated[
    Annotated[Name, AfterValidator(_in_catalogue), Tag("[name]")] | Annotated[Geometry, Tag("[geometry]")],
    Discriminator(lambda value: "[geometry]" if isinstance(value, dict | Geometry) else "[name]"),
]
"""Designation in the catalogue, or a geometry."""


def bearing_of(given: str | Geometry) -> Bearing:
    """Bearing of a designation or a geometry, in SI units."""
    if isinstance(given, str):
        return CATALOGUE[given]
    return Bearing(
        given.designation,
        given.n_balls,
        to_si(given.pitch_diameter_mm, "mm"),
        to_si(given.ball_diameter_mm, "mm"),
        to_si(given.contact_angle_deg, "deg"),
    )
