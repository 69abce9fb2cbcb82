"""Laws of order tracking: a line at order k lies at order k, at any speed, course of the speed and sample rate."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from features.signal import (
    angles_from_speed,
    angles_from_tacho,
    order_map,
    order_spectrum,
    resample_to_angle,
    track_speed,
)
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
def test_a_tone_at_an_order_is_the_same_tone_over_the_angle(order, shaft_rate, fs, phase):
    found = resampled(tone(order, shaft_rate, fs, phase), shaft_rate, fs)
    angle = np.arange(PER_TURN * TURNS) / PER_TURN
    expected = np.cos(2 * np.pi * order * angle + phase)
    np.testing.assert_allclose(found[EDGE:-EDGE], expected[EDGE:-EDGE], atol=1e-3)


@given(order=st.floats(66.0, 250.0))
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


FS, SECONDS = 12_800.0, 10.0
TIME = np.arange(round(FS * SECONDS)) / FS
RATE = np.stack([5 + 4 * TIME, 45 - 3 * TIME + np.sin(TIME)])
ANGLE = 2 * np.pi * np.stack([5 * TIME + 2 * TIME**2, 45 * TIME - 1.5 * TIME**2 - np.cos(TIME) + 1])
LINES = (1.0, 3.585, 5.415, 20.3)


def run_ups(orders=LINES, noise=0.3):
    """Two records with lines at orders of the shaft, of which one runs up and one down, shape (record, time)."""
    rng = np.random.default_rng(5)
    return sum(np.cos(order * ANGLE) for order in orders) + noise * rng.standard_normal(ANGLE.shape)


def assert_lines(x, angle, orders=LINES, height=0.02):
    """Each line stands within half a bin of its order, with its amplitude."""
    y = resample_to_angle(x, angle, PER_TURN)
    order, spectrum = order_spectrum(y, PER_TURN)
    for line in orders:
        near = np.abs(order - line) < 0.3
        found = order[near][spectrum[:, near].argmax(axis=1)]
        np.testing.assert_allclose(found, line, rtol=0, atol=0.5 * PER_TURN / y.shape[1])
        np.testing.assert_allclose(spectrum[:, near].max(axis=1), 1, rtol=height)


def test_lines_of_a_run_up_stand_at_their_orders_along_the_known_angle_and_the_known_speed():
    assert_lines(run_ups(), ANGLE)
    np.testing.assert_allclose(angles_from_speed(RATE, FS), ANGLE, atol=1e-6)


def test_lines_of_a_run_up_stand_at_their_orders_along_a_tacho_whatever_its_offset_and_noise():
    pulses = np.clip(20 * np.cos(2 * ANGLE + 1) - 15, 0, 2) + 0.05 * np.random.default_rng(1).standard_normal(
        ANGLE.shape
    )
    angle = angles_from_tacho(pulses - 7, pulses_per_turn=2)
    np.testing.assert_allclose(np.diff(angle - ANGLE)[:, 5000:-5000], 0, atol=2e-4)
    assert_lines(run_ups(), angle)
    with pytest.raises(ValueError, match="record 0 has 0 pulses above 3"):
        angles_from_tacho(pulses, threshold=3)


def test_lines_of_a_run_up_stand_at_their_orders_along_the_speed_that_is_tracked():
    lines = (1.0, 2.0, 5.0, 7.3)
    x = run_ups(lines)
    assert_lines(x, angles_from_speed(track_speed(x, FS, 4, 60).rate, FS), lines)


def test_both_ways_to_resample_agree_at_a_constant_speed_and_the_first_sample_is_at_a_whole_turn():
    angle = 2 * np.pi * (25.0 * TIME[None] - 3.25)
    x = np.cos(5 * angle)
    y = resample_to_angle(x, angle, PER_TURN)
    np.testing.assert_allclose(
        y[0, EDGE : 6 * PER_TURN], np.cos(10 * np.pi * np.arange(6 * PER_TURN) / PER_TURN)[EDGE:], atol=1e-3
    )
    constant = resample_to_orders(x, FS, np.array([25.0]), PER_TURN, y.shape[1])
    quarter = PER_TURN // 4
    np.testing.assert_allclose(constant[0, EDGE + quarter : -EDGE], y[0, EDGE : -EDGE - quarter], atol=1e-5)
    with pytest.raises(ValueError, match="angle: that of record 0 does not ascend"):
        resample_to_angle(x, angle[:, ::-1], PER_TURN)


def test_lines_stand_still_in_an_order_map_and_move_with_the_speed_in_none_of_its_windows():
    y = resample_to_angle(run_ups(), ANGLE, PER_TURN)
    turns, orders, amplitude = order_map(y, PER_TURN, turns=8)
    assert amplitude.shape == (2, len(turns), len(orders))
    near = np.abs(orders - 3.585) < 0.3
    highest = orders[near][amplitude[:, 1:-1, near].argmax(axis=2)]
    np.testing.assert_allclose(highest, 3.585, atol=0.5 / 8)
    assert (turns[0], turns[1]) == (4.0, 8.0)
    with pytest.raises(ValueError, match="are less than a window"):
        order_map(y, PER_TURN, turns=10_000)
