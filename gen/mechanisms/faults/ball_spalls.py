"""Spalls on a ball."""

from typing import Annotated, Any, Literal

from pydantic import Field, StrictInt

from gen.drawing import Distribution, Draws, Section, within
from gen.mechanisms.faults.race_spalls import Spalls
from gen.physics.bearing import Bearing
from gen.physics.extent import MAX_BALLS
from gen.support.errors import RecipeError


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
    ball: Annotated[StrictInt, Field(ge=0, lt=MAX_BALLS)] | None = None
    """Number of the damaged ball, from 0; any if left out."""
    track_deg: Distribution = within(0, 90, default=8.6)
    """Tilt of the spin axis at which a spall leaves the ball's track and is not hit; at 0 it is hit at every turn."""
    axis_offset_deg: Distribution = within(-90, 90, default=0.0)
    """Mean tilt of the spin axis of the ball."""
    axis_wander_deg: Distribution = within(0, 180, default=0.0)
    """Rms of the random variation of that tilt (0.05 to 0.6 shaft rates); it makes hits rarer and irregular."""
    axis_jumps: AxisJumps | None = None
    """Jumps of the spin axis from one turn of the cage to the next; none if left out."""

    def draw(self, of: Draws) -> Any:
        """The fault on one of the balls of a bearing."""
        ball = int(of.u("ball") * of.bearing.n_balls) if self.ball is None else self.ball
        return super().draw(of).model_copy(update={"ball": ball})

    def check(self, bearing: Bearing, item: str) -> None:
        """RecipeError if a spall is too wide, or the ball is none of the bearing."""
        super().check(bearing, item)
        if self.ball is None or self.ball >= bearing.n_balls:
            raise RecipeError(
                f"{item}: ball: the bearing has {bearing.n_balls} balls, numbered from 0; take one of them."
            )

    def turning(self) -> dict[str, float]:
        """Motion of the spin axis."""
        drawn = self.si()
        axis = {"axis_offset": drawn["axis_offset"], "axis_rms": drawn["axis_wander"], "axis_limit": drawn["track"]}
        if self.axis_jumps is None:
            return axis
        jumps = self.axis_jumps.si()
        return axis | {"axis_jumps": jumps["probability"], "axis_spread": jumps["spread"]}
