"""First course of the shaft speed of a signal: the path of straight pieces with the highest evidence for shaft harmonics.

``signal -> low analytic signal -> spectra along straight courses -> evidence for harmonics -> best path, window by window``

A window is multiplied by chirps before its transform, so that a line whose frequency changes evenly is as sharp as one of
constant frequency. A piece of the course is given by the rates at its two ends; its evidence is summed over harmonics. The
best chain of pieces is found by dynamic programming over these rates, as in chirplet path pursuit [1]_, and many orders
vote for one speed as in [2]_.

The evidence of a line is the logarithm of its power over the floor, so that several weak harmonics are worth more than one
strong line of another source. The smear of a strong line under chirps other than its own belongs to the floor; otherwise,
steep courses would find all their harmonics in it.

The mean evidence of the best path through noise follows a law that was found by simulation: it grows with the logarithm of
the pieces that a path can choose from. A path can be believed if its evidence is clearly above that law.

.. [1] E. J. Candes, P. R. Charlton, H. Helgason, "Detecting highly oscillatory signals by chirplet path pursuit", *Appl.
       Comput. Harmon. Anal.* 24 (1) (2008) 14-40.
.. [2] Q. Leclere, H. Andre, J. Antoni, "A multi-order probabilistic approach for Instantaneous Angular Speed
       tracking: debriefing of the CMMNO'14 diagnosis contest", *Mech. Syst. Signal Process.* 81 (2016) 375-386.
"""

from typing import NamedTuple

import numpy as np
from scipy.fft import fft, ifft, next_fast_len, rfft
from scipy.ndimage import uniform_filter1d
from scipy.special import exp1

from features.signal.demodulation import running_median
from features.signal.rows import BoolArray, ComplexArray, FloatArray, IntArray, row_kernel

HARMONICS = 5
WINDOW_TURNS = 8.0  # of the slowest speed
PADDING = 4  # length of the transforms over that of the windows
CANDIDATE_STEP = 0.3  # of two candidate rates, over the resolution of a window
CHIRP_STEP = 5.0  # of two chirps [Hz/s], over the squared resolution: halfway, a line is 0.3 dB lower
FLOOR_LINES = 4.0  # width of the floor, in slowest speeds
FLOOR_WINDOWS = 5  # over which it is averaged
SHARP = 20.0  # power over the floor from which the smear of a line is taken away
RIPPLE = 2.0  # highest power of a smear over its mean
HALF = 3.0  # power over the floor from which the evidence grows with its logarithm
WEIGHTS = np.arange(1, HARMONICS + 1) ** -0.25  # a single line is rather the first harmonic than the second
SLOPES = (-2.0, 2.0)  # exponents of the frequency that the power density of noise has
FAINTEST = 1e-5  # power of the floor over that of the highest line of the window
SILENT = 1e-8  # and of the record
NOISE = (-0.06, 0.22)  # law of the mean evidence of the best path through noise: constant, per logarithm of its choices
MARGIN = (0.1, 1.0)  # above it: constant, and over the root of the number of windows, of which one deviates by 0.27
NEARBY = 9  # windows that are judged together
PENALTY = 0.5  # of the steepest piece, in evidence


class Search(NamedTuple):
    """Shaft rates among which a course is sought."""

    slowest: float
    """[Hz]."""
    fastest: float
    """[Hz]."""
    steepest: float
    """Largest change of the rate [Hz/s]."""

    @property
    def length(self) -> float:
        """Of a window [s]."""
        return WINDOW_TURNS / self.slowest


class ChirpPath(NamedTuple):
    """Chain of straight pieces with the highest evidence."""

    time: FloatArray
    """Ends of the pieces [s], shape (end,)."""
    rate: FloatArray
    """Shaft rate there [Hz], shape (end,)."""
    evidence: FloatArray
    """Of each piece, shape (window,); 0 on average of a piece in noise that is chosen blindly."""
    reach: int
    """Steps of candidates that a piece may rise or fall."""
    density: FloatArray
    """Power of a sample of noise, per unit of the sample rate, shape (window, frequency)."""
    bin_width: float
    """Between two frequencies [Hz]."""

    def density_at(self, time: FloatArray, harmonic: int) -> FloatArray:
        """Density of the noise at a harmonic of the path at given times, both of shape (time,)."""
        place = np.rint(harmonic / self.bin_width * np.interp(time, self.time, self.rate)).astype(int)
        window = np.searchsorted(self.time[1:-1], time, side="right")
        return self.density[window, np.minimum(place, self.density.shape[1] - 1)]

    @property
    def noise(self) -> float:
        """Mean evidence of the best path through noise [1]."""
        return NOISE[0] + NOISE[1] * float(np.log(2 * self.reach + 1))

    def is_clear(self) -> bool:
        """Whether the evidence of the whole path is clearly above that of noise."""
        return bool(self.evidence.mean() > self.noise + margin(len(self.evidence)))


