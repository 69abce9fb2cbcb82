"""Laws of the rms velocity: that of a sine over its angular frequency, in the band of the standard alone."""

import numpy as np
import pytest

from features.signal import velocity_rms

FS = 12_000.0


@pytest.mark.parametrize(("shaft_rate", "low"), [(2.0, 2.0), (9.9, 2.0), (10.0, 10.0), (500.0, 10.0)])
@pytest.mark.parametrize("ratio", [0.53, 0.8, 1.0, 1.07, 2.5, 4.0, 12.03, 95.0, 100.0, 150.0])
def test_the_velocity_rms_of_a_tone_is_its_closed_form_through_third_order_butterworth_filters(shaft_rate, low, ratio):
    frequency = ratio * low
    x = 7 * np.sin(2 * np.pi * frequency * np.arange(round(12.3 * FS)) / FS + 1)[None] + 3.0
    gain = 1 / np.sqrt((1 + (low / frequency) ** 6) * (1 + (frequency / 1000) ** 6))
    expected = 7 / (2 * np.pi * frequency * np.sqrt(2)) * gain
    assert velocity_rms(x, FS, shaft_rate)[0] == pytest.approx(
        expected, rel=0.01 if ratio >= 1 else 0.05
    )  # the slope varies within a line


def test_each_record_has_the_velocity_rms_of_its_own_shaft_rate():
    x = np.random.default_rng(2).standard_normal((3, round(6 * FS)))
    found = velocity_rms(x, FS, [5.0, 25.0, 9.0])
    np.testing.assert_array_equal(found[[0, 2]], velocity_rms(x[[0, 2]], FS, 3.0))
    np.testing.assert_array_equal(found[1:2], velocity_rms(x[1:2], FS, 30.0))


def test_a_signal_without_the_band_and_a_machine_beyond_the_standard_have_no_velocity_rms():
    x = np.ones((2, round(4.9 * FS)))
    assert np.isnan(velocity_rms(x[:, : round(0.9 * FS)], FS, 25.0)).all()
    assert np.isnan(velocity_rms(np.ones((1, 6000)), 2000.0, 25.0)).all()
    np.testing.assert_array_equal(np.isnan(velocity_rms(x, FS, [9.9, 10.0])), [True, False])
    np.testing.assert_array_equal(np.isnan(velocity_rms(x, FS, [1.9, 501.0])), [True, True])
