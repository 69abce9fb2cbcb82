"""Laws of survival curves: the truth lies in their bands, and censored or late bearings do not bias them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from raceway.lives.survival import kaplan_meier, weibull, weibull_median_left

SLOPE, SCALE = 10 / 9, 1000.0
MEDIAN = SCALE * np.log(2) ** (1 / SLOPE)


def drawn(rng, count, late=0.0):
    """Entry, end and failure of lives with censoring at random, those that failed before they entered left out."""
    life, entry = SCALE * rng.weibull(SLOPE, 4 * count), late * rng.random(4 * count)
    seen = np.flatnonzero(life > entry)[:count]
    life, entry = life[seen], entry[seen]
    out = entry + 2000 * rng.random(count)
    return entry, np.minimum(life, out), life <= out


@pytest.mark.parametrize("late", [0.0, 300.0, 1000.0])
def test_the_true_survival_is_inside_its_band_in_nearly_all_runs(late):
    inside = 0
    for seed in range(2000):  # the share of 400 runs is known to 1 %
        curve = kaplan_meier(*drawn(np.random.default_rng(seed), 60, late))
        place = np.searchsorted(curve.time, MEDIAN, side="right") - 1
        low, high = curve.band()
        inside += low[place] <= 0.5 <= high[place]
    assert inside / 2000 >= 0.93


def test_without_censoring_the_curve_is_the_share_that_lives():
    life = np.random.default_rng(1).weibull(1.5, 100)
    curve = kaplan_meier(np.zeros(100), life, np.ones(100, bool))
    np.testing.assert_allclose(curve.share, 1 - np.arange(1, 101) / 100, atol=1e-12)
    assert curve.at(np.array([0.0]))[0] == 1


@pytest.mark.parametrize("late", [0.0, 300.0])
def test_the_weibull_fit_finds_the_distribution_of_censored_lives(late):
    slope, scale = weibull(*drawn(np.random.default_rng(2), 20_000, late))
    assert slope == pytest.approx(SLOPE, rel=0.03)
    assert scale == pytest.approx(SCALE, rel=0.03)


@given(st.floats(0.5, 3), st.floats(0, 3000))
def test_half_of_the_weibull_bearings_outlive_their_median(slope, age):
    left = weibull_median_left(slope, SCALE, np.array([age]))[0]
    survived = np.exp((age / SCALE) ** slope - ((age + left) / SCALE) ** slope)
    assert survived == pytest.approx(0.5)
