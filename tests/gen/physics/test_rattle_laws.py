"""Laws of a sensor that lifts off its mount: what holds it, how long it flies, and that it comes back to rest."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.integrate import solve_ivp

from gen.physics.rattle import rattling

FS = 12_000.0
REST = np.zeros(100_000)  # eight seconds: bounces of the hardest throw below take five


@given(
    arrays(np.float64, 200, elements=st.floats(-100, 100, width=32)),
    st.floats(5, 80),
    st.floats(0.05, 0.3),
    st.sampled_from([300.0, 1500.0, 5000.0, 15_000.0]),
)
def test_a_rattling_sensor_is_never_pulled_harder_than_it_is_held_and_comes_back_to_rest(
    shaken, holding, damping, frequency
):
    held = np.concatenate([shaken, REST])
    rattled, impacts = rattling(held, frequency, damping, holding, FS)
    assert rattled.min() >= -holding
    assert (impacts > 0) == bool((held < -holding).any())
    assert np.abs(rattled[-1000:]).max() < 1e-6 * holding


@given(arrays(np.float64, 200, elements=st.floats(-100, 100, width=32)), st.floats(100, 1000))
def test_a_sensor_that_is_held_hard_enough_keeps_every_bit(shaken, holding):
    rattled, impacts = rattling(shaken, 1500.0, 0.05, holding, FS)
    assert impacts == 0
    np.testing.assert_array_equal(rattled, shaken)


@given(st.floats(20, 90), st.integers(24, 240))
def test_a_flight_takes_the_time_of_a_thrown_body(fall, samples):
    """The machine falls away faster than the sensor follows, which then closes the gap with the holding acceleration of 10 m/s2."""
    held = np.concatenate([np.zeros(1000), np.full(samples, -fall), REST])
    rattled, _ = rattling(held, 5000.0, 0.3, 10.0, FS)
    excess, time = fall - 10.0, samples / FS
    rest = (excess * time + math.sqrt(excess**2 * time**2 + 10 * excess * time**2)) / 10
    landed = 1000 + int(np.argmax(rattled[1000:] != -10.0))
    assert (landed - 1000) / FS == pytest.approx(time + rest, abs=3 / FS)


def test_the_motion_does_not_depend_on_the_sample_rate():
    """Landings between two samples are found: a coarse rate gives the samples of a fine one, for as long as bounces do not grow apart."""
    fine = -100 * np.sin(2 * np.pi * 100 * np.arange(1920) / 192_000) * np.hanning(1920)
    fine = np.concatenate([fine, np.zeros(3840)])
    (exact, impacts), (coarse, same) = (
        rattling(fine[::every], 1500.0, 0.2, 20.0, 192_000 / every) for every in (1, 16)
    )
    assert same == impacts >= 2
    assert np.sqrt(np.mean((coarse - exact[::16]) ** 2)) < 0.1 * np.std(exact)


def test_the_motion_is_that_of_a_mass_on_a_spring_that_cannot_pull():
    """The equation of motion of the sensor itself, integrated by another method: a mass that rests on a preloaded spring and damper."""
    omega, zeta, holding, fs = 2 * np.pi * 800.0, 0.1, 20.0, 48_000.0
    time = np.arange(2400) / fs
    first = slice(1200)  # three periods of the machine; later impacts grow apart, as those of a bouncing ball do

    def base(t):
        return 60 * np.sin(2 * np.pi * 120 * t)

    def motion(t, state):
        linear, its_rate, d, rate = state[0], state[1], state[2], state[3]
        held = -(omega**2) * linear - 2 * zeta * omega * its_rate
        total = -(omega**2) * (linear + d) - 2 * zeta * omega * (its_rate + rate)
        sensor = max(total, -holding)
        return [its_rate, held - base(t), rate, sensor - held]

    solved = solve_ivp(motion, (0, time[-1]), [0, 0, 0, 0], t_eval=time, rtol=1e-8, atol=1e-12, max_step=4e-6)
    linear, its_rate, d, rate = solved.y
    held = -(omega**2) * linear - 2 * zeta * omega * its_rate
    sensor = np.maximum(-(omega**2) * (linear + d) - 2 * zeta * omega * (its_rate + rate), -holding)
    rattled, impacts = rattling(held, 800.0, zeta, holding, fs)
    assert impacts >= 3
    assert np.sqrt(np.mean((rattled - sensor)[first] ** 2)) < 0.05 * np.std(sensor)
