"""Shaft speed from the lines of spectra: the fault lines and shaft harmonics that fit one speed together.

``levels of lines at each candidate speed -> mean over windows -> evidence -> rate, uncertainty, clear``

A candidate is a relative error of the labelled speed. Its evidence is the comb of the best of three fault families in
the envelope, plus the shaft harmonics in the envelope and in the signal itself. No class label is needed: a faulty
bearing raises one comb, and a healthy machine only its shaft. That many orders vote for one speed is the idea of [1]_.

.. [1] Q. Leclere, H. Andre, J. Antoni, "A multi-order probabilistic approach for Instantaneous Angular Speed
       tracking: debriefing of the CMMNO'14 diagnosis contest", *Mech. Syst. Signal Process.* 81 (2016) 375-386.
"""

from typing import NamedTuple

import numpy as np

from features.signal.lines import COMB_HARMONICS, FAMILIES, Orders, families
from features.signal.rows import FloatArray, row_kernel

TOLERANCE = 0.08  # relative, largest speed error that is searched
STEP = 0.001  # relative, between two candidates
SHAFT_HARMONICS = 6
SHAFT_SHIFT = 10  # candidates: slip and contact angle move fault lines by 1 % against the shaft
EVIDENCE = ("unclear", *FAMILIES, "shaft")
"""Lines that tell the speed: none, those of a fault family, or shaft harmonics alone."""

FLOOR = -0.11  # mean log level of noise: that of a Rayleigh variable less the logarithm of its median
ENVELOPE_NOISE = (0.4, 0.3)  # standard deviation of the mean level of all bands: of one window, and lasting
SIGNAL_NOISE = (0.7, 0.35)  # the same for the spectrum of the signal
WEIGHTS = (0.5, 1.0)  # of the shaft harmonics in the envelope and in the signal, beside those of a fault family
HIGHEST = 4.0  # standard deviations that one shaft harmonic may count
AHEAD = 3.0  # standard deviations that the highest line of a comb may count above the second
PENALTY = 1.0  # standard deviations, of a speed error of `TOLERANCE`; it decides between equal candidates

RIVALS_BEYOND = 0.025  # relative distance from which another candidate is a rival
CLEAR_MARGIN = 1.5  # standard deviations by which the best candidate exceeds its rivals
SHAFT_BEHIND = 1.0  # standard deviations; if the shaft fits another speed better by more, the bearing may be another
CLEAR_FAMILY = 2.0  # standard deviations from which a comb, and not the shaft, is named
SHARPNESS = 2.0  # factor from evidence to a logarithm of probability
SLIP = 0.007  # relative, standard deviation of true from nominal orders
DISAGREEMENT = 2.0  # uncertainties


class ShaftSpeed(NamedTuple):
    """Shaft rate of one recording as its lines tell it.

    Nominal orders times `rate` give the fault lines that were found; slip and the contact angle move these against the
    shaft itself by about 1 %, which the uncertainty includes.
    """

    rate: float
    """Shaft rate [Hz]; NaN without a usable signal."""
    uncertainty: float
    """One standard deviation [Hz]; several per cent of the rate if the lines tell nothing."""
    clear: bool
    """Whether one speed fits the lines so much better than all others that it may replace the label."""
    agrees: bool
    """False if the rate is clear and differs from the label by more than two uncertainties."""
    evidence: str
    """The lines that tell the speed, one of `EVIDENCE`."""
    labelled_rate: float
    """Shaft rate as labelled [Hz]."""


def candidates(tolerance: float = TOLERANCE) -> FloatArray:
    """Relative errors of the labelled speed, from ``-tolerance`` to ``tolerance``, shape (candidate,)."""
    count = int(np.floor(tolerance / STEP + 1e-9))
    return STEP * np.arange(-count, count + 1)


def line_orders(orders: Orders) -> tuple[FloatArray, FloatArray]:
    """Orders read in the envelope, shape (record, line), and in the signal, shape (line,).

    The first are harmonics 1 to 3 of each family, then those of the shaft.
    """
    fault = families(orders)[:, :, None] * np.arange(1, COMB_HARMONICS + 1)
    shaft = np.arange(1.0, SHAFT_HARMONICS + 1)
    both = np.concatenate([fault.reshape(len(fault), -1), np.broadcast_to(shaft, (len(fault), len(shaft)))], axis=1)
    return both, shaft


