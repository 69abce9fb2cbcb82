"""Laws of the sensor chain: levels, path and background, on responses that need no simulation."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import welch

from gen.scenarios import draw_scenarios
from gen.simulation.timeline import timeline
from tests.measuring import FLOAT, FS, background_of, direct, hiss, measure, physical, quiet, response, rms, silence


@pytest.fixture(scope="module")
def levelled(recipe_with):
    """A recipe whose levels follow a signal-to-noise ratio, and its scenarios."""
    level = {"kind": "snr", "faulty_db": "uniform(-10, 25)", "healthy_db": "uniform(-20, 10)", "rms_m_s2": 1.0}
    recipe = recipe_with(FLOAT | {"level": level, "recording.duration_s": 1.0})
    return recipe, draw_scenarios(recipe)


def at_ratio(scenario, ratio):
    """The same record at another signal-to-noise ratio [dB]."""
    level = scenario.recipe.level.model_copy(update={"faulty_db": ratio, "healthy_db": ratio})
    return scenario.edited(level=level)


@pytest.mark.parametrize(("rise", "tries"), [(1.1, 2), (1e-9, 0)])
def test_the_first_ratio_at_which_the_fault_is_seen_is_taken_and_nothing_else_moves(levelled, rise, tries, monkeypatch):
    """A fault that raises the rms is seen above some ratio; one that adds nothing is seen at none, and the drawn ratio stays."""
    recipe, scenarios = levelled
    place = next(place for place, scenario in enumerate(scenarios) if scenario.fault != "healthy")
    scenario = at_ratio(scenarios[place], -30.0)
    bearing = np.float32(hiss(recipe, 1)[0])
    twin = np.float32(1e-3) * bearing
    whole = twin + np.float32(rise) * bearing[:, ::-1]
    monkeypatch.setattr("gen.measurement.components.lines_of_faults", lambda _: ())
    measured = measure([whole], [scenario], [twin], ratios={scenario.origin.record: [-20.0, 10.0, 20.0]})
    ratio = (-30.0, -20.0, 10.0)[tries]
    assert measured.detectable.tolist() == [int(tries > 0)]
    (taken,) = measured.scenarios
    assert taken.recipe.level.faulty_db == ratio
    assert taken.origin == scenario.origin.model_copy(update={"level_try": tries})
    assert taken.edited(level=scenario.recipe.level, origin=scenario.origin) == scenario


def test_the_gain_of_the_sensor_scales_bearing_and_background_alike(recipe_with):
    found = []
    for gain in (1, 4):
        recipe = recipe_with(FLOAT | {"level": {"kind": "physical", "background_m_s2": 2, "gain": gain}})
        found.append(measure(hiss(recipe, 4), draw_scenarios(recipe, 0, 4)))
    np.testing.assert_array_equal(4 * found[0].signal, found[1].signal)
    np.testing.assert_allclose(found[0].snr, found[1].snr)


@pytest.mark.parametrize(("rise", "seen"), [(1.2, 0), (1.3, 1)])
def test_wear_is_seen_if_it_raises_the_rms_by_a_quarter(recipe_with, rise, seen):
    quiet = {"level": {"kind": "physical", "background_m_s2": 1e-6}}
    recipe = recipe_with(FLOAT | quiet | {"faults": [{"kind": "distributed", "site": "inner"}]})
    twin = hiss(recipe, 2)
    measured = measure(np.float32(rise * twin), draw_scenarios(recipe, 0, 2), np.float32(twin))
    assert measured.detectable.tolist() == [seen, seen]
    np.testing.assert_allclose(measured.fault_snr, 20 * np.log10(rise - 1), atol=1e-3)


def test_the_bearing_stands_over_the_background_by_the_drawn_ratio(levelled):
    recipe, scenarios = levelled
    measured = measure(hiss(recipe, len(scenarios)), scenarios)
    loud = [at_ratio(scenario, 200.0) for scenario in scenarios]
    bearing = measure(hiss(recipe, len(scenarios)), loud).signal.astype(float)
    background = measure(silence(recipe, len(scenarios)), scenarios).signal.astype(float)
    drawn = [
        scenario.recipe.level.si()["healthy" if scenario.fault == "healthy" else "faulty"] for scenario in scenarios
    ]
    for row, ratio in enumerate(drawn):
        alone = np.stack([bearing[row].ravel(), background[row].ravel()], axis=1)
        gains, *_ = np.linalg.lstsq(alone, measured.signal[row].ravel().astype(float), rcond=None)
        parts = np.std(alone * gains, axis=0)
        assert 20 * np.log10(parts[0] / parts[1]) == pytest.approx(ratio, abs=0.01)
    np.testing.assert_allclose(measured.snr, drawn, atol=1e-3)


def test_the_background_does_not_know_the_class(recipe_with):
    recipe = recipe_with(FLOAT)
    scenarios = draw_scenarios(recipe)
    quiet = silence(recipe, len(scenarios))
    damaged = measure(quiet, scenarios).signal
    sound = measure(quiet, [scenario.without_fault() for scenario in scenarios]).signal
    np.testing.assert_array_equal(damaged, sound)
    assert rms(damaged).min() > 0.01


def test_records_of_one_rig_share_the_spectrum_of_their_noise_but_not_its_samples(recipe_with):
    recipe = recipe_with(FLOAT | {"recording.duration_s": 4.0} | quiet(slope=1, floor_db=-60))
    one, other = background_of(recipe, 2)[0][:, 0]
    assert abs(np.corrcoef(one, other)[0, 1]) < 0.1
    densities = welch(np.stack([one, other]), FS, nperseg=512)[1][:, 5:-5]
    assert np.corrcoef(np.log(densities))[0, 1] > 0.98


def test_a_record_is_measured_alike_alone_and_among_others(recipe_with):
    recipe = recipe_with()
    scenarios = draw_scenarios(recipe)
    moved = hiss(recipe, len(scenarios))
    together = measure(moved, scenarios)
    for place in (0, 7, 23):
        alone = measure(moved[place : place + 1], [scenarios[place]])
        np.testing.assert_array_equal(alone.signal[0], together.signal[place])


def tone_through(recipe, frequency):
    """Amplitude and phase of a tone of amplitude 1 behind the path, as a complex number."""
    axis = timeline(recipe)
    tone = round(frequency * axis.returned / FS) * FS / axis.returned  # whole cycles: the filter runs around the ends
    moved = response(recipe, 1, lambda time: np.cos(2 * np.pi * tone * time))
    seen = measure(moved, draw_scenarios(recipe, 0, 1)).signal[0, 0].astype(float)
    time = np.arange(axis.returned)[axis.kept] / FS
    model = np.stack([np.cos(2 * np.pi * tone * time), -np.sin(2 * np.pi * tone * time)], axis=1)
    real, imaginary = np.linalg.lstsq(model, seen)[0]
    return tone, complex(real, imaginary)


resonances = st.tuples(st.floats(500, 5500), st.floats(0.6, 8), st.floats(-40, 9.5), st.sampled_from([-1, 1]))


@given(st.floats(100, 5500), st.floats(0.01, 2), st.lists(resonances, max_size=3))
def test_a_tone_comes_through_the_path_with_the_transmissibility_of_its_resonances(
    recipe_with, frequency, gain, resonances
):
    frequencies, dampings, gains, signs = zip(*resonances, strict=True) if resonances else [()] * 4
    modes = {
        "count": len(resonances), "frequency_hz": [*frequencies], "damping_percent": [*dampings], "gain_db": [*gains], "sign": [*signs],
    }  # fmt: skip
    recipe = recipe_with(FLOAT | physical(0.0) | direct(gain, modes=modes))
    tone, found = tone_through(recipe, frequency)
    expected = complex(gain)
    for natural, damping, level, sign in resonances:
        stiff = natural**2 + 2j * damping / 100 * natural * tone
        expected += sign * 10 ** (level / 20) * stiff / (stiff - tone**2)
    assert found == pytest.approx(expected, abs=1e-4 * (1 + abs(expected)))


@pytest.mark.parametrize("slope", [-0.3, 0.0, 1.0, 2.0])
def test_the_noise_falls_with_the_drawn_slope_and_has_the_drawn_rms(recipe_with, slope):
    recipe = recipe_with(FLOAT | {"recording.duration_s": 20.0} | quiet(slope=slope) | physical(0.3))
    noise = background_of(recipe)[0][0, 0]
    frequency, density = welch(noise, FS, nperseg=4096)
    band = (frequency > 100) & (frequency < 4700)  # what the anti-alias filter passes
    fitted = np.polyfit(np.log(frequency[band]), np.log(density[band]), 1)[0]
    assert -fitted == pytest.approx(slope, abs=0.05)
    assert np.std(noise) == pytest.approx(
        0.3, rel=0.2 if slope == 2 else 0.03
    )  # most of its power is in a few slow cycles


def line(signal, frequency):
    """Rms of a line at ``frequency``, by projection."""
    wave = np.exp(-2j * np.pi * frequency * np.arange(len(signal)) / FS)
    return np.sqrt(2) * abs(np.mean(signal * wave))


def test_knocks_come_with_the_shaft_and_impulses_at_their_rate(recipe_with):
    counts, powers, steady = {}, {}, {"recording.duration_s": 5.0, "operation.shaft_rpm": 1800}
    for kind, often in (("knocks", {"orders": 2}), ("impulses", {"rate_hz": 40})):
        struck = quiet(**{kind: {**often, "level_db": 60}})
        ((signal,),), _ = background_of(recipe_with(FLOAT | steady | direct() | struck))
        counts[kind] = np.count_nonzero(np.abs(signal) > 300)
        powers[kind] = np.sum((signal / 1000) ** 2)
    assert counts["knocks"] == pytest.approx(2 * 30 * 5, abs=1)
    # a knock and an impulse of one size have one energy; the square of the size of a knock is 1 + 0.2^2 on average
    energy = powers["knocks"] / (1.04 * counts["knocks"])
    assert powers["impulses"] / energy == pytest.approx(40 * 5, abs=4 * np.sqrt(3 * 200))


MODULATION = {"modulation": {"probability": 1, "first": 0.6, "second": 0.2}}


def test_the_shaft_modulates_what_the_bearing_sends_down_the_path(recipe_with):
    changes = {"recording.duration_s": 4.0, "operation.shaft_rpm": 1800}
    recipe = recipe_with(FLOAT | changes | direct(**MODULATION) | physical(0.0))
    moved = response(recipe, 1, lambda time: np.sqrt(2) * np.cos(2 * np.pi * 2000 * time))
    signal = measure(moved, draw_scenarios(recipe, 0, 1)).signal[0, 0].astype(float)
    assert line(signal, 2000) == pytest.approx(1.0, abs=1e-3)
    for order, depth in ((1, 0.6), (2, 0.2)):
        assert line(signal, 2000 + 30 * order) == pytest.approx(depth / 2, abs=1e-3)
        assert line(signal, 2000 - 30 * order) == pytest.approx(depth / 2, abs=1e-3)


def test_channels_on_the_common_path_share_its_modulation_and_a_path_of_its_own_has_another(recipe_with):
    of_its_own = {"path": {"direct": 1.0, **MODULATION}}
    three = [{"name": "first"}, {"name": "second"}, {"name": "third", **of_its_own}]
    recipe = recipe_with(FLOAT | {"recording.channels": three} | direct(**MODULATION) | physical(0.0))
    first, second, third = measure(response(recipe, 1, np.ones_like), draw_scenarios(recipe, 0, 1)).signal[0]
    assert first.std() > 0.1
    np.testing.assert_array_equal(first, second)
    assert np.abs(first - third).max() > 0.1
