"""What is recorded: sensors, the way to them, the machine's own noise, levels and the converter."""

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field, StrictInt

from gen.recipe.distributions import Distribution, Number, within
from gen.recipe.section import Name, Section, Weight

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
    full_scale_m_s2: Annotated[Number, Field(gt=0, le=1e6)] = 500.0


class FloatConverter(Section):
    """No converter: 32-bit floating point."""

    kind: Literal["float32"]


class Modes(Section):
    """Resonances: how many, where, how damped, and how strong beside the direct part."""

    count: Distribution = within(0, 16)
    frequency_hz: Distribution = within(10, 50_000)
    damping_percent: Distribution = within(0.05, 50)
    gain_db: Distribution = within(-80, 80, default=0.0)


class Modulation(Section):
    """Amplitude modulation at one and two times the shaft rate, in a share of the rigs."""

    probability: Annotated[Number, Field(ge=0, le=1)]
    first: Distribution = within(0, 1)
    second: Distribution = within(0, 1)


class Path(Section):
    """Linear path from bearing to sensor, drawn per rig: a direct part and base-excited resonances with random signs."""

    direct: Distribution = within(0, 10, default=1.0)
    modes: Modes | None = None
    modulation: Modulation | None = None

    def silent(self) -> bool:
        """Whether it may let nothing through."""
        return self.direct.support()[1] == 0 and (self.modes is None or self.modes.count.support()[0] < 1)


class Channel(Section):
    """What a channel measures: the acceleration of a body along a direction.

    ``body`` is a body, or the weight of each where it is drawn per rig. ``sensor`` is the mass on the sensor resonance. A channel
    with a ``path`` of its own stands elsewhere on the machine, such as at its fan end.
    """

    name: Name
    body: Bodies = Field(default={"sensor": 1.0})
    angle_deg: Distribution = within(-360, 360, default=90.0)
    path: Path | None = None


class Recording(Section):
    """Sample rate, length and channels of every record."""

    sample_rate_hz: Annotated[Number, Field(ge=1000, le=200_000)]
    duration_s: Annotated[Number, Field(gt=0, le=600)]
    settle_s: Annotated[Number, Field(ge=0.05, le=10)] = 0.2
    """Simulated before the record starts, and dropped."""
    oversampling: Annotated[StrictInt, Field(ge=1, le=MAX_OVERSAMPLING)] | None = None
    """Steps per sample; by default as many as the stiffest mode of the record needs."""
    channels: Annotated[tuple[Channel, ...], Field(min_length=1, max_length=6)] = (Channel(name="sensor"),)
    converter: Annotated[Converter | FloatConverter, Field(discriminator="kind")] = Converter()


class Harmonics(Section):
    """Lines at multiples of the shaft rate, in a share of the rigs; levels are relative to the noise."""

    probability: Annotated[Number, Field(ge=0, le=1)]
    count: Distribution = within(1, 64)
    level_db: Distribution = within(-80, 40)


class Tones(Section):
    """Lines at fixed frequencies, in a share of the rigs; levels are relative to the noise."""

    probability: Annotated[Number, Field(ge=0, le=1)]
    count: Distribution = within(1, 64)
    frequency_hz: Distribution = within(1, 100_000)
    level_db: Distribution = within(-80, 40)
    modulation: Distribution = within(0, 1, default=0.0)


class Impulses(Section):
    """Ringing impulses that no fault causes, at random times; levels are peaks relative to the noise."""

    probability: Annotated[Number, Field(ge=0, le=1)]
    rate_hz: Distribution = within(0.1, 1000)
    level_db: Distribution = within(-80, 60)


class Knocks(Section):
    """Ringing impulses locked to the shaft; levels are peaks relative to the noise."""

    probability: Annotated[Number, Field(ge=0, le=1)]
    orders: Distribution = within(0.1, 20)
    level_db: Distribution = within(-80, 60)


class Background(Section):
    """What the machine sounds like without the bearing: drawn per rig, on healthy and faulty records alike."""

    slope: Distribution = within(-2, 4, default=0.0)
    floor_db: Distribution = within(-120, 20, default=-40.0)
    modes: Modes | None = None
    modulation: Modulation | None = None
    harmonics: Harmonics | None = None
    tones: Tones | None = None
    impulses: Impulses | None = None
    knocks: Knocks | None = None


class PhysicalLevel(Section):
    """The bearing as it was simulated, times a gain drawn per rig, over a background of drawn rms."""

    kind: Literal["physical"] = "physical"
    gain: Distribution = within(0, 1000, open_low=True, default=1.0)
    background_m_s2: Distribution = within(0, 1000, default=0.3)


class SnrLevel(Section):
    """Bearing over background by a drawn ratio, and the whole record at a drawn rms, so that no level gives the class away."""

    kind: Literal["snr"]
    faulty_db: Distribution = within(-60, 60)
    healthy_db: Distribution = within(-60, 60)
    rms_m_s2: Distribution = within(0, 1000, open_low=True, default=5.0)