def levels_at(level: FloatArray, bins: FloatArray, tolerance: float = TOLERANCE) -> FloatArray:
    """Levels of lines at every candidate speed and `SHAFT_SHIFT` candidates beyond, shape (record, line, candidate).

    Parameters
    ----------
    level
        Natural logarithm of the ratio of a spectrum to its floor, shape (record, frequency).
    bins
        Places of the lines at the labelled speed, in bins, shape (record, line). A line beyond the end of the spectrum
        has the level 0.
    tolerance
        Largest relative error of the label.
    """
    return _interpolated(level, bins, 1 + candidates(tolerance + SHAFT_SHIFT * STEP))


@row_kernel
def _interpolated(level: FloatArray, bins: FloatArray, factors: FloatArray) -> FloatArray:
    out = np.zeros((*bins.shape, len(factors)), np.float32)
    for row in range(bins.shape[0]):
        for line in range(bins.shape[1]):
            for candidate in range(len(factors)):
                place = bins[row, line] * factors[candidate]
                below = int(place)
                if below + 1 < level.shape[1]:
                    share = place - below
                    low, high = level[row, below], level[row, below + 1]
                    out[row, line, candidate] = low + share * (high - low)
    return out


def find_speed(levels: FloatArray, windows: int, shaft_rate: float, tolerance: float = TOLERANCE) -> ShaftSpeed:
    """Speed that fits the lines of one recording best.

    Parameters
    ----------
    levels
        Mean over the windows of the levels of `levels_at`: lines of the envelope, then of the signal, shape (line,
        candidate).
    windows
        Number of windows, 0 if none could be used.
    shaft_rate
        Labelled shaft rate [Hz].
    tolerance
        Largest relative error of the label.
    """
    if windows == 0:
        return ShaftSpeed(np.nan, np.nan, clear=False, agrees=True, evidence=EVIDENCE[0], labelled_rate=shaft_rate)
    combs, shaft = _deviations(levels, windows)
    error = candidates(tolerance)
    evidence = combs.max(axis=0) + shaft - PENALTY * (error / TOLERANCE) ** 2
    best = int(evidence.argmax())
    rivals = np.abs(error - error[best]) > RIVALS_BEYOND
    ahead = rivals.any() and evidence[best] - evidence[rivals].max() > CLEAR_MARGIN
    clear = bool(ahead and shaft.max() - shaft[best] < SHAFT_BEHIND)
    probability = np.exp(SHARPNESS * (evidence - evidence[best]))
    variance = np.average((error - error[best]) ** 2, weights=probability)
    rate, uncertainty = shaft_rate * (1 + error[best]), shaft_rate * np.sqrt(variance + SLIP**2)
    family = int(combs[:, best].argmax())
    named = family if combs[family, best] > CLEAR_FAMILY else len(FAMILIES)
    return ShaftSpeed(
        rate=float(rate),
        uncertainty=float(uncertainty),
        clear=clear,
        agrees=not (clear and abs(rate - shaft_rate) > DISAGREEMENT * uncertainty),
        evidence=EVIDENCE[1 + named if clear else 0],
        labelled_rate=float(shaft_rate),
    )


def _deviations(levels: FloatArray, windows: int) -> tuple[FloatArray, FloatArray]:
    """Combs of the families, shape (family, candidate), and the shaft, shape (candidate,), in standard deviations."""
    lines = len(FAMILIES) * COMB_HARMONICS
    envelope, signal = np.split(levels - FLOOR, [lines + SHAFT_HARMONICS])
    envelope = envelope / np.hypot(ENVELOPE_NOISE[0] / np.sqrt(windows), ENVELOPE_NOISE[1])
    signal = signal / np.hypot(SIGNAL_NOISE[0] / np.sqrt(windows), SIGNAL_NOISE[1])
    ordered = np.sort(envelope[:lines].reshape(len(FAMILIES), COMB_HARMONICS, -1), axis=1)
    ordered[:, -1] = np.minimum(ordered[:, -1], ordered[:, -2] + AHEAD)  # one line alone is no comb
    combs = ordered.mean(axis=1)[:, SHAFT_SHIFT:-SHAFT_SHIFT]
    shaft = sum(
        weight * np.clip(part, -1.0, HIGHEST).mean(axis=0)
        for weight, part in zip(WEIGHTS, (envelope[lines:], signal), strict=True)
    )
    near = np.lib.stride_tricks.sliding_window_view(np.asarray(shaft), 2 * SHAFT_SHIFT + 1)
    return combs, near.max(axis=-1)
