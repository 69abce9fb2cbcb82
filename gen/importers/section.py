"""A section of ``files`` in a mapping file: a pattern of paths, and the keys that come from the path or from the file itself.

A group of the pattern with the name of a key, such as ``{shaft_rpm}``, gives that key. The key can then be a table from the text in the
path to its value (``fault: {N: healthy}``). ``{variable: RPM, times: 60}`` is a number in the file, and ``{group}`` in a text is filled in.
"""

import reprlib
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, NamedTuple

from pydantic import BaseModel, ConfigDict, Field

from gen.importers.entry import SPALL_KEYS, WITHOUT_SPALL, Entry
from gen.importers.mapping_values import Name
from gen.importers.paths import PathPattern, Suits, fill_in

# a valid value of each key that a path can give, for the checks before any file is seen
STAND_INS: Mapping[str, Any] = {
    "fault": "inner", "shaft_rpm": 1.0, "sample_rate_hz": 1.0, "load_n": 0.0, "specimen": "1", "rig": "1", "recording": "1",
    "bearing": "6205", "width_mm": 1.0, "depth_um": 1.0, "angle_deg": 0.0, "n_spalls": 1,
}  # fmt: skip
_NUMBERS = ("shaft_rpm", "sample_rate_hz", "load_n", "width_mm", "depth_um", "angle_deg", "n_spalls")
IN_FILE = ("shaft_rpm", "sample_rate_hz", "load_n")
_TEMPLATES = ("specimen", "rig", "recording", "variable")
_LONGEST_NUMBER = 20


class Reading(BaseModel):
    """A number that is in the file or in its path, and the factor that turns it into the unit of the key."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    variable: Name | None = None
    times: Annotated[float, Field(gt=0, le=1e12, allow_inf_nan=False)] = 1.0


class Section(NamedTuple):
    """A section, read and checked.

    ``given`` has the keys with one value for all files, ``tables`` those with a value for each text in the path, and ``readings`` those
    with a number in the file or a factor.
    """

    position: int
    pattern: PathPattern
    given: Mapping[str, Any]
    tables: Mapping[str, Mapping[str, Any]]
    readings: Mapping[str, Reading]

    @property
    def from_path(self) -> tuple[str, ...]:
        """Keys that the path gives."""
        return tuple(group for group in self.pattern.groups if group in STAND_INS)

    @property
    def in_file(self) -> dict[str, Reading]:
        """Keys that are numbers in the file."""
        return {key: reading for key, reading in self.readings.items() if reading.variable is not None}

    def suits(self) -> dict[str, Suits]:
        """For each group that not every text suits, whether a text does."""
        numbers: dict[str, Suits] = {key: _is_number for key in self.from_path if key in _NUMBERS}
        return numbers | {key: table.__contains__ for key, table in self.tables.items()}

    def wanted(self) -> str:
        """Words on what the groups of a path must be; empty if any text will do."""
        found = [f"{key} a number" for key in self.from_path if key in _NUMBERS and key not in self.tables]
        found += [f"{key} one of {', '.join([*table][:8])}" for key, table in self.tables.items()]
        return f" with {' and '.join(found)}" if found else ""

    def keys_for(self, groups: Mapping[str, str], measured: Mapping[str, float] | None = None) -> dict[str, Any]:
        """Values of all keys for a file; those in the file are ``measured``, or stand-ins if it was not read yet."""
        found: dict[str, Any] = {key: fill_in(value, groups) if key in _TEMPLATES and isinstance(value, str) else value
                                 for key, value in self.given.items()}  # fmt: skip
        if isinstance(found.get("channels"), list):
            found["channels"] = [_filled_in(channel, groups) for channel in found["channels"]]
        for key in self.from_path:
            text = groups[key]
            times = self.readings[key].times if key in self.readings else 1.0
            found[key] = (
                self.tables[key][text] if key in self.tables else float(text) * times if key in _NUMBERS else text
            )
        found |= {key: STAND_INS[key] if measured is None else measured[key] for key in self.in_file}
        if "fault" in self.from_path and found["fault"] in WITHOUT_SPALL:
            found = {key: value for key, value in found.items() if key not in SPALL_KEYS}
        return found

    def examples(self) -> Iterator[Entry]:
        """Description with stand-ins for all that only a file or its path gives, for each value of each table; at least one."""
        first: dict[str, str] = {group: str(STAND_INS.get(group, "x")) for group in self.pattern.groups}
        first |= {key: next(iter(table)) for key, table in self.tables.items()}
        yield self.entry(first)
        for key, table in self.tables.items():
            yield from (self.entry(first | {key: text}) for text in table)

    def entry(self, groups: Mapping[str, str], measured: Mapping[str, float] | None = None) -> Entry:
        """Description of a file; ValidationError if the path or the file gives a value that is not allowed."""
        return Entry.model_validate(self.keys_for(groups, measured))


def split_keys(keys: Mapping[str, Any], pattern: PathPattern) -> tuple[dict[str, Any], dict[str, Any], dict[str, Any]]:
    """Keys with one value, tables, and raw readings of a section.

    Raises
    ------
    ValueError
        If a table or a factor has no group in the path, or a key of a table is neither text nor a whole number.
    """
    given, tables, readings = {}, {}, {}
    for key, value in keys.items():
        if not isinstance(value, dict) or key not in STAND_INS or key == "bearing":
            given[key] = value
        elif key in IN_FILE and "variable" in value and value.keys() <= {"variable", "times"}:
            readings[key] = value
        elif key not in pattern.groups:
            kind = "a factor" if value.keys() == {"times"} else "a table"
            message = (
                f"{key} is {kind}, and path has no group {{{key}}}; write {{{key}}} in the path where it tells {key}"
            )
            raise ValueError(message)
        elif key in _NUMBERS and value.keys() == {"times"}:
            readings[key] = value
        else:
            wrong = next((one for one in value if type(one) not in (str, int)), None)
            if wrong is not None or not value:
                message = f"{key}: {reprlib.repr(wrong if value else value)} is no text in a path; write it in quotes"
                raise ValueError(message)
            tables[key] = {str(one): meant for one, meant in value.items()}
    return given, tables, readings


def _filled_in(channel: Any, groups: Mapping[str, str]) -> Any:
    if not isinstance(channel, dict) or not isinstance(channel.get("variable"), str):
        return channel
    return channel | {"variable": fill_in(channel["variable"], groups)}


def _is_number(text: str) -> bool:
    whole, _, decimals = text.removeprefix("-").partition(".")
    digits = whole + decimals
    return len(text) <= _LONGEST_NUMBER and digits.isascii() and digits.isdigit() and whole != ""
