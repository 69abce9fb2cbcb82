"""Laws of the smoothing of speeds, and of signals without lines that stay at one frequency."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from features.signal.refinement import _smoothed
from features.signal.steady_lines import without_steady_lines

PRIOR = np.array([25.0, 4.0])


def smoothed_densely(time, y, information, change):
    """Posterior mean and variance of the rate by the covariance of all knots at once."""
    first, second = np.meshgrid(time - time[0], time - time[0], indexing="ij")
    low = np.minimum(first, second)
    prior = (
        PRIOR[0]
        + PRIOR[1] * first * second
        + change * (first * second * low - (first + second) * low**2 / 2 + low**3 / 3)
    )
    gain = prior @ np.linalg.inv(prior + np.diag(1 / information))
    return gain @ y, np.diag(prior - gain @ prior)


@given(seed=st.integers(0, 1000), change=st.floats(1e-3, 1e2))
def test_the_spline_is_the_mean_of_an_integrated_random_walk(seed, change):
    rng = np.random.default_rng(seed)
    time, y = np.cumsum(rng.uniform(0.1, 0.5, 20)), rng.standard_normal(20)
    information = rng.uniform(0.5, 20, 20)
    _, rate, _, variance = _smoothed(time, y, information, 0.0, PRIOR, change)
    mean, spread = smoothed_densely(time, y, information, change)
    np.testing.assert_allclose(rate, mean, atol=1e-6)
    np.testing.assert_allclose(variance, spread, rtol=1e-5)


@pytest.mark.parametrize("change", [1e-9, 1.0])
def test_a_straight_course_stays_straight_whatever_the_stiffness(change):
    time = np.arange(30) * 0.4
    _, rate, slope, _ = _smoothed(time, 20 + 0.7 * time, np.full(30, 1e6), 20.0, 1e4 * PRIOR, change)
    np.testing.assert_allclose(rate, 20 + 0.7 * time, atol=1e-4)
    np.testing.assert_allclose(slope, 0.7, atol=1e-3)


def test_lines_that_stay_are_removed_and_those_that_move_are_kept():
    rate, time = 500.0, np.arange(10_000) / 500.0
    noise = np.random.default_rng(0).standard_normal((2, 10_000))
    moving = np.exp(2j * np.pi * (20 * time + 0.4 * time**2))
    steady = 30 * np.exp(2j * np.pi * 50.03 * time) + 3 * np.exp(2j * np.pi * 149.9 * time)
    background = moving + 0.1 * (noise[0] + 1j * noise[1])
    rest = without_steady_lines(background + steady, rate, 0.8)
    inner = slice(1000, -1000)
    assert np.sqrt(np.mean(np.abs(rest - background)[inner] ** 2)) < 0.05
    np.testing.assert_array_equal(without_steady_lines(background, rate, 0.8), background)
