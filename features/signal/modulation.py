"""A line of an envelope: its place, the wander of its phase, its sidebands, and its share of the envelope.

A spall that every ball passes at the same spacing gives a line of constant phase. If speed, cage or spacing wander, the
phase wanders with them [1]_, and the line is smeared. The degree of cyclostationarity is that of [2]_.

.. [1] J. Antoni, R. B. Randall, "A stochastic model for simulation and diagnostics of rolling element bearings with
       localized faults", *J. Vib. Acoust.* 125 (2003) 282-289.
.. [2] A. Raad, J. Antoni, M. Sidahmed, "Indicators of cyclostationarity: theory and application to gear fault
       monitoring", *Mech. Syst. Signal Process.* 22 (2008) 574-587.
"""

import numpy as np
from numpy.polynomial import Polynomial
from scipy.fft import fft, fftfreq, ifft
from scipy.signal.windows import tukey

from features.signal.rows import FloatArray

TAPERED = 0.5  # fraction of a record that is tapered, half of it at each end


def highest_place(level: FloatArray, places: FloatArray, tolerance: float) -> np.ndarray:
    """Bin of the highest level within a relative tolerance of each place, shape (record,).

    Parameters
    ----------
    level
        Spectra, shape (record, frequency).
    places
        Nominal bins, shape (record,). Beyond the end of the spectrum, the result is its last bin.
    tolerance
        Relative, half the width of the search.
    """
    last = level.shape[-1] - 1
    highest = np.empty(len(level), dtype=np.intp)
    for row, place in enumerate(places):
        start = min(int(np.floor(place * (1 - tolerance))), last)
        stop = min(int(np.ceil(place * (1 + tolerance))), last)
        highest[row] = start + int(np.argmax(level[row, start : stop + 1]))
    return highest


def phase_wander(envelope: FloatArray, fs: float, frequency: FloatArray, half_width: FloatArray) -> FloatArray:
    """Rms deviation of the phase of a line from that of a constant frequency [rad], shape (record,).

    The envelope is tapered, so that neighbouring lines do not leak, and filtered to the frequencies within
    ``half_width`` of the line. The phase of this analytic signal is unwrapped and compared with its best straight line
    over time. Squares are weighted with the power of the filtered line, so that the phase counts little while the line
    fades and at the ends of the record. It is NaN if no frequency of a short record lies within ``half_width``.

    Parameters
    ----------
    envelope
        Shape (record, time).
    fs
        Sample rate of the envelope [Hz].
    frequency, half_width
        Of the line [Hz], shapes (record,).
    """
    n = envelope.shape[-1]
    tapered = (envelope - envelope.mean(axis=-1, keepdims=True)) * tukey(n, TAPERED)
    coefficients = np.asarray(fft(tapered, axis=-1), dtype=complex)
    beside = np.abs(fftfreq(n, 1 / fs) - frequency[:, None]) > half_width[:, None]
    coefficients[beside] = 0.0
    line = np.asarray(ifft(coefficients, axis=-1))
    return np.array([_wander(*row) for row in zip(np.unwrap(np.angle(line)), np.abs(line) ** 2, strict=True)])


def _wander(phase: FloatArray, weight: FloatArray) -> float:
    """Weighted rms of the residuals of a weighted straight line through a phase, shape (time,)."""
    if not weight.any():
        return np.nan
    time = np.linspace(-1.0, 1.0, len(phase))
    line = Polynomial.fit(time, phase, 1, w=np.sqrt(weight))
    return float(np.sqrt(np.average((phase - line(time)) ** 2, weights=weight)))


def sideband_ratio(spectrum: FloatArray, line: np.ndarray, spacing: FloatArray, reach: int) -> FloatArray:
    """Mean of the two sidebands of a line over the line itself, shape (record,).

    Parameters
    ----------
    spectrum
        Amplitudes, shape (record, frequency).
    line
        Bin of the line, shape (record,).
    spacing
        Distance of the sidebands [bins], shape (record,). A sideband outside the spectrum counts as zero.
    reach
        Bins to each side of a sideband in which its highest value is taken.
    """
    out = np.empty(len(spectrum))
    for row, (centre, distance) in enumerate(zip(line, spacing, strict=True)):
        sides = [_highest(spectrum[row], round(float(centre + sign * distance)), reach) for sign in (-1, 1)]
        out[row] = 0.5 * sum(sides) / spectrum[row, centre]
    return out


def _highest(spectrum: FloatArray, place: int, reach: int) -> float:
    around = spectrum[max(place - reach, 0) : max(place + reach + 1, 0)]
    return float(around.max()) if around.size else 0.0


def cyclostationarity(power: FloatArray, fs: float, frequency: FloatArray, harmonics: int) -> FloatArray:
    """Degree of cyclostationarity of second order at a frequency and its harmonics, shape (record,).

    The sum, over the harmonics, of the squared modulus of the mean of ``power * exp(-2 pi i k f t)``, over the squared
    mean power: 0 for stationary noise, 1 per harmonic for sharp pulses.

    Parameters
    ----------
    power
        Squared envelope, shape (record, time).
    fs
        Its sample rate [Hz].
    frequency
        Shape (record,) [Hz].
    harmonics
        Number of harmonics.
    """
    mean = power.mean(axis=-1)
    time = np.arange(power.shape[-1]) / fs
    turn = np.exp(-2j * np.pi * frequency[:, None] * time)
    window = np.hanning(power.shape[-1])
    weighted = (power - mean[:, None]) * (window / window.sum())
    return (
        sum((np.abs((weighted * turn**k).sum(axis=-1)) ** 2 for k in range(1, harmonics + 1)), np.zeros(len(power)))
        / mean**2
    )
