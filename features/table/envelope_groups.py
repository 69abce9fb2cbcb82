"""Groups ``lines`` and ``shape``: levels of fault lines, and shape of the signal, in envelopes of whitened bands.

``envelopes of a batch -> lines, shape of each band -> features in four views``

Both are independent of gain and spectral colour. The lines are those of [1]_. Features are computed in four `VIEWS` of
the signal, so their definitions are composed of a view and of a line or shape.

.. [1] R. B. Randall, J. Antoni, "Rolling element bearing diagnostics: a tutorial", *Mech. Syst. Signal
       Process.* 25 (2011) 485-520.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from itertools import combinations

import numpy as np
from scipy.fft import irfft, next_fast_len

from features.signal.lines import FAMILIES, FITTED_TOLERANCE, Orders, families, fitted_combs, read_lines
from features.signal.rows import ComplexArray, FloatArray
from features.signal.shape import moments, peaks
from features.table.feature_group import Feature, FeatureGroup
from features.table.record_batch import Envelopes, RecordBatch

VIEWS: Mapping[str, str] = {
    "cepstral": "in the band whitened by its cepstrum",
    "whitened": "in the band divided by the root of its power spectral density",
    "bands_max": "highest of the narrow whitened bands",
    "bands_mean": "mean of the narrow whitened bands",
}
"""Meaning of each view of the signal that features of envelopes are computed in."""

_level = partial(
    Feature, unit="Np", parameters="band, shaft rate, fault orders", source="Randall and Antoni, MSSP 25 (2011)"
)
RANDALL = "Randall, Vibration-based Condition Monitoring (2021)"
_shape = partial(Feature, parameters="band, shaft rate", source=RANDALL, least=0.0)
_raw = partial(Feature, parameters="band end", source=RANDALL, least=1.0)

_ORDERS = dict(zip(FAMILIES, ("BPFO", "BPFI", "2 BSF"), strict=True))
_SIDES = dict(zip(FAMILIES, ("fr", "fr", "FTF"), strict=True))
_SINGLES = {"bsf": "BSF", "fr": "fr", "2fr": "2 fr", "ftf": "FTF", "2ftf": "2 FTF", "fr-ftf": "fr - FTF"}


def _single(name: str, line: str) -> Feature:
    return _level(name, f"level of the line at {line}", f"max L(f), f within 1.5 % of {line}")


LINES = (
    *(
        _level(
            f"{family}_comb",
            f"mean level of harmonics 1 to 3 of {line}",
            f"max (L(f) + L(2 f) + L(3 f)) / 3, f within 2 % of {line}",
        )
        for family, line in _ORDERS.items()
    ),
    *(_single(f"{family}_h1", line) for family, line in _ORDERS.items()),
    *(_single(f"{family}_h2", f"2 x {line}") for family, line in _ORDERS.items()),
    *(
        _level(
            f"{family}_sidebands",
            f"mean level of the sidebands of {line} at {_SIDES[family]}",
            f"(max L(f) + max L(g)) / 2, f and g within 1.5 % of {line} -/+ {_SIDES[family]}",
        )
        for family, line in _ORDERS.items()
    ),
    *(_single(name, line) for name, line in _SINGLES.items()),
    _level(
        "highest_line",
        "level of the highest line between 0.25 and 12 fr",
        "max(0, L(f)), f from 0.25 to 12 fr",
        parameters="band, shaft rate",
        least=0.0,
    ),
)
RIVALS = tuple(
    _level(f"{a}_over_{b}", f"comb of {_ORDERS[a]} less the comb of {_ORDERS[b]}", f"{a}_comb - {b}_comb")
    for a, b in combinations(FAMILIES, 2)
)
FITTED = (
    *(
        _level(
            f"fitted_{family}_comb",
            f"mean level of harmonics 1 to 3 of {line} at the speed that fits the lines best, mean of all bands",
            f"max (M(f) + M(2 f) + M(3 f)) / 3, f within 0.4 % of (1 + e) {line}, M: mean of L over the bands",
        )
        for family, line in _ORDERS.items()
    ),
    _level(
        "fitted_speed_error",
        "relative distance of the speed that fits the lines best from the labelled speed",
        "|e|, e: where the highest comb of M less 7.5 max(0, |e| - 2 %) is largest, within 8 %",
        unit="1",
        least=0.0,
        most=FITTED_TOLERANCE,
    ),
)
SHAPES = (
    _shape(
        "impulsiveness",
        "logarithm of the kurtosis of the analytic signal, 0.69 for Gaussian noise",
        "ln(E|z|^4 / (E|z|^2)^2)",
        parameters="band",
        source="Antoni, MSSP 20 (2006)",
    ),
    _shape(
        "slow_fluctuation",
        "relative standard deviation of the power averaged over half a revolution",
        "std(P) / E|z|^2, P: mean of |z|^2 over 0.5 / fr",
    ),
    _shape(
        "slow_share",
        "share of the power of the envelope below 0.8 fr",
        "sum of A(f)^2 below 0.8 fr over the sum of all",
        most=1.0,
    ),
)
RAW = (
    _raw("raw_kurtosis", "kurtosis of the signal below the end of the band", "E x^4 / (E x^2)^2"),
    _raw("raw_crest_factor", "peak over rms of the signal below the end of the band", "max|x| / sqrt(E x^2)"),
)


def _in_views(features: Iterable[Feature]) -> Iterator[Feature]:
    """Yield features of every view."""
    for view, where in VIEWS.items():
        for feature in features:
            yield feature._replace(name=f"{view}_{feature.name}", meaning=f"{feature.meaning}, {where}")


def without_view(feature: Feature) -> Feature:
    """A feature with the word VIEW in place of its view; one of no view as it is.

    >>> without_view(next(_in_views(LINES))).name
    'VIEW_bpfo_comb'
    """
    for view, where in VIEWS.items():
        if feature.name.startswith(f"{view}_"):
            return feature._replace(
                name=feature.name.replace(view, "VIEW", 1), meaning=feature.meaning.removesuffix(f", {where}")
            )
    return feature


def _line_values(envelopes: Envelopes) -> FloatArray:
    """Levels of lines in each view, differences of combs in each view, and combs at the speed that fits best."""
    level, orders, bins_per_order = envelopes.level, envelopes.orders, envelopes.bins_per_order
    records, bands, _ = level.shape
    each = Orders(*(np.repeat(order, bands) for order in orders))
    read = read_lines(level.reshape(records * bands, -1), np.repeat(bins_per_order, bands), each)
    views = _views(read.reshape(records, bands, -1))
    # how far a fault family stands above another one
    pairs = combinations(range(len(FAMILIES)), 2)
    over = np.stack([views[..., a] - views[..., b] for a, b in pairs], axis=-1)
    fitted = fitted_combs(level.mean(axis=1), families(orders) * bins_per_order[:, None])
    return np.concatenate([_flat(views), _flat(over), fitted], axis=-1)


def _shape_values(envelopes: Envelopes) -> FloatArray:
    """Shape of the envelope in each view, and of the signal below the end of the band."""
    return np.concatenate([_flat(_views(envelopes.shape)), _raw_shape(envelopes.coefficients)], axis=-1)


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


def _group(features: tuple[Feature, ...], compute: Callable[[Envelopes], FloatArray]) -> FeatureGroup:
    """Group whose values are NaN in records that cannot show lines."""

    def compute_or_nan(batch: RecordBatch) -> FloatArray:
        values = np.full((len(batch.x), len(features)), np.nan)
        if batch.with_lines.size:
            values[batch.with_lines] = compute(batch.envelopes)
        return values

    return FeatureGroup(features, compute_or_nan)


LINE_GROUP = _group((*_in_views(LINES), *_in_views(RIVALS), *FITTED), _line_values)
SHAPE_GROUP = _group((*_in_views(SHAPES), *RAW), _shape_values)
