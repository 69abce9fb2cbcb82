"""The benchmark of machine conditions: it finds the growth, the phase, the levels and the envelope of made-up recordings."""

import numpy as np
import pytest

from benchmarks.machine_conditions import FS, SECONDS, SPEEDS, Recording, summary


def recording(rpm, seed=0):
    """An orbit at 1x whose size grows with the square of the speed, a third line 20 dB lower, and noise that comes and goes."""
    rng, angle = np.random.default_rng(seed), 2 * np.pi * rpm / 60 * np.arange(round(FS * SECONDS)) / FS
    noise = 0.3 * rng.standard_normal((2, len(angle))) * (1 + 0.8 * np.cos(2 * angle))
    orbit = np.stack([np.cos(angle), 0.5 * np.sin(angle)]) * 10 * (rpm / SPEEDS[-1]) ** 2
    return Recording("made up", rpm, noise + orbit + np.cos(3 * angle) * 10 ** (-20 / 20) * 10)


def test_a_made_up_machine_has_the_numbers_that_it_was_made_with():
    found = summary([recording(rpm, seed) for rpm in SPEEDS for seed in range(2)])
    assert found["growth of 1x with speed, exponent"] == pytest.approx(2, abs=0.01)
    assert found["second over first channel at 1x [dB]"] == pytest.approx(20 * np.log10(0.5), abs=0.1)
    assert found["phase between the channels at 1x [deg]"] == pytest.approx(90, abs=1)
    assert found["envelope at order 2 [dB]"] > 20 > found["envelope at order 5 [dB]"] + 10
    # one line of the four is there, so that the median is that of the noise
    assert found["order 1 [dB]"] > found["orders 2 to 5 [dB]"] + 30
    assert 0.8 < found["share of power in whole orders"] < 1
