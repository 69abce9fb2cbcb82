"""Operating conditions of a record: speed and load with their profiles, slip, jitter and temperature."""

import math
from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from gen.drawing import Distribution, Number, Section, within
from gen.physics.profile import Profile
from gen.support.units import percent_to_share

Share = Annotated[Number, Field(gt=0, le=1000)]
CLOSEST_TIMES_S = 1e-6  # between two points of a profile; its slope stays a finite number


class Ramp(Section):
    """A linear change over the whole record."""

    kind: Literal["ramp"]
    """Changes linearly from the first to the last sample of the record."""
    from_percent: Distribution = within(0.1, 1000)
    """Share of the drawn speed or load at the start of the record."""
    to_percent: Distribution = within(0.1, 1000)
    """Share of the drawn speed or load at the end of the record."""

    def course(self, duration: float) -> Profile:
        """The drawn change over a record of a ``duration`` in s."""
        drawn = self.si()
        return Profile((0.0, duration), (drawn["from"], drawn["to"]))


class RunUp(Section):
    """A smooth change between two times, by a polynomial of degree five."""

    kind: Literal["run_up"]
    """Changes by a polynomial of degree five, whose first and second derivatives are 0 at both ends."""
    from_percent: Distribution = within(0.1, 1000)
    """Share of the drawn speed or load before the change."""
    to_percent: Distribution = within(0.1, 1000)
    """Share of the drawn speed or load after the change."""
    start_s: Distribution = within(0, 600, default=0.0)
    """Time from the start of the record to the start of the change."""
    lasting_s: Distribution = within(0, 600, open_low=True)
    """Duration of the change."""

    def course(self, duration: float) -> Profile:
        """The drawn change, whatever the length of the record."""
        drawn = self.si()
        times = drawn["start"], drawn["start"] + drawn["lasting"]
        return Profile(times, (drawn["from"], drawn["to"]), smooth=True)


class Steps(Section):
    """Levels of equal duration with smooth transitions between them."""

    kind: Literal["steps"]
    """Divides the record into levels of equal duration."""
    levels_percent: Annotated[tuple[Share, ...], Field(min_length=2, max_length=100)]
    """Shares of the drawn speed or load, in the order of time."""
    step_s: Annotated[Number, Field(gt=0, le=60)] = 0.1
    """Duration of each transition; at most that of one level."""

    def course(self, duration: float) -> Profile:
        """The levels over a record of a ``duration`` in s."""
        levels = tuple(map(percent_to_share, self.levels_percent))
        changes = [duration * change / len(levels) for change in range(1, len(levels))]
        times = tuple(time + side * self.step_s / 2 for time in changes for side in (-1, 1))
        return Profile(times, tuple(level for pair in pairwise(levels) for level in pair), smooth=True)


class Table(Section):
    """A measured profile: linear between its points, constant before the first and after the last."""

    kind: Literal["table"]
    """Follows points that were measured on a machine."""
    times_s: Annotated[tuple[Number, ...], Field(min_length=1, max_length=10_000)]
    """Times of the points, from the start of the record, in rising order and at least a microsecond apart."""
    percent: Annotated[tuple[Share, ...], Field(min_length=1, max_length=10_000)]
    """Share of the drawn speed or load at each point."""

    def course(self, duration: float) -> Profile:
        """The points, whatever the length of the record."""
        return Profile(self.times_s, tuple(map(percent_to_share, self.percent)))

    @model_validator(mode="after")
    def _in_pairs(self) -> Self:
        if len(self.times_s) != len(self.percent):
            raise ValueError(f"{len(self.times_s)} times_s for {len(self.percent)} percent; give one each.")
        if any(after <= before for before, after in pairwise(self.times_s)):
            raise ValueError("times_s do not rise; sort them, each once.")
        closest = min((after - before for before, after in pairwise(self.times_s)), default=math.inf)
        if closest < CLOSEST_TIMES_S:
            raise ValueError(f"times_s: two are {closest:.3g} s apart; keep them at least {CLOSEST_TIMES_S:g} s apart.")
        return self


ProfileSection = Annotated[Ramp | RunUp | Steps | Table, Field(discriminator="kind")]


class SlipWalk(Section):
    """Slip of the cage that makes successive distances between balls independent."""

    spacing_percent: Distribution = within(0, 5, default=0.3)
    """Standard deviation of the distance from one impact on the outer race to the next, in percent of its mean."""


class OperationSection(Section):
    """Operating conditions, drawn per record."""

    drawn_per = "record"

    shaft_rpm: Distribution = within(1, 100_000)
    """True speed of the shaft at 100 % of the speed profile; the label differs from it by `label_error_percent`."""
    label_error_percent: Distribution = within(-50, 50, default=0.0)
    """Error of the labelled shaft rate; positive where the label is above the true mean."""
    load_n: Distribution = within(1, 1e7, default=300.0)
    """Constant radial load on the shaft in the direction of `machine.load_angle_deg`; it sets the load zone and the ball loads."""
    speed_wander_percent: Distribution = within(0, 10, default=0.1)
    """Rms of the slow random variation of the shaft speed (0.3 to 3 Hz), in percent of the speed; it smears lines."""
    mean_slip_percent: Distribution = within(-10, 20, default=0.0)
    """Mean slip of the cage: the balls go round this much slower than pure rolling gives, so FTF and BPFO fall and BPFI rises."""
    slip_percent: Distribution = within(0, 10, default=1.0)
    """Rms of the random variation of the slip (0.2 to 2 shaft rates); it smears the lines of race faults."""
    slip_walk: SlipWalk | None = None
    """Slip without memory: the phase of the lines of race faults walks at random; none if left out."""
    jitter_deg: Distribution = within(0, 5, default=0.3)
    """Rms of the random position of each ball in its cage pocket (0.3 to 3 cage rates), as an angle around the bearing."""
    spin_wander_percent: Distribution = within(0, 20, default=0.0)
    """Rms of the random variation of the ball spin rate (0.05 to 0.6 shaft rates); it smears the lines of ball faults."""
    axial_load_n: Distribution = within(0, 1e7, default=0.0)
    """Axial load: it reduces the operating clearance, so that more balls carry load. It needs a contact angle above 0."""
    load_wander_percent: Distribution = within(0, 50, default=0.0)
    """Rms of the slow random variation of the load (0.05 to 1 shaft rate), in percent of the load."""
    temperature_celsius: Distribution = within(-40, 200, default=40.0)
    """Temperature of the oil in the contacts; it sets the viscosity and so the film. It needs `contact.lubricant`."""
    inner_ring_hotter_k: Distribution = within(-50, 100, default=0.0)
    """Temperature of the inner ring above that of the outer ring; thermal expansion reduces the operating clearance."""
    speed_profile: ProfileSection | None = None
    """Course of the shaft speed over the record, in percent of `shaft_rpm`; constant if left out."""
    load_profile: ProfileSection | None = None
    """Course of the radial load over the record, in percent of `load_n`, with the keys of `speed_profile`; constant if left out."""
