"""Laws of detection: a known curve is recovered and covered, correlated records tell no more, areas are those of scikit-learn."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import expit
from sklearn.metrics import roc_auc_score

from features.baselines.detection import FALSE_ALARMS, detection, fit_detection, roc

A50, SLOPE = 0.5e-3, 3.0  # m, and of the logit over ln(width)
A90 = A50 * np.exp(np.log(9) / SLOPE)


def inspected(records, seed):
    """Widths [m] and detections of records, a specimen each."""
    rng = np.random.default_rng(seed)
    width = 1e-3 * np.exp(rng.uniform(np.log(0.1), np.log(3), records))
    detected = rng.random(records) < expit(SLOPE * np.log(width / A50))
    return detected.astype(float), width, np.arange(records)


def test_a_known_curve_is_recovered():
    fit = fit_detection(*inspected(20_000, seed=0))
    assert fit.slope == pytest.approx(SLOPE, rel=0.05)
    assert 1e-3 * np.exp(-fit.intercept / fit.slope) == pytest.approx(A50, rel=0.03)
    assert fit.a90 == pytest.approx(A90, rel=0.03)
    assert fit.a90 < fit.a90_95 < 1.1 * fit.a90
    low, middle, _ = fit.band(np.array([fit.a90_95, fit.a90]))
    assert (low[0], middle[1]) == pytest.approx((0.9, 0.9))


def test_each_edge_of_the_band_and_a90_95_hold_about_as_often_as_stated():
    widths = np.array([0.3e-3, A50, A90])
    true = expit(SLOPE * np.log(widths / A50))
    found = [fit_detection(*inspected(80, seed)) for seed in range(400)]
    bands = np.array([fit.band(widths) for fit in found])
    assert 0.92 < np.mean(bands[:, 0] <= true) < 0.98
    assert 0.92 < np.mean(bands[:, 2] >= true) < 0.98
    assert 0.92 < np.mean([fit.a90_95 is None or fit.a90_95 >= A90 for fit in found]) < 0.99


def test_repeated_records_of_a_specimen_tell_no_more_than_one():
    detected, width, specimen = inspected(100, seed=1)
    one, many = (
        fit_detection(detected, width, specimen),
        fit_detection(*(np.repeat(x, 7) for x in (detected, width, specimen))),
    )
    assert many.covariance == pytest.approx(one.covariance, rel=1e-4)
    assert many.a90_95 == pytest.approx(one.a90_95, rel=1e-4)


@pytest.mark.parametrize("detected", [[1, 1, 1, 1], [0, 0, 0, 0], [0, 0, 1, 1]])
def test_without_overlap_there_are_observed_shares_and_no_fit(detected):
    found = detection(np.array(detected), np.array([1, 2, 3, 4]) * 1e-3, np.arange(4))
    assert found.fit is None
    assert [one.detected for one in found.bins] == detected


def test_records_without_a_width_are_left_out():
    width = np.array([np.nan, 0.0, 1e-3])
    assert [one.records for one in detection(np.array([0, 0, 1]), width, np.arange(3)).bins] == [1]
    assert detection(np.array([0, 0]), width[:2], np.arange(2)) is None


@given(st.lists(st.tuples(st.booleans(), st.integers(0, 5)), min_size=2, max_size=40))
@settings(deadline=None)
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
