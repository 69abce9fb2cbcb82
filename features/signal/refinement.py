"""Course of the shaft speed to the limit that the noise sets, from a course that is near it.

``signal turned back by the angle of the course -> deviation of each window -> smoothing spline -> next course``

Turned back by the angle of the shaft, a harmonic is a line near zero. The slope of the likelihood of its power in a window
tells how far the course is from the speed; harmonics count by their power over the noise and by their squared order. The
deviations are smoothed by a spline [1]_ whose stiffness is the most likely one for their size, so that a ramp is straight and
a modulation is kept, and the next course starts from there. Windows of several lengths are tried, since long ones have less
noise and short ones follow faster changes; the course with the highest power along it is taken, less its degrees of freedom.

.. [1] R. Kohn, C. F. Ansley, "A new algorithm for spline smoothing based on smoothing a stochastic process", *SIAM J. Sci.
       Stat. Comput.* 8 (1) (1987) 33-48.
"""

from typing import NamedTuple

import numpy as np
from scipy.ndimage import uniform_filter1d

from features.signal.chirplets import HARMONICS, ChirpPath, Search
from features.signal.rows import ComplexArray, FloatArray, row_kernel

CHAINS = ((0.25,), (0.5, 1.0, 2.0, 4.0, 8.0))
"""Lengths of windows over those of the path; each chain begins at the path, each length at the course before."""
COHERENT = 8.0  # length of the windows over which harmonics must be coherent, over that of the path
ROUNDS = 3  # corrections at each length
AVERAGED = 5  # windows whose power is averaged
CONSISTENT = 9  # windows over which a harmonic must agree with the others
FINEST = 1e-6  # relative standard deviation of a window, at least
STIFFNESSES = 10.0 ** np.arange(-12.0, 2.5, 0.5)  # of the spline: squared change of the slope a second, over rate^5


class Course(NamedTuple):
    """Cubic spline through the shaft rate at given times, straight beyond them."""

    time: FloatArray
    """[s], shape (knot,)."""
    rate: FloatArray
    """[Hz], shape (knot,)."""
    slope: FloatArray
    """[Hz/s], shape (knot,)."""
    variance: FloatArray
    """Of the rate [Hz^2], shape (knot,)."""
    freedom: float
    """Degrees of freedom, of a straight course 2."""

    def at(self, time: FloatArray) -> FloatArray:
        """Shaft rate at given times [Hz], both of shape (time,)."""
        first = np.clip(np.searchsorted(self.time, time, side="right") - 1, 0, len(self.time) - 2)
        span = self.time[first + 1] - self.time[first]
        share = (time - self.time[first]) / span
        u = np.clip(share, 0.0, 1.0)
        v = 1 - u
        rate = (1 + 2 * u) * v**2 * self.rate[first] + (1 + 2 * v) * u**2 * self.rate[first + 1]
        rate += span * u * v * (v * self.slope[first] - u * self.slope[first + 1])
        beyond = np.where(share < u, self.slope[0], self.slope[-1])
        return rate + (share - u) * span * beyond


class Deviations(NamedTuple):
    """Shaft rate in windows along a course, all but the last of shape (window,)."""

    time: FloatArray
    """Centre of the part of the window that lies within the signal [s]."""
    rate: FloatArray
    """[Hz]."""
    information: FloatArray
    """Reciprocal of the variance of the rate [Hz^-2]; 0 where no harmonic stands above the noise."""
    power: FloatArray
    """Power of each harmonic over that of the noise, shape (window, harmonic)."""


def refined(z: ComplexArray, rate: float, path: ChirpPath, search: Search) -> Course:
    """Most likely smooth course near a path, of an analytic signal of shape (time,) and its sample rate [Hz]."""
    time = np.arange(len(z)) / rate

    def corrected(course: FloatArray, scale: float) -> Course:
        return smoothed(deviations(z, rate, course, path, scale * search.length), search)

    longest = len(z) / rate / search.length
    found: list[tuple[float, Course]] = []
    for chain in CHAINS:
        course = corrected(np.interp(time, path.time, path.rate), chain[0])
        for scale in np.repeat([scale for scale in chain if scale <= longest], ROUNDS):
            course = corrected(course.at(time), scale)
            coherent = deviations(z, rate, course.at(time), path, min(COHERENT, longest) * search.length)
            found.append((float(coherent.power.sum()) - course.freedom, course))
    return max(found, key=lambda one: one[0])[1]


