"""Filters that several mechanisms use."""

from typing import Any

from numpy.typing import NDArray


def recursive(gain: float, pole: complex, signal: NDArray[Any]) -> NDArray[Any]:
    """Filter of first order along time: ``gain`` times the signal plus ``pole`` times the output one sample before."""
    from scipy.signal import lfilter  # loads for half a second, and few recipes need it

    return lfilter([gain], [1.0, -pole], signal)
