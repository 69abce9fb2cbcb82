"""A broken cage."""

from typing import Literal

from gen.corpus.schema import Variable
from gen.drawing import Distribution, within
from gen.mechanisms.faults.bearing_fault import BearingFault


class CageFault(BearingFault):
    """A broken cage: one ball is out of place, and its pocket knocks on the housing once per cage turn."""

    labels = (
        Variable("pitch_error", "f8", "rad", "label", "angle by which a ball is out of its place in a broken cage",
            lambda fault: fault.si()["pitch_error"]),
        Variable("knock", "f8", "N", "label", "typical knock of a broken cage on the housing", lambda fault: fault.si()["knock"]),
    )  # fmt: skip

    sizes, lines = ("pitch_error_deg", "knock_n"), {"cage": ("ftf", 1)}

    kind: Literal["cage"]
    """Breaks one pocket of the cage: lines at FTF and its multiples."""
    pitch_error_deg: Distribution = within(0, 10, default=3.0)
    """Angle around the bearing by which the ball of the broken pocket is displaced."""
    knock_n: Distribution = within(0, 10_000, default=20.0)
    """Typical peak force of the knock, 60 degrees after the pocket has passed the direction of the load; 0 for none."""

    def turning(self) -> dict[str, float]:
        """Knock, and the ball that is out of its place."""
        return {"knock": self.si()["knock"], "late_ball": 0, "late_by": self.si()["pitch_error"]}
