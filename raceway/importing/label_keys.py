"""Keys that describe recordings: columns of a table of labels, or common to all of its rows."""

from typing import Annotated, Literal, NamedTuple, Self

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from gen.corpus.fault_classes import fault_class
from gen.physics.bearing import Bearing
from gen.physics.bearing_text import bearing_of_label
from gen.support.key_types import Keys, Millimetres, Name, Text
from raceway.importing.acceleration import WITHOUT_UNITS, Place
from raceway.importing.conversion import VOLTAGES, Scale, Unit, unit_problem, volts_per_acceleration
from raceway.importing.label_values import (
    Column,
    Count,
    Degrees,
    Delimiter,
    FaultClass,
    Hertz,
    Inside,
    Micrometres,
    Newtons,
    Rpm,
    Sensitivity,
)

_OF_SPALLS = ("width_mm", "depth_um", "angle_deg", "n_spalls")


class Sensor(NamedTuple):
    """A channel with all that is needed to read it."""

    name: str
    place: Place
    scale: Scale


class SensorKeys(Keys):
    """Keys that a file and each of its channels can have."""

    variable: Name | None = None
    column: Column | None = None
    unit: Unit | None = None
    sensitivity_mv_per_g: Sensitivity | None = None
    sensitivity_mv_per_m_s2: Sensitivity | None = None


class OneOfSeveral(SensorKeys):
    """One sensor of several; keys that it lacks are those of the file."""

    name: Name


def _names_differ(channels: tuple[OneOfSeveral, ...]) -> tuple[OneOfSeveral, ...]:
    names = [channel.name for channel in channels]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ValueError(f"two are called {twice}; give each a name of its own.")
    return channels


class Labels(SensorKeys):
    """All keys of one file of recordings."""

    path: Inside
    fault: FaultClass
    specimen: Name
    rig: Name = "1"
    recording: Name | None = None
    bearing: Annotated[Bearing, BeforeValidator(bearing_of_label)]
    shaft_rpm: Rpm
    load_n: Newtons | None = None
    width_mm: Millimetres | None = None
    depth_um: Micrometres | None = None
    angle_deg: Degrees | None = None
    n_spalls: Count | None = None
    sample_rate_hz: Hertz | None = None
    resample_hz: Hertz | None = None
    delimiter: Delimiter | None = None
    decimal: Literal[".", ","] | None = None
    channel: Name = "sensor"
    channels: (
        Annotated[tuple[OneOfSeveral, ...], Field(min_length=1, max_length=64), AfterValidator(_names_differ)] | None
    ) = None
    title: Text = "Own recordings"
    origin: Text = "Origin and licence are not stated."

    @property
    def name(self) -> str:
        """Name of the recording in messages: the file, and the variable and column that are chosen in it."""
        return ":".join(str(part) for part in (self.path, self.variable, self.column) if part is not None)

    @property
    def sensors(self) -> tuple[Sensor, ...]:
        """Channels in their order, with the keys of the file where a channel has none."""
        several = [(channel.name, channel) for channel in self.channels or ()]
        return tuple(self._sensor(name, keys) for name, keys in several or [(self.channel, self)])

    @property
    def channel_names(self) -> tuple[str, ...]:
        """Names of the channels."""
        return tuple(sensor.name for sensor in self.sensors)

    def _sensor(self, name: str, own: SensorKeys) -> Sensor:
        unit = own.unit or self.unit
        given = own if own.sensitivity_mv_per_g or own.sensitivity_mv_per_m_s2 or unit not in VOLTAGES else self
        sensitivity = volts_per_acceleration(given.sensitivity_mv_per_g, given.sensitivity_mv_per_m_s2)
        column = self.column if own.column is None else own.column
        return Sensor(
            name, Place(own.variable or self.variable, column, self.delimiter, self.decimal), Scale(unit, sensitivity)
        )

    @model_validator(mode="after")
    def _belong_together(self) -> Self:
        if self.sample_rate_hz is None and self.path.lower().endswith(".npy"):
            raise ValueError("sample_rate_hz: is missing; give it.")
        if (
            self.unit is None
            and self.path.lower().endswith(WITHOUT_UNITS)
            and not (self.channels and all(channel.unit for channel in self.channels))
        ):
            raise ValueError("unit: is missing; give it.")
        spall = next((key for key in _OF_SPALLS if getattr(self, key) is not None), None)
        if spall and fault_class(self.fault).n_spalls <= 0:
            raise ValueError(f"{spall}: describes a spall, and fault is {self.fault}; remove one of the two.")
        for keys in (self, *(self.channels or ())):
            if keys.sensitivity_mv_per_g is not None and keys.sensitivity_mv_per_m_s2 is not None:
                raise ValueError(
                    "sensitivity_mv_per_g and sensitivity_mv_per_m_s2 are both given; remove one of the two."
                )
        for sensor in self.sensors:
            problem = unit_problem(*sensor.scale)
            if problem is not None:
                raise ValueError(f"{f'sensor {sensor.name}: ' if self.channels else ''}{problem}.")
        return self
