"""A damaged tooth of a gear, which changes the mesh once per turn of its gear and strikes as it passes.

While the tooth is in contact, amplitude and phase of the mesh change, as those of a softer tooth do [1]_, over a bell of the angle of its
gear that is one tooth wide; each passage excites the path.

.. [1] P. D. McFadden, "Detecting fatigue cracks in gears by amplitude and phase demodulation of the meshing vibration", Journal of
       Vibration, Acoustics, Stress, and Reliability in Design 108(2), 1986, pp. 165-170.
"""

import math

import numpy as np

from gen.drawing import Distribution, Probability, Section, within
from gen.mechanisms.background.source import FloatArray


class ToothFault(Section):
    """A tooth with a crack or a spall: it changes amplitude and phase of the mesh, and strikes once per turn of its gear."""

    probability: Probability
    """Share of the gears that have a damaged tooth."""
    on_mate: Distribution = within(0, 1, default=0.0)
    """1 if the tooth is one of the mating gear, 0 if it is one of the gear on the shaft; both with `choice(0, 1)`."""
    drop: Distribution = within(0, 1)
    """Share of the amplitude of the mesh that is missing while the tooth is in contact."""
    phase_deg: Distribution = within(0, 180, default=0.0)
    """How far the mesh lags then, in degrees of the mesh cycle; n times this at the nth multiple."""
    strikes_db: Distribution = within(-80, 60)
    """Mean of the peaks of its strikes behind the path, relative to the rms of the background noise."""

    @property
    def is_on_mate(self) -> bool:
        """Whether the drawn tooth is one of the mating gear."""
        return round(self.si()["on_mate"]) == 1


def contact_of_tooth(angles: FloatArray, teeth: int) -> FloatArray:
    """How much of the contact one tooth has, from 0 to 1, for ``angles`` of its gear [rad], which has some ``teeth``."""
    return np.exp((np.cos(angles) - 1) / (math.pi / teeth) ** 2)
