"""Laws of a line of an envelope: its place, the wander of its phase, its sidebands, its cyclostationarity."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal.windows import tukey

from features.signal.demodulation import fine_amplitudes, weight_by_hann
from features.signal.modulation import TAPERED, cyclostationarity, highest_place, phase_wander, sideband_ratio

law = settings(max_examples=10)
RATE, N = 5000.0, 10_000
TIME = np.arange(N) / RATE


WEIGHT = tukey(N, TAPERED)


def of(value):
    return np.array([value])


def deviation(phase):
    """Weighted rms deviation of a phase from its best straight line."""
    residual = phase - np.polyval(np.polyfit(TIME, phase, 1, w=WEIGHT), TIME)
    return np.sqrt(np.average(residual**2, weights=WEIGHT**2))


@law
@given(st.floats(0.02, 0.6), st.floats(2.0, 6.0), st.floats(0.0, 6.0))
def test_the_wander_of_a_line_is_the_rms_of_its_phase_modulation(rms, rate, start):
    drift = np.sqrt(2) * rms * np.sin(2 * np.pi * rate * TIME + start)
    envelope = (2 + np.cos(2 * np.pi * 110.0 * TIME + drift))[None]
    assert phase_wander(envelope, RATE, of(110.0), of(40.0))[0] == pytest.approx(deviation(drift), rel=0.05, abs=0.005)


@pytest.mark.parametrize("share", [0.01, 0.03])
def test_the_line_of_pulses_that_walk_at_random_wanders_as_the_walk(share):
    """The phase of the line at the pulse rate is 2 pi times the deviation of the pulses, in spacings."""
    rng = np.random.default_rng(4)
    found, walked = [], []
    for _ in range(40):
        walk = np.cumsum(share * rng.standard_normal(200))
        instants = (np.arange(200) + walk) / 100.0
        envelope = np.exp(-(((TIME[:, None] - instants) / 0.0005) ** 2)).sum(axis=1)
        walked.append(deviation(2 * np.pi * np.interp(TIME, instants, walk)))
        found.append(phase_wander(envelope[None], RATE, of(100.0), of(40.0))[0])
    assert np.mean(found) == pytest.approx(np.mean(walked), rel=0.05)


def test_the_highest_place_is_searched_within_the_tolerance_alone():
    level = np.zeros((2, 200))
    level[:, [96, 102, 107]] = [3.0, 1.0, 3.0]
    assert highest_place(level, np.array([100.0, 150.0]), 0.03).tolist() == [102, 145]
    assert highest_place(level, np.array([98.0, 1e4]), 0.03).tolist() == [96, 199]


@law
@given(st.floats(0.1, 0.9), st.floats(20.0, 40.0))
def test_the_sidebands_of_an_amplitude_modulation_are_half_its_depth(depth, spacing):
    envelope = (3 + (1 + depth * np.cos(2 * np.pi * spacing * TIME)) * np.cos(2 * np.pi * 120.0 * TIME))[None]
    spectrum = fine_amplitudes(weight_by_hann(envelope), 2 * N + 1)
    per_hz = 4 * N / RATE
    found = sideband_ratio(spectrum, np.array([round(120 * per_hz)]), of(spacing * per_hz), 2)
    assert found[0] == pytest.approx(depth / 2, rel=0.02)


@law
@given(st.floats(0.0, 1.0), st.floats(0.01, 100.0))
def test_the_cyclostationarity_of_a_cosine_is_a_quarter_of_its_squared_depth(depth, gain):
    power = gain * (1 + depth * np.cos(2 * np.pi * 100.0 * TIME))[None]
    assert cyclostationarity(power, RATE, of(100.0), 3)[0] == pytest.approx(depth**2 / 4, abs=1e-6)


def test_sharp_pulses_have_a_cyclostationarity_of_one_per_harmonic_and_noise_has_none():
    power = np.zeros((1, N))
    power[0, ::50] = 1.0
    assert cyclostationarity(power, RATE, of(100.0), 3)[0] == pytest.approx(3.0, abs=0.01)
    noise = np.random.default_rng(0).exponential(size=(20, N))
    assert cyclostationarity(noise, RATE, np.full(20, 100.0), 3).mean() < 10 / N
