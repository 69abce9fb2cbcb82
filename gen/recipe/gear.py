"""Gear mesh in the background of a machine."""

from gen.drawing.distributions import Distribution, within
from gen.drawing.section import Probability, Section


class GearMesh(Section):
    """A gear on the shaft: lines at multiples of its tooth mesh, with sidebands of the shaft and of the mating gear."""

    probability: Probability
    """Share of the rigs that have a gear."""
    teeth: Distribution = within(5, 500)
    """Number of teeth of the gear on the shaft, rounded to a whole number; the order of the mesh line."""
    mate_teeth: Distribution = within(5, 2000)
    """Number of teeth of the mating gear, rounded to a whole number; it turns by teeth / mate_teeth of the shaft."""
    count: Distribution = within(1, 16)
    """Number of multiples of the mesh frequency, rounded to a whole number; those beyond half the sample rate are left out."""
    level_db: Distribution = within(-80, 40)
    """Rms of such a line without sidebands and ahead of the paths, relative to that of the background noise; drawn for each. All lines
    together have the same rms ahead of the paths and behind them."""
    shaft_modulation: Distribution = within(0, 1, default=0.0)
    """Depth of the amplitude modulation once per turn of the shaft: a gear that runs out of true."""
    mate_modulation: Distribution = within(0, 1, default=0.0)
    """Depth of the amplitude modulation once per turn of the mating gear."""
    phase_deg: Distribution = within(0, 180, default=0.0)
    """Peak of the phase modulation once per turn of the shaft, in degrees of the mesh cycle; n times this at the nth multiple."""
