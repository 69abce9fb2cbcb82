"""Measurement of a record: channels, levels and the converter."""

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field, StrictInt

from gen.drawing import Distribution, Draws, Name, Number, Section, Weight, weighted_index, within
from gen.mechanisms.path import PathSection

MAX_OVERSAMPLING = 96

Body = Literal["shaft", "housing", "sensor"]


def _certain(value: Any) -> Any:
    return {value: 1.0} if isinstance(value, str) else value


def _possible(weights: dict[Any, float]) -> dict[Any, float]:
    if sum(weights.values()) <= 0:
        raise ValueError("no body has a weight above 0; give one, such as body: sensor.")
    return weights


Bodies = Annotated[
    dict[Body, Weight],
    BeforeValidator(_certain, json_schema_input_type=Body | dict[Body, Weight]),
    AfterValidator(_possible),
]


class Converter(Section):
    """A 16-bit analogue-to-digital converter."""

    kind: Literal["adc"]
    """Stores the signal as 16-bit counts."""
    full_scale_m_s2: Annotated[Number, Field(ge=1e-6, le=1e6)] = 500.0
    """Largest acceleration that the converter measures; samples beyond it are clipped, and counted per record."""


class FloatConverter(Section):
    """No converter: 32-bit floating point."""

    kind: Literal["float32"]
    """Stores the signal in floating point, without rounding to counts and without clipping."""


class Channel(Section):
    """A sensor: the acceleration of a body along one direction."""

    name: Name
    """Name of the channel in the corpus."""
    body: Bodies = Field(default={"sensor": 1.0})
    """Body that carries the sensor; `sensor` is the mass of `machine.resonator`. With weights, it is drawn per rig."""
    angle_deg: Distribution = within(-360, 360, default=90.0)
    """Direction that is measured, counter-clockwise from the horizontal; 90 is up."""
    path: PathSection | None = None
    """Transfer path of this channel alone, as for a sensor at the fan end; the common `path` if left out."""

    def draw(self, of: Draws) -> Any:
        """The sensor on one of its bodies."""
        place = weighted_index(tuple(self.body.values()), of.u("body"))
        return super().draw(of).model_copy(update={"body": {[*self.body][place]: 1.0}})

    @property
    def drawn_body(self) -> Body:
        """Body that carries the drawn sensor."""
        return next(body for body, weight in self.body.items() if weight)


class RecordingSection(Section):
    """Sample rate, length and channels of every record."""

    drawn_per = "rig"

    sample_rate_hz: Annotated[Number, Field(ge=1000, le=200_000)]
    """Sample rate of all channels; the signal is flat up to 0.8 of half this rate."""
    duration_s: Annotated[Number, Field(gt=0, le=600)]
    """Length of a record."""
    settle_s: Annotated[Number, Field(ge=0.05, le=10)] = 0.2
    """Time simulated before the record starts and dropped, so that transients decay."""
    oversampling: Annotated[StrictInt, Field(ge=1, le=MAX_OVERSAMPLING)] | None = None
    """Integration steps per sample; if left out, as many as the stiffest mode of the record needs."""
    channels: Annotated[tuple[Channel, ...], Field(min_length=1, max_length=6)] = (Channel(name="sensor"),)
    """Sensors that are recorded at the same time."""
    high_pass_hz: Distribution = within(0, 100, default=0.0)
    """Frequency at which the sensors have lost 3 dB on the way down to 0 Hz, drawn per rig: 0.3 to 5 for piezoelectric ones, 0 for none."""
    offset_m_s2: Distribution = within(-1e4, 1e4, default=0.0)
    """Constant that amplifier and converter add to the signal of all channels, drawn per rig."""
    converter: Annotated[Converter | FloatConverter, Field(discriminator="kind")] = Converter(kind="adc")
    """Conversion of the signal to stored numbers."""

    @property
    def full_scale(self) -> float | None:
        """Largest acceleration of the converter [m s-2]; None without one."""
        return None if self.converter.kind == "float32" else self.converter.full_scale_m_s2


class PhysicalLevel(Section):
    """The simulated acceleration times a gain, plus a background of drawn rms; drawn per rig."""

    drawn_per = "rig"

    kind: Literal["physical"]
    """Keeps the level of the simulation, so that a larger fault gives a larger signal."""
    gain: Distribution = within(0, 1e12, open_low=True, default=1.0)
    """Factor on bearing signal and background, such as the sensitivity of a sensor."""
    background_m_s2: Distribution = within(0, 1e12, default=1.0)
    """Rms of the background noise before the gain; lines and impulses are added at their levels relative to it."""


class SnrLevel(Section):
    """A drawn signal-to-noise ratio and a drawn rms of the whole record, so that the level does not give the class away."""

    drawn_per = "record"

    kind: Literal["snr"]
    """Scales bearing signal and background per record."""
    faulty_db: Distribution = within(-60, 60)
    """Rms of what the fault adds over that of all else, background and bearing without the fault; for records with a fault. With
    `truth.twins: false` it is that of the whole bearing signal over the background."""
    healthy_db: Distribution = within(-60, 60, per="rig")
    """Rms of the bearing signal over that of the background, for healthy records; one ratio for all of a rig. Healthy balls pass the load
    at BPFO too: from about -5 dB on that line stands out, with `waviness_nm: 20` from about 5 dB on."""
    rms_m_s2: Distribution = within(0, 1000, open_low=True, default=5.0)
    """Rms of the whole record, bearing signal and background together."""
