"""Shaft speed of a recording, from signals: the spectra of its windows, and the speed that fits their lines.

``signals -> windows of at most a second -> level of the envelope (mean of all bands) and of the signal -> lines``
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike

from features.signal.demodulation import ZERO_PADDING, analytic_band, spectrum_over_floor
from features.signal.lines import Orders
from features.signal.rows import FloatArray, centre, squared_modulus
from features.signal.spectra import fourier_coefficients
from features.signal.speed import TOLERANCE, ShaftSpeed, find_speed, levels_at, line_orders, near_label
from features.table.band import DEFAULT_BAND
from features.table.record_batch import BATCH, FLOOR_WIDTH, LOWEST_RATE, SHORTEST, bands_of, usable_records

LONGEST = 1.0  # seconds; the lines of a longer signal are narrower than a candidate, and wander with the speed


def shaft_speed(
    x: ArrayLike, fs: float, shaft_rate: float, orders: Sequence[ArrayLike], tolerance: float = TOLERANCE
) -> ShaftSpeed:
    """Shaft speed of one recording, estimated from what repeats in it.

    It searches the speeds within ``tolerance`` of the label for the one at which shaft harmonics and the lines of one
    kind of fault stand out together; it needs no class label. The order of the windows and the gain do not matter.

    Parameters
    ----------
    x
        Windows of one recording, shape (window, time), or one signal, shape (time,). Windows longer than a second are
        cut. Constant windows, and those with values that are not finite, are left out.
    fs
        Sample rate [Hz].
    shaft_rate
        Shaft rate as labelled [Hz].
    orders
        Nominal orders ``ftf, bpfo, bpfi, bsf`` (or `Orders`): numbers, or arrays of one value per window.
    tolerance
        Largest relative error of the label, up to 0.2.

    Raises
    ------
    ValueError
        For a tolerance outside 0.01 to 0.2, or a sample rate or shaft rate that is not a positive number.
    """
    if not 0.01 <= tolerance <= 0.2:
        raise ValueError(f"tolerance: {tolerance} is not in [0.01, 0.2]; give the largest relative error of the label.")
    if not (0 < fs < np.inf and 0 < shaft_rate < np.inf):
        raise ValueError(f"fs and shaft_rate: {fs} and {shaft_rate} are not both positive numbers; give them in Hz.")
    # one window is a recording of one
    x = np.atleast_2d(np.asarray(x))
    each = Orders(*(np.broadcast_to(np.asarray(order, dtype=float), (len(x),)) for order in orders))
    total: FloatArray = np.zeros((1, 1))
    windows = 0
    # levels are averaged over the windows: noise falls, lines stay
    for _, levels in line_levels(x, fs, np.full(len(x), float(shaft_rate)), each, tolerance):
        total, windows = total + levels.sum(axis=0, dtype=float), windows + len(levels)
    return find_speed(total / max(windows, 1), windows, shaft_rate, tolerance)


def line_levels(
    x: FloatArray, fs: float, shaft_rate: FloatArray, orders: Orders, tolerance: float = TOLERANCE
) -> Iterator[tuple[np.ndarray, FloatArray]]:
    """Yield, batch by batch, numbers of records and the levels of their lines at every candidate speed.

    The levels are those of `features.signal.speed.levels_at`, of shape (window, line, candidate). A record that is longer
    than a second gives several windows; one that cannot be used gives none.

    Parameters
    ----------
    x
        Signals, shape (record, time).
    fs
        Sample rate [Hz].
    shaft_rate
        As labelled [Hz], shape (record,).
    orders
        Nominal fault orders, each of shape (record,).
    tolerance
        Largest relative error of the labels.
    """
    # long records are cut: within a piece the speed hardly changes
    pieces = max(1, int(np.ceil(x.shape[-1] / fs / LONGEST - 1e-9)))
    length = x.shape[-1] // pieces
    duration = length / fs
    if fs < LOWEST_RATE or duration < SHORTEST[1]:
        return
    # the same length for all, so that their spectra have the same bins
    cut = x[:, : pieces * length].reshape(-1, length)
    numbers = np.repeat(np.arange(len(x)), pieces)
    rates, nominal = shaft_rate[numbers], Orders(*(order[numbers] for order in orders))
    chosen = np.flatnonzero(usable_records(cut, rates, nominal) & (duration * rates >= SHORTEST[0]))
    # in batches, so that memory does not grow with the number of records
    for start in range(0, len(chosen), BATCH):
        rows = chosen[start : start + BATCH]
        batch = Orders(*(order[rows] for order in nominal))
        yield numbers[rows], _levels(centre(cut[rows]), fs, rates[rows], batch, tolerance)


def _levels(x: FloatArray, fs: float, shaft_rate: FloatArray, orders: Orders, tolerance: float) -> FloatArray:
    """Levels of the lines of the envelope, mean of all bands, and of the signal, shape (window, line, candidate)."""
    in_envelope, in_signal = line_orders(orders)
    highest = (1 + 2 * tolerance) * shaft_rate * in_envelope.max(axis=-1)
    resolution, envelope, signal = level_spectra(x, fs, shaft_rate, float(highest.max()))
    places, factors = shaft_rate[:, None] / resolution, near_label(tolerance)
    both = (levels_at(envelope, in_envelope * places, factors), levels_at(signal, in_signal * places, factors))
    return np.concatenate(both, axis=1)


def level_spectra(x: FloatArray, fs: float, shaft_rate: FloatArray, top: float) -> tuple[float, FloatArray, FloatArray]:
    """Resolution [Hz], and log levels over the floor: of the envelope, mean of all bands, and of the signal.

    The spectra have the shape (record, frequency) and end at ``top`` [Hz], or before. The floor is a running median over
    some orders of the shaft rates, shape (record,).
    """
    duration = x.shape[-1] / fs
    resolution = 1 / (ZERO_PADDING * duration)
    bins = int(top / resolution) + 2
    width = np.maximum(FLOOR_WIDTH[0] * shaft_rate, FLOOR_WIDTH[1]) / resolution
    mean = np.zeros((len(x), bins), np.float32)
    bands = bands_of(fourier_coefficients(x, fs, DEFAULT_BAND.high), duration, fs)
    # the mean over narrow bands needs no choice of the band that a fault excites
    for band in bands:
        z = analytic_band(band, 0, band.shape[-1])
        _, _, level = spectrum_over_floor(np.sqrt(squared_modulus(z)), width, bins)
        mean[:, : level.shape[-1]] += level / len(bands)
    return resolution, mean, spectrum_over_floor(x, width, bins)[2]
