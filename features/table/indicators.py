"""Features of vibration records in four groups: fault lines, envelope shape, band energies, time statistics.

``records -> six whitened analytic signals -> level of their envelope spectra -> lines; moduli -> shape``

The six signals are a broad band (`features.table.band`, 0.3-5 kHz by default) with cepstral pre-whitening, the same band
divided by its power spectral density, and four narrower bands of the latter; another band has its own narrower ones.
Frequencies above the band are not used, so that features depend as little as possible on the recording equipment.
``lines`` and ``shape`` are independent of gain and spectral colour; ``bands`` and ``time`` are not, and depend strongly
on the machine. The lines are those of [1]_.

`features.table.definitions` has the name and definition of every feature. A new group needs its definitions there and a function
in ``GROUP_FEATURES``.

.. [1] R. B. Randall, J. Antoni, "Rolling element bearing diagnostics: a tutorial", *Mech. Syst. Signal
       Process.* 25 (2011) 485-520.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.fft import irfft, next_fast_len

from features.signal.demodulation import ZERO_PADDING, analytic_band, spectrum_over_floor
from features.signal.lines import FAMILIES, Orders, families, fitted_combs, highest_order, read_lines
from features.signal.rows import ComplexArray, FloatArray, centre, squared_modulus
from features.signal.shape import envelope_shape, moments, peaks, time_statistics
from features.signal.spectra import band_energies, fourier_coefficients, power_density, whiten_by_psd, whiten_cepstrally
from features.table.band import DEFAULT_BAND, Band
from features.table.definitions import ENERGY_ORDERS, GROUPS, SHAPES, added_group, define_features
from gen.support.plugins import unusable

__all__ = ["Orders", "feature_names", "indicators"]

WHITENING_WIDTH = 50.0  # Hz
FLOOR_WIDTH = (3.0, 30.0)  # window of the floor: orders of the shaft, and its least width [Hz]

SHORTEST = (2.0, 0.05)  # shaft revolutions and seconds below which a record shows no line
LOWEST_RATE = DEFAULT_BAND.lowest_rate  # Hz

FAINTEST_ENERGY = 1e-12  # of the total energy, 120 dB below it

BATCH = 16  # records computed together, so that their arrays fit into the cache of a core; features do not depend on it

RIVALS = tuple(combinations(range(len(FAMILIES)), 2))


def feature_names(groups: Sequence[str] = GROUPS, band: Band = DEFAULT_BAND) -> tuple[str, ...]:
    """Names of the features of some groups, in the order of the columns of `indicators`.

    Raises
    ------
    ValueError
        For a group that does not exist.
    """
    return tuple(feature.name for feature in define_features(groups, band))


def indicators(
    x: FloatArray,
    fs: float,
    shaft_rate: ArrayLike,
    orders: Sequence[ArrayLike],
    groups: Sequence[str] = GROUPS,
    band: Band = DEFAULT_BAND,
) -> tuple[FloatArray, tuple[str, ...]]:
    """Features of records, and their names.

    All features of a record are NaN if its signal is constant or not finite, or if its shaft rate or one of its orders is
    not a positive number. Its lines and shape are NaN if it is shorter than two shaft revolutions or 0.05 s, or if the
    first narrow band does not end below half of fs (1.5 kHz with the default band).

    Parameters
    ----------
    x
        Signals, shape (record, time).
    fs
        Sample rate [Hz].
    shaft_rate
        One for all records, or shape (record,) [Hz].
    orders
        Nominal orders ``ftf, bpfo, bpfi, bsf``: numbers, or each of shape (record,).
    groups
        Some of `GROUPS`; the columns have their order. ``lines`` and ``shape`` share most of their computation.
    band
        Band that lines and shape are computed from; no feature but those of ``time`` uses frequencies above it.

    Returns
    -------
    Shape (record, feature), and a name for each feature.

    Raises
    ------
    ValueError
        For a group that does not exist.
    """
    names = feature_names(groups, band)
    values = np.full((len(x), len(names)), np.nan)
    rates, *each = (np.broadcast_to(np.asarray(value, float), len(x)) for value in (shaft_rate, *orders))
    usable = np.flatnonzero(usable_records(x, rates, Orders(*each)))
    for start in range(0, len(usable), BATCH):
        rows = usable[start : start + BATCH]
        batch = centre(x[rows])
        nominal = Orders(*(order[rows] for order in each))
        values[rows] = _features(batch, fs, rates[rows], nominal, groups, band)
    return values, names


def usable_records(x: FloatArray, shaft_rate: FloatArray, orders: Orders) -> np.ndarray:
    known = [np.isfinite(values) & (values > 0) for values in (shaft_rate, *orders)]
    highest, lowest = x.max(axis=-1), x.min(axis=-1)
    return np.isfinite(highest) & np.isfinite(lowest) & (highest > lowest) & np.logical_and.reduce(known)


def _features(
    x: FloatArray, fs: float, shaft_rate: FloatArray, orders: Orders, groups: Sequence[str], band: Band
) -> FloatArray:
    by_group: dict[str, FloatArray] = {}
    for group in groups:
        if group not in by_group:  # one function may compute several groups
            compute = GROUP_FEATURES.get(group, partial(_added, group))
            by_group |= compute(x, fs, shaft_rate, orders, band)
    return np.concatenate([by_group[group] for group in groups], axis=-1)


def _added(group: str, x: FloatArray, *others: Any) -> dict[str, FloatArray]:
    """Values of a group of a plug-in."""
    added = added_group(group)
    values, wanted = added.compute(x, *others), (len(x), len(added.features))
    if np.shape(values) != wanted:
        raise unusable(
            "features", group, f"its values have the shape {np.shape(values)} and not {wanted}, (record, feature)"
        )
    return {group: values}


def _lines_and_shape(
    x: FloatArray, fs: float, shaft_rate: FloatArray, orders: Orders, band: Band
) -> dict[str, FloatArray]:
    duration = x.shape[-1] / fs
    lines = np.full((len(x), len(feature_names(("lines",)))), np.nan)
    shape = np.full((len(x), len(feature_names(("shape",)))), np.nan)
    # a line needs some turns of the shaft; shorter records keep NaN
    long_enough = np.flatnonzero(duration * shaft_rate >= SHORTEST[0])
    features = {"lines": lines, "shape": shape}
    if fs < band.lowest_rate or duration < SHORTEST[1] or not long_enough.size:
        return features
    shaft_rate, orders = shaft_rate[long_enough], Orders(*(order[long_enough] for order in orders))
    # one transform of the signal serves all bands
    coefficients = fourier_coefficients(x[long_enough], fs, band.high)
    *read, fitted = _read(bands_of(coefficients, duration, fs, band), duration, shaft_rate, orders)
    line_views, shape_views = map(_views, read)
    # how far a fault family stands above another one
    over = np.stack([line_views[..., a] - line_views[..., b] for a, b in RIVALS], axis=-1)
    lines[long_enough] = np.concatenate([_flat(line_views), _flat(over), fitted], axis=-1)
    shape[long_enough] = np.concatenate([_flat(shape_views), _raw_shape(coefficients)], axis=-1)
    return features


def bands_of(coefficients: ComplexArray, duration: float, fs: float, band: Band = DEFAULT_BAND) -> list[ComplexArray]:
    """Both broad bands of whitened coefficients, and the narrow bands with more than half below the Nyquist frequency."""
    cepstral = whiten_cepstrally(coefficients)
    whitened = whiten_by_psd(coefficients, round(WHITENING_WIDTH * duration))
    narrow = [(whitened, edges) for edges in band.narrow if sum(edges) < fs]
    cuts = [(cepstral, band), (whitened, band), *narrow]
    return [source[:, round(low * duration) : round(high * duration)] for source, (low, high) in cuts]


def _read(
    bands: list[ComplexArray], duration: float, shaft_rate: FloatArray, orders: Orders
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Lines and shape of the envelope of each band, shapes (record, band, value), and combs of their mean level."""
    level, shape, bins_per_order = levels_and_shape(bands, duration, shaft_rate, highest_order(orders))
    each = Orders(*(np.repeat(order, len(bands)) for order in orders))
    lines = read_lines(level.reshape(-1, level.shape[-1]), np.repeat(bins_per_order, len(bands)), each)
    fitted = fitted_combs(level.mean(axis=1), families(orders) * bins_per_order[:, None])
    return lines.reshape(*level.shape[:2], -1), shape, fitted


