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
from scipy.fft import irfft, rfft

from gen.scenarios import Gear

FloatArray = NDArray[np.float64]

FLAT = 0.8  # of half the sample rate: the pass band of the records


def gear_mesh(gear: Gear, angles: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Vibration of a gear mesh at the levels of its lines, relative to the rms of the background noise, shape (time,) [1].

    A multiple of the mesh fades out where its frequency passes from 0.8 to 1 times half the sample rate, as behind an anti-alias filter.

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
        total += (amplitude * power).real * np.clip((1 - multiple * rate) / (1 - FLAT), 0.0, 1.0)
    modulation = 1 + gear.shaft_modulation * np.cos(angles - gear.high_point)
    modulation += gear.mate_modulation * np.cos(angles * (gear.teeth / gear.mate_teeth) + start)
    return total * modulation


def gear_in_channels(
    gear: Gear, angles: FloatArray, paths: NDArray[np.complexfloating], n: int, rng: np.random.Generator
) -> NDArray[np.floating]:
    """Vibration of a gear mesh behind the transfer path of each channel, shape (channel, time), in single precision [1].

    Its rms over all channels is that ahead of the paths. The convolution is circular, as that of the bearing: what it wraps around falls
    into the lead ahead of the record.

    Parameters
    ----------
    gear, angles, rng
        As for :func:`gear_mesh`.
    paths : array, shape (channel, frequency)
        Transfer function of each path [1].
    n : int
        Samples of the Fourier transform that the paths are given for; at least as many as ``angles`` has.
    """
    mesh = gear_mesh(gear, angles, rng).astype(np.float32)
    behind = irfft(rfft(mesh, n) * paths, n)[:, : len(mesh)]
    power = np.mean(np.square(behind), dtype=float)
    return behind * np.float32(math.sqrt(np.mean(np.square(mesh), dtype=float) / power) if power > 0 else 0.0)
