"""Vibration of a gear mesh: multiples of the mesh frequency with sidebands of both gears.

The mesh turns with the shaft, so it is computed from the shaft angle. A gear that runs out of true changes amplitude and phase of the mesh
once per turn, and its mate changes the amplitude at its own rate [1]_::

    mesh  = teeth * angle + phase_modulation * cos(angle - lead_point)
    x     = (1 + shaft_modulation * cos(angle - high_point) + mate_modulation * cos(mate)) * sum_k a_k cos(k * mesh + phase_k)
    mate  = angle * teeth / mate_teeth + start

Amplitude modulation gives a pair of equal sidebands; phase modulation together with it makes them unequal.

.. [1] P. D. McFadden, "Detecting fatigue cracks in gears by amplitude and phase demodulation of the meshing vibration", Journal of
       Vibration, Acoustics, Stress, and Reliability in Design 108(2), 1986, pp. 165-170.
"""

import math

import numpy as np

from gen.corpus.schema import Variable
from gen.drawing import Distribution, Drawn, Draws, Probability, Purpose, within
from gen.mechanisms.background.source import FloatArray, LockedSource
from gen.support.units import decibel_to_ratio


class GearMesh(LockedSource):
    """A gear on the shaft: lines at multiples of its tooth mesh, with sidebands of the shaft and of the mating gear."""

    place, of_rig, of_record = "gear_mesh", Purpose.GEAR, Purpose.GEAR_PHASE
    labels = (
        Variable("gear_mesh", "i4", "1", "latent", "teeth of the gear on the shaft, the order of its mesh line; 0 without a gear",
            lambda drawn: drawn["teeth"]),
    )  # fmt: skip

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

    def draw_present(self, draws: Draws) -> Drawn:
        """Teeth, lines, modulations [1] and their phases [rad]."""
        drawn = draws.section(self)
        levels = [drawn["level"], *(draws.value(self.level_db) for _ in range(round(drawn["count"]) - 1))]
        return {
            "teeth": round(drawn["teeth"]),
            "mate_teeth": round(drawn["mate_teeth"]),
            "lines": tuple({"level": decibel_to_ratio(level), "phase": draws.angle()} for level in levels),
            "shaft_modulation": drawn["shaft_modulation"],
            "mate_modulation": drawn["mate_modulation"],
            "phase_modulation": drawn["phase"],
            "high_point": draws.angle(),
            "lead_point": draws.angle(),
        }

    @staticmethod
    def vibrations(drawn: Drawn, angles: FloatArray, fs: float, rng: np.random.Generator) -> list[FloatArray]:  # noqa: ARG004
        """Vibration of the mesh. The angle of the mate at the first sample is random: other teeth meet there in each record.

        A multiple of the mesh above half the sample rate, which the anti-alias filter would remove, is left out.
        """
        start = 2 * math.pi * rng.random()
        rate = np.abs(np.gradient(drawn["teeth"] * angles)) / math.pi  # of the mesh, over half the sample rate
        wobble = drawn["phase_modulation"] * np.cos(angles - drawn["lead_point"])
        turn = np.exp(1j * (drawn["teeth"] * angles + wobble))
        total, power = np.zeros(len(angles)), np.ones(len(angles), complex)
        for multiple, line in enumerate(drawn["lines"], start=1):
            power *= turn
            amplitude = math.sqrt(2) * line["level"] * np.exp(1j * line["phase"])
            total += (amplitude * power).real * (multiple * rate < 1)
        modulation = 1 + drawn["shaft_modulation"] * np.cos(angles - drawn["high_point"])
        modulation += drawn["mate_modulation"] * np.cos(angles * (drawn["teeth"] / drawn["mate_teeth"]) + start)
        return [total * modulation]
