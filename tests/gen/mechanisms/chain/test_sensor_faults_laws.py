"""Laws of the faults of the measuring chain: effect of each on samples and spectrum, and that its flag is true."""

import math
from dataclasses import replace

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
from gen.physics.rattle import rattling
from gen.scenarios import Purpose, draw_scenarios
from tests.sensor_faults import SENSOR_FAULTS, rarely

FS, N = 12_000.0, 12_000
TIME = np.arange(N) / FS
MOUNT = {"frequency": 1500.0, "damping": 0.05, "holding": 1e6}
accelerations = st.floats(-100, 100, width=32)
signals = arrays(np.float64, (2, 64), elements=accelerations)


def rng(seed=0):
    return np.random.default_rng(seed)


def added(fault, drawn, shape=(1, N), seed=0):
    """What a fault adds to silence, shape (channel, time), and the values of its labels."""
    return fault.disturb(drawn, np.zeros(shape), FS, rng(seed))


def disturbed(signal, scenario):
    """Signal behind the measuring chain of a scenario, and the labels of its faults."""
    of = scenario.rig.sensor_faults, scenario.record.sensor_faults
    return disturb(signal, *of, FS, scenario.rng(Purpose.SENSOR_NOISE))


def hiss(seed=0, rms=10.0, shape=(2, 1200)):
    return (rms * rng(seed).standard_normal(shape)).astype(np.float32)


@pytest.mark.parametrize("sections", [{}, rarely(SENSOR_FAULTS, 0)])
def test_a_record_without_sensor_faults_keeps_every_bit(recipe_with, sections):
    signal = hiss()
    for scenario in draw_scenarios(recipe_with({"sensor_faults": sections})):
        assert not any(scenario.rig.sensor_faults)
        found, labels = disturbed(signal, scenario)
        assert np.array_equal(found, signal)
        assert labels == {}


