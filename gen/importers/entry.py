"""Description of one recording in a mapping file: its place, unit, bearing, speed and fault."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple, Self

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag, model_validator

from gen.corpus import FAULTS, UNKNOWN
from gen.importers.conversion import VOLTAGES, Scale, Unit, unit_problem, volts_per_acceleration
from gen.importers.mapping_values import (
    Column,
    Delimiter,
    Geometry,
    Micrometres,
    Millimetres,
    Name,
    Pattern,
    Sensitivity,
)
from gen.importers.signals import Place
from gen.physics.bearing import Bearing
from gen.physics.catalogue import CATALOGUE
from gen.units import to_si

if TYPE_CHECKING:
    FaultClass = str
else:
    FaultClass = Literal[(*FAULTS, UNKNOWN)]
WITHOUT_SPALL = ("healthy", "cage", UNKNOWN)
SPALL_KEYS = ("width_mm", "depth_um", "angle_deg", "n_spalls")
MOST_CHANNELS = 64
_EVERYWHERE = "is missing; give it there, or at the top for all files"


class Measurement(BaseModel):
    """Keys that a file and each of its channels can have."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    variable: Name | None = None
    column: Column = None
    unit: Unit | None = None
    sensitivity_mv_per_g: Sensitivity | None = None
    sensitivity_mv_per_m_s2: Sensitivity | None = None

    @model_validator(mode="after")
    def _one_sensitivity(self) -> Self:
        if self.sensitivity_mv_per_g is not None and self.sensitivity_mv_per_m_s2 is not None:
            message = "sensitivity_mv_per_g and sensitivity_mv_per_m_s2 are both given; remove one of the two"
            raise ValueError(message)
        return self

    @property
    def sensitivity(self) -> float | None:
        """Sensitivity of the sensor [V per m s-2]."""
        return volts_per_acceleration(self.sensitivity_mv_per_g, self.sensitivity_mv_per_m_s2)


class Channel(Measurement):
    """One sensor of a recording with several; keys that it lacks are those of the file."""

    name: Name


class Sensor(NamedTuple):
    """A channel with all that is needed to read it."""

    name: str
    place: Place
    scale: Scale


class Entry(Measurement):
    """Description of a file, or of all files that match a pattern."""

    path: Pattern
    bearing: Annotated[
        Annotated[Name, Tag("name")] | Annotated[Geometry, Tag("geometry")],
        Discriminator(lambda value: "geometry" if isinstance(value, dict) else "name"),
    ]
    sample_rate_hz: Annotated[float, Field(ge=1, le=1e8, allow_inf_nan=False)] | None = None
    shaft_rpm: Annotated[float, Field(ge=0.001, le=1e7, allow_inf_nan=False)]
    fault: FaultClass
    specimen: Name
    rig: Name = "1"
    recording: Name | None = None
    channels: Annotated[tuple[Channel, ...], Field(min_length=1, max_length=MOST_CHANNELS)] | None = None
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
        spall = [key for key in SPALL_KEYS if getattr(self, key) is not None]
        if self.fault in WITHOUT_SPALL and spall:
            message = f"{spall[0]} describes a spall, and fault is {self.fault}; remove one of the two"
            raise ValueError(message)
        return self

    @model_validator(mode="after")
    def _rate_is_known(self) -> Self:
        if self.sample_rate_hz is None and not self.path.lower().endswith(".wav"):
            message = f"sample_rate_hz {_EVERYWHERE}"
            raise ValueError(message)
        return self

    @model_validator(mode="after")
    def _units_are_known(self) -> Self:
        names = [channel.name for channel in self.channels or ()]
        if len(set(names)) < len(names):
            message = f"two channels are called {next(name for name in names if names.count(name) > 1)}"
            raise ValueError(message)
        if self.unit is None and not all(channel.unit for channel in self.channels or (self,)):
            message = f"unit {_EVERYWHERE}"
            raise ValueError(message)
        for sensor in sensors(self, ""):
            problem = unit_problem(*sensor.scale)
            if problem is not None:
                message = f"channel {sensor.name}: {problem}" if sensor.name else problem
                raise ValueError(message)
        return self


def sensors(entry: Entry, name: str) -> Iterator[Sensor]:
    """Channels of a recording in their order, with the keys of the file where a channel has none; ``name`` is that of a single one."""
    own: Measurement
    for own in entry.channels or (entry,):
        unit = own.unit or entry.unit
        sensitivity = own.sensitivity
        if sensitivity is None and unit in VOLTAGES:
            sensitivity = entry.sensitivity
        column = entry.column if own.column is None else own.column
        place = Place(own.variable or entry.variable, column, entry.delimiter)
        yield Sensor(own.name if isinstance(own, Channel) else name, place, Scale(unit or "m/s2", sensitivity))


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
