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
from numpy.typing import NDArray

from gen.scenarios import Gear

FloatArray = NDArray[np.float64]


def gear_mesh(gear: Gear, angles: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Vibration of a gear mesh at the levels of its lines, relative to the rms of the background noise, shape (time,) [1].

    A multiple of the mesh above half the sample rate, which the anti-alias filter would remove, is left out.

    Parameters
    ----------
    gear : Gear
    angles : array, shape (time,)
        True angle of the shaft at each sample [rad].
    rng : Generator
        Draws the angle of the mate at the first sample; the teeth that meet there differ from record to record.
    """
    start = 2 * math.pi * rng.random()
    rate = np.abs(np.gradient(gear.teeth * angles)) / math.pi  # of the mesh, over half the sample rate
    wobble = gear.phase_modulation * np.cos(angles - gear.lead_point)
    turn = np.exp(1j * (gear.teeth * angles + wobble))
    total, power = np.zeros(len(angles)), np.ones(len(angles), complex)
    for multiple, line in enumerate(gear.lines, start=1):
        power *= turn
        amplitude = math.sqrt(2) * line["level"] * np.exp(1j * line["phase"])
        total += (amplitude * power).real * (multiple * rate < 1)
    modulation = 1 + gear.shaft_modulation * np.cos(angles - gear.high_point)
    modulation += gear.mate_modulation * np.cos(angles * (gear.teeth / gear.mate_teeth) + start)
    return total * modulation
