"""Laws of resampling at equal angles: a line at order k lies at order k, at any speed and sample rate."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from features.signal.orders import resample_to_orders

PER_TURN, TURNS = 128, 4
EDGE = 40  # resampled samples at each end whose interpolation would need samples outside the record


def tone(order, shaft_rate, fs, phase=0.0):
    """A cosine at an order of the shaft, shape (1, time), long enough for all turns."""
    count = int((TURNS + 0.5) * fs / shaft_rate)
    return np.cos(2 * np.pi * order * shaft_rate * np.arange(count) / fs + phase)[None].astype(np.float32)


def resampled(x, shaft_rate, fs):
    return resample_to_orders(x, fs, np.array([shaft_rate]), PER_TURN, PER_TURN * TURNS)[0]


@given(
    order=st.floats(0.5, 50.0),
    shaft_rate=st.floats(5.0, 60.0),
    fs=st.sampled_from([8000.0, 12_000.0, 48_000.0]),
    phase=st.floats(0, 6),
)
@settings(deadline=None, max_examples=40)
def test_a_tone_at_an_order_is_the_same_tone_over_the_angle(order, shaft_rate, fs, phase):
    found = resampled(tone(order, shaft_rate, fs, phase), shaft_rate, fs)
    angle = np.arange(PER_TURN * TURNS) / PER_TURN
    expected = np.cos(2 * np.pi * order * angle + phase)
    np.testing.assert_allclose(found[EDGE:-EDGE], expected[EDGE:-EDGE], atol=1e-3)


@pytest.mark.parametrize("order", [7, 23, 50])
def test_the_spectrum_has_its_line_at_the_order(order):
    found = resampled(tone(order, 11.3, 12_000.0), 11.3, 12_000.0)
    assert np.abs(np.fft.rfft(found)).argmax() == order * TURNS


@given(order=st.floats(66.0, 250.0))
@settings(deadline=None, max_examples=30)
def test_orders_above_half_the_samples_per_turn_are_removed(order):
    found = resampled(tone(order, 20.0, 12_000.0), 20.0, 12_000.0)
    assert np.abs(found[EDGE:-EDGE]).max() < 2e-4 if order > 67 else np.abs(found[EDGE:-EDGE]).max() < 1e-2


def test_resampling_is_linear_and_no_record_depends_on_the_others():
    rng = np.random.default_rng(0)
    x, rates = rng.standard_normal((5, 3000)), np.array([10.0, 17.0, 25.0, 31.0, 58.0])
    whole = resample_to_orders(x, 12_000.0, rates, PER_TURN, 200)
    assert (whole.shape, whole.dtype) == ((5, 200), np.float32)
    for row in range(5):
        alone = resample_to_orders(x[row : row + 1], 12_000.0, rates[row : row + 1], PER_TURN, 200)
        np.testing.assert_array_equal(alone[0], whole[row])
    np.testing.assert_allclose(resample_to_orders(-2 * x, 12_000.0, rates, PER_TURN, 200), -2 * whole, rtol=1e-5)


def test_a_record_is_zero_after_its_end():
    found = resample_to_orders(np.ones((1, 400)), 4000.0, np.array([20.0]), PER_TURN, 10 * PER_TURN)[0]
    np.testing.assert_allclose(found[EDGE : 2 * PER_TURN - EDGE], 1, atol=1e-3)
    assert np.all(found[2 * PER_TURN + EDGE :] == 0)