def levels_and_shape(
    bands: list[ComplexArray], duration: float, shaft_rate: FloatArray, highest: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Envelope spectrum of each band over its floor, and the shape of its envelope.

    Parameters
    ----------
    bands
        Coefficients of each band, as from `bands_of`.
    duration
        Of the records [s].
    shaft_rate
        Shape (record,) [Hz].
    highest
        Order up to which levels are needed, shape (record,).

    Returns
    -------
    Levels as of `log_level`, shape (record, band, bin), 0 beyond the end of a spectrum; values of `envelope_shape`, shape
    (record, band, value); and bins per order, shape (record,).
    """
    resolution = 1 / (ZERO_PADDING * duration)
    bins = int(np.max(highest * shaft_rate) / resolution) + 2
    # the floor spans some lines of the shaft, and at least a width that noise needs
    width = np.maximum(FLOOR_WIDTH[0] * shaft_rate, FLOOR_WIDTH[1]) / resolution
    level = np.zeros((len(shaft_rate), len(bands), bins), np.float32)
    shape = np.empty((len(shaft_rate), len(bands), len(SHAPES)))
    for number, band in enumerate(bands):
        z = analytic_band(band, 0, band.shape[-1])
        power = squared_modulus(z)
        weighted, spectrum, over_floor = spectrum_over_floor(np.sqrt(power), width, bins)
        level[:, number, : over_floor.shape[1]] = over_floor
        shape[:, number] = envelope_shape(power, weighted, spectrum, z.shape[-1] / duration, shaft_rate)
    return level, shape, shaft_rate / resolution


def _views(values: FloatArray) -> FloatArray:
    """Values of both broad bands, and maximum and mean over the narrow bands, shape (record, view, value)."""
    narrow = values[:, 2:]
    return np.stack([values[:, 0], values[:, 1], narrow.max(axis=1), narrow.mean(axis=1)], axis=1)


def _flat(values: FloatArray) -> FloatArray:
    return values.reshape(len(values), -1)


def _raw_shape(coefficients: ComplexArray) -> FloatArray:
    """Kurtosis and crest factor of the signal below the end of the band, shape (record, 2)."""
    n = next_fast_len(2 * coefficients.shape[-1])
    raw = np.asarray(irfft(coefficients, n=n, axis=-1, norm="forward")) + coefficients[:, :1].real
    _, _, square, _, fourth = moments(raw).T
    return np.stack([fourth / square**2, peaks(raw) / np.sqrt(square)], axis=-1)


def _time(x: FloatArray, *_: object) -> dict[str, FloatArray]:
    return {"time": time_statistics(x)}


def _log_energies(x: FloatArray, fs: float, shaft_rate: FloatArray, _: Orders, band: Band) -> dict[str, FloatArray]:
    """Natural logarithm of energies [unit of x squared] in bands of frequency, then in bands of order."""
    frequencies, density = power_density(x, fs)
    density[:, frequencies > band.high] = 0.0
    in_hz = band_energies(density, frequencies, band.energy_edges)
    in_orders = band_energies(density, frequencies, np.multiply.outer(shaft_rate, ENERGY_ORDERS))
    least = FAINTEST_ENERGY * (frequencies[1] - frequencies[0]) * density.sum(axis=-1, keepdims=True)
    energies = np.concatenate([in_hz, in_orders], axis=-1)
    return {"bands": np.log(np.maximum(energies, least + np.finfo(float).tiny))}


GroupFunction = Callable[[FloatArray, float, FloatArray, Orders, Band], dict[str, FloatArray]]
GROUP_FEATURES: Mapping[str, GroupFunction] = {
    "lines": _lines_and_shape,
    "shape": _lines_and_shape,
    "bands": _log_energies,
    "time": _time,
}
"""Function that computes a group, and perhaps others, from signals, sample rate, shaft rates, orders and band."""
