"""All of a record passes one measuring chain: high pass of the sensor, anti-alias filter, offset, converter."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import welch

from gen.measurement.measure import measure
from gen.measurement.rig import high_pass
from gen.physics.kernel.decimate import decimation, pass_band
from gen.scenarios import draw_scenarios
from tests.measuring import mode, path, quiet, tone

FS = 12_000.0
DIRECT = path(1.0)
SOUND = quiet(floor=0.0)
LONG = {"recording.converter": {"kind": "float32"}, "recording.duration_s": 10.0, "operation.shaft_rpm": 1800}
GEAR = {
    "teeth": 150, "mate_teeth": 300, "lines": ({"level": 3.0, "phase": 0.0},) * 2, "shaft_modulation": 0.9, "mate_modulation": 0.0,
    "phase_modulation": 0.0, "high_point": 0.0, "lead_point": 0.0,
}  # fmt: skip
NOISY = {
    "noise": SOUND,
    "modes": quiet(floor=0.0, modes=(mode(5900.0, 0.01, 3.0),)),
    "tones": quiet(floor=0.0, tones=(tone(5950.0, 3.0), tone(7000.0, 3.0))),
    "impulses": quiet(floor=0.0, impulses=tone(40.0, 30.0)),
    "knocks": quiet(floor=0.0, knocks=tone(3.0, 30.0)),
    "gear": quiet(floor=0.0, gear_mesh=GEAR),
}


def wave(n):
    return np.float32(np.sqrt(2)) * np.cos(2 * np.pi * 30 / FS * np.arange(n), dtype=np.float32)


def line(signal):
    """Rms of the line at 30 Hz."""
    return np.sqrt(2) * abs(np.mean(signal * np.exp(-2j * np.pi * 30 / FS * np.arange(len(signal)))))


def recorded(recipe_with, background, bearing=None, **of_rig):
    scenario = draw_scenarios(recipe_with(LONG), 0, 1)[0]
    rig = replace(scenario.rig, background=background, background_rms=1.0, gain=1.0, path=DIRECT, **of_rig)
    n = round((0.05 + 10.0) * FS)
    silence = np.zeros(n, np.float32) if bearing is None else bearing(n)
    return measure(silence[None, None], [replace(scenario, rig=rig)]).signal[0, 0].astype(float)


@pytest.mark.parametrize("source", NOISY)
def test_nothing_of_the_machine_gets_past_the_anti_alias_filter(recipe_with, source):
    """Where the filter of the kernel lets less than 0.3 % of the bearing through, no source of the machine is stronger."""
    frequency, density = welch(recorded(recipe_with, NOISY[source]), FS, nperseg=4096)
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
    of_shaft = line(recorded(recipe_with, quiet(floor=0.0, harmonics=(tone(1.0, 1.0),)), high_pass=40.0))
    of_bearing = line(recorded(recipe_with, SOUND, wave, high_pass=40.0))
    expected = abs(high_pass(40.0, np.array([30.0])))[0]
    assert of_shaft == pytest.approx(expected, abs=0.03)
    assert of_bearing == pytest.approx(expected, abs=0.03)


def test_the_offset_is_the_mean_of_a_record_behind_a_sensor_that_measures_no_mean(recipe_with):
    assert recorded(recipe_with, SOUND, high_pass=5.0, offset=0.7).mean() == pytest.approx(0.7, abs=1e-4)
