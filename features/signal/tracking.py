"""Course of the shaft speed of a recording, from the harmonics of the shaft alone.

``short-time spectra -> shaft comb at each candidate speed -> smoothest strong path -> phase of the clearest harmonic``

The level of a comb is that of the harmonics of the shaft over the floor, less that halfway between them, so that neither
half nor double the speed has as high a comb [1]_. The course is the path over the windows with the highest sum of combs
less a penalty for its steps, found by dynamic programming. The signal is then resampled along that course, and the phase
of a narrow band around one harmonic corrects the angle [2]_: of the harmonic whose correction makes the others most
coherent, in three bands, each narrower than the one before.

Two harmonics must stand above the noise all the time; with one, the course is not corrected and errs by one or two per
cent. A stronger train of lines within the range of speeds, such as that of another shaft, a gear or the mains, is taken
for the shaft. Noise in the phase is multiplied by the ratio of an order to that of the harmonic, so lines of high orders
are smeared if the shaft lines are weak. A tacho has none of these limits.

.. [1] A. Camacho, J. G. Harris, "A sawtooth waveform inspired pitch estimator for speech and music", *J. Acoust. Soc.
       Am.* 124 (3) (2008) 1638-1652.
.. [2] F. Bonnardot, M. El Badaoui, R. B. Randall, J. Daniere, F. Guillet, "Use of the acceleration signal of a gearbox
       in order to perform angular resampling (with limited speed fluctuation)", *Mech. Syst. Signal Process.* 19 (4)
       (2005) 766-785.
"""

import numpy as np
from scipy.fft import ifft, rfft

from features.signal.demodulation import ZERO_PADDING, fine_amplitudes, log_level, weight_by_hann
from features.signal.door import Positive, Rows, checked
from features.signal.orders import angles_from_speed, resample_to_angle
from features.signal.rows import ComplexArray, FloatArray, IntArray, row_kernel
from features.signal.speed import levels_at

HARMONICS = 5
WINDOW_TURNS = 8.0  # of the slowest speed
HALF_BANDS = (0.2, 0.1, 0.05)  # orders, of the bands around a harmonic whose phase is read
PER_TURN = 32  # samples of the resampled signal
OVERLAP = 8  # windows that contain a sample
FLOOR_LINES = 10.0  # width of the floor, in slowest speeds
LEAST_GAIN = 0.1  # sum of the shares of power that become lines, from which a correction is made
HIGHEST = 3.0  # natural logarithm of the ratio to the floor that a line may count
PENALTY = 0.5  # of a step as large as the steepest change of speed allows


@checked
def track_speed(x: Rows, fs: Positive, slowest: Positive, fastest: Positive, steepest: Positive | None = None) -> Rows:
    """Shaft rate at each sample [Hz], shape (record, time), estimated from the harmonics of the shaft.

    Parameters
    ----------
    x
        Signals, shape (record, time), at least 16 turns of the slowest speed long.
    fs
        Sample rate [Hz].
    slowest, fastest
        Range of the shaft rate [Hz]. The narrower it is, the surer is the answer.
    steepest
        Largest change of the rate [Hz/s]; by default the whole range in a second.

    Raises
    ------
    ValueError
        For a range that is not ascending or reaches beyond the sample rate, or a signal that is too short.
    """
    top = (HARMONICS + 0.5) * fastest
    if not 0 < slowest < fastest or top > fs / 2:
        raise ValueError(
            f"slowest, fastest: {slowest:g} and {fastest:g} Hz are no range below {fs / (2 * HARMONICS + 1):.4g} Hz, so that "
            f"{HARMONICS} harmonics lie below half the sample rate; give two ascending rates."
        )
    length = round(WINDOW_TURNS / slowest * fs)
    if x.shape[1] < 2 * length:
        raise ValueError(
            f"x: {x.shape[1] / fs:.3g} s are too short for a course of {slowest:g} Hz; give {2 * WINDOW_TURNS / slowest:.3g} s or more."
        )
    steepest = fastest - slowest if steepest is None else steepest
    step = fs / (ZERO_PADDING * length) / HARMONICS
    candidates = np.linspace(slowest, fastest, 2 + int((fastest - slowest) / step))
    middle, rate = _ridge(x, fs, length, candidates, steepest)
    found = np.clip(_at_samples(middle, rate, x.shape[1]), slowest, fastest)
    for half_band in HALF_BANDS:
        found = np.stack([_refined(*row, fs, half_band) for row in zip(x, found, strict=True)])
    return found


def _at_samples(middle: FloatArray, rate: FloatArray, count: int) -> FloatArray:
    """Rates at samples from rates at windows, shape (record, time); straight on by half a window at both ends."""
    span = min(OVERLAP, len(middle) - 1)
    steps = np.stack([rate[:, 0] - rate[:, span], rate[:, -1] - rate[:, -1 - span]]) / (middle[span] - middle[0])
    ends = rate[:, 0] + steps[0] * middle[0], rate[:, -1] + steps[1] * (count - 1 - middle[-1])
    courses = np.concatenate([ends[0][:, None], rate, ends[1][:, None]], axis=1)
    places = np.concatenate([[0.0], middle, [count - 1.0]])
    return np.stack([np.interp(np.arange(count), places, course) for course in courses])


