"""Definition of every feature: name, meaning, formula, group, unit, parameters, source and range.

Columns of tables have the names and the order of `define_features`. Features of envelopes are computed in four `VIEWS`
of the signal, so their definitions are composed of a view and of a line or shape.

In formulas, x is the signal without its mean, E the mean over time, fr the shaft rate, and z the analytic signal of the
band of a view. ``L(f) = ln(A(f) / floor(f))``: A is the amplitude spectrum of the envelope ``|z|``, and its floor is its
running median over 3 fr, at least 30 Hz.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import combinations, pairwise
from math import inf
from typing import NamedTuple

import numpy as np

from features.signal.lines import FAMILIES, FITTED_TOLERANCE
from features.table.band import DEFAULT_BAND, Band
from gen.support.plugins import plugin, plugins, unusable

ENERGY_ORDERS = (0.5, 1.5, 2.5, 3.5, 5.5, 10.5, 20.5, 40.5)

VIEWS: Mapping[str, str] = {
    "cepstral": "in the band whitened by its cepstrum",
    "whitened": "in the band divided by the root of its power spectral density",
    "bands_max": "highest of the narrow whitened bands",
    "bands_mean": "mean of the narrow whitened bands",
}
"""Meaning of each view of the signal that features of envelopes are computed in."""


class Feature(NamedTuple):
    """Definition of a feature; its values lie between ``least`` and ``most``, or are NaN."""

    name: str
    meaning: str
    formula: str
    group: str = ""
    unit: str = "1"
    parameters: str = ""
    source: str = ""
    least: float = -inf
    most: float = inf

    @property
    def range(self) -> str:
        """Range as text."""
        if self.most < inf:
            return f"{self.least:g} to {self.most:g}"
        return f">= {self.least:g}" if self.least > -inf else "any"


RANDALL = "Randall, Vibration-based Condition Monitoring (2021)"
_level = partial(
    Feature,
    group="lines",
    unit="Np",
    parameters="band, shaft rate, fault orders",
    source="Randall and Antoni, MSSP 25 (2011)",
)
_shape = partial(Feature, group="shape", unit="1", parameters="band, shaft rate", source=RANDALL, least=0.0)
_raw = partial(Feature, group="shape", unit="1", parameters="end of the band", source=RANDALL, least=1.0)
_energy = partial(
    Feature, group="bands", unit="ln(re 1 m2 s-4)", source="Welch, IEEE Trans. Audio Electroacoust. 15 (1967)"
)
_time = partial(
    Feature, group="time", unit="1", parameters="none", source="Lei et al., Expert Syst. Appl. 35 (2008)", least=1.0
)

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
TIMES = (
    _time("rms", "root mean square", "sqrt(E x^2)", unit="m s-2", least=0.0),
    _time("peak", "largest modulus", "max|x|", unit="m s-2", least=0.0),
    _time("crest_factor", "peak over rms", "max|x| / sqrt(E x^2)"),
    _time("kurtosis", "fourth moment over the squared second, 3 for Gaussian noise", "E x^4 / (E x^2)^2"),
    _time("skewness", "third moment over the cubed rms, 0 for Gaussian noise", "E x^3 / (E x^2)^1.5", least=-inf),
    _time("shape_factor", "rms over the mean modulus", "sqrt(E x^2) / E|x|"),
    _time("impulse_factor", "peak over the mean modulus", "max|x| / E|x|"),
    _time("clearance_factor", "peak over the squared mean root of the modulus", "max|x| / (E sqrt|x|)^2"),
)


def _energies(band: Band) -> Iterator[Feature]:
    """Yield the energies between frequencies, and then those between orders."""
    for edges, unit, place, parameters in (
        (band.energy_edges, "Hz", "Hz", "band"),
        (ENERGY_ORDERS, "orders", "fr", "end of the band, shaft rate"),
    ):
        for low, high in pairwise(edges):
            yield _energy(
                f"energy_{low:g}-{high:g}_{unit}",
                f"logarithm of the energy from {low:g} to {high:g} {place}",
                "ln of the integral of the power spectral density over the band",
                parameters=parameters,
            )


def _in_views(features: Iterable[Feature]) -> Iterator[Feature]:
    """Yield features of every view."""
    for view, where in VIEWS.items():
        for feature in features:
            yield feature._replace(name=f"{view}_{feature.name}", meaning=f"{feature.meaning}, {where}")


_OF_EVERY_BAND = {
    "lines": (*_in_views(LINES), *_in_views(RIVALS), *FITTED),
    "shape": (*_in_views(SHAPES), *RAW),
    "time": tuple(feature._replace(name=f"time_{feature.name}") for feature in TIMES),
}
GROUPS = ("lines", "shape", "bands", "time")
"""Groups of a table for which none are named, so that no package that is installed changes it."""
ALL_GROUPS = (*GROUPS, *plugins("features"))

for _name in plugins("features"):
    if _name in GROUPS:
        raise unusable("features", _name, f"{_name} is taken")


class FeatureGroup(NamedTuple):
    """A group of features of a plug-in."""

    features: tuple[Feature, ...]
    """In the order of the values."""
    compute: Callable[..., np.ndarray]
    """Values, shape (record, feature), of signals without their mean, shape (record, time), sample rate, shaft rates, orders and band."""


def added_group(group: str) -> FeatureGroup:
    """Group of a plug-in.

    Raises
    ------
    RacewayError
        If the name of one of its features is taken.
    """
    added = plugin("features", group, FeatureGroup)
    if same := {feature.name for feature in define_features()} & {feature.name for feature in added.features}:
        raise unusable("features", group, f"{min(same)} is taken")
    return added


def define_features(groups: Sequence[str] = GROUPS, band: Band = DEFAULT_BAND) -> tuple[Feature, ...]:
    """Definitions of the features of some groups, in the order of the columns of `features.table.indicators.indicators`.

    Raises
    ------
    ValueError
        For a group that does not exist.
    """
    unknown = [group for group in groups if group not in ALL_GROUPS]
    if unknown or isinstance(groups, str):
        message = f"groups: {groups!r} is not a list of feature groups; choose from {', '.join(ALL_GROUPS)}."
        raise ValueError(message)
    return tuple(feature for group in groups for feature in _features_of(group, band))


def _features_of(group: str, band: Band) -> Iterable[Feature]:
    if group not in GROUPS:
        return (feature._replace(group=group) for feature in added_group(group).features)
    return _OF_EVERY_BAND.get(group) or _energies(band)


def measured_quantity(feature: str) -> str:
    """Name of a feature without its view, since features of one quantity tell much the same.

    >>> measured_quantity("bands_max_bpfi_comb"), measured_quantity("raw_kurtosis")
    ('bpfi_comb', 'raw_kurtosis')
    """
    view = next((view for view in (*VIEWS, "fitted") if feature.startswith(f"{view}_")), "")
    return feature.removeprefix(f"{view}_")


def feature_coordinates(
    groups: Sequence[str] = GROUPS, band: Band = DEFAULT_BAND
) -> dict[str, tuple[str, np.ndarray, dict[str, str]]]:
    """Coordinates of the dimension ``feature`` of a table: its name, group, unit and meaning."""
    features = define_features(groups, band)
    columns = {
        "feature": ([feature.name for feature in features], "name of the feature"),
        "group": ([feature.group for feature in features], "group of the feature"),
        "units": ([feature.unit for feature in features], "unit of the feature"),
        "long_name": ([feature.meaning for feature in features], "meaning of the feature"),
    }
    return {
        name: ("feature", np.array(texts, dtype=object), {"long_name": about})
        for name, (texts, about) in columns.items()
    }
