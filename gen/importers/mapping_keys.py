"""Keys of a mapping file that describe recordings, and the facts of one file that follow from them.

A fact can be given as a value, as a table from the text in the path to the value (``fault: {N: healthy}``), or, if it is a number, as a
reading: ``{variable: RPM, times: 60}`` is in the file, ``{times: 1000}`` in the path.
"""

from typing import Annotated, Any, NamedTuple, TypeVar

from pydantic import AfterValidator, Discriminator, Field, Tag

from gen.corpus import UNKNOWN
from gen.importers.conversion import Scale, Unit
from gen.importers.mapping_values import (
    AnyBearing,
    Column,
    Count,
    Degrees,
    Delimiter,
    FaultClass,
    Hertz,
    Keys,
    Line,
    Micrometres,
    Millimetres,
    Name,
    Newtons,
    Rpm,
    Sensitivity,
)
from gen.importers.paths import parse_pattern
from gen.importers.signals import Place

WITHOUT_SPALL = ("healthy", "cage", UNKNOWN)
SPALL_KEYS = ("width_mm", "depth_um", "angle_deg", "n_spalls")
NUMBERS = ("shaft_rpm", "sample_rate_hz", "load_n", *SPALL_KEYS)
Value = TypeVar("Value")


class Reading(Keys):
    """A number in the file, or without a variable in the path, and the factor that turns it into the unit of the key."""

    variable: Name | None = None
    times: Annotated[float, Field(gt=0, le=1e12)] = 1.0


def _form_of_text(value: Any) -> str:
    return "[table]" if isinstance(value, dict) else "[one]"


def _form_of_number(value: Any) -> str:
    return "[reading]" if isinstance(value, dict) and value.keys() & {"variable", "times"} else _form_of_text(value)


_One = Annotated[Value, Tag("[one]")]
_Table = Annotated[dict[Line, Value], Field(min_length=1), Tag("[table]")]
_Text = Annotated[_One[Value] | _Table[Value], Discriminator(_form_of_text)]
_Number = Annotated[_One[Value] | _Table[Value] | Annotated[Reading, Tag("[reading]")], Discriminator(_form_of_number)]


def _is_pattern(text: str) -> str:
    parse_pattern(text)
    return text


class SensorKeys(Keys):
    """Keys that a file and each of its channels can have."""

    variable: Name | None = None
    column: Column | None = None
    unit: Unit | None = None
    sensitivity_mv_per_g: Sensitivity | None = None
    sensitivity_mv_per_m_s2: Sensitivity | None = None


class Channel(SensorKeys):
    """One sensor of a recording with several; keys that it lacks are those of the file."""

    name: Name


def _names_differ(channels: tuple[Channel, ...]) -> tuple[Channel, ...]:
    names = [channel.name for channel in channels]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ValueError(f"two are called {twice}; give each a name of its own.")
    return channels


class FileKeys(SensorKeys):
    """Keys of a file or of all files of a path; at the top they apply to every file that does not have them itself."""

    path: Annotated[Line, AfterValidator(_is_pattern)] | None = None
    channels: (
        Annotated[tuple[Channel, ...], Field(min_length=1, max_length=64), AfterValidator(_names_differ)] | None
    ) = None
    delimiter: Delimiter | None = None
    bearing: AnyBearing | None = None
    fault: _Text[FaultClass] | None = None
    specimen: _Text[Name] | None = None
    rig: _Text[Name] | None = None
    recording: _Text[Name] | None = None
    shaft_rpm: _Number[Rpm] | None = None
    sample_rate_hz: _Number[Hertz] | None = None
    load_n: _Number[Newtons] | None = None
    width_mm: _Number[Millimetres] | None = None
    depth_um: _Number[Micrometres] | None = None
    angle_deg: _Number[Degrees] | None = None
    n_spalls: _Number[Count] | None = None


class Facts(Keys):
    """Facts of one file; numbers that it holds itself are None until it is read."""

    bearing: AnyBearing
    fault: FaultClass
    specimen: Name
    rig: Name = "1"
    recording: Name | None = None
    shaft_rpm: Rpm | None = None
    sample_rate_hz: Hertz | None = None
    load_n: Newtons | None = None
    width_mm: Millimetres | None = None
    depth_um: Micrometres | None = None
    angle_deg: Degrees | None = None
    n_spalls: Count | None = None


class Sensor(NamedTuple):
    """A channel with all that is needed to read it."""

    name: str
    place: Place
    scale: Scale