def _refined(x: FloatArray, rate: FloatArray, fs: float, half_band: float) -> FloatArray:
    """Shaft rate at each sample [Hz], from one near it and the phase of one harmonic; all of shape (time,).

    In the signal resampled along the given rate, harmonic k is a line near order k. The phase of the band around it,
    divided by k, is the error of the angle. The harmonic whose error makes the others most coherent is the one of the
    shaft; the rate is left as it is if none does.
    """
    angle = angles_from_speed(rate[None], fs)
    spectrum = rfft(resample_to_angle(x[None], angle, PER_TURN)[0])
    count = 2 * (len(spectrum) - 1)
    orders = np.arange(len(spectrum)) * (PER_TURN / count)
    numbers = np.arange(1, HARMONICS + 1)[:, None]
    bands = np.zeros((HARMONICS, count), spectrum.dtype)
    bands[:, : len(spectrum)] = np.where(np.abs(orders - numbers) < half_band, spectrum, 0)
    bands = np.asarray(ifft(bands, axis=1)) * np.exp(-2j * np.pi * numbers * np.arange(count) / PER_TURN)
    errors = np.unwrap(np.angle(bands), axis=1) / numbers
    gains = _coherence(bands, errors, numbers) - _coherence(bands, 0 * errors, numbers)
    best = int(np.argmax(gains))
    if gains[best] < LEAST_GAIN:
        return rate
    error = np.interp(angle[0] * (PER_TURN / (2 * np.pi)), np.arange(count), errors[best])
    ratio = np.gradient(angle[0] + error) / np.gradient(angle[0])
    largest = half_band / (best + 1)
    return rate * np.clip(ratio, 1 - largest, 1 + largest)


def _coherence(bands: ComplexArray, errors: FloatArray, numbers: IntArray) -> FloatArray:
    """Sum over all other harmonics of the share of their power that is a line, for each error, shape (harmonic,)."""
    power = np.mean(np.abs(bands) ** 2, axis=1) + np.finfo(float).tiny
    share = [np.abs(np.mean(bands * np.exp(-1j * numbers * error), axis=1)) ** 2 / power for error in errors]
    return np.sum(share, axis=1) - np.diagonal(share)


def _ridge(
    x: FloatArray, fs: float, length: int, candidates: FloatArray, steepest: float
) -> tuple[FloatArray, FloatArray]:
    """Middle of each window [samples], shape (window,), and the strongest smooth course, shape (record, window)."""
    hop = max(1, length // OVERLAP)
    windows = np.lib.stride_tricks.sliding_window_view(x, length, axis=1)[:, ::hop]
    resolution = fs / (ZERO_PADDING * length)
    width = FLOOR_LINES * candidates[0] / resolution
    bins = int((HARMONICS + 0.5) * candidates[-1] / resolution) + 2
    end = min(bins + int(width) + 1, ZERO_PADDING * length // 2 + 1)
    spectrum = fine_amplitudes(weight_by_hann(windows.reshape(-1, length)), end)
    level = np.clip(log_level(spectrum, np.full(len(spectrum), width), bins), 0, HIGHEST)
    halves = 0.5 * np.arange(1, 2 * HARMONICS + 1)
    places = np.broadcast_to(halves * candidates[0] / resolution, (len(level), len(halves)))
    lines = levels_at(level, places, candidates / candidates[0])
    comb = (lines[:, 1::2].mean(axis=1) - lines[:, ::2].mean(axis=1)).reshape(*windows.shape[:2], -1)
    reach = max(1.0, steepest * hop / fs / (candidates[1] - candidates[0]))
    return 0.5 * (length - 1) + hop * np.arange(windows.shape[1]), candidates[_strongest_paths(comb, reach)]


@row_kernel
def _strongest_paths(comb: FloatArray, reach: float) -> IntArray:
    """Candidate of each window on the path with the highest sum of combs less penalties, shape (record, window)."""
    records, windows, candidates = comb.shape
    path = np.empty((records, windows), np.int64)
    came = np.empty((windows, candidates), np.int64)
    span = int(reach)
    penalties = PENALTY * (np.arange(-span, span + 1) / reach) ** 2
    for row in range(records):
        best = comb[row, 0].astype(np.float64)
        for window in range(1, windows):
            after = np.empty(candidates)
            for candidate in range(candidates):
                low, high = max(0, candidate - span), min(candidates, candidate + span + 1)
                highest, place = -np.inf, low
                for before in range(low, high):
                    value = best[before] - penalties[before - candidate + span]
                    if value > highest:
                        highest, place = value, before
                came[window, candidate] = place
                after[candidate] = highest + comb[row, window, candidate]
            best = after
        path[row, -1] = np.argmax(best)
        for window in range(windows - 1, 0, -1):
            path[row, window - 1] = came[window, path[row, window]]
    return path
