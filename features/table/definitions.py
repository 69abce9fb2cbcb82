"""All feature groups, built-in and of plug-ins, and the definition of every feature: name, meaning, formula, unit, source and range.

Columns of tables have the names and the order of `define_features`.

In formulas, x is the signal without its mean, E the mean over time, fr the shaft rate, and z the analytic signal of the
band of a view. ``L(f) = ln(A(f) / floor(f))``: A is the amplitude spectrum of the envelope ``|z|``, and its floor is its
running median over 3 fr, at least 30 Hz.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from features.table.band import DEFAULT_BAND, checked_band
from features.table.envelope_groups import LINE_GROUP, SHAPE_GROUP, VIEWS
from features.table.feature_group import Feature, FeatureGroup
from features.table.waveform_groups import ENERGY_GROUP, TIME_GROUP
from gen.support.plugins import plugin, plugins, unusable

BUILT_IN: Mapping[str, FeatureGroup] = {
    "lines": LINE_GROUP,
    "shape": SHAPE_GROUP,
    "bands": ENERGY_GROUP,
    "time": TIME_GROUP,
}
GROUPS = tuple(BUILT_IN)
"""Groups of a table for which none are named, so that no package that is installed changes it."""
ALL_GROUPS = (*GROUPS, *plugins("features"))

for _name in plugins("features"):
    if _name in GROUPS:
        raise unusable("features", _name, f"{_name} is taken")


def find_group(name: str) -> FeatureGroup:
    """The group of a name in `ALL_GROUPS`.

    Raises
    ------
    RacewayError
        If it belongs to a plug-in that cannot be loaded, or the name of one of its features is taken.
    """
    if name in BUILT_IN:
        return BUILT_IN[name]
    group: FeatureGroup = plugin("features", name, FeatureGroup)
    taken = {feature.name for feature in define_features()}
    if same := taken & {feature.name for feature in group.features_in(DEFAULT_BAND)}:
        raise unusable("features", name, f"{min(same)} is taken")
    return group


def define_features(groups: Sequence[str] = GROUPS, band: tuple[float, float] = DEFAULT_BAND) -> tuple[Feature, ...]:
    """Definitions of the features of some groups, in the order of the columns of `features.table.indicators.indicators`.

    Raises
    ------
    ValueError
        For a group that does not exist, or a band that is too narrow or out of range.
    """
    unknown = [name for name in groups if name not in ALL_GROUPS]
    if unknown or isinstance(groups, str):
        raise ValueError(f"groups: {groups!r} is not a list of feature groups; choose from {', '.join(ALL_GROUPS)}.")
    edges = checked_band(*band)
    return tuple(feature._replace(group=name) for name in groups for feature in find_group(name).features_in(edges))


def measured_quantity(feature: str) -> str:
    """Name of a feature without its view, since features of one quantity tell much the same.

    >>> measured_quantity("bands_max_bpfi_comb"), measured_quantity("raw_kurtosis")
    ('bpfi_comb', 'raw_kurtosis')
    """
    view = next((view for view in (*VIEWS, "fitted") if feature.startswith(f"{view}_")), "")
    return feature.removeprefix(f"{view}_")


def feature_coordinates(
    groups: Sequence[str] = GROUPS, band: tuple[float, float] = DEFAULT_BAND
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
