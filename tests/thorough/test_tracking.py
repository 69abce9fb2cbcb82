"""Courses of the shaft speed: a ramp told in each of a hundred draws, and no course of a hundred for noise."""

import numpy as np
import pytest
from scipy.signal import lfilter

from features.signal import track_speed
from tests.run_ups import FS, run_up

RANGE = (10.0, 45.0)


@pytest.mark.parametrize(("level", "largest"), [(0, 0.01), (-20, 0.1)])
def test_a_ramp_from_12_to_36_hz_is_told_throughout_in_each_of_a_hundred_draws(level, largest):
    for seed in range(100):
        rate, x = run_up("ramp", level, seed=seed)
        assert 100 * np.median(np.abs(track_speed(x, FS, *RANGE).rate / rate - 1)) < largest


@pytest.mark.parametrize("pole", [0.0, 0.97, -0.97], ids=["white", "red", "blue"])
@pytest.mark.parametrize(("search", "seconds"), [((10.0, 45.0), 20), ((10.0, 45.0), 2), ((25.0, 35.0), 10)])
def test_noise_has_a_course_in_at_most_one_of_a_hundred_draws(pole, search, seconds):
    fs = 13 * search[1]
    x = lfilter([1], [1, -pole], np.random.default_rng(0).standard_normal((100, int(seconds * fs))), axis=1)
    assert np.isfinite(track_speed(x, fs, *search).rate).any(axis=1).sum() <= 1
