"""Measures that the statements of the seed paper are judged by, on displacements of shape (time,) or (channel, time)."""

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks, hilbert

FloatArray = NDArray[np.floating]
Line = tuple[float, float, float]

_PLACES = 64  # in a turn of the shaft, at which the envelope is averaged


def decay(time: FloatArray, x: FloatArray) -> float:
    """Largest distance from the settled mean at 0.05 to 0.1 s, over the largest before 0.05 s."""
    away = np.abs(x - x[time > 0.5].mean())
    return float(away[(time >= 0.05) & (time < 0.1)].max() / away[time < 0.05].max())


def steadiness(time: FloatArray, x: FloatArray) -> float:
    """Share of the peaks before 0.1 s that are lower than the one before, of the distance from the settled mean."""
    away = np.abs(x - x[time > 0.5].mean())[time < 0.1]
    peaks = away[find_peaks(away)[0]]
    return float(np.mean(np.diff(peaks) < 0))


def unrest(settled: FloatArray) -> float:
    """Standard deviation over the mean, without sign."""
    return float(settled.std() / abs(settled.mean()))


def oscillations(time: FloatArray, x: FloatArray) -> float:
    """Number of oscillations around the settled mean before 0.05 s."""
    above = (x > x[time > 0.5].mean())[time < 0.05]
    return float(np.count_nonzero(above[1:] != above[:-1]) / 2)


def modulation(x: FloatArray, turn: float) -> float:
    """Standard deviation over the mean of the envelope averaged over all turns of ``turn`` samples.

    Only a modulation that repeats in every turn remains: m sin gives m / sqrt(2). The envelope of Gaussian noise, which itself varies by
    0.52, gives 0.11 at most over the 42 turns of a run.
    """
    envelope = np.abs(hilbert(x - x.mean()))
    place = (np.arange(len(x)) / turn % 1 * _PLACES).astype(int)
    averaged = np.bincount(place, envelope) / np.bincount(place)
    return float(averaged.std() / averaged.mean())


def asymmetry(x: FloatArray) -> float:
    """Largest excursion from the mean to the one side over that to the other, the larger over the smaller."""
    up, down = x.max() - x.mean(), x.mean() - x.min()
    return float(max(up, down) / min(up, down))


def similarity(frequency: FloatArray, power: FloatArray, other: FloatArray) -> float:
    """Correlation of the logarithms of two power spectra between 20 and 1000 Hz."""
    both = (frequency >= 20) & (frequency <= 1000)
    return float(np.corrcoef(np.log(power[both]), np.log(other[both]))[0, 1])


def sharpest(frequency: FloatArray, power: FloatArray) -> float:
    """Highest rise over the running median of 25 bins, of the bins within 30 dB of the maximum between 20 and 2000 Hz [dB]."""
    level = 10 * np.log10(power[(frequency >= 20) & (frequency <= 2000)])
    floor = np.median(np.lib.stride_tricks.sliding_window_view(np.pad(level, 12, mode="edge"), 25), axis=1)
    return float((level - floor)[level > level.max() - 30].max())


def highest(frequency: FloatArray, power: FloatArray, low: float, high: float) -> tuple[float, float]:
    """Frequency [Hz] and power of the highest bin from ``low`` to ``high``."""
    inside = np.flatnonzero((frequency >= low) & (frequency <= high))
    best = inside[np.argmax(power[inside])]
    return float(frequency[best]), float(power[best])


def lines(frequency: FloatArray, power: FloatArray) -> list[Line]:
    """Lines above 20 Hz and within 30 dB of the highest: frequency [Hz], level below the highest [dB], prominence [dB] of 10 and more."""
    level = 10 * np.log10(power[frequency >= 20] + 1e-30)
    peaks, properties = find_peaks(level, height=level.max() - 30, prominence=10, wlen=61)
    columns = (frequency[frequency >= 20][peaks], level[peaks] - level.max(), properties["prominences"])
    return [(float(f), float(below), float(rise)) for f, below, rise in zip(*columns, strict=True)]


def count_lines(peaks: list[Line], low: float, high: float) -> float:
    """Number of lines from ``low`` to ``high`` that are within 20 dB of the highest line of the spectrum."""
    return float(sum(low <= f <= high and below > -20 for f, below, _ in peaks))
