"""Laws of calibration: order of classes, copies of a record, known temperatures, stated coverage."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.special import softmax

from features.baselines.calibration import COVERAGE, answering, calibrate, combine, fit_calibration
from features.baselines.predictions import predictions
from gen.corpus import FAULTS

FOUR = FAULTS[:4]


def drawn_rows(largest: float):
    """Probabilities of some records, none below exp(-2 * largest) / 4."""
    logarithms = arrays(float, st.tuples(st.integers(1, 20), st.just(4)), elements=st.floats(-largest, largest))
    return logarithms.map(lambda values: softmax(values, axis=1))


rows = drawn_rows(8.0)
temperatures = st.floats(0.2, 5.0)


def drawn(temperature: float, records: int = 20_000, seed: int = 0):
    """Probabilities of records whose classes are drawn from the probabilities with that temperature, and the classes."""
    rng = np.random.default_rng(seed)
    probabilities = softmax(1.5 * rng.standard_normal((records, 4)), axis=1)
    right = calibrate(probabilities, temperature)
    truth = (rng.random((records, 1)) > right.cumsum(axis=1)).sum(axis=1)
    return probabilities, np.minimum(truth, 3)


@given(rows, temperatures)
def test_a_temperature_keeps_the_order_of_the_classes(probabilities, temperature):
    found = calibrate(probabilities, temperature)
    np.testing.assert_allclose(found.sum(axis=1), 1.0)
    ordered = np.take_along_axis(found, probabilities.argsort(axis=1), axis=1)
    assert (np.diff(ordered, axis=1) >= -1e-12).all()


@given(rows, st.integers(1, 9))
def test_copies_of_a_record_say_no_more_than_one(probabilities, copies):
    recording = np.repeat(np.arange(len(probabilities)), copies)
    found = combine(np.repeat(probabilities, copies, axis=0), recording)
    np.testing.assert_allclose(found, probabilities, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("temperature", [0.5, 1.0, 2.0])
def test_the_temperature_that_the_classes_were_drawn_with_is_found(temperature):
    probabilities, truth = drawn(temperature)
    found = fit_calibration(probabilities, truth)
    # 20,000 records determine a temperature to about 2 %
    assert found.temperature == pytest.approx(temperature, rel=0.06)


@pytest.mark.parametrize("times", [2, 9])
def test_the_number_of_records_of_a_class_has_no_effect_on_the_temperature(times):
    probabilities, truth = drawn(2.0, 500)
    more = np.concatenate([np.arange(500), np.tile(np.flatnonzero(truth == 0), times)])
    found = [fit_calibration(probabilities[rows], truth[rows]) for rows in (np.arange(500), more)]
    assert found[1].temperature == pytest.approx(found[0].temperature, rel=1e-3)


@given(st.integers(0, 999), st.integers(1, 200))
def test_the_stated_share_of_the_records_is_answered(seed, records):
    probabilities, truth = drawn(1.0, records, seed)
    found = fit_calibration(probabilities, truth)
    pooled = predictions(probabilities, FOUR, np.arange(records), found)
    assert pooled.answered.mean() == found.coverage
    assert COVERAGE <= found.coverage < COVERAGE + 1 / records


def test_the_threshold_is_the_highest_one_that_answers_enough():
    probabilities = np.array([[0.9, 0.1], [0.2, 0.8], [0.7, 0.3], [0.4, 0.6]])
    assert [answering(probabilities, share) for share in (0.25, 0.5, 0.51, 1.0)] == [0.9, 0.8, 0.7, 0.6]
