"""A race worn over its whole circumference."""

from typing import Annotated, Literal

from pydantic import Field, StrictInt

from gen.corpus.schema import Variable
from gen.drawing import Distribution, within
from gen.mechanisms.faults.bearing_fault import BearingFault
from gen.physics.extent import HIGHEST_ORDER, LOWEST_ORDER


class DistributedFault(BearingFault):
    """A race worn over its whole circumference; records are labelled with the race."""

    labels = (
        Variable("wear", "f8", "m", "label", "rms waviness of a worn race, 0 if none is", lambda fault: fault.si()["waviness"]),
    )  # fmt: skip

    sizes = ("waviness_um",)

    kind: Literal["distributed"]
    """Adds waviness to a whole race: noise at low frequency, no line in the envelope spectrum."""
    site: Literal["inner", "outer"]
    """Race that is worn, and the class label."""
    waviness_um: Distribution = within(0, 50, open_low=True, default=0.5)
    """Rms waviness of the worn race, in addition to that of the specimen."""
    order: Annotated[StrictInt, Field(ge=LOWEST_ORDER, le=HIGHEST_ORDER)] | None = None
    """Waves per turn, if all wear has one order; if left out, orders 2 to 60 with amplitudes that fall as 1/order."""
