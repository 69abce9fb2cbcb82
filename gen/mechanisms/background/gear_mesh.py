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
from gen.drawing import Distribution, Probability, within
from gen.mechanisms.background.impulses import add_strikes
from gen.mechanisms.background.source import FloatArray, MachineSource, Streams
from gen.mechanisms.background.tooth_fault import ToothFault, contact_of_tooth
from gen.support.units import decibel_to_ratio


class GearMesh(MachineSource):
    """A gear on the shaft: lines at multiples of its tooth mesh, with sidebands of the shaft and of the mating gear."""

    place = "gear_mesh"
    labels = (
        Variable("gear_mesh", "i4", "1", "latent", "teeth of the gear on the shaft, the order of its mesh line; 0 without a gear",
            lambda gear: round(gear.si()["teeth"])),
        Variable("tooth_fault", "i1", "1", "label", "gear that has a damaged tooth, whatever the condition of the bearing",
            lambda gear: 0 if gear.tooth_fault is None else 1 + gear.tooth_fault.is_on_mate,
            {0: "none", 1: "gear", 2: "mate"}),
    )  # fmt: skip

    probability: Probability
    """Share of the rigs that have a gear."""
    teeth: Distribution = within(5, 500)
    """Number of teeth of the gear on the shaft, rounded to a whole number; the order of the mesh line."""
    mate_teeth: Distribution = within(5, 2000)
    """Number of teeth of the mating gear, rounded to a whole number; it turns by teeth / mate_teeth of the shaft."""
    count: Distribution = within(1, 16)
    """Number of multiples of the mesh frequency, rounded to a whole number; those beyond half the sample rate are left out."""
    level_db: Distribution = within(-80, 40, each=True)
    """Rms of such a line without sidebands and ahead of the paths, relative to that of the background noise; drawn for each. All lines
    together have the same rms ahead of the paths and behind them."""
    shaft_modulation: Distribution = within(0, 1, default=0.0)
    """Depth of the amplitude modulation once per turn of the shaft: a gear that runs out of true."""
    mate_modulation: Distribution = within(0, 1, default=0.0)
    """Depth of the amplitude modulation once per turn of the mating gear."""
    phase_deg: Distribution = within(0, 180, default=0.0)
    """Peak of the phase modulation once per turn of the shaft, in degrees of the mesh cycle; n times this at the nth multiple."""
    tooth_fault: ToothFault | None = None
    """Damaged tooth of one of the gears; all are whole if left out."""

    def vibrations(self, angles: FloatArray, fs: float, stream: Streams) -> list[FloatArray]:
        """Vibration of the mesh, which a damaged tooth makes weaker and late.

        A multiple of the mesh above half the sample rate, which the anti-alias filter would remove, is left out.
        """
        drawn, mate = self.si(), self._mate_angles(angles, stream)
        teeth, levels = round(drawn["teeth"]), decibel_to_ratio(drawn["level"])
        high_point, lead_point, *phases = 2 * math.pi * stream(level="rig").random(2 + len(levels))
        modulation = (
            1 + drawn["shaft_modulation"] * np.cos(angles - high_point) + drawn["mate_modulation"] * np.cos(mate)
        )
        mesh = teeth * angles + drawn["phase"] * np.cos(angles - lead_point)
        if self.tooth_fault is not None:
            fault, of_mate = self.tooth_fault.si(), self.tooth_fault.is_on_mate
            contact = contact_of_tooth(mate if of_mate else angles, round(drawn["mate_teeth"]) if of_mate else teeth)
            modulation *= 1 - fault["drop"] * contact
            mesh -= fault["phase"] * contact
        rate = np.abs(np.gradient(teeth * angles)) / math.pi  # of the mesh, over half the sample rate
        turn = np.exp(1j * mesh)
        total, power = np.zeros(len(angles)), np.ones(len(angles), complex)
        for multiple, (level, phase) in enumerate(zip(levels, phases, strict=True), start=1):
            power *= turn
            total += (math.sqrt(2) * level * np.exp(1j * phase) * power).real * (multiple * rate < 1)
        return [total * modulation]

    def add_impulses(self, hits: FloatArray, angles: FloatArray, fs: float, stream: Streams) -> None:
        """Strikes of a damaged tooth, once per turn of its gear."""
        if self.tooth_fault is not None:
            turned = self._mate_angles(angles, stream) if self.tooth_fault.is_on_mate else angles
            add_strikes(hits, turned, self.tooth_fault.si()["strikes"], stream())

    def _mate_angles(self, angles: FloatArray, stream: Streams) -> FloatArray:
        """Angle of the mating gear [rad]; that at the first sample is random, since other teeth meet there in each record."""
        drawn = self.si()
        return angles * (round(drawn["teeth"]) / round(drawn["mate_teeth"])) + 2 * math.pi * stream().random()
