"""Lines of a simulated run-up stand at their orders along the true angle of the shaft, and along its tracked speed."""

import numpy as np
import pytest
from scipy.signal import butter, hilbert, sosfiltfilt

import gen
from features.signal import angles_from_speed, order_spectrum, resample_to_angle, track_speed

RUN_UP = {"kind": "run_up", "from_percent": 25, "to_percent": 100, "start_s": 0.3, "lasting_s": 5}
BACKGROUND = {"slope": 0.5, "harmonics": {"probability": 1, "count": 3, "level_db": -6}}


@pytest.fixture(scope="module")
def run_up():
    return gen.record(
        gen.inner(width_mm=0.8),
        shaft_rpm=2400,
        duration_s=6,
        sample_rate_hz=12_000,
        seed=4,
        speed_profile=RUN_UP,
        background=BACKGROUND,
    )


@pytest.fixture(scope="module", params=["true", "tracked"])
def angle(request, run_up):
    if request.param == "true":
        return gen.shaft_angles(run_up).values[None]
    return angles_from_speed(track_speed(run_up.acceleration.values, 12_000, 7, 45).rate, 12_000)


def test_harmonics_of_the_shaft_and_the_line_of_the_fault_stand_within_half_a_bin(run_up, angle):
    x = run_up.acceleration.values
    envelope = np.abs(hilbert(sosfiltfilt(butter(4, (2000, 5000), "bandpass", fs=12_000, output="sos"), x)))
    for signal, lines in ((x, (1, 2, 3)), (envelope, (1, 2, run_up.true_bpfi.item()))):
        y = resample_to_angle(signal, angle, 128)
        order, (spectrum,) = order_spectrum(y, 128)
        for line in lines:
            near = np.abs(order - line) < 0.2
            assert order[near][spectrum[near].argmax()] == pytest.approx(line, abs=0.5 * 128 / y.shape[1])
            assert spectrum[near].max() > 8 * np.median(spectrum[near])
