"""Fault lines in the level of an envelope spectrum over its floor, looked up at orders of the shaft.

A spall makes the envelope repeat at its fault order and leaves a line there, harmonics above it, and
sidebands at the rate at which the spall passes through the load [1]_. Speed labels and orders of real
machines are off by a per cent or two, so a single line is the highest level within a tolerance, and a comb
may shift as a whole.

.. [1] R. B. Randall, J. Antoni, "Rolling element bearing diagnostics: a tutorial", *Mech. Syst. Signal
       Process.* 25 (2011) 485-520.
"""

from typing import NamedTuple

import numpy as np

from features.spectra import FloatArray

LINE_TOLERANCE = 0.015
COMB_TOLERANCE = 0.02
COMB_HARMONICS = np.arange(1, 4)
HIGHEST_LINE_ORDERS = (0.25, 12.0)

FAMILIES = ("bpfo", "bpfi", "2bsf")
LINE_NAMES = (
    *(f"{family}_{what}" for what in ("comb", "h1", "h2", "sidebands") for family in FAMILIES),
    *("bsf", "fr", "2fr", "ftf", "2ftf", "fr-ftf"),
    "highest_line",
)


class Orders(NamedTuple):
    """Nominal fault orders of records, each of shape (record,), in multiples of the shaft rate.

    ``bsf`` is the spin of a ball. A spall on it strikes both raceways in each spin: its line is ``2 * bsf``.
    """

    ftf: FloatArray
    bpfo: FloatArray
    bpfi: FloatArray
    bsf: FloatArray


def families(orders: Orders) -> FloatArray:
    """Fundamental order of each of `FAMILIES`, shape (record, family)."""
    return np.stack([orders.bpfo, orders.bpfi, 2 * orders.bsf], axis=-1)


def highest_order(orders: Orders) -> FloatArray:
    """Highest order at which `read_lines` looks, shape (record,)."""
    comb = COMB_HARMONICS[-1] * (1 + COMB_TOLERANCE) * families(orders).max(axis=-1)
    return np.maximum(comb, HIGHEST_LINE_ORDERS[1])


def read_lines(level: FloatArray, bins_per_order: FloatArray, orders: Orders) -> FloatArray:
    """Levels of the lines of `LINE_NAMES`, shape (record, line).

    Parameters
    ----------
    level
        Natural logarithm of an envelope spectrum over its floor, shape (record, frequency). Lines beyond its
        end read 0, as high as the floor.
    bins_per_order
        Shape (record,).
    orders
        Where the lines are.
    """
    level = np.pad(level, ((0, 0), (0, 1)))
    base, one = families(orders), np.ones_like(orders.ftf)
    ftf = orders.ftf
    sides = np.stack([one, one, ftf], axis=-1)
    singles = np.stack([orders.bsf, one, 2 * one, ftf, 2 * ftf, one - ftf], axis=-1)
    places = np.concatenate([base, 2 * base, base - sides, base + sides, singles], axis=-1)
    read = single_lines(level, places * bins_per_order[:, None])
    h1, h2, lower, upper, others = np.split(read, [3, 6, 9, 12], axis=-1)
    return np.concatenate(
        [
            combs(level, base * bins_per_order[:, None]),
            h1,
            h2,
            0.5 * (lower + upper),
            others,
            highest_line(level, bins_per_order)[:, None],
        ],
        axis=-1,
    )


def single_lines(level: FloatArray, bins: FloatArray) -> FloatArray:
    """Highest level within the tolerance of each place, shapes (record, frequency) at (record, line)."""
    first = np.rint(bins * (1 - LINE_TOLERANCE)).astype(np.intp)[..., None]
    last = np.rint(bins * (1 + LINE_TOLERANCE)).astype(np.intp)[..., None]
    window = np.minimum(first + np.arange((last - first).max() + 1), last)
    return _pick(level, window).max(axis=-1)


def combs(level: FloatArray, bins: FloatArray) -> FloatArray:
    """Largest mean level of harmonics 1 to 3 over a speed error shared by the three, shape (record, family).

    The error runs over +-2 % in steps that move the third harmonic by one bin.
    """
    step = 1 / (COMB_HARMONICS[-1] * bins)[..., None]
    count = int(np.ceil(2 * COMB_TOLERANCE / step.min())) + 1
    error = np.minimum(-COMB_TOLERANCE + step * np.arange(count), COMB_TOLERANCE)
    total = np.zeros(error.shape)
    for harmonic in COMB_HARMONICS:
        total += _pick(level, np.rint(harmonic * bins[..., None] * (1 + error)).astype(np.intp))
    return total.max(axis=-1) / len(COMB_HARMONICS)


def highest_line(level: FloatArray, bins_per_order: FloatArray) -> FloatArray:
    """Level of the highest line between 0.25 and 12 orders, shape (record,)."""
    low, high = (np.rint(order * bins_per_order)[:, None] for order in HIGHEST_LINE_ORDERS)
    place = np.arange(level.shape[-1])
    return np.where((place >= low) & (place <= high), level, 0.0).max(axis=-1)


def _pick(level: FloatArray, bins: np.ndarray) -> FloatArray:
    flat = np.clip(bins, 0, level.shape[-1] - 1).reshape(len(bins), -1)
    return np.take_along_axis(level, flat, axis=-1).reshape(bins.shape)