@pytest.mark.parametrize("ratio", [0.1, 1 / 3, 1, 2])
def test_a_mount_transmits_like_a_mass_that_is_excited_through_a_spring_and_a_damper(ratio):
    wave = np.cos(2 * np.pi * 1500 * ratio * TIME)
    found = through_mount(wave, MOUNT, FS)
    loss = 2 * 0.05 * ratio
    expected = math.sqrt((1 + loss**2) / ((1 - ratio**2) ** 2 + loss**2))
    settled = slice(N // 2, N // 2 + 6000)  # whole periods
    assert math.sqrt(2 * np.mean(found[settled] ** 2)) == pytest.approx(expected, rel=1e-3)


def test_the_end_of_a_record_does_not_reach_its_start_through_the_mount():
    struck = np.zeros(N)
    struck[-2] = 1.0
    assert np.abs(through_mount(struck, MOUNT, FS)[: N // 2]).max() < 1e-3


def test_a_mount_has_settled_at_the_first_sample():
    power = np.mean([through_mount(hiss(seed, shape=(1, 1200))[0], MOUNT, FS) ** 2 for seed in range(300)], axis=0)
    assert power[:20].mean() == pytest.approx(power[600:].mean(), rel=0.25)


def test_a_sensor_that_is_held_hard_enough_resonates_and_does_not_rattle():
    signal = hiss()
    found, labels = LooseMount.disturb((None, MOUNT), signal, FS, rng())
    assert labels == {"loose_mount": 1, "rattle": 0}
    np.testing.assert_array_equal(found[0], signal[0])
    np.testing.assert_allclose(found[1], through_mount(signal[1], MOUNT, FS), rtol=1e-6)


def test_a_loose_sensor_shows_the_impacts_that_are_counted():
    wave = np.zeros((1, N))
    wave[0, 1000:1120] = -60.0
    mount = MOUNT | {"holding": 20.0}
    found, labels = LooseMount.disturb((mount,), wave, FS, rng())
    held = through_mount(wave[0], mount, FS)
    assert labels["rattle"] == rattling(held, 1500.0, 0.05, 20.0, FS)[1] >= 1
    assert found.min() >= -20
    assert found.max() > 3 * np.abs(held).max()


LINEAR = {"limit": 20.0, "knee": 0.0, "recovery": 0.0}


@given(signals, st.floats(1, 90), st.sampled_from([0.0, 0.1, 0.5, 1.0]))
def test_an_amplifier_never_exceeds_its_limit_and_is_linear_below_its_knee(signal, limit, knee):
    drawn, half_knee = {"limit": limit, "knee": knee, "recovery": 0.0}, knee * limit
    found, labels = Saturation.disturb(drawn, signal, FS, rng())
    assert np.abs(found).max() <= limit * (1 + 1e-12)
    below = np.abs(signal) <= limit - half_knee
    np.testing.assert_array_equal(found[below], signal[below])
    beyond = np.abs(signal) >= limit + half_knee
    assert labels["saturated"] == np.count_nonzero(beyond)
    np.testing.assert_allclose(np.abs(found[beyond]), limit, rtol=1e-12)
    np.testing.assert_array_equal(Saturation.disturb(drawn, -signal, FS, rng())[0], -found)


def test_the_knee_is_smooth_and_ends_at_the_limit():
    given = np.linspace(0, 40, 4001)[None]
    found, labels = Saturation.disturb({"limit": 20.0, "knee": 0.5, "recovery": 0.0}, given, FS, rng())
    slope = np.diff(found[0]) / np.diff(given[0])
    assert np.abs(np.diff(slope)).max() < 1e-3
    assert slope[0] == pytest.approx(1.0)
    assert found[0, given[0] >= 30] == pytest.approx(20.0)
    assert labels["saturated"] == np.count_nonzero(given >= 30)


def test_an_overload_shifts_the_baseline_to_the_other_side_until_the_amplifier_has_recovered():
    struck = np.zeros((1, N))
    struck[:, 1000:1024] = 100.0
    found, labels = Saturation.disturb({**LINEAR, "recovery": 0.02}, struck, FS, rng())
    after = found[0, 1024:]
    assert labels["saturated"] == 24
    assert after[0] == pytest.approx(-80 * (1 - math.exp(-24 / 240)), rel=0.01)
    assert after[240] / after[0] == pytest.approx(math.exp(-1))
    assert not found[0, :1000].any()


def test_a_settling_baseline_decays_with_its_time_constant():
    drawn = {"wander": 0.0, "wander_corner": 1.0, "settling": 5.0, "settling_time": 0.25}
    found, _ = added(Drift, drawn, (2, N))
    np.testing.assert_allclose(found, np.tile(5 * np.exp(-TIME / 0.25), (2, 1)))


def test_a_wandering_baseline_has_its_rms_from_the_first_sample_on_and_forgets_at_its_corner():
    """Autocorrelation exp(-2 pi f t) of noise behind a low-pass filter of first order."""
    drawn = {"wander": 3.0, "wander_corner": 5.0, "settling": 0.0, "settling_time": 1.0}
    found, _ = added(Drift, drawn, (4000, 400))
    for sample in (0, 100, 399):
        assert found[:, sample].std() == pytest.approx(3.0, rel=0.05)  # 4 sigma of 4000
    assert np.mean(found[:, 0] * found[:, 399]) / 9 == pytest.approx(math.exp(-2 * np.pi * 5 * 399 / FS), abs=0.07)


@given(st.integers(0, 2**32 - 1), st.integers(1, 12), st.floats(1e-5, 0.01), st.sampled_from([0.0, 0.5, 1.0]))
def test_gaps_are_held_or_zero_at_the_same_times_in_all_channels_and_counted(seed, count, length, held):
    signal = 1 + rng(seed).random((3, 300))
    found, labels = DroppedSamples.disturb({"count": count, "gap": length, "held": held}, signal, FS, rng(seed))
    changed = found != signal
    assert (changed == changed[0]).all()
    assert 1 <= labels["dropped_samples"] == np.count_nonzero(changed[0]) <= count * max(round(length * FS), 1)
    assert not changed[0, 0]
    assert (found[changed] == 0).all() or held > 0
    previous = np.roll(found, 1, axis=1)
    assert ((found == previous) | (found == 0))[changed].all()
    assert (found[changed] != 0).all() or held < 1


def test_a_gap_of_almost_the_whole_record_leaves_the_first_sample():
    signal = 1 + rng().random((1, 50))
    found, labels = DroppedSamples.disturb({"count": 1, "gap": 99.0, "held": 1.0}, signal, FS, rng())
    assert labels["dropped_samples"] == 49
    assert (found == signal[0, 0]).all()


def test_gaps_before_the_converter_are_gaps_behind_it():
    signal, drawn = hiss(rms=200), {"count": 5, "gap": 0.002, "held": 0.5}
    converted = np.clip(np.rint(signal * 60), -32767, 32767)
    after, _ = DroppedSamples.disturb(drawn, converted, FS, rng())
    before, _ = DroppedSamples.disturb(drawn, signal, FS, rng())
    np.testing.assert_array_equal(np.clip(np.rint(before * 60), -32767, 32767), after)


@given(st.lists(st.tuples(st.floats(0, 0.999), st.floats(0.01, 100)), min_size=1, max_size=6))
def test_gain_steps_multiply_and_the_first_sample_has_a_gain_of_one(pairs):
    steps = tuple({"share": share, "gain": gain} for share, gain in sorted(pairs))
    (found,), labels = GainSteps.disturb(steps, np.ones((1, 1000)), FS, rng())
    assert labels == {"gain_steps": len(pairs)}
    assert found[0] == 1
    assert found[-1] == pytest.approx(math.prod(gain for _, gain in pairs))
    assert np.count_nonzero(np.diff(found)) <= len(pairs)


HUM = {"frequency": 50.0, "deviation": 0.0, "rms": 2.0, "count": 3.0, "third": -6.0}


def test_hum_has_lines_at_odd_multiples_of_the_mains_alone():
    spectrum = 2 / N * np.abs(np.fft.rfft(added(MainsHum, {**HUM, "deviation": 0.02})[0][0]))
    third = 10 ** (-6 / 20)
    for order, ratio in ((1, 1.0), (3, third), (5, 3 / 5 * third), (7, 3 / 7 * third)):
        assert spectrum[51 * order] == pytest.approx(math.sqrt(2) * 2 * ratio)
    assert np.count_nonzero(spectrum > 1e-9) == 4


def test_hum_beyond_half_the_sample_rate_does_not_alias():
    spectrum = np.abs(np.fft.rfft(added(MainsHum, {**HUM, "frequency": 2500.0})[0][0]))
    assert np.flatnonzero(spectrum > 1e-6).tolist() == [2500]


BURST = {"rate": 20.0, "frequency": 3000.0, "decay": 0.002, "peak": 10.0}


def test_a_burst_oscillates_at_its_frequency_and_decays_in_its_time():
    tried = (added(EmiBursts, {**BURST, "rate": 1.0}, seed=seed) for seed in range(1000))
    alone = next(found[0] for found, labels in tried if labels["emi_bursts"] == 1)
    start = int(np.flatnonzero(alone)[0])
    burst = alone[start : start + 480]
    size = np.sqrt(burst[0::4] ** 2 + burst[1::4] ** 2 * math.exp(2 / 24))  # a quarter of a period apart
    np.testing.assert_allclose(size[1:] / size[:-1], math.exp(-4 / 24), rtol=1e-6)
    assert not alone[:start].any()
    assert np.argmax(np.abs(np.fft.rfft(alone))) == pytest.approx(3000, abs=15)


def test_bursts_come_at_their_rate_with_their_peak():
    found = [added(EmiBursts, BURST, seed=seed) for seed in range(400)]
    assert np.mean([labels["emi_bursts"] for _, labels in found]) == pytest.approx(20, abs=1)
    energy = 100 / 2 / (1 - math.exp(-2 / 24))  # of one burst: half of peak^2 times the sum of exp(-2 n / 24)
    assert np.mean([np.sum(signal**2) for signal, _ in found]) == pytest.approx(20 * energy, rel=0.06)


def only(scenario, *names):
    """The same scenario with some of its sensor faults."""
    rig, record = (
        replace(part, sensor_faults={name: drawn for name, drawn in part.sensor_faults.items() if name in names})
        for part in (scenario.rig, scenario.record)
    )
    return replace(scenario, rig=rig, record=record)


@pytest.fixture(scope="module")
def dirty(recipe_with):
    recipe = recipe_with({"sensor_faults": SENSOR_FAULTS, "recording.channels": [{"name": name} for name in "ab"]})
    return draw_scenarios(recipe)


@pytest.mark.parametrize("fault", CHAIN, ids=lambda fault: fault.place)
def test_a_label_is_set_by_its_own_fault_and_by_no_other(dirty, fault):
    labels = disturbed(hiss(), only(dirty[0], fault.place))[1]
    assert {name for name, value in labels.items() if value} == {label.name for label in fault.labels}


def test_the_streams_of_no_two_faults_are_the_same():
    """A stream of its own keeps the values of each fault where they are when another comes or goes."""
    for kind in ("rig_stream", "record_stream", "noise_stream"):
        numbers = [number for fault in CHAIN if (number := getattr(fault, kind)) is not None]
        assert sorted(numbers) == list(range(len(numbers)))


@pytest.mark.parametrize("names", [("mains_hum", "drift"), ("drift", "emi_bursts"), ("emi_bursts", "mains_hum")])
def test_the_random_times_of_a_fault_do_not_depend_on_the_other_faults(dirty, names):
    """Faults ahead of the amplifier add up, so each can be found as a difference."""
    silence = np.zeros((2, 1200))
    one, other, both = (disturbed(silence, only(dirty[0], *some))[0] for some in (names[:1], names[1:], names))
    np.testing.assert_allclose(one + other, both, atol=1e-12)


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


def test_everything_ahead_of_the_amplifier_stays_within_its_limit(dirty):
    for scenario in dirty:
        assert np.abs(disturbed(hiss(rms=40.0), scenario)[0]).max() <= 20 * (1 + 1e-6)


def test_sensor_faults_of_a_faulty_record_and_of_its_twin_are_the_same(dirty):
    signal = hiss()
    for scenario in dirty[:8]:
        one, other = disturbed(signal, scenario), disturbed(signal, scenario.without_fault())
        np.testing.assert_array_equal(one[0], other[0])
        assert one[1] == other[1]


def test_flags_count_what_is_in_the_record(recipe_with):
    """Channels on loose mounts are those that change, bursts that do not occur are not counted, and a baseline below 0 counts as well."""
    sections = {
        "loose_mount": {**SENSOR_FAULTS["loose_mount"], "probability": 0.5},
        "drift": {**SENSOR_FAULTS["drift"], "settling_m_s2": -30},
        "emi_bursts": {**SENSOR_FAULTS["emi_bursts"], "rate_hz": 5},
    }
    channels = [{"name": name} for name in "ab"]
    recipe = recipe_with({"sensor_faults": sections, "recording.channels": channels, "corpus.rigs": 12})
    signal, silence, seen, loose = hiss(), np.zeros((2, 1200)), set(), set()
    for scenario in draw_scenarios(recipe):
        found, flags = disturbed(signal, only(scenario, "loose_mount"))
        assert flags.get("loose_mount", 0) == np.count_nonzero((found != signal).any(axis=1))
        loose.add(flags.get("loose_mount", 0))
        found, flags = disturbed(silence, only(scenario, "drift"))
        assert flags["drift"] == np.abs(found).max() > 10
        found, flags = disturbed(silence, only(scenario, "emi_bursts"))
        assert (flags["emi_bursts"] > 0) == found.any()
        seen.add(flags["emi_bursts"])
    assert loose == {0, 1, 2}
    assert 0 in seen
    assert len(seen) > 1


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_record_that_diverged_is_passed_on_without_a_warning(dirty, value):
    signal = hiss()
    signal[:, 600:] = value
    found, flags = disturbed(signal, dirty[0])
    assert found is signal
    assert flags == {}
