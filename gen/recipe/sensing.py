"""Measurement of a record: channels, transfer paths, background of the machine, levels and the converter."""

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field, StrictInt

from gen.drawing.distributions import Distribution, Number, within
from gen.drawing.section import Name, Probability, Section, Weight
from gen.recipe.gear import GearMesh

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

    kind: Literal["adc"] = "adc"
    """Stores the signal as 16-bit counts."""
    full_scale_m_s2: Annotated[Number, Field(ge=1e-6, le=1e6)] = 500.0
    """Largest acceleration that the converter measures; samples beyond it are clipped, and counted per record."""


class FloatConverter(Section):
    """No converter: 32-bit floating point."""

    kind: Literal["float32"]
    """Stores the signal in floating point, without rounding to counts and without clipping."""


class Modes(Section):
    """Resonances, drawn per rig."""

    count: Distribution = within(0, 16)
    """Number of resonances, rounded to a whole number."""
    frequency_hz: Distribution = within(10, 50_000)
    """Natural frequency of a resonance, drawn for each."""
    damping_percent: Distribution = within(0.05, 50)
    """Damping ratio of a resonance, drawn for each."""
    gain_db: Distribution = within(-80, 80, default=0.0)
    """Gain of a resonance relative to a direct part of 1; its sign is random."""


class Modulation(Section):
    """Amplitude modulation at one and two times the shaft rate: sidebands around every line."""

    probability: Probability
    """Share of the rigs that have the modulation."""
    first: Distribution = within(0, 1)
    """Depth of the modulation at 1x shaft rate, relative to the mean amplitude."""
    second: Distribution = within(0, 1)
    """Depth of the modulation at 2x shaft rate, relative to the mean amplitude."""


class PathSection(Section):
    """Linear transfer path from bearing to sensor, drawn per rig: a direct part and base-excited resonances."""

    direct: Distribution = within(0, 10, default=1.0)
    """Gain of the direct part, the same at all frequencies."""
    modes: Modes | None = None
    """Resonances of the path; none if left out."""
    modulation: Modulation | None = None
    """Modulation of the signal that the path transmits; none if left out."""

    def silent(self) -> bool:
        """Whether a drawn path may transmit nothing."""
        return self.direct.support()[1] == 0 and (self.modes is None or self.modes.count.support()[0] < 1)


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


class RecordingSection(Section):
    """Sample rate, length and channels of every record."""

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
    converter: Annotated[Converter | FloatConverter, Field(discriminator="kind")] = Converter()
    """Conversion of the signal to stored numbers."""


class Harmonics(Section):
    """Lines at multiples of the shaft rate."""

    probability: Probability
    """Share of the rigs that have these lines."""
    count: Distribution = within(1, 64)
    """Number of lines, at 1x, 2x, ... shaft rate; rounded to a whole number."""
    level_db: Distribution = within(-80, 40)
    """Rms of a line relative to that of the background noise, drawn for each; the mean over all directions and channels."""
    growth: Distribution = within(0, 4, default=0.0)
    """Power of the speed with which the lines grow along `operation.speed_profile`; 2 is that of an unbalance."""


class Tones(Section):
    """Lines at fixed frequencies, such as those of other machines."""

    probability: Probability
    """Share of the rigs that have these lines."""
    count: Distribution = within(1, 64)
    """Number of lines, rounded to a whole number."""
    frequency_hz: Distribution = within(1, 100_000)
    """Frequency of a line, drawn for each; above half the sample rate it aliases."""
    level_db: Distribution = within(-80, 40)
    """Rms of a line relative to that of the background noise, drawn for each."""
    modulation: Distribution = within(0, 1, default=0.0)
    """Depth of the amplitude modulation of a line at 1x shaft rate, drawn for each."""


class Impulses(Section):
    """Impulses at random times, which no fault causes and which excite the path."""

    probability: Probability
    """Share of the rigs that have these impulses."""
    rate_hz: Distribution = within(0.1, 1000)
    """Mean number of impulses per second."""
    level_db: Distribution = within(-80, 60)
    """Rms of their peaks behind the path, relative to the rms of the background noise."""


class Knocks(Section):
    """Impulses locked to the shaft, which no bearing fault causes and which excite the path."""

    probability: Probability
    """Share of the rigs that have these impulses."""
    orders: Distribution = within(0.1, 20)
    """Number of impulses per turn of the shaft."""
    level_db: Distribution = within(-80, 60)
    """Mean of their peaks behind the path, relative to the rms of the background noise."""


class BackgroundSection(Section):
    """Vibration of the machine without the bearing: drawn per rig, the same for healthy and faulty records."""

    slope: Distribution = within(-2, 4, default=0.0)
    """Exponent of the noise: its power spectral density falls with frequency to this power above 10 Hz; 0 is white."""
    floor_db: Distribution = within(-120, 20, default=-40.0)
    """Rms of a white floor, relative to that of the noise with slope and resonances."""
    modes: Modes | None = None
    """Resonances that shape the noise; none if left out."""
    modulation: Modulation | None = None
    """Modulation of the noise by the shaft; none if left out."""
    harmonics: Harmonics | None = None
    """Lines at multiples of the shaft rate; none if left out."""
    tones: Tones | None = None
    """Lines at fixed frequencies; none if left out."""
    impulses: Impulses | None = None
    """Impulses at random times; none if left out."""
    knocks: Knocks | None = None
    """Impulses locked to the shaft; none if left out."""
    coherence: Distribution = within(0, 1, default=0.0)
    """Magnitude-squared coherence of the noise between two channels: 0 for independent noise, 1 for the same."""
    gear_mesh: GearMesh | None = None
    """Lines of a gear on the shaft; none if left out."""


class PhysicalLevel(Section):
    """The simulated acceleration times a gain, plus a background of drawn rms; drawn per rig."""

    kind: Literal["physical"] = "physical"
    """Keeps the level of the simulation, so that a larger fault gives a larger signal."""
    gain: Distribution = within(0, 1000, open_low=True, default=1.0)
    """Factor on bearing signal and background, such as the sensitivity of a sensor."""
    background_m_s2: Distribution = within(0, 1000, default=1.0)
    """Rms of the background noise before the gain; lines and impulses are added at their levels relative to it."""


class SnrLevel(Section):
    """A drawn signal-to-noise ratio and a drawn rms of the whole record, so that the level does not give the class away."""

    kind: Literal["snr"]
    """Scales bearing signal and background per record."""
    faulty_db: Distribution = within(-60, 60)
    """Rms of what the fault adds over that of all else, background and bearing without the fault; for records with a fault. With
    `truth.twins: false` it is that of the whole bearing signal over the background."""
    healthy_db: Distribution = within(-60, 60)
    """Rms of the bearing signal over that of the background, for healthy records; one ratio for all of a rig."""
    rms_m_s2: Distribution = within(0, 1000, open_low=True, default=5.0)
    """Rms of the whole record, bearing signal and background together."""
