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
from gen.support.units import decibel_to_ratio


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
    strikes_db: Distribution = within(-80, 40)
    """Rms of the strikes ahead of the paths, relative to that of the background noise."""

    def contact(self, angles: FloatArray, teeth: int) -> FloatArray:
        """How much of the contact the tooth has, from 0 to 1, for ``angles`` of its gear [rad], which has some ``teeth``."""
        return np.exp((np.cos(angles) - 1) / (math.pi / teeth) ** 2)

    def strikes(self, angles: FloatArray, rng: np.random.Generator) -> FloatArray:
        """A strike at the sample at which the tooth comes into contact in each turn, shape (time,) [1]; some are stronger than others."""
        hits = np.zeros(len(angles))
        times = np.flatnonzero(np.diff(np.floor(angles / (2 * math.pi)))) + 1
        hits[times] = 1 + 0.2 * rng.standard_normal(len(times))
        rms = float(np.sqrt(np.mean(hits**2)))
        return hits * (decibel_to_ratio(self.si()["strikes"]) / rms) if rms > 0 else hits
