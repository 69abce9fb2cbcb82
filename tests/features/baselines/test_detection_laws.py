"""Laws of detection: intervals hold as often as stated, correlated records tell no more, areas are those of scikit-learn."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binom, binomtest
from sklearn.metrics import roc_auc_score

from features.baselines.detection import FALSE_ALARMS, detection, roc


@pytest.mark.parametrize("chance", [0.1, 0.5, 0.95])
def test_the_interval_holds_at_least_as_often_as_stated(chance):
    """Exact for independent specimens: all numbers of hits, weighted with their probability."""
    n = 12
    held = 0.0
    for hits in range(n + 1):
        (found,) = detection(np.arange(n) < hits, np.full(n, 1e-3), np.arange(n))
        held += binom.pmf(hits, n, chance) * (found.low <= chance <= found.high)
        expected = binomtest(hits, n).proportion_ci(0.95, "exact")
        assert (found.low, found.high) == pytest.approx((expected.low, expected.high))
    assert held >= 0.95


def test_repeated_records_of_a_specimen_tell_no_more_than_one():
    trials = np.arange(100) % 3 > 0, np.full(100, 1e-3), np.arange(100)
    (one,), (many,) = (detection(*(np.repeat(x, n) for x in trials)) for n in (1, 7))
    assert (many.records, many.specimens) == (700, 100)
    assert (many.low, many.high) == pytest.approx((one.low, one.high))


def test_records_without_a_width_are_left_out():
    width = np.array([np.nan, 0.0, 1e-3])
    assert [one.records for one in detection(np.array([0, 0, 1]), width, np.arange(3))] == [1]
    assert detection(np.array([0, 0]), width[:2], np.arange(2)) == ()


@given(st.lists(st.tuples(st.booleans(), st.integers(0, 5)), min_size=2, max_size=40))
def test_the_area_is_that_of_scikit_learn_and_the_curve_rises_to_one(records):
    faulty, level = np.array(records).T
    faulty = faulty.astype(bool)
    found = roc(faulty, level / 5, np.arange(len(level)), seed=0)
    if len(np.unique(faulty)) < 2:
        assert found is None
        return
    assert found.area == pytest.approx(roc_auc_score(faulty, level))
    for share, alarms in zip(found.detected, FALSE_ALARMS, strict=True):
        thresholds = [t for t in (*np.unique(level), 9) if np.mean(level[~faulty] >= t) <= alarms]
        assert share == pytest.approx(np.mean(level[faulty] >= min(thresholds)))


def test_the_interval_of_the_area_is_narrowed_by_specimens_and_not_by_their_records():
    rng = np.random.default_rng(0)
    faulty = np.arange(60) % 2 == 1
    level = faulty + rng.standard_normal(60)
    one, many = (roc(*(np.repeat(x, n) for x in (faulty, level, np.arange(60))), seed=0) for n in (1, 9))
    assert many.interval == pytest.approx(one.interval)
    assert many.low == pytest.approx(one.low)
    low, high = one.interval
    assert low < one.area < high
    assert roc(faulty, level, np.where(faulty, 0, np.arange(60)), seed=0).interval is None
