"""Levels are those of NumPy and SciPy, and the velocity is the integral of the acceleration in the band of ISO 20816."""

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid
from scipy.signal import butter, sosfiltfilt
from scipy.stats import kurtosis

from features.diagnosis.levels import ACCELERATION, levels_of, velocity_rms

FS = 12_000.0


def noise(seconds, seed=1):
    return np.random.default_rng(seed).standard_normal(round(FS * seconds))


@pytest.mark.parametrize("mean", [0.0, 8.7])
def test_levels_are_those_of_numpy_and_scipy_and_do_not_depend_on_the_mean(mean):
    x = noise(3.0) ** 3
    levels = levels_of((x + mean).astype(np.float32), FS, "fan", "x", ACCELERATION)
    assert levels.mean == pytest.approx(mean + x.mean(), abs=1e-5)
    assert levels.rms == pytest.approx(x.std(), rel=1e-5)
    assert levels.peak == pytest.approx(np.abs(x - x.mean()).max(), rel=1e-5)
    assert levels.crest_factor == pytest.approx(np.abs(x - x.mean()).max() / x.std(), rel=1e-5)
    assert levels.kurtosis == pytest.approx(kurtosis(x, fisher=False), rel=1e-5)


def test_the_velocity_of_tones_is_their_amplitude_over_their_angular_frequency_within_the_band():
    t = np.arange(round(4 * FS)) / FS
    tones = {4.0: 1.0, 25.0: 2.0, 120.3: 5.0, 950.0: 30.0, 1500.0: 90.0}
    x = sum(level * np.sin(2 * np.pi * f * t) for f, level in tones.items())
    within = [level / (2 * np.pi * f) / np.sqrt(2) for f, level in tones.items() if 10 <= f <= 1000]
    assert velocity_rms(x, FS) == pytest.approx(np.sqrt(np.sum(np.square(within))), rel=0.005)


def test_the_velocity_of_noise_is_that_of_its_integral_in_time():
    x = noise(60.0)
    velocity = cumulative_trapezoid(x, dx=1 / FS)
    filtered = sosfiltfilt(butter(8, (10, 1000), "bandpass", fs=FS, output="sos"), velocity)
    assert velocity_rms(x, FS) == pytest.approx(filtered.std(), rel=0.05)


def test_what_the_signal_cannot_tell_is_not_a_number():
    assert np.isnan(levels_of(noise(3.0), FS, "", "", "unit of the file").velocity_rms_mm_s)
    assert np.isnan(velocity_rms(noise(0.9), FS))
    assert np.isnan(velocity_rms(noise(3.0), 2000.0))
    constant = levels_of(np.full(24_000, 3.0), FS, "", "", ACCELERATION)
    assert (constant.mean, constant.rms, constant.peak, constant.velocity_rms_mm_s) == (3.0, 0.0, 0.0, 0.0)
    assert np.isnan([constant.crest_factor, constant.kurtosis]).all()
