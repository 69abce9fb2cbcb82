"""Laws of integration: a sine over its angular frequency, in the pass band alone, and the zones of ISO 20816-3."""

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid
from scipy.signal import butter, sosfiltfilt

from features.signal import displacement, iso_zone, velocity, velocity_rms

FS = 12_000.0
MIDDLE = slice(round(FS), round(-FS))


@pytest.mark.parametrize("frequency", [10.0, 25.3, 120.7])
def test_a_sine_is_integrated_within_a_thousandth_whatever_its_number_of_periods(frequency):
    t, omega = np.arange(round(4.03 * FS)) / FS, 2 * np.pi * frequency
    phases = omega * t + [[0.3], [1.1]]
    x = 3 * np.sin(phases) + 8.0
    v, s = velocity(x, FS) * omega / 3, displacement(x, FS) * omega**2 / 3
    np.testing.assert_allclose(v[:, MIDDLE], -np.cos(phases)[:, MIDDLE], atol=1e-3)
    np.testing.assert_allclose(s[:, MIDDLE], -np.sin(phases)[:, MIDDLE], atol=1e-3)


def test_what_lies_below_half_the_high_pass_is_removed():
    x = np.sin(2 * np.pi * 9.7 * np.arange(round(3 * FS)) / FS)[None].astype(np.float32)
    kept, removed = velocity(x, FS, high_pass=9.0), velocity(x, FS, high_pass=20.0)
    assert kept.dtype == np.float32
    assert np.abs(removed[:, MIDDLE]).max() < 1e-3 * np.abs(kept[:, MIDDLE]).max()


def test_the_velocity_rms_of_tones_is_that_of_those_within_the_band():
    t = np.arange(round(4 * FS)) / FS
    tones = {4.0: 1.0, 25.0: 2.0, 120.3: 5.0, 950.0: 30.0, 1500.0: 90.0}
    x = sum(level * np.sin(2 * np.pi * f * t) for f, level in tones.items())
    within = [level / (2 * np.pi * f) / np.sqrt(2) for f, level in tones.items() if 10 <= f <= 1000]
    np.testing.assert_allclose(
        velocity_rms(np.stack([x, 2 * x]), FS), np.sqrt(np.sum(np.square(within))) * np.array([1, 2]), rtol=0.005
    )


def test_the_velocity_rms_of_noise_is_that_of_its_integral_in_time():
    x = np.random.default_rng(1).standard_normal(round(60 * FS))
    filtered = sosfiltfilt(butter(8, (10, 1000), "bandpass", fs=FS, output="sos"), cumulative_trapezoid(x, dx=1 / FS))
    assert velocity_rms(x[None], FS) == pytest.approx(filtered.std(), rel=0.05)


def test_a_signal_without_the_band_has_no_velocity_rms():
    assert np.isnan(velocity_rms(np.ones((2, round(0.9 * FS))), FS)).all()
    assert np.isnan(velocity_rms(np.ones((1, 6000)), 2000.0)).all()


def test_zones_end_at_their_limits_and_depend_on_group_and_support():
    assert iso_zone([[2.3, 2.31], [7.1, 7.11]], 1).tolist() == [["A", "B"], ["C", "D"]]
    assert iso_zone([1.4, 3.0], 2).tolist() == ["A", "C"]
    assert iso_zone(3.0, 2, "flexible") == iso_zone(3.0, 1) == "B"
    with pytest.raises(ValueError, match="give group 1 or 2"):
        iso_zone(1.0, 3)
    with pytest.raises(ValueError, match="-1 is negative"):
        iso_zone([1.0, -1.0], 1)


def test_a_high_pass_beyond_the_signal_is_refused():
    with pytest.raises(ValueError, match="high_pass: 6000 Hz is not between"):
        velocity(np.ones((1, 100)), FS, 6000.0)
