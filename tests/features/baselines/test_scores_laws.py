"""Laws of scores and detection: counts, invariances, and intervals that only independent specimens narrow."""

import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.stats import binom, binomtest
from sklearn.metrics import log_loss, roc_auc_score

from features.baselines.calibration import UNCALIBRATED
from features.baselines.detection import FALSE_ALARMS, detection, roc
from features.baselines.predictions import predictions
from features.baselines.records import Records
from features.baselines.scores import (
    area,
    balanced_log_loss,
    ends_of,
    expected_calibration_error,
    interval_text,
    no_width_text,
    reliability_bins,
    resampled_recall,
    score,
)
from gen.corpus import FAULTS


@st.composite
def labelled(draw):
    """Fault, prediction and specimen of some records; a prediction may be a class that is absent."""
    size = draw(st.integers(1, 60))
    present = draw(st.sets(st.integers(0, 3), min_size=1))
    fault = draw(arrays(np.intp, size, elements=st.sampled_from(sorted(present))))
    predicted = draw(arrays(np.intp, size, elements=st.integers(0, 3)))
    specimen = draw(arrays(np.intp, size, elements=st.integers(0, 9)))
    return fault, predicted, specimen


def made_records(fault, specimen, recording):
    unused = np.zeros(len(fault), dtype=int)
    rows, none = pd.DataFrame(index=range(len(fault))), 0.0 * unused
    return Records("made up", rows, fault, unused, specimen, recording, none, none, unused)


def scores_of(fault, predicted, specimen):
    records = made_records(fault, specimen, np.arange(len(fault)))
    return score(records, predictions(np.eye(4)[predicted], FAULTS[:4], records.recording, UNCALIBRATED))[0]


@given(labelled())
def test_figures_are_means_over_the_classes_present_and_agree_with_counts(case):
    fault, predicted, specimen = case
    found = scores_of(fault, predicted, specimen)
    present = np.unique(fault)
    hits = [np.sum((fault == c) & (predicted == c)) for c in present]
    both = [np.sum(fault == c) + np.sum(predicted == c) for c in present]
    assert found.balanced_accuracy == pytest.approx(np.mean([np.mean(predicted[fault == c] == c) for c in present]))
    assert found.macro_f1 == pytest.approx(np.mean([2 * n / of for n, of in zip(hits, both, strict=True)]))
    assert found.accuracy == pytest.approx(np.mean(fault == predicted))
    assert found.classes == tuple(FAULTS[c] for c in present)
    told_as = [[np.sum((fault == c) & (predicted == other)) for other in range(4)] for c in present]
    np.testing.assert_array_equal(found.confusion, told_as)
    assert np.sum(found.confusion) == len(fault) == found.records
    alarms = predicted[fault == 0] != 0
    assert found.false_alarms == (pytest.approx(alarms.mean()) if len(alarms) else None)


@given(labelled(), st.randoms(use_true_random=False))
def test_scores_do_not_depend_on_the_order_of_the_records(case, random):
    order = list(range(len(case[0])))
    random.shuffle(order)
    assert scores_of(*(values[order] for values in case)) == scores_of(*case)


@given(labelled())
def test_recordings_of_one_record_score_like_records(case):
    found = scores_of(*case)
    whole = found.by_recording
    assert whole is not None
    assert whole.log_loss == pytest.approx(found.log_loss)
    assert whole.ece == pytest.approx(found.ece)
    same = {"log_loss": None, "ece": None, "reliability": (), "roc": None}
    assert replace(whole, **same) == replace(found, by_recording=None, **same)


def test_a_recording_is_decided_by_the_geometric_mean_of_its_windows():
    fault = np.array([1, 1, 1, 2])
    records = made_records(fault, np.array([0, 0, 0, 1]), np.array([0, 0, 0, 1]))
    unsure, sure = [0.4, 0.6], [1.0, 0.0]
    probabilities = np.array([unsure, unsure, sure, [0.0, 1.0]])
    found, _ = score(records, predictions(probabilities, FAULTS[1:3], records.recording, UNCALIBRATED))
    assert found.by_recording is not None
    assert found.balanced_accuracy == pytest.approx((1 / 3 + 1) / 2)
    assert found.by_recording.balanced_accuracy == 1.0
    assert found.by_recording.records == 2


