"""Mapping files: YAML that describes a user's recordings file by file.

A key that describes a file can be given once at the top for all files, and again for a file that differs. A quantity that a recipe also
has is spelt as in a recipe, with the unit at the end of the key.
"""

import difflib
import reprlib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, NamedTuple

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from gen.errors import CorpusError
from gen.importers.entry import Channel, Entry
from gen.importers.mapping_values import Geometry, Name, Text
from gen.importers.paths import groups_in, parse_pattern
from gen.importers.section import STAND_INS, Reading, Section, split_keys
from gen.yaml_files import read_yaml

_RENAMED = {
    "depth_mm": "depth_um, in micrometres",
    "sensitivity": "sensitivity_mv_per_g or sensitivity_mv_per_m_s2",
    "resample": "resample_hz at the top",
    "shaft_hz": "shaft_rpm, which is 60 times as large",
}


class _Top(BaseModel):
    """The file as a whole; further keys apply to every recording."""

    model_config = ConfigDict(extra="allow", frozen=True)

    title: Text = "Own recordings"
    origin: Text = "Origin and licence are not stated."
    channel: Name = "sensor"
    resample_hz: Annotated[float, Field(ge=1, le=1e8, allow_inf_nan=False)] | None = None
    files: Annotated[list[dict[str, Any]], Field(min_length=1)]


class MappingFile(NamedTuple):
    """A mapping file, read and checked; ``channels`` are the names of the channels of all recordings."""

    title: str
    origin: str
    channels: tuple[str, ...]
    resample: float | None
    sections: tuple[Section, ...]


def read_mapping(path: Path) -> MappingFile:
    """Read and check a mapping file.

    Raises
    ------
    CorpusError
        If it is missing, is not YAML, or has a wrong key or value; the first of them is named.
    """
    raw = _read(path)
    try:
        top = _Top.model_validate(raw)
    except ValidationError as error:
        message = f"{path}: {sentence_of(error, '', raw, None)}"
        raise CorpusError(message) from None
    common = top.model_extra or {}
    sections: list[Section] = []
    names: list[tuple[str, ...]] = []
    for number, own in enumerate(top.files):
        where = f"files[{number}]"
        try:
            section, entry = _section(number, common, own)
        except ValidationError as error:
            message = f"{path}: {sentence_of(error, f'{where}.', common, own)}"
            raise CorpusError(message) from None
        except ValueError as error:
            message = f"{path}: {where}.{error}."
            raise CorpusError(message) from None
        sections.append(section)
        names.append(tuple(channel.name for channel in entry.channels or ()) or (top.channel,))
        if names[-1] != names[0]:
            message = (
                f"{path}: {where} has the channels {', '.join(names[-1])}, and files[0] has {', '.join(names[0])}; "
                f"give all files the same channels, or make a corpus of each."
            )
            raise CorpusError(message)
    return MappingFile(top.title, top.origin, names[0], top.resample_hz, tuple(sections))


def _read(path: Path) -> dict[str, Any]:
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
    return raw


def _section(number: int, common: Mapping[str, Any], own: Mapping[str, Any]) -> tuple[Section, Entry]:
    """A section, and the description of a file that has stand-ins for all that only the file or its path gives.

    Raises
    ------
    ValidationError
        If a value is not allowed.
    ValueError
        If path and keys do not belong together, with the end of a sentence.
    """
    text = own.get("path", common.get("path"))
    try:
        pattern = parse_pattern(text if isinstance(text, str) and text else "x.wav")
    except ValueError as error:
        message = f"path: {error}"
        raise ValueError(message) from None
    keys = {key: value for key, value in common.items() if key not in pattern.groups or isinstance(value, dict)}
    keys |= own
    given, tables, raw_readings = split_keys(keys, pattern)
    twice = next(
        (
            key
            for key in pattern.groups
            if key in STAND_INS and (key in given or raw_readings.get(key, {}).get("variable"))
        ),
        None,
    )
    if twice is not None:
        message = f"{twice} is given, and {{{twice}}} in the path tells it too; remove one of the two"
        raise ValueError(message)
    lost = next((name for key in ("specimen", "rig", "recording", "variable") if isinstance(given.get(key), str)
                 for name in groups_in(given[key]) if name not in pattern.groups), None)  # fmt: skip
    if lost is not None:
        message = f"path has no group {{{lost}}}, which another key refers to; write {{{lost}}} in the path"
        raise ValueError(message)
    readings = {key: _checked(Reading, value, key) for key, value in raw_readings.items()}
    section = Section(number, pattern, given, tables, readings)
    first, *_ = section.examples()
    return section, first


def _checked(model: type[Reading], value: Any, key: str) -> Reading:
    try:
        return model.model_validate(value)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join([key, *(str(part) for part in first["loc"])])
        message = f"{place}: {reprlib.repr(first['input'])} is not allowed; {first['msg'][0].lower()}{first['msg'][1:]}"
        raise ValueError(message) from None


def sentence_of(error: ValidationError, where: str, common: Mapping[str, Any], own: Mapping[str, Any] | None) -> str:
    """Sentence about the first cause, at the place where the user wrote the value."""
    # an unknown key comes before the missing key that it causes, a key of the geometry before "not a string"
    complaint = max(error.errors(), key=lambda one: (one["type"] == "extra_forbidden", len(one["loc"])))
    place = complaint["loc"]
    tags = ("name", "geometry") if place[:1] == ("bearing",) else ("int", "str")  # of the kinds of a value, not keys
    keys = [*map(str, place[:1]), *(str(part) for part in place[1:] if part not in tags)]
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
            known = [*Entry.model_fields, *Geometry.model_fields, *Channel.model_fields, *_Top.model_fields]
            near = difflib.get_close_matches(keys[-1], known, n=1)
            return f"{where}{key} is not a key here; " + (f"did you mean {near[0]}?" if near else "remove it.")
        case "value_error":
            return f"{(where + key).removesuffix('.')}: {message}.".removeprefix(": ")
        case _:
            return (
                f"{where}{key}: {reprlib.repr(complaint['input'])} is not allowed; {message[0].lower()}{message[1:]}."
            )
