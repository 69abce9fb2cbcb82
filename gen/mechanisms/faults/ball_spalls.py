"""Spalls on a ball."""

from typing import Literal

from gen.drawing import Distribution, Drawn, Draws, Known, Section, within
from gen.mechanisms.faults.race_spalls import Spalls


class AxisJumps(Section):
    """Jumps of the spin axis of a damaged ball, at most one per turn of the cage, where the ball is opposite the load."""

    probability_percent: Distribution = within(0, 100, default=50.0)
    """Probability of a jump in a turn of the cage."""
    spread_deg: Distribution = within(0, 90, default=10.0)
    """Standard deviation of the tilt after a jump, in addition to `axis_offset_deg`, and of the change of the spin angle."""


class BallFault(Spalls):
    """Spalls on one ball, which hit both races: a line at twice BSF."""

    kind: Literal["ball"]
    """Puts the spalls on one ball."""
    track_deg: Distribution = within(0, 90, default=8.6)
    """Tilt of the spin axis at which a spall leaves the ball's track and is not hit; at 0 it is hit at every turn."""
    axis_offset_deg: Distribution = within(-90, 90, default=0.0)
    """Mean tilt of the spin axis of the ball."""
    axis_wander_deg: Distribution = within(0, 180, default=0.0)
    """Rms of the random variation of that tilt (0.05 to 0.6 shaft rates); it makes hits rarer and irregular."""
    axis_jumps: AxisJumps | None = None
    """Jumps of the spin axis from one turn of the cage to the next; none if left out."""

    def draw(self, draws: Draws, known: Known) -> Drawn:
        """Motion of the spin axis."""
        drawn = draws.section(self, known)
        axis = {name: drawn[name] for name in ("track", "axis_offset", "axis_wander")}
        if self.axis_jumps is not None:
            jumps = draws.section(self.axis_jumps)
            axis |= {"jumps": jumps["probability"], "spread": jumps["spread"]}
        return axis
