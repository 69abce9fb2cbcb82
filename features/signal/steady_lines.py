"""Lines that stand at one frequency, such as those of the mains, and signals without them.

``power of each frequency over the record -> lines that never leave theirs -> slow amplitude of each -> subtracted``
"""

import numpy as np
from scipy.fft import fft, next_fast_len
from scipy.ndimage import maximum_filter1d
from scipy.signal import fftconvolve

from features.signal.rows import ComplexArray, FloatArray, hann_window

PADDING = 4  # length of the transforms over that of the windows
LEAST_SHARE = 0.25  # quantile over the record of the power of a frequency
OF_HIGHEST = 0.5  # of the median over the record of the highest power nearby, from which that quantile is a line
NEARBY = 6.0  # resolutions of a window, to each side
FAINTEST = 1e-4  # power over that of the highest steady line
AMPLITUDE_WINDOWS = 4.0  # length over which the amplitude of a line is averaged, in windows


def without_steady_lines(z: ComplexArray, rate: float, length: float) -> ComplexArray:
    """Analytic signal without the lines that stay at one frequency, shape (time,).

    Parameters
    ----------
    z, rate
        Analytic signal, shape (time,), and its sample rate [Hz].
    length
        Of the windows [s]. A line is steady if it is at one frequency, within the reciprocal of this length, for three
        quarters of the record.
    """
    count = round(length * rate)
    rest, time = z.copy(), np.arange(len(z)) / rate
    for frequency in _steady_frequencies(z, rate, count):
        base = rest * np.exp(-2j * np.pi * frequency * time)
        slow = _averaged(base, count)
        drift = float(np.angle(np.vdot(slow[:-1], slow[1:]))) * rate
        turning = np.exp(1j * drift * time)
        line = _averaged(base / turning, round(AMPLITUDE_WINDOWS * count)) * turning
        rest -= line * np.exp(2j * np.pi * frequency * time)
    return rest


def _steady_frequencies(z: ComplexArray, rate: float, count: int) -> FloatArray:
    """Frequencies of steady lines [Hz], the highest line first, shape (line,)."""
    windows = np.lib.stride_tricks.sliding_window_view(z, count)[:: count // 2]
    transform = next_fast_len(PADDING * count)
    power = np.abs(np.asarray(fft(windows * hann_window(count, float), transform, axis=1))) ** 2
    lasting = np.quantile(power, LEAST_SHARE, axis=0)
    resolution = transform / count
    highest = np.median(maximum_filter1d(power, int(2 * NEARBY * resolution) + 1, axis=1, mode="wrap"), axis=0)
    peak = lasting == maximum_filter1d(lasting, int(4 * resolution) + 1, mode="wrap")
    steady = peak & (lasting > np.maximum(OF_HIGHEST * highest, FAINTEST * lasting.max()))
    lines = np.flatnonzero(steady)
    return rate / transform * lines[np.argsort(-lasting[lines], kind="stable")]


def _averaged(z: ComplexArray, count: int) -> ComplexArray:
    """Mean over a Hann window around each sample, shape (time,)."""
    window = hann_window(count, float)
    weight = np.asarray(fftconvolve(np.ones(len(z)), window, "same"), dtype=float)
    return np.asarray(np.asarray(fftconvolve(z, window, "same")) / weight, dtype=complex)
