"""Noise of a machine: its colour, its resonances, and what its channels have in common."""

import math

import numpy as np
from numpy.typing import NDArray

from gen.drawing import Distribution, Section, within
from gen.mechanisms.path import Modes, Modulation, transmissibility
from gen.physics.elementary import power
from gen.support.units import decibel_to_ratio

FloatArray = NDArray[np.floating]
Float32Array = NDArray[np.float32]


class Noise(Section):
    """Vibration of the machine without the bearing: drawn per rig, the same for healthy and faulty records."""

    drawn_per = "rig"

    slope: Distribution = within(-2, 4, default=0.0)
    """Exponent of the noise: its power spectral density falls with frequency to this power above 10 Hz; 0 is white."""
    floor_db: Distribution = within(-120, 20, default=-40.0)
    """Rms of a white floor, relative to that of the noise with slope and resonances."""
    modes: Modes | None = None
    """Resonances that shape the noise; none if left out."""
    modulation: Modulation | None = None
    """Modulation of the noise by the shaft; none if left out."""
    coherence: Distribution = within(0, 1, default=0.0)
    """Magnitude-squared coherence of the noise between two channels: 0 for independent noise, 1 for the same."""


def noise_spectrum(noise: Noise, frequency: FloatArray) -> FloatArray:
    """Amplitude spectrum of the noise of a machine, with unit mean power, shape (frequency,) [1].

    Its PSD is a white floor plus ``f^-slope``, constant below 10 Hz, times the resonances.
    """
    drawn = noise.si()
    falling = power(np.maximum(frequency, 10.0), -drawn["slope"] / 2)
    falling *= np.abs(1 + transmissibility(noise.modes, frequency))
    falling[0] = 0.0
    density = falling**2 / np.mean(falling**2) + decibel_to_ratio(drawn["floor"]) ** 2
    return np.sqrt(density / np.mean(density))


def noise_factors(noise: Noise, frequency: FloatArray, chain: FloatArray, n: int) -> Float32Array:
    """Factors that turn complex numbers of unit variance into the spectrum of ``n`` samples of noise of unit rms, shape (frequency,) [1].

    ``chain``, shape (frequency,), is the amplitude response of the measuring chain [1].
    """
    factors = noise_spectrum(noise, frequency) * chain
    factors *= math.sqrt(n / 2) / np.sqrt(np.mean(np.square(factors)))
    # the spectrum is real at 0 Hz, and at the Nyquist frequency of an even n: one number has all of the power there
    factors[:1] *= math.sqrt(2)
    factors[n - n // 2 :] *= math.sqrt(2)
    return factors.astype(np.float32)