@given(labelled())
def test_more_records_of_the_same_specimens_do_not_narrow_the_interval(case):
    fault, predicted, specimen = (np.concatenate([values, values]) for values in case)
    specimen = specimen + 10 * (np.arange(len(specimen)) // len(case[0]))  # at least two specimens of each class
    once = ends_of(resampled_recall(fault, predicted == fault, specimen, 0))
    thrice = ends_of(resampled_recall(*(np.repeat(values, 3) for values in (fault, predicted == fault, specimen)), 0))
    assert once == pytest.approx(thrice)
    assert 0 <= once[0] <= once[1] <= 1


@given(labelled())
def test_the_interval_is_not_known_exactly_where_a_class_has_one_specimen(case):
    fault, predicted, specimen = case
    alone = any(len(np.unique(specimen[fault == c])) == 1 for c in np.unique(fault))
    found = scores_of(fault, predicted, specimen)
    assert (found.interval is None) == alone
    assert (interval_text(found.interval) == "not known: a class has one specimen") == alone


@pytest.mark.parametrize("specimens", [2, 7, 300])
def test_specimens_that_are_all_right_bound_the_error_of_the_smallest_class(specimens):
    fault = np.repeat([0, 1], [specimens, specimens + 5])
    found = scores_of(fault, fault, np.arange(len(fault)))
    bound = re.search(
        rf"with {specimens} of a class, its true share of errors may be up to (\S+) %", no_width_text([found])
    )
    assert binom.pmf(0, specimens, float(bound[1]) / 100) == pytest.approx(0.05, rel=0.02)
    assert no_width_text([scores_of(fault, 0 * fault, np.arange(len(fault))), replace(found, interval=None)]) == ""


def test_the_interval_leaves_out_two_and_a_half_per_cent_at_each_end(monkeypatch):
    """Specimens have different numbers of records, so that the resampled accuracies are nearly continuous."""
    monkeypatch.setattr("features.baselines.scores.RESAMPLES", 20_000)
    rng = np.random.default_rng(3)
    records = rng.integers(1, 30, 400)
    specimen = np.repeat(np.arange(400), records)
    correct = rng.random(len(specimen)) < 0.5
    hits = np.bincount(specimen, weights=correct)
    share = hits.sum() / records.sum()
    deviation = np.sqrt(np.sum((hits - share * records) ** 2)) / records.sum()  # of a ratio of two sums
    low, high = ends_of(resampled_recall(np.ones(len(specimen), int), correct, specimen, 0))
    # 20,000 resamples determine the quantile to 1 %; a 94 % interval is 4 % narrower
    assert (share - low) / deviation == pytest.approx(1.96, rel=0.03)
    assert (high - share) / deviation == pytest.approx(1.96, rel=0.03)


@given(st.integers(0, 999), st.integers(2, 4))
def test_the_log_loss_agrees_with_that_of_scikit_learn(seed, classes):
    rng = np.random.default_rng(seed)
    fault = np.concatenate([np.arange(classes), rng.integers(classes, size=40)])
    probabilities = rng.dirichlet(np.ones(classes), len(fault)).round(2) + 0.01  # rounded for ties
    probabilities /= probabilities.sum(axis=1, keepdims=True)
    codes = np.arange(classes)
    weights = 1 / np.bincount(fault)[fault]
    expected = log_loss(fault, probabilities, sample_weight=weights, labels=codes)
    assert balanced_log_loss(fault, probabilities, codes) == pytest.approx(expected)


def test_the_area_counts_the_pairs_of_the_classes_present():
    probabilities = np.array([[0.6, 0.3, 0.1], [0.1, 0.2, 0.7], [0.5, 0.4, 0.1]])
    # class 0 is above class 1 in both pairs, class 1 above class 0 in one of two
    assert area(np.array([0, 1, 0]), probabilities, np.arange(3)) == pytest.approx((1 + 0) / 2)
    assert area(np.array([0, 1, 1]), probabilities, np.arange(3)) == pytest.approx((1 + 0.5) / 2)
    assert area(np.array([0, 2, 0]), probabilities[:, :2], np.arange(2)) == pytest.approx(
        (1 + 0.5) / 2
    )  # class 2 is unknown
    assert area(np.array([1, 1, 1]), probabilities, np.arange(3)) is None


def test_the_calibration_error_of_overconfident_answers_is_that_computed_by_hand():
    largest = np.array([0.95, 0.95, 0.95, 0.95, 0.55, 0.55])
    right = np.array([True, True, False, False, True, False])
    bins = reliability_bins(largest, right)
    assert [(found.records, found.accuracy) for found in bins] == [(2, 0.5), (4, 0.5)]
    assert expected_calibration_error(bins) == pytest.approx((2 * 0.05 + 4 * 0.45) / 6)


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
