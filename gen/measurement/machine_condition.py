"""Vibration of a machine that is not well: lines at orders of its shaft, and bursts of noise that come and go with it.

Loose, rubbing or crooked parts repeat every turn, or every second one, and show in a hundred multiples of the shaft rate, up to some
kilohertz. Where many of them stand close together, the envelope has lines at every order, those of healthy bearings among them.
A burst is noise times ``exp(k (cos(n angle + start) - 1))``, a bell of the shaft angle whose width follows from ``k`` [1]_.

.. [1] N. I. Fisher, Statistical Analysis of Circular Data, Cambridge University Press, 1993, section 3.3.6.
"""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft

from gen.drawing.draws import Drawn
from gen.scenarios import ConditionSignal

FloatArray = NDArray[np.float64]

_PERIOD = 2**15  # samples of a table of one period: the 400th line is in it to 1e-3 of its amplitude


def condition_lines(condition: ConditionSignal, angles: FloatArray) -> FloatArray:
    """Lines of a condition over the rms of the background noise, for ``angles`` of the shaft [rad], shape (time,) [1].

    A line that passes half the sample rate anywhere in the record, where the anti-alias filter would remove it, is left out.
    """
    fastest = float(np.abs(np.diff(angles)).max()) * condition.order
    lines = condition.lines[: math.ceil(math.pi / fastest) - 1] if fastest > 0 else condition.lines
    if not lines:
        return np.zeros(len(angles))
    spectrum = [0.0, *(line["level"] * np.exp(1j * line["phase"]) for line in lines)]
    period = irfft(spectrum, _PERIOD) * (_PERIOD / math.sqrt(2))
    return np.interp(condition.order * angles, np.arange(_PERIOD) * (2 * math.pi / _PERIOD), period, period=2 * math.pi)


def condition_bursts(drawn: Drawn, angles: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Bursts of a condition at their rms over that of the background noise, for ``angles`` of the shaft [rad], shape (time,) [1]."""
    sharpness = 1 / drawn["length"] ** 2
    bells = np.exp(sharpness * (np.cos(drawn["order"] * angles + drawn["start"]) - 1))
    return drawn["level"] * bells / math.sqrt(np.mean(bells**2)) * rng.standard_normal(len(angles))
