"""Laws of the untrained rule: the classes it can predict, and its predictions for trains of impulses."""

from functools import cache

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import softmax

from features.baselines.estimators import EnvelopeRule
from features.table.class_features import COMBS, EVIDENCE, class_features
from features.table.indicators import Orders, feature_names, indicators
from gen.corpus import FAULTS
from gen.corpus.fault_classes import BUILT_IN

FS, TURNS, RECORDS = 12_000.0, 30, 20
ORDERS = Orders(*map(np.array, ([0.3983], [3.5848], [5.4152], [2.3567])))
TRAINS = {row.name: [line.order(ORDERS)[0] for line in row.lines[: row.n_spalls or 1]] for row in BUILT_IN}
COLUMNS = [feature for fault in TRAINS for feature in class_features(fault)]
FOUR, SIX = np.arange(4), np.arange(len(BUILT_IN))
levels = st.one_of(st.floats(-1, 4), st.just(np.nan))
rows = st.lists(st.tuples(*[levels] * len(COLUMNS)), min_size=1, max_size=5)


def table(found):
    return pd.DataFrame(found, columns=COLUMNS, dtype=float).reindex(columns=list(EVIDENCE))


def impulse_trains(lines, shaft_rate, rng):
    """Impulse responses of a 3 kHz resonance at some lines, with 1 % jitter of the period, in white noise."""
    time = np.arange(round(TURNS / shaft_rate * FS)) / FS
    x = 0.05 * rng.standard_normal(time.size)
    for line in lines:
        period = 1 / (line * shaft_rate)
        at = np.arange(-rng.uniform() * period, time[-1], period)
        for moment in at + 0.01 * period * rng.standard_normal(at.size):
            since = np.maximum(time - moment, 0)
            x += np.exp(-800 * since) * np.sin(2 * np.pi * 3000 * since)
    return x


@cache
def lines_of(fault):
    """Features of records with the trains of a class, at 25 to 50 Hz shaft rate and with at most 1 % label error."""
    rng = np.random.default_rng(FAULTS.index(fault))
    values = []
    for shaft_rate in rng.uniform(25, 50, RECORDS):
        label = np.array([shaft_rate * rng.uniform(0.99, 1.01)])
        values.append(
            indicators(impulse_trains(TRAINS[fault], shaft_rate, rng)[None], FS, label, ORDERS, ("lines",))[0]
        )
    return pd.DataFrame(np.concatenate(values), columns=list(feature_names(("lines",))))


def shares(frame, classes):
    """Share of the records that each class is predicted for."""
    named = EnvelopeRule().fit(frame, classes).predict(frame)
    return {fault: float(np.mean(named == code)) for code, fault in enumerate(FAULTS)}


@pytest.mark.parametrize("fault", list(TRAINS))
def test_trains_of_impulses_are_classified_as_the_fault_that_causes_them(fault):
    assert shares(lines_of(fault), SIX)[fault] > 0.9


@given(rows)
def test_without_cage_and_compound_the_rule_compares_only_combs_and_threshold(found):
    frame = table(found)
    combs = np.nan_to_num(frame[list(COMBS.values())].to_numpy(), nan=-np.inf)
    expected = softmax(np.column_stack([np.ones(len(frame)), combs]), axis=1)
    for known in (FOUR, np.array([0, 1]), np.array([3])):
        rule = EnvelopeRule().fit(frame, known)
        np.testing.assert_array_equal(rule.classes_, FOUR)
        np.testing.assert_array_equal(rule.predict_proba(frame), expected)


@given(rows, st.sets(st.integers(0, 5), min_size=1))
def test_cage_and_compound_are_predicted_only_if_the_corpus_has_them(found, known):
    frame = table(found)
    rule = EnvelopeRule().fit(frame, np.array(sorted(known)))
    assert set(rule.classes_) == known | set(FOUR)
    assert set(rule.predict(frame)) <= set(rule.classes_)
    np.testing.assert_allclose(rule.predict_proba(frame).sum(axis=1), 1.0)


@given(st.floats(1.1, 3), st.floats(1.1, 3), st.floats(-1, 0.5))
def test_two_race_combs_are_a_compound_fault_if_neither_exceeds_twice_the_other(inner, outer, ball):
    frame = table([[inner, outer, ball, 0.0, 0.0]])
    compound = EnvelopeRule().fit(frame, SIX).predict(frame)[0] == FAULTS.index("compound")
    assert compound == (min(inner, outer) > max(inner, outer) / 2)


@given(st.floats(1.1, 3), st.floats(0.1, 3))
def test_the_lines_of_the_cage_count_as_a_ball_spall_if_the_ball_comb_is_at_least_half_as_high(series, ball):
    frame = table([[0.0, 0.0, ball, series, series]])
    cage = EnvelopeRule().fit(frame, SIX).predict(frame)[0] == FAULTS.index("cage")
    assert cage == (ball < series / 2)
