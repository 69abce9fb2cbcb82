"""Laws of colour: gain has none, several references set the scale, and no record in a strange colour is answered healthy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from features.baselines.calibration import UNCALIBRATED
from features.baselines.colour_distance import COUNTED, DECIBELS, SCATTER, Colour, distance, scatter_of
from features.baselines.predictions import UNSURE, Predictions, predictions
from gen.corpus import FAULTS
from gen.corpus.fault_classes import HEALTHY

CLASSES = FAULTS[:3]
TILT = np.linspace(-1, 1, len(COUNTED)) / DECIBELS  # about 0.7 dB
SURE = np.array([[0.98, 0.01, 0.01]])


def coloured(decibels: float, records: int = 1, channels: int = 1) -> Colour:
    """Changes of a distance, in the direction of ``TILT``."""
    change = np.full((channels, records, 1), decibels) * TILT / distance(TILT)
    return Colour(change, np.full((channels, records), SCATTER))


@given(st.floats(-50, 50), st.floats(0, 40))
def test_a_gain_has_no_colour_and_a_change_of_all_bands_is_its_size(gain, decibels):
    change = coloured(decibels).changes[0, 0]
    assert distance(change + gain) == pytest.approx(decibels, abs=1e-9)


def test_the_scatter_is_that_of_the_references_if_it_is_larger_than_usual():
    assert scatter_of(TILT[None]) == scatter_of(np.stack([TILT, 1.1 * TILT])) == SCATTER
    assert scatter_of(np.stack([10 * TILT, -10 * TILT])) == pytest.approx(20 * distance(TILT))
    assert scatter_of(np.stack([TILT, TILT, 30 * TILT])) == pytest.approx(29 * distance(TILT))


def told(probabilities: np.ndarray, colour: Colour | None = None) -> Predictions:
    return predictions(probabilities, CLASSES, np.array([0]), UNCALIBRATED, colour=colour)


@given(st.floats(0, 20))
def test_a_strange_colour_moves_no_probability(d):
    np.testing.assert_array_equal(told(SURE, coloured(d * SCATTER)).probabilities, told(SURE).probabilities)


def test_healthy_is_answered_near_the_reference_alone():
    for scatters, answer in ((0.0, HEALTHY), (0.9, HEALTHY), (1.1, UNSURE)):
        assert told(SURE, coloured(scatters * SCATTER)).answers == (answer,)
    assert told(SURE[:, ::-1], coloured(4 * SCATTER)).answers == (CLASSES[-1],)


def test_one_channel_in_a_strange_colour_is_enough():
    colour = coloured(0.0, channels=2)
    colour.changes[1] = coloured(2 * SCATTER).changes[0]
    assert told(np.stack([SURE, SURE]), colour).answers == (UNSURE,)