class _Windows(NamedTuple):
    """Windows of an analytic signal, the chirps by which they are multiplied, and the bins that are kept."""

    signal: ComplexArray  # (window, sample)
    chirps: ComplexArray  # (chirp, sample), times the Hann window; the middle one is constant
    chirp_step: float  # [Hz/s]
    hop: float  # [s]
    transform: int
    bins: int
    bin_width: float  # [Hz]
    floor_width: int  # [bins]
    cone: float  # half the width of a line under the chirp beside its own [bins]


def baseband(x: FloatArray, fs: float, top: float) -> tuple[ComplexArray, float]:
    """Analytic signal below a frequency ``top`` [Hz], shape (time,), and its sample rate [Hz]; its first sample is that of x."""
    padded = next_fast_len(5 * len(x) // 4, real=True)
    kept = min(int(1.25 * top * padded / fs) + 1, padded // 2)
    taper = np.clip(5 - 4 * np.arange(kept) * fs / (padded * top), 0, 1)
    count = next_fast_len(kept + 1)
    spectrum = np.asarray(rfft(x - x.mean(), padded))[:kept]
    z = np.asarray(ifft(2 * spectrum * taper, count)) * (count / padded)
    return z[: int(np.ceil(len(x) * count / padded))], fs * count / padded


def strongest_path(z: ComplexArray, rate: float, search: Search) -> ChirpPath:
    """Path with the highest evidence, of an analytic signal of shape (time,) as from `baseband` and its sample rate [Hz]."""
    windows = _windows_of(z, rate, search)
    count = 2 + int((search.fastest - search.slowest) * windows.signal.shape[1] / (CANDIDATE_STEP * rate))
    candidates = np.linspace(search.slowest, search.fastest, count)
    step = float(candidates[1] - candidates[0])
    reach = max(1, int(np.ceil(search.steepest * windows.hop / step)))
    bins = np.array([search.slowest, step]) / windows.bin_width
    chirps = step / windows.hop / windows.chirp_step
    middle = windows.chirps[len(windows.chirps) // 2]
    floor = _noise(_power(windows.signal * middle, windows), windows.floor_width)
    came, before, best = np.zeros((len(floor), count), np.int64), np.zeros((len(floor), count)), np.zeros(count)
    for number, window in enumerate(windows.signal):
        evidence = evidence_for(_sharp(_power(window * windows.chirps, windows), floor[number], windows.cone))
        before[number] = best
        best, came[number] = _next_ends(best, evidence, reach, bins, chirps, WEIGHTS)
    ends, evidence = _traced(best, before, came)
    density = floor / np.sum(middle.real**2)
    return ChirpPath(
        windows.hop * np.arange(len(floor) + 1), candidates[ends], evidence, reach, density, windows.bin_width
    )


def _windows_of(z: ComplexArray, rate: float, search: Search) -> _Windows:
    """Windows of a few turns, each twice as long as the piece of the course in its middle; zeros beyond the signal."""
    hop = round(0.5 * search.length * rate)
    length = 2 * hop
    count = -(-len(z) // hop)
    padded = np.pad(z, (hop // 2, 2 * length))
    signal = np.lib.stride_tricks.sliding_window_view(padded, length)[: count * hop : hop]
    place = (np.arange(length) + 0.5) / length
    chirp_step = CHIRP_STEP * (rate / length) ** 2
    most = int(np.ceil(HARMONICS * search.steepest / chirp_step))
    slopes = chirp_step * np.arange(-most, most + 1)[:, None]
    chirps = np.exp(-1j * np.pi * slopes * ((place - 0.5) * length / rate) ** 2) * np.sin(np.pi * place) ** 2
    transform = next_fast_len(PADDING * length)
    bins = min(transform, int((HARMONICS + 0.5) * search.fastest * transform / rate) + 2)
    width = int(FLOOR_LINES * search.slowest * transform / rate)
    cone = 0.5 * CHIRP_STEP * transform / length
    return _Windows(signal, chirps, chirp_step, hop / rate, transform, bins, rate / transform, width, cone)


def _power(signals: ComplexArray, windows: _Windows) -> FloatArray:
    """Power spectra of weighted signals, shape (signal, sample) to (signal, frequency)."""
    spectrum = np.asarray(fft(signals, windows.transform, axis=1))[:, : windows.bins]
    return spectrum.real**2 + spectrum.imag**2


def _noise(power: FloatArray, width: int) -> FloatArray:
    """Mean power of the noise from the running median of spectra without their slope, both of shape (window, frequency)."""
    windows, count = power.shape
    place, highest = np.log(np.arange(1, count + 1)), power.max(axis=1, keepdims=True)
    least = np.maximum(FAINTEST * highest, max(SILENT * float(highest.max()), np.finfo(float).tiny))
    widths = np.full(windows, float(width))
    level = np.log(running_median(power, widths, count) + least).mean(axis=0)
    slope = np.exp(np.clip(np.polyfit(place, level, 1)[0], *SLOPES) * place)
    floor = uniform_filter1d(running_median(power / slope, widths, count), FLOOR_WINDOWS, axis=0, mode="nearest")
    return np.maximum(floor * slope / np.log(2), least)


def margin(windows: int) -> float:
    """Mean evidence over some windows that noise does not exceed by chance, above its expectation."""
    return MARGIN[0] + MARGIN[1] / np.sqrt(windows)


def clear_nearby(evidence: FloatArray, noise: float) -> BoolArray:
    """Whether the mean evidence of the windows around each is clearly above that of noise, both of shape (window,).

    No window counts more than twice what is needed, so that strong lines do not hide a silent part.
    """
    count = min(NEARBY, len(evidence))
    least = noise + margin(count)
    return uniform_filter1d(np.minimum(evidence, 2 * least), count, mode="nearest") > least


def evidence_for(ratio: FloatArray) -> FloatArray:
    """Evidence for a line from its power over the floor; 0 on average in noise."""
    return np.log1p(ratio / HALF) - np.exp(HALF) * exp1(HALF)


@row_kernel
def _sharp(power: FloatArray, floor: FloatArray, cone: float) -> FloatArray:
    """Power over the floor and over the smear of lines under chirps that are not their own, shape (chirp, frequency).

    Under a chirp that differs by d steps of s Hz/s, a line of power P in a Hann window of length L is about s d L wide, and
    its power is 4 P / (s d L^2). The highest line comes first; what it explains is no line.
    """
    chirps, bins = power.shape
    smear, highest, own = np.zeros((chirps, bins + 1)), np.zeros(bins), np.zeros(bins, np.int64)
    for place in range(bins):
        own[place] = np.argmax(power[:, place])
        highest[place] = power[own[place], place]
    lines, count = np.empty(bins, np.int64), 0
    for place in np.argsort(-highest):
        explained = SHARP * floor[place]
        for line in lines[:count]:
            steps = abs(own[line] - own[place])
            if abs(line - place) <= cone * (steps + 1):
                explained += RIPPLE * 4 / CHIRP_STEP * highest[line] / max(steps, 1)
        if highest[place] > explained:
            lines[count] = place
            count += 1
    for place in lines[:count]:
        for chirp in range(chirps):
            steps = abs(chirp - own[place])
            if steps > 1:
                half = int(cone * steps)
                level = RIPPLE * 4 / CHIRP_STEP * highest[place] / steps
                smear[chirp, max(0, place - half)] += level
                smear[chirp, min(bins, place + half + 1)] -= level
    ratio = np.empty((chirps, bins))
    for chirp in range(chirps):
        level = 0.0
        for place in range(bins):
            level += smear[chirp, place]
            ratio[chirp, place] = power[chirp, place] / (floor[place] + max(level, 0.0))
    return ratio


@row_kernel
def _next_ends(
    best: FloatArray, evidence: FloatArray, reach: int, bins: FloatArray, chirps: float, weights: FloatArray
) -> tuple[FloatArray, IntArray]:
    """Highest evidence of a path to each candidate at the end of a piece, and the candidate at its start.

    Candidate c is at bin ``bins[0] + c * bins[1]`` of the first harmonic; a rise of a candidate is ``chirps`` chirps.
    """
    after, came = np.full(len(best), -np.inf), np.zeros(len(best), np.int64)
    middle = evidence.shape[0] // 2
    for end in range(len(best)):
        for start in range(max(0, end - reach), min(len(best), end + reach + 1)):
            value = best[start] - PENALTY * ((end - start) / reach) ** 2
            place = bins[0] + 0.5 * (start + end) * bins[1]
            for k in range(1, len(weights) + 1):
                chirp = middle + int(np.rint(k * (end - start) * chirps))
                line = int(np.rint(k * place))
                if 0 <= chirp < evidence.shape[0] and line < evidence.shape[1]:
                    value += weights[k - 1] * evidence[chirp, line]
            if value > after[end]:
                after[end], came[end] = value, start
    return after, came


def _traced(best: FloatArray, before: FloatArray, came: IntArray) -> tuple[IntArray, FloatArray]:
    """Candidates at the ends of the pieces of the best path, shape (end,), and the evidence of each, shape (window,)."""
    ends = np.zeros(len(came) + 1, np.int64)
    ends[-1] = np.argmax(best)
    for window in range(len(came) - 1, -1, -1):
        ends[window] = came[window, ends[window + 1]]
    sums = np.append(before[np.arange(len(came)), ends[:-1]], best[ends[-1]])
    return ends, np.diff(sums)
