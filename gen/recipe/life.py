"""Life of the bearings of a recipe: when a spall begins, how it grows, when it is looked at, and when the test ends."""

from typing import Annotated

from pydantic import Field, StrictBool

from gen.drawing import Distribution, Number, Section, within

Above0 = Annotated[Number, Field(gt=0)]


class LifeEnd(Section):
    """End of the test of a bearing: the first of these limits that is reached is its failure."""

    length_mm: Annotated[Number, Field(gt=0, le=60)] = 6.0
    """Length of the spall; or the greatest length that its race or ball can have, if that is less."""
    peak_m_s2: Above0 | None = None
    """Largest acceleration of a snapshot, in any channel; no limit if left out."""
    velocity_mm_s: Above0 | None = None
    """Rms velocity of a snapshot between 10 and 1000 Hz, in any channel, as in ISO 20816-1; no limit if left out."""


class LifeSection(Section):
    """Life of each specimen, from its first turn to its failure; its records are snapshots of it, one after the other."""

    drawn_per = "specimen"

    cadence_h: Above0
    """Time from one snapshot to the next."""
    damaged_cadence_h: Above0 | None = None
    """The same behind the first snapshot with a spall longer than `damaged_from_mm`; `cadence_h` if left out."""
    damaged_from_mm: Annotated[Number, Field(ge=0)] = 0.5
    """Length of a spall at which the snapshots become denser."""
    entry_h: Distribution = within(0, 1e6, default=0.0)
    """Age at the first snapshot; bearings that failed before are not in the corpus."""
    withdrawal_h: Distribution = within(0, 1e7, open_low=True, default=1e7)
    """Age at which a bearing is taken out although it works: the same for all, or of each its own."""
    end: LifeEnd = LifeEnd()
    """Failure of a bearing."""
    accelerated: StrictBool = False
    """Allows loads beyond the dynamic rating, as in overload tests; ISO 281 says nothing about lives there."""
    a_iso: Distribution = within(1e-3, 50, default=1.0)
    """Life modification factor of ISO 281: lubrication, contamination and material."""
    first_length_scatter: Distribution = within(0, 2, default=0.3)
    """Standard deviation of the logarithm of the first length of a spall, about the `width_mm` of its fault."""
    full_depth_mm: Distribution = within(0, 60, default=2.0)
    """Length at which a spall has the `depth_um` of its fault. A shorter one is as much shallower, over the width of the contact: a young
    spall is narrower than the contact is."""
    growth_mm_per_mrev: Distribution = within(0, 1e5, open_low=True, default=2.0)
    """Growth of a spall of 1 mm in a million turns at a load of the dynamic rating."""
    growth_exponent: Distribution = within(0, 3, default=1.0)
    """Exponent of the length in the growth; 1 grows exponentially, more ever faster."""
    load_exponent: Distribution = within(0, 10, default=3.0)
    """How steeply the growth rises with the load: the exponent of load over dynamic rating."""
    critical_mm: Distribution = within(0, 60, open_low=True, default=2.0)
    """Length beyond which a spall grows faster."""
    acceleration: Distribution = within(1, 1000, default=4.0)
    """Factor of the growth beyond `critical_mm`."""
    growth_noise: Distribution = within(0, 3, default=0.3)
    """Standard deviation of the logarithm of the growth, which varies slowly."""
    history_h: Distribution = within(0, 1e6, open_low=True, default=100.0)
    """Correlation time of load, speed, temperature, growth, noise and knocks."""
    load_history_percent: Distribution = within(0, 50, default=0.0)
    """Slow variation of the load over the life: standard deviation of its logarithm."""
    speed_history_percent: Distribution = within(0, 20, default=0.0)
    """Slow variation of the speed over the life: standard deviation of its logarithm."""
    temperature_history_k: Distribution = within(0, 50, default=0.0)
    """Slow variation of the temperature of the oil over the life: standard deviation."""
    background_history_db: Distribution = within(0, 20, default=0.0)
    """Slow variation of the noise of the machine over the life: standard deviation of its level."""
    louder_when_new_db: Distribution = within(0, 20, default=0.0)
    """How much louder the noise is at the age 0 than later; it falls with `running_in_h`."""
    running_in_h: Distribution = within(0, 1e6, open_low=True, default=24.0)
    """Time in which a new machine loses two thirds of `louder_when_new_db`."""
    knocks_share: Distribution = within(0, 1, default=1.0)
    """Share of the life in which `knocks` and `impulses` of the background are there; they come and go with `history_h`."""
    clearance_um_per_mrev: Distribution = within(0, 1, default=0.0)
    """Wear of the races in a million turns at a load of the dynamic rating, as clearance; it is proportional to load and way."""
    waviness_nm_per_mrev: Distribution = within(0, 100, default=0.0)
    """Wear of the races likewise, as rms waviness."""
