"""Definitions of features: every column has one, and its values are where the definition says."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from features.table.band import DEFAULT_BAND, Band
from features.table.definitions import GROUPS, define_features
from features.table.indicators import Orders, feature_names, indicators

FS = 12_000.0
TIME = np.arange(6000) / FS
NOISE = np.random.default_rng(0).standard_normal(len(TIME))
EXTREME = {
    "click": np.where(np.arange(len(TIME)) == 3000, 1.0, 0.0),
    "step": np.sign(TIME - 0.2),
    "square": np.sign(np.sin(2 * np.pi * 30.0 * TIME + 0.1)),
    "alternating": np.resize([1.0, -1.0], len(TIME)),
    "tone": np.sin(2 * np.pi * 107.5 * TIME),
    "slow bursts": NOISE * (np.sin(2 * np.pi * 12.0 * TIME) > 0.99),
    "burst": NOISE * np.exp(-(((TIME - 0.25) / 1e-3) ** 2)),
    "heavy tails": np.random.default_rng(1).standard_t(1.1, len(TIME)),
    "train": np.exp(-500 * np.mod(TIME, 1 / 107.5)) * np.sin(2 * np.pi * 3000 * TIME),
}


def assert_in_range(x, rate, band=DEFAULT_BAND):
    orders = Orders(*(np.full(len(x), order) for order in (0.3983, 3.5848, 5.4152, 2.3567)))
    values, names = indicators(x, FS, np.full(len(x), rate), orders, GROUPS, band)
    for column, feature in zip(values.T, define_features(GROUPS, band), strict=True):
        inside = (column >= feature.least - 1e-6) & (column <= feature.most + 1e-6) | np.isnan(column)
        assert inside.all(), f"{feature.name}: {column} is not {feature.range}"
    return dict(zip(names, values.T, strict=True))


@pytest.mark.parametrize("band", [DEFAULT_BAND, Band(300.0, 9000.0), Band(0.0, 1000.0)])
def test_every_column_has_a_definition_of_its_group_in_full(band):
    for group in GROUPS:
        features = define_features((group,), band)
        assert tuple(feature.name for feature in features) == feature_names((group,), band)
        assert {feature.group for feature in features} == {group}
        for feature in features:
            assert all(feature[:7]), feature
            assert feature.least < feature.most


def test_different_features_have_different_names_and_meanings_in_the_order_of_their_groups():
    features = define_features()
    assert (
        len({feature.meaning for feature in features}) == len({feature.name for feature in features}) == len(features)
    )
    assert tuple(dict.fromkeys(feature.group for feature in features)) == GROUPS


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("rate", [5.0, 30.0, 300.0])
def test_extreme_signals_have_features_in_their_ranges(rate, dtype):
    assert_in_range(np.stack([*EXTREME.values()]).astype(dtype), rate)


@settings(max_examples=10)
@given(
    st.integers(0, 2**32 - 1),
    st.floats(5.0, 200.0),
    st.floats(-150, 150),
    st.floats(0.0, 1.0),
    st.sampled_from([*EXTREME]),
    st.sampled_from([DEFAULT_BAND, Band(0.0, 9000.0), Band(2000.0, 3000.0)]),
)
def test_random_signals_have_features_in_their_ranges(seed, rate, decibels, share, extreme, band):
    noise = np.random.default_rng(seed).standard_normal((3, len(TIME)))
    assert_in_range(10 ** (decibels / 20) * (share * noise + (1 - share) * EXTREME[extreme]), rate, band)
