"""Mapping files: YAML that describes a user's recordings file by file.

A key that describes a file can be given once at the top for all files, and again for a file that differs. A quantity that a recipe also
has is spelt as in a recipe, with the unit at the end of the key.
"""

import difflib
import math
import reprlib
import unicodedata
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    ValidationError,
    model_validator,
)

from gen.corpus import FAULTS, UNKNOWN
from gen.errors import CorpusError
from gen.physics.bearing import Bearing
from gen.physics.catalogue import CATALOGUE
from gen.units import to_si
from gen.yaml_files import read_yaml

if TYPE_CHECKING:
    FaultClass = str
else:
    FaultClass = Literal[(*FAULTS, UNKNOWN)]
_MOST_COLUMNS = 1_000_000
_RENAMED = {"depth_mm": "depth_um, in micrometres"}
Millimetres = Annotated[float, Field(gt=0, le=10_000, allow_inf_nan=False)]
Micrometres = Annotated[float, Field(gt=0, le=10_000_000, allow_inf_nan=False)]


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


class Entry(BaseModel):
    """Description of a file, or of all files that match a pattern."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    path: Pattern
    bearing: Annotated[
        Annotated[Name, Tag("name")] | Annotated[Geometry, Tag("geometry")],
        Discriminator(lambda value: "geometry" if isinstance(value, dict) else "name"),
    ]
    unit: Literal["g", "m/s2"]
    sample_rate_hz: Annotated[float, Field(ge=1, le=1e8, allow_inf_nan=False)]
    shaft_rpm: Annotated[float, Field(ge=0.001, le=1e7, allow_inf_nan=False)]
    fault: FaultClass
    specimen: Name
    rig: Name = "1"
    variable: Name | None = None
    column: Annotated[int | str | None, AfterValidator(_column)] = None
    delimiter: Delimiter | None = None
    load_n: Annotated[float, Field(ge=0, le=1e9, allow_inf_nan=False)] | None = None
    width_mm: Millimetres | None = None
    depth_um: Micrometres | None = None
    angle_deg: Annotated[float, Field(ge=-360, le=360, allow_inf_nan=False)] | None = None
    n_spalls: Annotated[int, Field(ge=1, le=1000)] | None = None

    @model_validator(mode="after")
    def _bearing_is_known(self) -> Self:
        if isinstance(self.bearing, str) and self.bearing not in CATALOGUE:
            known = ", ".join(CATALOGUE)
            message = f"bearing {self.bearing} is not in the catalogue ({known}); give its geometry instead"
            raise ValueError(message)
        return self

    @model_validator(mode="after")
    def _spall_keys_need_a_spall(self) -> Self:
        spall = [key for key in ("width_mm", "depth_um", "angle_deg", "n_spalls") if getattr(self, key) is not None]
        if self.fault in ("healthy", "cage", UNKNOWN) and spall:
            message = f"{spall[0]} describes a spall, and fault is {self.fault}; remove one of the two"
            raise ValueError(message)
        return self


class _Top(BaseModel):
    """The file as a whole; further keys apply to every recording."""

    model_config = ConfigDict(extra="allow", frozen=True)

    title: Text = "Own recordings"
    origin: Text = "Origin and licence are not stated."
    channel: Name = "sensor"
    files: Annotated[list[dict[str, Any]], Field(min_length=1)]


class MappingFile(NamedTuple):
    """A mapping file, read and checked."""

    title: str
    origin: str
    channel: str
    entries: tuple[Entry, ...]


def read_mapping(path: Path) -> MappingFile:
    """Read and check a mapping file.

    Raises
    ------
    CorpusError
        If it is missing, is not YAML, or has a wrong key or value; the first of them is named.
    """
    if path.is_dir():
        raise CorpusError(
            f"{path}: is a folder; give the YAML file that describes the recordings, such as {path / 'mapping.yaml'}."
        )
    if not path.is_file():
        raise CorpusError(f"{path}: no such file; give the YAML file that describes the recordings.")
    raw = read_yaml(path, CorpusError)
    if not isinstance(raw, dict):
        raise CorpusError(
            f"{path}: holds no keys; give files, a list of sections with path, fault, specimen and further keys."
        )
    try:
        top = _Top.model_validate(raw)
    except ValidationError as error:
        message = f"{path}: {_sentence(error, '', raw, None)}"
        raise CorpusError(message) from None
    common = top.model_extra or {}
    entries: list[Entry] = []
    for number, own in enumerate(top.files):
        try:
            entries.append(Entry.model_validate(common | own))
        except ValidationError as error:
            message = f"{path}: {_sentence(error, f'files[{number}].', common, own)}"
            raise CorpusError(message) from None
    return MappingFile(top.title, top.origin, top.channel, tuple(entries))


def bearing_of(entry: Entry) -> Bearing:
    """Bearing of an entry, in SI units."""
    if isinstance(entry.bearing, str):
        return CATALOGUE[entry.bearing]
    return bearing_of_geometry(entry.bearing)


def bearing_of_geometry(geometry: Geometry) -> Bearing:
    """Bearing of a geometry, in SI units."""
    return Bearing(
        geometry.designation,
        geometry.n_balls,
        to_si(geometry.pitch_diameter_mm, "mm"),
        to_si(geometry.ball_diameter_mm, "mm"),
        to_si(geometry.contact_angle_deg, "deg"),
    )


def _sentence(error: ValidationError, where: str, common: dict[str, Any], own: dict[str, Any] | None) -> str:
    """Sentence about the first cause, at the place where the user wrote the value."""
    # an unknown key comes before the missing key that it causes, a key of the geometry before "not a string"
    complaint = max(error.errors(), key=lambda one: (one["type"] == "extra_forbidden", len(one["loc"])))
    keys = [str(part) for part in complaint["loc"] if part not in ("name", "geometry", "int", "str")]
    key = ".".join(keys)
    if own is not None and keys and keys[0] in common and keys[0] not in own:
        where = ""
    message = complaint["msg"].removeprefix("Value error, ")
    match complaint["type"]:
        case "missing":
            return f"{where}{key} is missing; give it there" + (
                "." if own is None else ", or at the top for all files."
            )
        case "extra_forbidden":
            if keys[-1] in _RENAMED:
                return f"{where}{key} is not a key here; give {_RENAMED[keys[-1]]}."
            near = difflib.get_close_matches(keys[-1], [*Entry.model_fields, *Geometry.model_fields], n=1)
            return f"{where}{key} is not a key here; " + (f"did you mean {near[0]}?" if near else "remove it.")
        case "value_error":
            return f"{where}{key}{': ' if key else ''}{message}."
        case _:
            return (
                f"{where}{key}: {reprlib.repr(complaint['input'])} is not allowed; {message[0].lower()}{message[1:]}."
            )
