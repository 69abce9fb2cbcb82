"""Input of networks: levels of envelope spectra at multiples of the fault orders of the bearing.

A spall has its lines at multiples of one fault order. On this grid they lie at the same places for every bearing, speed
and sample rate, so a network needs to learn no geometry; filters shared by all families learn what a comb looks like.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from features.signal.lines import FAMILIES, Orders, families
from features.signal.rows import FloatArray, centre, row_kernel
from features.signal.spectra import fourier_coefficients
from features.table.band import DEFAULT_BAND
from features.table.record_batch import BATCH, SHORTEST, bands_of, levels_and_shape, usable_records

CELLS = 48  # per multiple of an order
MULTIPLES = 3.3  # end of the grid
GRID = np.arange(1, int(MULTIPLES * CELLS) + 1) / CELLS
FAMILY_NAMES = (*FAMILIES, "2fr")  # harmonics of the shaft lie at multiples of one half
BANDS = 2 + len(DEFAULT_BAND.narrow)


def envelope_orders(x: Any, operating: Mapping[str, ArrayLike]) -> FloatArray:
    """Levels of envelope spectra over their floors at multiples of the fault orders, in single precision.

    A level is the natural logarithm of the highest line in one cell of the grid `GRID`: 158 multiples from 1/48 to 3.3.

    Parameters
    ----------
    x
        Signals, shape (record, time): an array, or `Waveforms` sampled at equal times, which are read batch by batch.
    operating
        ``sample_rate`` [Hz], ``shaft_rate`` [Hz], ``ftf``, ``bpfo``, ``bpfi`` and ``bsf`` [orders], each one number or of shape
        (record,); the sample rate must be the same for all. More names may be there, as in ``Waveforms.operating``.

    Returns
    -------
    Shape (record, family, band, multiple): the families BPFO, BPFI, 2 BSF and twice the shaft rate; and the broad band after
    cepstral pre-whitening, the same divided by its power spectral density, and four narrower bands, as in
    `features.table.indicators`. The levels are 0 where there is no spectrum: beyond half the sample rate, and for records that are
    constant, not finite, shorter than two turns or 0.05 s, or whose shaft rate or orders are not positive numbers.
    """
    levels = np.zeros((len(x), len(FAMILY_NAMES), BANDS, len(GRID)), np.float32)
    names = ("sample_rate", "shaft_rate", *Orders._fields)
    columns = [np.broadcast_to(np.asarray(operating[name], float), len(x)) for name in names]
    # in batches, so that memory does not grow with the number of signals
    for start in range(0, len(x), BATCH):
        rows = slice(start, start + BATCH)
        signals, (fs, rates, *nominal) = x[rows], (column[rows] for column in columns)
        duration = signals.shape[-1] / fs
        # levels of a record that cannot show lines stay 0, that of the floor
        usable = usable_records(signals, rates, Orders(*nominal)) & (duration * rates >= SHORTEST[0])
        usable &= duration >= SHORTEST[1]
        if usable.any():
            read = _levels(signals[usable], fs[0], rates[usable], Orders(*(order[usable] for order in nominal)))
            levels[start : start + BATCH, :, : read.shape[2]][usable] = read
    return levels


def _levels(x: FloatArray, fs: float, shaft_rate: FloatArray, orders: Orders) -> FloatArray:
    duration = x.shape[-1] / fs
    of_families = np.column_stack([families(orders), np.full(len(x), 2.0)])
    bands = bands_of(fourier_coefficients(centre(x), fs, DEFAULT_BAND.high), duration, fs)
    highest = (MULTIPLES + 1 / CELLS) * of_families.max(axis=1)
    level, _, bins_per_order = levels_and_shape(bands, duration, shaft_rate, highest)
    return _highest(level, of_families * bins_per_order[:, None], GRID, 0.5 / CELLS)


@row_kernel
def _highest(level: FloatArray, bins: FloatArray, grid: FloatArray, half: float) -> FloatArray:
    """Highest level within ``half`` of each multiple of a family at ``bins``, shape (record, family, band, multiple)."""
    out = np.zeros((level.shape[0], bins.shape[1], level.shape[1], len(grid)), level.dtype)
    for row in range(level.shape[0]):
        for family in range(bins.shape[1]):
            for cell in range(len(grid)):
                first = int(np.rint((grid[cell] - half) * bins[row, family]))
                last = min(int(np.rint((grid[cell] + half) * bins[row, family])), level.shape[2] - 1)
                for band in range(level.shape[1]):
                    if first <= last:
                        out[row, family, band, cell] = level[row, band, first : last + 1].max()
    return out
