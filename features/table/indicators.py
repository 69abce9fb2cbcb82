"""Features of vibration records, computed batch by batch: those of `features.table.definitions`, in the order of its groups."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from features.signal.arguments import no_orders, one_or_each
from features.signal.lines import Orders
from features.signal.rows import FloatArray, centre
from features.table.band import DEFAULT_BAND, checked_band
from features.table.definitions import BUILT_IN, GROUPS, define_features, find_group
from features.table.feature_group import FeatureGroup
from features.table.record_batch import BATCH, RecordBatch, usable_records
from gen.support.plugins import unusable

__all__ = ["Orders", "feature_names", "indicators"]


def feature_names(groups: Sequence[str] = GROUPS, band: tuple[float, float] = DEFAULT_BAND) -> tuple[str, ...]:
    """Names of the features of some groups, in the order of the columns of `indicators`.

    Raises
    ------
    ValueError
        As `define_features`.
    """
    return tuple(feature.name for feature in define_features(groups, band))


def indicators(
    x: FloatArray,
    fs: float,
    shaft_rate: ArrayLike,
    orders: Sequence[ArrayLike],
    groups: Sequence[str] = GROUPS,
    band: tuple[float, float] = DEFAULT_BAND,
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
        Band that lines and shape are computed from [Hz], such as ``(300, 9000)``; no feature but those of ``time`` uses frequencies
        above it.

    Returns
    -------
    Shape (record, feature), and a name for each feature.

    Raises
    ------
    ValueError
        For a group that does not exist, arrays of other shapes, or a band that is too narrow or out of range.
    """
    band, x = checked_band(*band), np.asarray(x)
    if x.ndim != 2:
        raise ValueError(f"x: an array of shape {x.shape} is given in place of (record, time).")
    if isinstance(orders, str) or not hasattr(orders, "__len__") or len(orders) != len(Orders._fields):
        raise no_orders(orders, "orders")
    names = feature_names(groups, band)
    # the groups of plug-ins are checked once, and not in each batch
    chosen = [(name, find_group(name)) for name in groups]
    values = np.full((len(x), len(names)), np.nan)
    rates = one_or_each(shaft_rate, "shaft_rate", len(x))
    each = [one_or_each(order, "orders", len(x)) for order in orders]
    usable = np.flatnonzero(usable_records(x, rates, Orders(*each)))
    for start in range(0, len(usable), BATCH):
        rows = usable[start : start + BATCH]
        nominal = Orders(*(order[rows] for order in each))
        batch = RecordBatch(centre(x[rows]), fs, rates[rows], nominal, band)
        values[rows] = np.concatenate([_values(name, group, batch) for name, group in chosen], axis=-1)
    return values, names


def _values(name: str, group: FeatureGroup, batch: RecordBatch) -> FloatArray:
    """Values of a group, shape (record, feature); those of a plug-in are checked."""
    values, shape = group.compute(batch), (len(batch.x), len(group.features_in(batch.band)))
    if name not in BUILT_IN and np.shape(values) != shape:
        raise unusable(
            "features", name, f"its values have the shape {np.shape(values)} and not {shape}, (record, feature)"
        )
    return values
