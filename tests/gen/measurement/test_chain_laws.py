"""All of a record passes one measuring chain: high pass of the sensor, anti-alias filter, offset, converter."""

import numpy as np
import pytest
from scipy.signal import welch

from gen.measurement.rig import high_pass
from gen.physics.kernel.decimate import decimation, pass_band
from gen.scenarios import draw_scenarios
from gen.simulation.timeline import timeline
from tests.measuring import FLOAT, direct, lines, measure, quiet

FS = 12_000.0
LONG = FLOAT | direct() | {"recording.duration_s": 10.0, "operation.shaft_rpm": 1800}
LOUD = 9.5  # dB
GEAR = {"teeth": 150, "mate_teeth": 300, "shaft_modulation": 0.9} | lines([LOUD, LOUD])
NOISY = {
    "noise": {},
    "modes": {"modes": {"count": 1, "frequency_hz": 5900, "damping_percent": 1, "gain_db": LOUD, "sign": 1}},
    "tones": {"tones": lines([LOUD, LOUD]) | {"frequency_hz": [5950, 7000]}},
    "impulses": {"impulses": {"rate_hz": 40, "level_db": 30}},
    "knocks": {"knocks": {"orders": 3, "level_db": 30}},
    "gear": {"gear_mesh": GEAR},
}


def wave(n):
    return np.float32(np.sqrt(2)) * np.cos(2 * np.pi * 30 / FS * np.arange(n), dtype=np.float32)


def line(signal):
    """Rms of the line at 30 Hz."""
    return np.sqrt(2) * abs(np.mean(signal * np.exp(-2j * np.pi * 30 / FS * np.arange(len(signal)))))


def recorded(recipe_with, changes, bearing=np.zeros):
    """Record of a machine whose bearing vibrates as a function of the number of samples says."""
    recipe = recipe_with(LONG | quiet() | changes)
    moved = np.float32(bearing(timeline(recipe).returned))
    return measure(moved[None, None], draw_scenarios(recipe, 0, 1)).signal[0, 0].astype(float)


@pytest.mark.parametrize("source", NOISY)
def test_nothing_of_the_machine_gets_past_the_anti_alias_filter(recipe_with, source):
    """Where the filter of the kernel lets less than 0.3 % of the bearing through, no source of the machine is stronger."""
    frequency, density = welch(recorded(recipe_with, quiet(**NOISY[source])), FS, nperseg=4096)
    assert pass_band(np.array([0.985])) < 3e-3
    beyond, below = density[frequency > 0.985 * FS / 2].max(), density[(frequency > 3000) & (frequency < 4500)].mean()
    assert beyond < 0.01 * below


def test_the_gain_of_the_anti_alias_filter_is_that_of_the_kernel():
    filters = decimation(8).last
    taps = filters.taps[:, 0].astype(float)
    for share in (0.1, 0.8, 0.9, 0.95, 0.99):
        # inputs come at twice the sample rate
        gain = abs(np.sum(taps * np.exp(-1j * np.pi * share / 2 * np.arange(len(taps)))))
        assert pass_band(np.array([share])) == pytest.approx(gain, abs=2e-5)


def test_a_sensor_loses_three_decibels_at_its_corner_and_six_an_octave_below_it():
    corner, octaves = 2.0, 2.0 ** np.arange(-6.0, 7.0)
    gains = np.abs(high_pass(corner, corner * octaves))
    np.testing.assert_allclose(gains, octaves / np.sqrt(1 + octaves**2))
    assert high_pass(corner, np.zeros(1)) == 0.0
    np.testing.assert_array_equal(high_pass(0.0, octaves), 1.0)


def test_bearing_and_machine_pass_the_same_sensor(recipe_with):
    """A slow line loses as much whether the bearing makes it or the shaft, at 30 Hz behind a corner of 40 Hz."""
    slow = {"recording.high_pass_hz": 40}
    of_shaft = line(recorded(recipe_with, quiet(harmonics=lines([0])) | slow))
    of_bearing = line(recorded(recipe_with, slow, wave))
    expected = abs(high_pass(40.0, np.array([30.0])))[0]
    assert of_shaft == pytest.approx(expected, abs=0.03)
    assert of_bearing == pytest.approx(expected, abs=0.03)


def test_the_offset_is_the_mean_of_a_record_behind_a_sensor_that_measures_no_mean(recipe_with):
    sensor = {"recording.high_pass_hz": 5, "recording.offset_m_s2": 0.7}
    assert recorded(recipe_with, sensor).mean() == pytest.approx(0.7, abs=1e-4)
