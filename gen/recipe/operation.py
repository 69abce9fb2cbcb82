"""How the machine runs: speed and load with their profiles over a record, slip, jitter, temperature."""

from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from gen.recipe.distributions import Distribution, Number, within
from gen.recipe.section import Section

Share = Annotated[Number, Field(gt=0, le=1000)]


class Ramp(Section):
    """From one share to another, evenly over the record."""

    kind: Literal["ramp"]
    from_percent: Distribution = within(0.1, 1000)
    to_percent: Distribution = within(0.1, 1000)


class RunUp(Section):
    """From one share to another between two times, starting and ending without a jerk (a polynomial of degree five)."""

    kind: Literal["run_up"]
    from_percent: Distribution = within(0.1, 1000)
    to_percent: Distribution = within(0.1, 1000)
    start_s: Distribution = within(0, 600, default=0.0)
    lasting_s: Distribution = within(0, 600, open_low=True)


class Steps(Section):
    """Levels one after the other, each as long as the others, with smooth steps between them."""

    kind: Literal["steps"]
    levels_percent: Annotated[tuple[Share, ...], Field(min_length=2, max_length=100)]
    step_s: Annotated[Number, Field(gt=0, le=60)] = 0.1


class Table(Section):
    """A measured profile: shares at times, straight between them, constant before the first and after the last."""

    kind: Literal["table"]
    times_s: Annotated[tuple[Number, ...], Field(min_length=1, max_length=10_000)]
    percent: Annotated[tuple[Share, ...], Field(min_length=1, max_length=10_000)]

    @model_validator(mode="after")
    def _in_pairs(self) -> Self:
        if len(self.times_s) != len(self.percent):
            raise ValueError(f"{len(self.times_s)} times_s for {len(self.percent)} percent; give one each.")
        if any(after <= before for before, after in pairwise(self.times_s)):
            raise ValueError("times_s do not rise; sort them, each once.")
        return self


Profile = Annotated[Ramp | RunUp | Steps | Table, Field(discriminator="kind")]


class Operation(Section):
    """How the machine runs, drawn per record; profiles are shares of ``shaft_rpm`` and ``load_n`` over the record."""

    shaft_rpm: Distribution = within(1, 100_000)
    label_error_percent: Distribution = within(-50, 50, default=0.0)
    load_n: Distribution = within(1, 1e7, default=300.0)
    speed_wander_percent: Distribution = within(0, 10, default=0.1)
    mean_slip_percent: Distribution = within(-10, 20, default=0.0)
    slip_percent: Distribution = within(0, 10, default=1.0)
    jitter_deg: Distribution = within(0, 5, default=0.3)
    spin_wander_percent: Distribution = within(0, 20, default=0.0)
    """How unevenly the balls spin, rms."""
    axial_load_n: Distribution = within(0, 1e7, default=0.0)
    """Pulls the balls up their grooves; needs a contact angle."""
    load_wander_percent: Distribution = within(0, 50, default=0.0)
    """Slow fluctuation of the load, rms."""
    temperature_celsius: Distribution = within(-40, 200, default=40.0)
    """Of the oil in the contacts."""
    inner_ring_hotter_k: Distribution = within(-50, 100, default=0.0)
    """Inner ring over outer ring: takes up clearance."""
    speed_profile: Profile | None = None
    load_profile: Profile | None = None
