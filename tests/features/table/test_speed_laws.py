"""Laws of the estimated shaft speed of signals: wrong labels are found, and noise and healthy machines raise no alarm."""

from math import cos
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from features import shaft_speed

FS, SAMPLES = 12_000.0, 6000
seeds = st.integers(0, 2**32 - 1)


class Bearing(NamedTuple):
    ftf: float
    bpfo: float
    bpfi: float
    bsf: float


def bearing(balls, ratio, angle=0.0):
    """Nominal orders from the number of balls, ball over pitch diameter, and contact angle [rad] (Randall and Antoni, 2011)."""
    share = ratio * cos(angle)
    return Bearing(
        0.5 * (1 - share), 0.5 * balls * (1 - share), 0.5 * balls * (1 + share), 0.5 / ratio * (1 - share**2)
    )


ORDERS = bearing(9, 0.2)


def harmonics(t, rate, count=6):
    return np.sum([np.cos(2 * np.pi * k * rate * t + k) / k for k in range(1, count + 1)], axis=0)


def recording(seed, rate, order=None, windows=4, shaft=0.5, noise=1.0):
    """Windows of a machine: noise, harmonics of its shaft, and impulses at an order that excite a resonance, modulated."""
    rng = np.random.default_rng(seed)
    t = np.arange(windows * SAMPLES) / FS
    x = noise * rng.standard_normal(len(t)) + shaft * harmonics(t, rate)
    if order is not None:
        since = np.mod(t + rng.uniform(), 1 / (order * rate))
        modulation = 1 + 0.4 * np.cos(2 * np.pi * rate * t)
        x += 8 * modulation * np.exp(-900 * since) * np.sin(2 * np.pi * 2800 * since)
    return x.reshape(windows, SAMPLES)


geometries = st.tuples(st.integers(7, 13), st.floats(0.15, 0.28), st.floats(0.0, 0.4))


@given(seeds, geometries, st.sampled_from(["bpfo", "bpfi", "2bsf"]), st.floats(12.0, 45.0), st.floats(-0.075, 0.075))
def test_a_train_of_impulses_with_a_wrong_label_is_found_within_its_uncertainty(seed, geometry, family, rate, error):
    orders = bearing(*geometry)
    order = {"bpfo": orders.bpfo, "bpfi": orders.bpfi, "2bsf": 2 * orders.bsf}[family]
    found = shaft_speed(recording(seed, rate, order), FS, rate / (1 + error), orders)
    if found.clear:
        assert abs(found.rate - rate) < 3 * found.uncertainty
        assert found.uncertainty < 0.04 * rate
    if not found.agrees:
        assert abs(error) > 0.005


@pytest.mark.parametrize("family", ["bpfo", "bpfi", "2bsf"])
def test_clear_estimates_are_common_and_their_errors_are_within_two_uncertainties(family):
    rng = np.random.default_rng(7)
    clear, within = 0, 0
    for seed in range(24):
        orders = bearing(rng.integers(7, 14), rng.uniform(0.15, 0.28))
        order = {"bpfo": orders.bpfo, "bpfi": orders.bpfi, "2bsf": 2 * orders.bsf}[family]
        rate, error = rng.uniform(12, 45), rng.uniform(-0.075, 0.075)
        found = shaft_speed(recording(seed, rate, order), FS, rate / (1 + error), orders)
        clear += found.clear
        within += found.clear and abs(found.rate - rate) < 2 * found.uncertainty
    assert clear >= 12
    assert within >= 0.95 * clear


def clear_in_noise(windows, recordings=300):
    """Of so many recordings of noise, those whose speed is clear."""
    rng = np.random.default_rng(3)
    clear = 0
    for _ in range(recordings):
        orders = bearing(rng.integers(7, 14), rng.uniform(0.15, 0.28))
        clear += shaft_speed(rng.standard_normal((windows, SAMPLES)), FS, rng.uniform(9, 50), orders).clear
    return clear


def test_noise_alone_is_clear_in_less_than_one_per_cent():
    """Of eight windows too: tests/thorough/test_speed_laws.py."""
    assert clear_in_noise(1, 150) <= 1


def test_a_healthy_machine_with_the_right_label_raises_no_alarm():
    rng = np.random.default_rng(4)
    alarms = 0
    for seed in range(150):
        orders, rate = bearing(rng.integers(7, 14), rng.uniform(0.15, 0.28)), rng.uniform(12, 45)
        alarms += not shaft_speed(recording(seed, rate, windows=2, shaft=rng.uniform(0, 1)), FS, rate, orders).agrees
    assert alarms <= 1


@pytest.mark.parametrize("mains", [50.0, 60.0])
def test_the_mains_beside_a_shaft_harmonic_raise_no_alarm(mains):
    rng = np.random.default_rng(5)
    t = np.arange(4 * SAMPLES) / FS
    for seed in range(40):
        rate = mains / rng.integers(1, 4) * rng.uniform(0.95, 1.05)
        hum = rng.uniform(0.5, 3) * np.sum([np.cos(2 * np.pi * k * mains * t) / k for k in (1, 2, 3, 5)], axis=0)
        x = recording(seed, rate) + hum.reshape(4, SAMPLES)
        assert shaft_speed(x, FS, rate, ORDERS).agrees


def test_a_bearing_other_than_the_one_named_does_not_pass_as_a_speed():
    wrong = Bearing(ORDERS.ftf, 1.05 * ORDERS.bpfo, 1.05 * ORDERS.bpfi, 1.05 * ORDERS.bsf)
    for seed in range(10):
        assert not shaft_speed(recording(seed, 25.0, ORDERS.bpfo, shaft=1.0), FS, 25.0, wrong).clear


@given(seeds, st.permutations(range(4)), st.floats(1e-3, 1e3))
def test_order_of_windows_and_gain_change_nothing(seed, order, gain):
    x = recording(seed, 25.0, ORDERS.bpfo)
    once, again = shaft_speed(x, FS, 26.0, ORDERS), shaft_speed(gain * x[list(order)], FS, 26.0, ORDERS)
    assert again.clear == once.clear
    assert again.rate == pytest.approx(once.rate, rel=2e-3)
    assert again.uncertainty == pytest.approx(once.uncertainty, rel=0.02)


def test_one_long_signal_is_cut_like_its_windows():
    x = recording(0, 25.0, ORDERS.bpfo, windows=8)
    assert shaft_speed(x.ravel(), FS, 26.0, ORDERS) == shaft_speed(x.reshape(4, -1), FS, 26.0, ORDERS)


def test_a_window_of_less_than_two_turns_is_not_used():
    x = recording(0, 25.0, ORDERS.bpfo)[:, :900]  # 75 ms
    assert np.isnan(shaft_speed(x, FS, 25.0, ORDERS).rate)
    assert shaft_speed(x, FS, 27.0, ORDERS).rate > 0


@pytest.mark.parametrize(("fs", "rate"), [(0.0, 25.0), (FS, -1.0), (np.nan, 25.0), (FS, np.inf)])
def test_rates_that_are_not_positive_are_refused(fs, rate):
    with pytest.raises(ValueError, match="give them in Hz"):
        shaft_speed(np.ones((1, 10)), fs, rate, ORDERS)