def deviations(z: ComplexArray, rate: float, course: FloatArray, path: ChirpPath, length: float) -> Deviations:
    """Shaft rate in windows that overlap by half, from the slope of the likelihood at a course.

    The power P of harmonic k in a window, over that of the noise, is its logarithm of the likelihood. With the weights w of
    the window, the signal z turned back along the course, and the time t from the centre of the window::

        P = |Z|^2 / S,  Z = sum(w z),  dP/drate = 4 pi k Im(conj(Z) sum(w t z)) / S

    Parameters
    ----------
    z, rate
        Analytic signal, shape (time,), and its sample rate [Hz].
    course
        Shaft rate at each sample [Hz], shape (time,).
    path
        Path near the course, along which the noise is known.
    length
        Of the windows [s].
    """
    hop = max(2, round(0.5 * length * rate))
    count, lead = -(-len(z) // hop), hop // 2
    offset = (np.arange(2 * hop) + 0.5 - hop) / rate
    weight = np.cos(np.pi * offset / (2 * hop) * rate) ** 2
    moments = np.stack([weight * offset**power for power in range(3)], axis=1)
    w0, w1, w2 = (_cut(np.ones_like(z), lead, hop, count) @ moments).T.real
    e0, e1, e2 = (_cut(np.ones_like(z), lead, hop, count) @ (moments * weight[:, None])).T.real
    centre = w1 / w0
    spread, noise_spread = w2 / w0 - centre**2, e2 / e0 - 2 * centre * e1 / e0 + centre**2
    time = (hop * np.arange(count) - lead + hop - 0.5) / rate + centre
    near = np.interp(time, np.arange(len(z)) / rate, course)
    turned = 2j * np.pi / rate * (np.cumsum(course) - 0.5 * course)
    power, share, step, information = (np.zeros((count, HARMONICS)) for _ in range(4))
    for k in range(1, HARMONICS + 1):
        z0, z1 = (_cut(z * np.exp(-k * turned), lead, hop, count) @ moments[:, :2]).T
        noise = path.density_at(time, k) * e0
        power[:, k - 1] = np.abs(z0) ** 2 / noise
        slope = 4 * np.pi * k * np.imag(np.conj(z0) * (z1 - centre * z0)) / noise
        curvature = 2 * (2 * np.pi * k) ** 2 * spread
        mean = np.maximum(uniform_filter1d(power[:, k - 1], AVERAGED, mode="nearest"), 1.0)
        share[:, k - 1] = 1 - 1 / mean  # of the power that is not noise
        step[:, k - 1] = slope / (curvature * mean)
        information[:, k - 1] = mean * curvature * spread / noise_spread  # a Hann window is not the best weight
    step = np.clip(step, -1 / length, 1 / length)
    information *= share**2 / _inconsistency(step, information, share**2)
    total = information.sum(axis=1)
    mean_step = np.sum(step * information, axis=1) / np.maximum(total, np.finfo(float).tiny)
    return Deviations(time, near + mean_step, np.minimum(total, (FINEST * near) ** -2.0), power)


def _inconsistency(step: FloatArray, information: FloatArray, weight: FloatArray) -> FloatArray:
    """Squared distance of the harmonics from their median, over the variance that they have from noise; at least 1.

    A line close to a harmonic, such as one of the mains, pulls its deviation away from those of the others. All arrays have
    the shape (window, harmonic).
    """
    order = np.argsort(step, axis=1)
    share = np.cumsum(np.take_along_axis(weight, order, axis=1), axis=1)
    middle = np.argmax(share >= 0.5 * share[:, -1:], axis=1)[:, None]
    median = np.take_along_axis(step, np.take_along_axis(order, middle, axis=1), axis=1)
    excess = weight * (step - median) ** 2 * information
    return np.maximum(1.0, uniform_filter1d(excess, CONSISTENT, axis=0, mode="nearest"))


def _cut(z: ComplexArray, lead: int, hop: int, count: int) -> ComplexArray:
    """Windows of two hops of a signal that is zero outside its time, the first from ``lead`` before it, (window, sample)."""
    padded = np.pad(z, (lead, 3 * hop))
    return np.lib.stride_tricks.sliding_window_view(padded, 2 * hop)[: count * hop : hop]


def smoothed(found: Deviations, search: Search) -> Course:
    """Smoothing spline of the most likely stiffness through deviations."""
    prior = np.array([search.fastest, max(search.steepest, search.fastest / found.time[-1])]) ** 2
    start = 0.5 * (search.slowest + search.fastest)
    stiffness = STIFFNESSES * search.slowest**5
    likelihood = [_smoothed(*found[:3], start, prior, change)[0] for change in stiffness]
    _, rate, slope, variance = _smoothed(*found[:3], start, prior, stiffness[int(np.argmax(likelihood))])
    return Course(found.time, rate, slope, variance, float(np.sum(variance * found.information)))


@row_kernel
def _smoothed(
    time: FloatArray, y: FloatArray, information: FloatArray, start: float, prior: FloatArray, change: float
) -> tuple[float, FloatArray, FloatArray, FloatArray]:
    """Log-likelihood, rate, slope and variance of the rate, from a Kalman filter and the smoother of Rauch, Tung and Striebel.

    The slope is a random walk with variance ``change`` per second; state and covariance are (m, s) and ((a, b), (b, c)).
    """
    count = len(time)
    before, after = np.empty((count, 5)), np.empty((count, 5))
    m, s, a, b, c, likelihood = start, 0.0, prior[0], 0.0, prior[1], 0.0
    for i in range(count):
        if i > 0:
            h = time[i] - time[i - 1]
            m += h * s
            a += 2 * h * b + h * h * c + change * h**3 / 3
            b += h * c + change * h * h / 2
            c += change * h
        before[i] = np.array([m, s, a, b, c])
        if information[i] > 0:
            total, error = a + 1 / information[i], y[i] - m
            likelihood -= 0.5 * (np.log(total) + error * error / total)
            m, s = m + a / total * error, s + b / total * error
            a, b, c = a - a * a / total, b - a * b / total, c - b * b / total
        after[i] = np.array([m, s, a, b, c])
    for i in range(count - 2, -1, -1):
        h = time[i + 1] - time[i]
        m, s, a, b, c = after[i]
        m1, s1, a1, b1, c1 = before[i + 1]
        determinant = a1 * c1 - b1 * b1
        u, v = a + h * b, b + h * c  # covariance of both states: ((u, b), (v, c))
        g00, g01 = (u * c1 - b * b1) / determinant, (b * a1 - u * b1) / determinant
        g10, g11 = (v * c1 - c * b1) / determinant, (c * a1 - v * b1) / determinant
        dm, ds = after[i + 1, 0] - m1, after[i + 1, 1] - s1
        da, db, dc = after[i + 1, 2] - a1, after[i + 1, 3] - b1, after[i + 1, 4] - c1
        after[i, 0], after[i, 1] = m + g00 * dm + g01 * ds, s + g10 * dm + g11 * ds
        after[i, 2] = a + g00 * g00 * da + 2 * g00 * g01 * db + g01 * g01 * dc
        after[i, 3] = b + g00 * g10 * da + (g00 * g11 + g01 * g10) * db + g01 * g11 * dc
        after[i, 4] = c + g10 * g10 * da + 2 * g10 * g11 * db + g11 * g11 * dc
    return likelihood, after[:, 0].copy(), after[:, 1].copy(), after[:, 2].copy()
