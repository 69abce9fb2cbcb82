"""Laws of the faults of the measuring chain: effect of each on samples and spectrum, and that its flag is true."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from gen.mechanisms.chain.drift import Drift
from gen.mechanisms.chain.dropped_samples import DroppedSamples
from gen.mechanisms.chain.emi_bursts import EmiBursts
from gen.mechanisms.chain.gain_steps import GainSteps
from gen.mechanisms.chain.loose_mount import LooseMount, through_mount
from gen.mechanisms.chain.mains_hum import MainsHum
from gen.mechanisms.chain.measuring_chain import CHAIN, disturb
from gen.mechanisms.chain.saturation import Saturation
from gen.mechanisms.mechanism import mechanisms_of
from gen.physics.rattle import rattling
from gen.scenarios import draw_scenarios
from tests.measuring import drawn
from tests.sensor_faults import SENSOR_FAULTS, rarely

FS, N = 12_000.0, 12_000
TIME = np.arange(N) / FS
MOUNT = 1500.0, 0.05  # frequency [Hz] and damping ratio
accelerations = st.floats(-100, 100, width=32)
signals = arrays(np.float64, (2, 64), elements=accelerations)


def rng(seed=0):
    return np.random.default_rng(seed)


def added(fault, shape=(1, N), seed=0):
    """What a fault adds to silence, shape (channel, time), and the values of its labels."""
    return through(fault, np.zeros(shape), seed)


def through(fault, signal, seed=0):
    """Signal with a fault, and the values of its labels by name."""
    found, *values = fault.disturb(signal, FS, rng(seed))
    return found, dict(zip([label.name for label in fault.labels], values, strict=True))


def disturbed(signal, scenario):
    """Signal behind the measuring chain of a scenario, and the labels of its faults."""
    return disturb(signal, scenario.recipe.sensor_faults, FS, scenario.stream)


def hiss(seed=0, rms=10.0, shape=(2, 1200)):
    return (rms * rng(seed).standard_normal(shape)).astype(np.float32)


@pytest.mark.parametrize("sections", [{}, rarely(SENSOR_FAULTS, 0)])
def test_a_record_without_sensor_faults_keeps_every_bit(recipe_with, sections):
    signal = hiss()
    for scenario in draw_scenarios(recipe_with({"sensor_faults": sections})):
        assert not [*mechanisms_of(scenario.recipe.sensor_faults)]
        found, labels = disturbed(signal, scenario)
        assert np.array_equal(found, signal)
        assert labels == {}


@pytest.mark.parametrize("ratio", [0.1, 1 / 3, 1, 2])
def test_a_mount_transmits_like_a_mass_that_is_excited_through_a_spring_and_a_damper(ratio):
    wave = np.cos(2 * np.pi * 1500 * ratio * TIME)
    found = through_mount(wave, *MOUNT, FS)
    loss = 2 * 0.05 * ratio
    expected = math.sqrt((1 + loss**2) / ((1 - ratio**2) ** 2 + loss**2))
    settled = slice(N // 2, N // 2 + 6000)  # whole periods
    assert math.sqrt(2 * np.mean(found[settled] ** 2)) == pytest.approx(expected, rel=1e-3)


def loosely_mounted(channel, holding):
    return drawn(LooseMount, loose_channels=[channel], frequency_hz=[1500], damping_percent=[5], holding_m_s2=[holding])


def test_a_sensor_that_is_held_hard_enough_resonates_and_does_not_rattle():
    signal = hiss()
    found, labels = through(loosely_mounted(1, 1e6), signal)
    assert labels == {"loose_mount": 1, "rattle": 0}
    np.testing.assert_array_equal(found[0], signal[0])
    np.testing.assert_allclose(found[1], through_mount(signal[1], *MOUNT, FS), rtol=1e-6)


def test_a_loose_sensor_shows_the_impacts_that_are_counted():
    wave = np.zeros((1, N))
    wave[0, 1000:1120] = -60.0
    found, labels = through(loosely_mounted(0, 20), wave)
    held = through_mount(wave[0], *MOUNT, FS)
    assert labels["rattle"] == rattling(held, *MOUNT, 20.0, FS)[1] >= 1
    assert found.min() >= -20
    assert found.max() > 3 * np.abs(held).max()


@given(signals, st.floats(1, 90), st.sampled_from([0, 10, 50, 100]))
def test_an_amplifier_never_exceeds_its_limit_and_is_linear_below_its_knee(signal, limit, knee):
    amplifier, half_knee = drawn(Saturation, limit_m_s2=limit, knee_percent=knee), knee / 100 * limit
    found, labels = through(amplifier, signal)
    assert np.abs(found).max() <= limit * (1 + 1e-12)
    below = np.abs(signal) <= limit - half_knee
    np.testing.assert_array_equal(found[below], signal[below])
    beyond = np.abs(signal) >= limit + half_knee
    assert labels["saturated"] == np.count_nonzero(beyond)
    np.testing.assert_allclose(np.abs(found[beyond]), limit, rtol=1e-12)
    np.testing.assert_array_equal(through(amplifier, -signal)[0], -found)


def test_an_overload_shifts_the_baseline_to_the_other_side_until_the_amplifier_has_recovered():
    struck = np.zeros((1, N))
    struck[:, 1000:1024] = 100.0
    found, labels = through(drawn(Saturation, limit_m_s2=20, recovery_s=0.02), struck)
    after = found[0, 1024:]
    assert labels["saturated"] == 24
    assert after[0] == pytest.approx(-80 * (1 - math.exp(-24 / 240)), rel=0.01)
    assert after[240] / after[0] == pytest.approx(math.exp(-1))
    assert not found[0, :1000].any()


def test_a_settling_baseline_decays_with_its_time_constant():
    found, _ = added(drawn(Drift, settling_m_s2=5, settling_time_s=0.25), (2, N))
    np.testing.assert_allclose(found, np.tile(5 * np.exp(-TIME / 0.25), (2, 1)))


def test_a_wandering_baseline_has_its_rms_from_the_first_sample_on_and_forgets_at_its_corner():
    """Autocorrelation exp(-2 pi f t) of noise behind a low-pass filter of first order."""
    found, _ = added(drawn(Drift, wander_m_s2=3, wander_corner_hz=5), (4000, 400))
    for sample in (0, 100, 399):
        assert found[:, sample].std() == pytest.approx(3.0, rel=0.05)  # 4 sigma of 4000
    assert np.mean(found[:, 0] * found[:, 399]) / 9 == pytest.approx(math.exp(-2 * np.pi * 5 * 399 / FS), abs=0.07)


@given(st.integers(0, 2**32 - 1), st.integers(1, 12), st.floats(1e-5, 0.01), st.sampled_from([0, 50, 100]))
def test_gaps_are_held_or_zero_at_the_same_times_in_all_channels_and_counted(seed, count, length, held):
    signal = 1 + rng(seed).random((3, 300))
    gaps = drawn(DroppedSamples, count=count, gap_s=length, held_percent=held)
    found, labels = through(gaps, signal, seed)
    changed = found != signal
    assert (changed == changed[0]).all()
    assert 1 <= labels["dropped_samples"] == np.count_nonzero(changed[0]) <= count * max(round(length * FS), 1)
    assert not changed[0, 0]
    assert (found[changed] == 0).all() or held > 0
    previous = np.roll(found, 1, axis=1)
    assert ((found == previous) | (found == 0))[changed].all()
    assert (found[changed] != 0).all() or held < 100


@given(st.lists(st.floats(-40, 40), min_size=1, max_size=6), st.integers(0, 2**32 - 1))
def test_gain_steps_multiply_and_the_first_sample_has_a_gain_of_one(steps, seed):
    (found,), labels = through(drawn(GainSteps, count=len(steps), step_db=steps), np.ones((1, 1000)), seed)
    assert labels == {"gain_steps": len(steps)}
    assert found[0] == 1
    assert found[-1] == pytest.approx(10 ** (sum(steps) / 20))
    assert np.count_nonzero(np.diff(found)) <= len(steps)


def hum(**changes):
    return added(drawn(MainsHum, **({"rms_m_s2": 2, "third_db": -6} | changes)))[0][0]


def test_hum_has_lines_at_odd_multiples_of_the_mains_alone():
    spectrum = 2 / N * np.abs(np.fft.rfft(hum(deviation_percent=2)))
    third = 10 ** (-6 / 20)
    for order, ratio in ((1, 1.0), (3, third), (5, 3 / 5 * third), (7, 3 / 7 * third)):
        assert spectrum[51 * order] == pytest.approx(math.sqrt(2) * 2 * ratio)
    assert np.count_nonzero(spectrum > 1e-9) == 4


def bursts(rate):
    return drawn(EmiBursts, rate_hz=rate, frequency_hz=3000, decay_s=0.002, peak_m_s2=10)


def test_a_burst_oscillates_at_its_frequency_and_decays_in_its_time():
    tried = (added(bursts(1), seed=seed) for seed in range(1000))
    alone = next(found[0] for found, labels in tried if labels["emi_bursts"] == 1)
    start = int(np.flatnonzero(alone)[0])
    burst = alone[start : start + 480]
    size = np.sqrt(burst[0::4] ** 2 + burst[1::4] ** 2 * math.exp(2 / 24))  # a quarter of a period apart
    np.testing.assert_allclose(size[1:] / size[:-1], math.exp(-4 / 24), rtol=1e-6)
    assert not alone[:start].any()
    assert np.argmax(np.abs(np.fft.rfft(alone))) == pytest.approx(3000, abs=15)


def only(scenario, *names):
    """The same scenario with some of its sensor faults."""
    section = scenario.recipe.sensor_faults
    others = {fault.place: None for fault in CHAIN if fault.place not in names}
    return scenario.edited(sensor_faults=section.model_copy(update=others))


@pytest.fixture(scope="module")
def dirty(recipe_with):
    recipe = recipe_with({"sensor_faults": SENSOR_FAULTS, "recording.channels": [{"name": name} for name in "ab"]})
    return draw_scenarios(recipe)


@pytest.mark.parametrize("fault", CHAIN, ids=lambda fault: fault.place)
def test_a_label_is_set_by_its_own_fault_and_by_no_other(dirty, fault):
    labels = disturbed(hiss(), only(dirty[0], fault.place))[1]
    assert {name for name, value in labels.items() if value} == {label.name for label in fault.labels}


def test_a_disturbed_record_keeps_shape_and_type_and_does_not_depend_on_other_records(dirty):
    signal = hiss()
    before = signal.copy()
    alone = disturbed(signal, dirty[5])
    for scenario in dirty:
        found, _ = disturbed(signal, scenario)
        assert (found.shape, found.dtype) == (signal.shape, signal.dtype)
    again = disturbed(signal, dirty[5])
    np.testing.assert_array_equal(alone[0], again[0])
    assert alone[1] == again[1]
    np.testing.assert_array_equal(signal, before)


def test_sensor_faults_of_a_faulty_record_and_of_its_twin_are_the_same(dirty):
    signal = hiss()
    for scenario in dirty[:8]:
        one, other = disturbed(signal, scenario), disturbed(signal, scenario.without_fault())
        np.testing.assert_array_equal(one[0], other[0])
        assert one[1] == other[1]
