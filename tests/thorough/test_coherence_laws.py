"""False alarms of coherence, shaft speed and course of the speed, and a ramp that is told in each of a hundred draws."""

import numpy as np
import pytest
from scipy.signal import lfilter

from features.signal import spectral_coherence, track_speed
from tests.features.signal.test_cyclic_laws import exceedances
from tests.features.table.test_speed_laws import clear_in_noise
from tests.resonances import ringing_noise
from tests.run_ups import FS, run_up


@pytest.mark.parametrize("damping", [0.002, 0.005, 0.01, 0.02, 0.05])
@pytest.mark.parametrize("resonance", [1000.0, 4000.0])
@pytest.mark.parametrize(
    ("fs", "seconds", "records"), [(12_800.0, 1.0, 200), (25_600.0, 1.0, 200), (25_600.0, 10.0, 20)]
)
def test_noise_of_a_resonance_exceeds_the_thresholds_half_to_twice_as_often_as_promised(
    fs, seconds, records, resonance, damping
):
    rng = np.random.default_rng(int(resonance + 1e4 * damping))
    shares = exceedances(rng, fs, seconds, records, resonance, damping, (0.1, 0.01, 0.001))
    assert 0.5 < min(shares) <= max(shares) < 2


@pytest.mark.parametrize("seed", range(5))
def test_noise_of_twelve_resonances_exceeds_the_threshold_half_to_twice_as_often_as_promised(seed):
    rng, fs, seconds = np.random.default_rng(seed), 25_600.0, 2.0
    modes = list(zip(rng.uniform(500, 11_000, 12), np.exp(rng.uniform(np.log(0.002), np.log(0.05), 12)), strict=True))
    found = spectral_coherence(ringing_noise(rng, fs, round(seconds * fs), 50, modes), fs, 300.0)
    squared = found.squared[..., found.cyclic > 4.0 / seconds]
    for probability in (0.1, 0.01, 0.001):
        assert 0.5 < np.mean(squared > found.threshold(probability)) / probability < 2


def test_noise_of_eight_windows_is_clear_in_less_than_one_per_cent():
    assert clear_in_noise(8) <= 2


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
