"""Laws of the faults of the measuring chain: effect of each on samples and spectrum, and that its flag is true."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from gen.measurement.rattle import rattling
from gen.measurement.sensor_faults import (
    SensorFlags,
    disturb,
    drift,
    emi_bursts,
    gain_steps,
    mains_hum,
    mount_loosely,
    saturate,
    through_mount,
    with_gaps,
)
from gen.scenarios import draw_scenarios
from tests.sensor_faults import SENSOR_FAULTS, rarely

law = settings(deadline=None, max_examples=50)
FS, N = 12_000.0, 12_000
TIME = np.arange(N) / FS
MOUNT = {"frequency": 1500.0, "damping": 0.05, "holding": 1e6}
accelerations = st.floats(-100, 100, width=32)
signals = arrays(np.float64, (2, 64), elements=accelerations)


def rng(seed=0):
    return np.random.default_rng(seed)


def hiss(seed=0, rms=10.0, shape=(2, 1200)):
    return (rms * rng(seed).standard_normal(shape)).astype(np.float32)


@pytest.mark.parametrize("sections", [{}, rarely(SENSOR_FAULTS, 0)])
def test_a_record_without_sensor_faults_keeps_every_bit(recipe_with, sections):
    signal = hiss()
    for scenario in draw_scenarios(recipe_with({"sensor_faults": sections})):
        found, flags = disturb(signal, scenario, FS)
        assert np.array_equal(found, signal)
        assert flags == SensorFlags() == (0,) * 8


@pytest.mark.parametrize("ratio", [0.1, 1 / 3, 1, 2])
def test_a_mount_transmits_like_a_mass_that_is_excited_through_a_spring_and_a_damper(ratio):
    wave = np.cos(2 * np.pi * 1500 * ratio * TIME)
    found = through_mount(wave, MOUNT, FS)
    loss = 2 * 0.05 * ratio
    expected = math.sqrt((1 + loss**2) / ((1 - ratio**2) ** 2 + loss**2))
    settled = slice(N // 2, N // 2 + 6000)  # whole periods
    assert math.sqrt(2 * np.mean(found[settled] ** 2)) == pytest.approx(expected, rel=1e-3)


def test_a_mount_reads_an_eighth_too_much_at_a_third_of_its_resonance():
    """1 / (1 - 1/9) = 1.125, the rule by which the useful range of an accelerometer ends there."""
    wave = np.cos(2 * np.pi * 500 * TIME)
    found = through_mount(wave, {**MOUNT, "damping": 0.001, "frequency": 1500.0}, FS)
    assert np.ptp(found[N // 2 :]) / 2 == pytest.approx(1.125, rel=1e-3)


def test_the_end_of_a_record_does_not_reach_its_start_through_the_mount():
    struck = np.zeros(N)
    struck[-2] = 1.0
    assert np.abs(through_mount(struck, MOUNT, FS)[: N // 2]).max() < 1e-3


def test_a_mount_has_settled_at_the_first_sample():
    power = np.mean([through_mount(hiss(seed, shape=(1, 1200))[0], MOUNT, FS) ** 2 for seed in range(300)], axis=0)
    assert power[:20].mean() == pytest.approx(power[600:].mean(), rel=0.25)


def test_a_sensor_that_is_held_hard_enough_resonates_and_does_not_rattle():
    signal = hiss()
    found, impacts = mount_loosely(signal, (None, MOUNT), FS)
    assert impacts == 0
    np.testing.assert_array_equal(found[0], signal[0])
    np.testing.assert_allclose(found[1], through_mount(signal[1], MOUNT, FS), rtol=1e-6)


def test_a_loose_sensor_shows_the_impacts_that_are_counted():
    wave = np.zeros((1, N))
    wave[0, 1000:1120] = -60.0
    mount = MOUNT | {"holding": 20.0}
    found, impacts = mount_loosely(wave, (mount,), FS)
    held = through_mount(wave[0], mount, FS)
    assert impacts == rattling(held, 1500.0, 0.05, 20.0, FS)[1] >= 1
    assert found.min() >= -20
    assert found.max() > 3 * np.abs(held).max()


LINEAR = {"limit": 20.0, "knee": 0.0, "recovery": 0.0}


@law
@given(signals, st.floats(1, 90), st.sampled_from([0.0, 0.1, 0.5, 1.0]))
def test_an_amplifier_never_exceeds_its_limit_and_is_linear_below_its_knee(signal, limit, knee):
    drawn, half_knee = {"limit": limit, "knee": knee, "recovery": 0.0}, knee * limit
    found, count = saturate(signal, drawn, FS)
    assert np.abs(found).max() <= limit * (1 + 1e-12)
    below = np.abs(signal) <= limit - half_knee
    np.testing.assert_array_equal(found[below], signal[below])
    beyond = np.abs(signal) >= limit + half_knee
    assert count == np.count_nonzero(beyond)
    np.testing.assert_allclose(np.abs(found[beyond]), limit, rtol=1e-12)
    np.testing.assert_array_equal(saturate(-signal, drawn, FS)[0], -found)


def test_the_knee_is_smooth_and_ends_at_the_limit():
    given = np.linspace(0, 40, 4001)[None]
    found, count = saturate(given, {"limit": 20.0, "knee": 0.5, "recovery": 0.0}, FS)
    slope = np.diff(found[0]) / np.diff(given[0])
    assert np.abs(np.diff(slope)).max() < 1e-3
    assert slope[0] == pytest.approx(1.0)
    assert found[0, given[0] >= 30] == pytest.approx(20.0)
    assert count == np.count_nonzero(given >= 30)


def test_a_limited_sine_has_odd_harmonics_and_no_even_ones():
    found, _ = saturate(30 * np.cos(2 * np.pi * 100 * TIME)[None], LINEAR, FS)
    spectrum = 2 / N * np.abs(np.fft.rfft(found[0]))
    assert spectrum[300] > 1
    assert spectrum[[0, 200, 400, 600]].max() < 1e-9


def test_an_overload_shifts_the_baseline_to_the_other_side_until_the_amplifier_has_recovered():
    struck = np.zeros((1, N))
    struck[:, 1000:1024] = 100.0
    found, count = saturate(struck, {**LINEAR, "recovery": 0.02}, FS)
    after = found[0, 1024:]
    assert count == 24
    assert after[0] == pytest.approx(-80 * (1 - math.exp(-24 / 240)), rel=0.01)
    assert after[240] / after[0] == pytest.approx(math.exp(-1))
    assert not found[0, :1000].any()


def test_a_settling_baseline_decays_with_its_time_constant():
    found = drift({"wander": 0.0, "wander_corner": 1.0, "settling": 5.0, "settling_time": 0.25}, (2, N), FS, rng())
    np.testing.assert_allclose(found, np.tile(5 * np.exp(-TIME / 0.25), (2, 1)))


def test_a_wandering_baseline_has_its_rms_from_the_first_sample_on_and_forgets_at_its_corner():
    """Autocorrelation exp(-2 pi f t) of noise behind a low-pass filter of first order."""
    drawn = {"wander": 3.0, "wander_corner": 5.0, "settling": 0.0, "settling_time": 1.0}
    found = drift(drawn, (4000, 400), FS, rng())
    for sample in (0, 100, 399):
        assert found[:, sample].std() == pytest.approx(3.0, rel=0.05)  # 4 sigma of 4000
    assert np.mean(found[:, 0] * found[:, 399]) / 9 == pytest.approx(math.exp(-2 * np.pi * 5 * 399 / FS), abs=0.07)


def test_drift_is_a_disturbance_of_low_frequencies():
    """Beyond ten times its corner lies 1 - (2/pi) atan(10) = 6.3 % of its power."""
    drawn = {"wander": 1.0, "wander_corner": 10.0, "settling": 0.0, "settling_time": 1.0}
    found = drift(drawn, (200, N), FS, rng())
    power = np.mean(np.abs(np.fft.rfft(found)) ** 2, axis=0)
    assert power[100:].sum() / (power.sum() - power[0] / 2) == pytest.approx(0.063, abs=0.02)


@law
@given(st.integers(0, 2**32 - 1), st.integers(1, 12), st.floats(1e-5, 0.01), st.sampled_from([0.0, 0.5, 1.0]))
def test_gaps_are_held_or_zero_at_the_same_times_in_all_channels_and_counted(seed, count, length, held):
    signal = 1 + rng(seed).random((3, 300))
    found, lost = with_gaps(signal, {"count": count, "gap": length, "held": held}, FS, rng(seed))
    changed = found != signal
    assert (changed == changed[0]).all()
    assert 1 <= lost == np.count_nonzero(changed[0]) <= count * max(round(length * FS), 1)
    assert not changed[0, 0]
    assert (found[changed] == 0).all() or held > 0
    previous = np.roll(found, 1, axis=1)
    assert ((found == previous) | (found == 0))[changed].all()
    assert (found[changed] != 0).all() or held < 1


def test_a_gap_of_almost_the_whole_record_leaves_the_first_sample():
    signal = 1 + rng().random((1, 50))
    found, lost = with_gaps(signal, {"count": 1, "gap": 99.0, "held": 1.0}, FS, rng())
    assert lost == 49
    assert (found == signal[0, 0]).all()


def test_gaps_before_the_converter_are_gaps_behind_it():
    signal, drawn = hiss(rms=200), {"count": 5, "gap": 0.002, "held": 0.5}
    converted = np.clip(np.rint(signal * 60), -32767, 32767)
    after, _ = with_gaps(converted, drawn, FS, rng())
    before = with_gaps(signal, drawn, FS, rng())[0]
    np.testing.assert_array_equal(np.clip(np.rint(before * 60), -32767, 32767), after)


@law
@given(st.lists(st.tuples(st.floats(0, 0.999), st.floats(0.01, 100)), min_size=1, max_size=6))
def test_gain_steps_multiply_and_the_first_sample_has_a_gain_of_one(pairs):
    steps = tuple({"share": share, "gain": gain} for share, gain in sorted(pairs))
    found = gain_steps(steps, 1000)
    assert found[0] == 1
    assert found[-1] == pytest.approx(math.prod(gain for _, gain in pairs))
    assert np.count_nonzero(np.diff(found)) <= len(pairs)


HUM = {"frequency": 50.0, "rms": 2.0, "count": 3.0, "third": -6.0}


def test_hum_has_lines_at_odd_multiples_of_the_mains_alone():
    spectrum = 2 / N * np.abs(np.fft.rfft(mains_hum(HUM, 0.02, N, FS, rng())))
    third = 10 ** (-6 / 20)
    for order, ratio in ((1, 1.0), (3, third), (5, 3 / 5 * third), (7, 3 / 7 * third)):
        assert spectrum[51 * order] == pytest.approx(math.sqrt(2) * 2 * ratio)
    assert np.count_nonzero(spectrum > 1e-9) == 4


def test_hum_beyond_half_the_sample_rate_does_not_alias():
    spectrum = np.abs(np.fft.rfft(mains_hum({**HUM, "frequency": 2500.0}, 0.0, N, FS, rng())))
    assert np.flatnonzero(spectrum > 1e-6).tolist() == [2500]


BURST = {"rate": 20.0, "frequency": 3000.0, "decay": 0.002, "peak": 10.0}


def test_a_burst_oscillates_at_its_frequency_and_decays_in_its_time():
    alone = next(
        found for seed in range(1000) for found, count in [emi_bursts({**BURST, "rate": 1.0}, N, FS, rng(seed))] if count == 1
    )  # fmt: skip
    start = int(np.flatnonzero(alone)[0])
    burst = alone[start : start + 480]
    size = np.sqrt(burst[0::4] ** 2 + burst[1::4] ** 2 * math.exp(2 / 24))  # a quarter of a period apart
    np.testing.assert_allclose(size[1:] / size[:-1], math.exp(-4 / 24), rtol=1e-6)
    assert not alone[:start].any()
    assert np.argmax(np.abs(np.fft.rfft(alone))) == pytest.approx(3000, abs=15)


def test_bursts_come_at_their_rate_with_their_peak():
    found = [emi_bursts(BURST, N, FS, rng(seed)) for seed in range(400)]
    assert np.mean([count for _, count in found]) == pytest.approx(20, abs=1)
    energy = 100 / 2 / (1 - math.exp(-2 / 24))  # of one burst: half of peak^2 times the sum of exp(-2 n / 24)
    assert np.mean([np.sum(signal**2) for signal, _ in found]) == pytest.approx(20 * energy, rel=0.06)


def only(scenario, *names):
    """The same scenario with some of its sensor faults."""
    rig, record = scenario.rig.sensor_faults, scenario.record.sensor_faults
    mounts = rig.loose_mounts if "loose_mount" in names else (None,) * len(rig.loose_mounts)
    kept = {name: getattr(rig, name) if name in names else None for name in ("saturation", "mains_hum")}
    rig = replace(rig, loose_mounts=mounts, **kept)
    kept = {
        name: getattr(record, name) if name in names else None for name in ("drift", "dropped_samples", "emi_bursts")
    }
    record = replace(record, gain_steps=record.gain_steps if "gain_steps" in names else (), **kept)
    return replace(
        scenario, rig=replace(scenario.rig, sensor_faults=rig), record=replace(scenario.record, sensor_faults=record)
    )


@pytest.fixture(scope="module")
def dirty(recipe_with):
    recipe = recipe_with({"sensor_faults": SENSOR_FAULTS, "recording.channels": [{"name": name} for name in "ab"]})
    return draw_scenarios(recipe)


FLAG_OF = {"saturation": "saturated"}


@pytest.mark.parametrize("name", SENSOR_FAULTS)
def test_a_flag_is_set_by_its_own_fault_and_by_no_other(dirty, name):
    flags = disturb(hiss(), only(dirty[0], name), FS)[1]._asdict()
    own = {FLAG_OF.get(name, name)} | ({"rattle"} if name == "loose_mount" else set())
    assert {flag for flag, value in flags.items() if value} == own


@pytest.mark.parametrize("names", [("mains_hum", "drift"), ("drift", "emi_bursts"), ("emi_bursts", "mains_hum")])
def test_the_random_times_of_a_fault_do_not_depend_on_the_other_faults(dirty, names):
    """Faults ahead of the amplifier add up, so each can be found as a difference."""
    silence = np.zeros((2, 1200))
    one, other, both = (disturb(silence, only(dirty[0], *some), FS)[0] for some in (names[:1], names[1:], names))
    np.testing.assert_allclose(one + other, both, atol=1e-12)


def test_a_disturbed_record_keeps_shape_and_type_and_does_not_depend_on_other_records(dirty):
    signal = hiss()
    before = signal.copy()
    alone = disturb(signal, dirty[5], FS)
    for scenario in dirty:
        found, _ = disturb(signal, scenario, FS)
        assert (found.shape, found.dtype) == (signal.shape, signal.dtype)
    again = disturb(signal, dirty[5], FS)
    np.testing.assert_array_equal(alone[0], again[0])
    assert alone[1] == again[1]
    np.testing.assert_array_equal(signal, before)


def test_everything_ahead_of_the_amplifier_stays_within_its_limit(dirty):
    for scenario in dirty:
        assert np.abs(disturb(hiss(rms=40.0), scenario, FS)[0]).max() <= 20 * (1 + 1e-6)


def test_sensor_faults_of_a_faulty_record_and_of_its_twin_are_the_same(dirty):
    signal = hiss()
    for scenario in dirty[:8]:
        one, other = disturb(signal, scenario, FS), disturb(signal, scenario.without_fault(), FS)
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
        found, flags = disturb(signal, only(scenario, "loose_mount"), FS)
        assert flags.loose_mount == np.count_nonzero((found != signal).any(axis=1))
        loose.add(flags.loose_mount)
        found, flags = disturb(silence, only(scenario, "drift"), FS)
        assert flags.drift == np.abs(found).max() > 10
        found, flags = disturb(silence, only(scenario, "emi_bursts"), FS)
        assert (flags.emi_bursts > 0) == found.any()
        seen.add(flags.emi_bursts)
    assert loose == {0, 1, 2}
    assert 0 in seen
    assert len(seen) > 1


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_record_that_diverged_is_passed_on_without_a_warning(dirty, value):
    signal = hiss()
    signal[:, 600:] = value
    found, flags = disturb(signal, dirty[0], FS)
    assert found is signal
    assert flags == SensorFlags()
