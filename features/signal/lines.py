"""Levels of fault lines over the floor of an envelope spectrum, at orders of the shaft.

A spall modulates the envelope periodically at its fault order. The spectrum then has a line there, its harmonics, and
sidebands at the rate at which the spall passes the load zone [1]_. Speed labels and nominal orders of real machines are
wrong by one or two per cent, so a single line is the highest level within a tolerance, and a comb may shift as a whole.
A few labels are wrong by more; `fitted_combs` are read at the speed that fits the lines best.

.. [1] R. B. Randall, J. Antoni, "Rolling element bearing diagnostics: a tutorial", *Mech. Syst. Signal
       Process.* 25 (2011) 485-520.
"""

from typing import NamedTuple

import numpy as np

from features.signal.rows import FloatArray, row_kernel

LINE_TOLERANCE = 0.015  # relative, of a single line
COMB_TOLERANCE = 0.02  # relative, shared by the harmonics of a comb
COMB_HARMONICS = 3
FITTED_TOLERANCE = 0.08  # relative, of the speed that `fitted_combs` search
FITTED_PENALTY = 7.5  # levels per unit of speed error beyond the tolerance of a comb
FITTED_SPREAD = 0.004  # relative, between families at the fitted speed: slip and contact angle move them apart
HIGHEST_LINE_ORDERS = (0.25, 12.0)  # orders between which the highest line is searched

FAMILIES = ("bpfo", "bpfi", "2bsf")


class Orders(NamedTuple):
    """Nominal fault orders of records, each of shape (record,), in multiples of the shaft rate.

    ``bsf`` is the spin frequency of a ball. Its spall strikes both races in each spin, so its line is ``2 * bsf``.
    """

    ftf: FloatArray
    bpfo: FloatArray
    bpfi: FloatArray
    bsf: FloatArray


def families(orders: Orders) -> FloatArray:
    """Fundamental order of each of `FAMILIES`, shape (record, family)."""
    return np.stack([orders.bpfo, orders.bpfi, 2 * orders.bsf], axis=-1)


def highest_order(orders: Orders) -> FloatArray:
    """Highest order that `read_lines` and `fitted_combs` read, shape (record,)."""
    reach = 1 + FITTED_TOLERANCE + FITTED_SPREAD
    comb = COMB_HARMONICS * reach * families(orders).max(axis=-1)
    return np.maximum(comb, HIGHEST_LINE_ORDERS[1])


def read_lines(level: FloatArray, bins_per_order: FloatArray, orders: Orders) -> FloatArray:
    """Levels of the lines of `features.table.envelope_groups.LINES`, shape (record, line).

    Parameters
    ----------
    level
        Natural logarithm of the ratio of an envelope spectrum to its floor, shape (record, frequency). A line beyond
        the end of the spectrum has the level 0 of the floor.
    bins_per_order
        Bins per order of the shaft, shape (record,).
    orders
        Nominal orders of the lines.
    """
    base, shaft = families(orders), np.ones_like(orders.ftf)
    ftf = orders.ftf
    sides = np.stack([shaft, shaft, ftf], axis=-1)
    singles = np.stack([orders.bsf, shaft, 2 * shaft, ftf, 2 * ftf, shaft - ftf], axis=-1)
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


@row_kernel
def single_lines(level: FloatArray, bins: FloatArray) -> FloatArray:
    """Highest level within the tolerance of each line; ``bins`` and the result have the shape (record, line)."""
    out = np.empty(bins.shape)
    for row in range(bins.shape[0]):
        for line in range(bins.shape[1]):
            first = int(np.rint(bins[row, line] * (1 - LINE_TOLERANCE)))
            last = int(np.rint(bins[row, line] * (1 + LINE_TOLERANCE)))
            highest = _at(level[row], last)
            for place in range(first, last):
                highest = max(highest, _at(level[row], place))
            out[row, line] = highest
    return out


@row_kernel
def combs(level: FloatArray, bins: FloatArray) -> FloatArray:
    """Largest mean level of harmonics 1 to 3 over all speed errors that the three may share, shape (record, family).

    The speed error varies from -2 % to +2 % in steps that move the third harmonic by one bin.
    """
    out = np.empty(bins.shape)
    for row in range(bins.shape[0]):
        for family in range(bins.shape[1]):
            step = 1 / (COMB_HARMONICS * bins[row, family])
            highest = -np.inf
            for number in range(int(np.ceil(2 * COMB_TOLERANCE / step)) + 1):
                error = min(-COMB_TOLERANCE + step * number, COMB_TOLERANCE)
                highest = max(highest, _comb(level[row], bins[row, family] * (1 + error)))
            out[row, family] = highest
    return out


@row_kernel
def fitted_combs(level: FloatArray, bins: FloatArray) -> FloatArray:
    """Combs of all families at one common speed, and the modulus of its relative error, shape (record, family + 1).

    The speed is that within 8 % of the label at which the highest comb of any family is largest, less a penalty that
    grows with the error beyond 2 %. The families are read at this speed within 0.4 %. All have one speed, because a
    tolerance of 8 % of their own would let each find some line.

    Parameters
    ----------
    level
        As for `read_lines`, one row per record.
    bins
        Place of the fundamental line of each family, in bins, shape (record, family).
    """
    out = np.empty((bins.shape[0], bins.shape[1] + 1))
    for row in range(bins.shape[0]):
        steps = int(np.ceil(FITTED_TOLERANCE * COMB_HARMONICS * bins[row].max()))
        step = FITTED_TOLERANCE / steps
        highest, fitted = -np.inf, 0.0
        for number in range(-steps, steps + 1):
            error = step * number
            penalty = FITTED_PENALTY * max(0.0, abs(error) - COMB_TOLERANCE)
            for family in range(bins.shape[1]):
                comb = _comb(level[row], bins[row, family] * (1 + error)) - penalty
                if comb > highest:
                    highest, fitted = comb, error
        around = int(np.ceil(FITTED_SPREAD / step))
        for family in range(bins.shape[1]):
            highest = -np.inf
            for number in range(-around, around + 1):
                error = fitted + FITTED_SPREAD * number / around
                highest = max(highest, _comb(level[row], bins[row, family] * (1 + error)))
            out[row, family] = highest
        out[row, -1] = abs(fitted)
    return out


@row_kernel
def _comb(level: FloatArray, place: float) -> float:
    """Mean level of the harmonics of a line at ``place`` bins."""
    total = 0.0
    for harmonic in range(1, COMB_HARMONICS + 1):
        total += _at(level, int(np.rint(harmonic * place)))
    return total / COMB_HARMONICS


@row_kernel
def highest_line(level: FloatArray, bins_per_order: FloatArray) -> FloatArray:
    """Level of the highest line between 0.25 and 12 orders, at least 0, shape (record,)."""
    out = np.empty(len(level))
    for row in range(len(level)):
        first = int(np.rint(HIGHEST_LINE_ORDERS[0] * bins_per_order[row]))
        last = int(np.rint(HIGHEST_LINE_ORDERS[1] * bins_per_order[row]))
        highest = level.dtype.type(0.0)
        for place in range(first, min(last + 1, level.shape[1])):
            highest = max(highest, level[row, place])
        out[row] = highest
    return out


@row_kernel
def _at(level: FloatArray, place: int) -> float:
    return level[max(place, 0)] if place < len(level) else 0.0
