"""Keys that describe recordings: columns of a table of labels, or common to all of its rows."""

import math
import re
import unicodedata
from pathlib import Path, PureWindowsPath
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from gen.corpus import FAULTS, UNKNOWN
from gen.corpus.fault_classes import fault_class
from gen.physics.bearing import Bearing
from gen.physics.bearing_text import bearing_of_label
from gen.support.key_types import Keys, Millimetres, Name, Text, as_text, on_one_line
from raceway.importing.acceleration import WITHOUT_UNITS, Sensor
from raceway.importing.conversion import VOLTAGES, Scale, Unit, unit_problem, volts_per_acceleration
from raceway.importing.speed_course import FASTEST, SLOWEST

if TYPE_CHECKING:
    FaultClass = str
else:
    FaultClass = Literal[(*FAULTS, UNKNOWN)]
_OF_SPALLS = ("width_mm", "depth_um", "angle_deg", "n_spalls")
_MOST_COLUMNS = 1_000_000
_SPEED_TOLERANCE = 0.05  # of the nominal speed


def _inside(text: str) -> str:
    path = Path(on_one_line(text).replace("\\", "/"))  # Windows has backslashes
    if path.is_absolute() or PureWindowsPath(text).drive or ".." in path.parts:
        raise ValueError(f"{text} leads out of the folder of the recordings; put the table into a folder above them.")
    return path.as_posix()


def _column(column: Any) -> Any:
    if isinstance(column, str) and not re.fullmatch(r"\d{7,}", column):
        return on_one_line(column)
    if type(column) is int and 0 <= column < _MOST_COLUMNS:
        return column
    raise ValueError(f"is not a column; give its number, 0 to {_MOST_COLUMNS - 1}, or its name in the header.")


def _separates(mark: str) -> str:
    if mark in '\r\n#"' or mark.isalnum() or mark in "+-." or unicodedata.category(mark) == "Cs":
        raise ValueError(f"{mark!r} cannot separate columns; give one character such as a comma, a semicolon or a tab.")
    return mark


Column = Annotated[int | str, BeforeValidator(_column)]
Rpm = Annotated[float, Field(ge=SLOWEST, le=FASTEST)]
Hertz = Annotated[float, Field(ge=1, le=1e8)]
Seconds = Annotated[float, Field(ge=0, le=1e12)]
Sensitivity = Annotated[float, Field(ge=1e-6, le=1e6)]


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

    path: Annotated[str, Field(min_length=1, max_length=1000), BeforeValidator(as_text), AfterValidator(_inside)]
    fault: FaultClass
    specimen: Name
    rig: Name = "0"
    recording: Name | None = None
    bearing: Annotated[Bearing, BeforeValidator(bearing_of_label)]
    shaft_rpm: Rpm | None = None
    nominal_rpm: Rpm | None = None
    speed_column: Column | None = None
    speed_unit: Name | None = None
    load_n: Annotated[float, Field(ge=0, le=1e9)] | None = None
    motor_load_w: Annotated[float, Field(ge=0, le=1e9)] | None = None
    width_mm: Millimetres | None = None
    depth_um: Annotated[float, Field(gt=0, le=10_000_000)] | None = None
    angle_deg: Annotated[float, Field(ge=-360, le=360)] | None = None
    n_spalls: Annotated[int, Field(ge=1, le=1000)] | None = None
    age_s: Seconds | None = None
    rul_s: Seconds | None = None
    event: Literal["censored", "failed"] | None = None
    sample_rate_hz: Hertz | None = None
    long_rate_hz: Hertz | None = None
    long_samples: int = 0
    resample_hz: Hertz | None = None
    delimiter: Annotated[str, Field(min_length=1, max_length=1), AfterValidator(_separates)] | None = None
    decimal: Literal[".", ","] | None = None
    channel: Name = "sensor"
    channels: (
        Annotated[tuple[OneOfSeveral, ...], Field(min_length=1, max_length=64), AfterValidator(_names_differ)] | None
    ) = None
    note: Text | None = None
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

    def speed(self, stated: float | None) -> tuple[float, list[str]]:
        """Speed [rpm] of a file that states one or none, and a sentence without its end if the nominal one is used."""
        if self.speed_column is not None:
            return stated or math.nan, []
        if self.shaft_rpm is not None or self.nominal_rpm is None:
            return self.shaft_rpm or math.nan, []
        if stated is not None and abs(stated / self.nominal_rpm - 1) <= _SPEED_TOLERANCE:
            return stated, []
        told = "no speed" if stated is None else f"{stated:g} rpm"
        return self.nominal_rpm, [f"states {told}: the nominal {self.nominal_rpm:g} rpm are used"]

    def _sensor(self, name: str, own: SensorKeys) -> Sensor:
        unit = own.unit or self.unit
        keys = own if own.sensitivity_mv_per_g or own.sensitivity_mv_per_m_s2 or unit not in VOLTAGES else self
        sensitivity = volts_per_acceleration(keys.sensitivity_mv_per_g, keys.sensitivity_mv_per_m_s2)
        column = self.column if own.column is None else own.column
        variable = own.variable or self.variable
        place = name, variable, column, self.delimiter, self.decimal
        course, long = (self.speed_column, self.speed_unit), (self.long_rate_hz, self.long_samples)
        return Sensor(*place, Scale(unit, sensitivity), self.sample_rate_hz, *course, *long)

    @model_validator(mode="after")
    def _belong_together(self) -> Self:
        speed = self.shaft_rpm or self.nominal_rpm
        if speed is None and self.speed_column is None:
            raise ValueError("shaft_rpm: is missing; give it.")
        if self.speed_column is not None and (speed or self.recording):
            raise ValueError(
                "speed_column: tells the speed of one file; leave shaft_rpm, nominal_rpm and recording out."
            )
        if self.sample_rate_hz is None and self.path.lower().endswith(".npy"):
            raise ValueError("sample_rate_hz: is missing; give it.")
        if (
            self.unit is None
            and self.path.lower().endswith(WITHOUT_UNITS)
            and not (self.channels and all(channel.unit for channel in self.channels))
        ):
            raise ValueError("unit: is missing; give it.")
        if self.age_s is None and (self.event or self.rul_s is not None):
            raise ValueError("age_s: is missing, which event and rul_s go with; give it.")
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
