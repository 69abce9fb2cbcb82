"""Shaft speed from the lines of spectra: the fault lines and shaft harmonics that fit one speed together.

``levels of lines at each candidate speed -> mean over windows -> evidence -> rate, uncertainty, clear``

A candidate is a multiple of the labelled speed. Its evidence is the comb of the best of three fault families in the
envelope, plus the shaft harmonics in the envelope and in the signal itself. No class label is needed: a faulty bearing
raises one comb, and a healthy machine only its shaft, or the even harmonics of the outer race, as its balls pass the
load zone. That many orders vote for one speed is the idea of [1]_.

.. [1] Q. Leclere, H. Andre, J. Antoni, "A multi-order probabilistic approach for Instantaneous Angular Speed
       tracking: debriefing of the CMMNO'14 diagnosis contest", *Mech. Syst. Signal Process.* 81 (2016) 375-386.
"""

from typing import NamedTuple

import numpy as np

from features.signal.lines import FAMILIES, Orders, families
from features.signal.rows import FloatArray, brief, row_kernel

TOLERANCE = 0.08  # relative, largest speed error that is searched
STEP = 0.001  # relative, between two candidates
SHAFT_HARMONICS = 6
COMBS = ((0, (1, 2, 3)), (1, (1, 2, 3)), (2, (1, 2, 3)), (0, (2, 4, 6)))
"""Combs that tell a speed: number of the family, and harmonics."""
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

    def __repr__(self) -> str:
        return brief(self)


def candidates(tolerance: float = TOLERANCE) -> FloatArray:
    """Relative errors of the labelled speed, from ``-tolerance`` to ``tolerance``, shape (candidate,)."""
    count = int(np.floor(tolerance / STEP + 1e-9))
    return STEP * np.arange(-count, count + 1)


def line_orders(orders: Orders) -> tuple[FloatArray, FloatArray]:
    """Orders read in the envelope, shape (record, line), and in the signal, shape (line,).

    The first are the lines of `COMBS`, then those of the shaft.
    """
    fault = np.concatenate([families(orders)[:, [family]] * harmonics for family, harmonics in COMBS], axis=1)
    shaft = np.arange(1.0, SHAFT_HARMONICS + 1)
    return np.concatenate([fault, np.broadcast_to(shaft, (len(fault), len(shaft)))], axis=1), shaft


def near_label(tolerance: float = TOLERANCE) -> FloatArray:
    """Candidate speeds over the labelled one, with `SHAFT_SHIFT` more at each end, shape (candidate,)."""
    return 1 + candidates(tolerance + SHAFT_SHIFT * STEP)


@row_kernel
def levels_at(level: FloatArray, bins: FloatArray, factors: FloatArray) -> FloatArray:
    """Levels of lines at every candidate speed, shape (record, line, candidate).

    Parameters
    ----------
    level
        Natural logarithm of the ratio of a spectrum to its floor, shape (record, frequency).
    bins
        Places of the lines at the labelled speed, in bins, shape (record, line). A line beyond the end of the spectrum
        has the level 0.
    factors
        Candidate speeds over the labelled one, shape (candidate,).
    """
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
        Mean over the windows of the levels of `levels_at` at the speeds of `near_label`: lines of the envelope, then of
        the signal, shape (line, candidate).
    windows
        Number of windows, 0 if none could be used.
    shaft_rate
        Labelled shaft rate [Hz].
    tolerance
        Largest relative error of the label.
    """
    if windows == 0:
        return ShaftSpeed(np.nan, np.nan, clear=False, agrees=True, evidence=EVIDENCE[0], labelled_rate=shaft_rate)
    combs, shaft = evidence_of(levels, windows)
    error = candidates(tolerance)
    evidence = combs.max(axis=0) + shaft - PENALTY * (error / TOLERANCE) ** 2
    best = int(evidence.argmax())
    rivals = np.abs(error - error[best]) > RIVALS_BEYOND
    ahead = rivals.any() and evidence[best] - evidence[rivals].max() > CLEAR_MARGIN
    clear = bool(ahead and shaft.max() - shaft[best] < SHAFT_BEHIND)
    rate, uncertainty = shaft_rate * (1 + error[best]), shaft_rate * spread_of(error, evidence, best)
    return ShaftSpeed(
        rate=float(rate),
        uncertainty=float(uncertainty),
        clear=clear,
        agrees=not (clear and abs(rate - shaft_rate) > DISAGREEMENT * uncertainty),
        evidence=name_of(combs[:, best]) if clear else EVIDENCE[0],
        labelled_rate=float(shaft_rate),
    )


def spread_of(error: FloatArray, evidence: FloatArray, best: int) -> float:
    """Relative standard deviation of the speed, slip included, from the evidence of candidates."""
    probability = np.exp(SHARPNESS * (evidence - evidence[best]))
    return float(np.sqrt(np.average((error - error[best]) ** 2, weights=probability) + SLIP**2))


def name_of(combs: FloatArray) -> str:
    """Lines that tell a speed, one of `EVIDENCE`, from the height of each comb there, shape (comb,)."""
    highest = int(combs.argmax())
    return EVIDENCE[1 + COMBS[highest][0]] if combs[highest] > CLEAR_FAMILY else EVIDENCE[-1]


def evidence_of(levels: FloatArray, windows: int) -> tuple[FloatArray, FloatArray]:
    """Heights of `COMBS`, shape (comb, candidate), and of the shaft, shape (candidate,), in standard deviations.

    The first and last `SHAFT_SHIFT` candidates of the levels are left out.
    """
    lines = sum(len(harmonics) for _, harmonics in COMBS)
    envelope, signal = np.split(levels, [lines + SHAFT_HARMONICS])
    combs = comb_height(envelope[:lines].reshape(len(COMBS), -1, envelope.shape[-1]), windows)
    noise = [np.hypot(single / np.sqrt(windows), lasting) for single, lasting in (ENVELOPE_NOISE, SIGNAL_NOISE)]
    shaft = sum(
        weight * np.clip((part - FLOOR) / deviation, -1.0, HIGHEST).mean(axis=0)
        for weight, part, deviation in zip(WEIGHTS, (envelope[lines:], signal), noise, strict=True)
    )
    near = np.lib.stride_tricks.sliding_window_view(np.asarray(shaft), 2 * SHAFT_SHIFT + 1)
    return combs[:, SHAFT_SHIFT:-SHAFT_SHIFT], near.max(axis=-1)


def comb_height(levels: FloatArray, windows: int) -> FloatArray:
    """Height of combs in standard deviations of noise, from levels (..., harmonic, candidate) to (..., candidate)."""
    deviation = np.hypot(ENVELOPE_NOISE[0] / np.sqrt(windows), ENVELOPE_NOISE[1])
    ordered = np.sort((levels - FLOOR) / deviation, axis=-2)
    highest = np.minimum(ordered[..., -1, :], ordered[..., -2, :] + AHEAD)  # one line alone is no comb
    return (ordered[..., :-1, :].sum(axis=-2) + highest) / ordered.shape[-2]
