"""Laws of the simulation of scenarios: a record depends on itself alone, and is accurate or refused."""

import math

import numpy as np
import pytest

from gen.physics.kernel.decimate import decimation
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import open_integrations, runs_of, simulate
from gen.support.errors import SimulationError
from tests.lanes import march_lanes
from tests.reference_motion import waviness
from tests.responses import accelerations_of, failures_of, input_of

FS = 12_000.0


def decimation_taps(n_steps: int) -> np.ndarray:
    """All stages of the decimation as one filter at the rate of the steps, shape (tap,)."""
    whole, spacing = np.ones(1), 1
    for taps, factor, kept in decimation(n_steps):
        if taps.size:
            spread = np.zeros(kept * spacing + 1)
            spread[::spacing] = taps[: kept + 1, 0]
            whole, spacing = np.convolve(whole, spread), spacing * factor
    return whole


@pytest.fixture(scope="module")
def simulated(recipe_with):
    """The small recipe, its scenarios and their responses."""
    recipe = recipe_with()
    scenarios = draw_scenarios(recipe)
    return recipe, scenarios, simulate(scenarios)


def test_a_record_gives_the_same_bits_alone_among_others_and_in_any_order(simulated):
    _, scenarios, together = simulated
    for place in (0, 5, 13, 23):
        (alone,) = simulate([scenarios[place]])
        np.testing.assert_array_equal(alone.acceleration, together[place].acceleration)
    backwards = simulate(scenarios[::-1])[::-1]
    np.testing.assert_array_equal(accelerations_of(backwards), accelerations_of(together))
    assert [run.oversampling for run in backwards] == [run.oversampling for run in together]


def test_a_longer_settling_time_drops_more_and_changes_nothing_else(recipe_with):
    short, long = (recipe_with({"recording.settle_s": settle, "recording.duration_s": 0.1}) for settle in (0.06, 0.11))
    early, late = (accelerations_of(simulate(draw_scenarios(recipe, 0, 4))) for recipe in (short, long))
    shift = round(0.05 * FS)
    np.testing.assert_array_equal(late[..., :-shift], early[..., shift:])


def test_a_response_is_the_decimated_motion_of_its_bodies_along_its_channels(recipe_with):
    channels = [{"name": "a", "body": "sensor", "angle_deg": 30}, {"name": "b", "body": "housing"}]
    recipe = recipe_with({"recording.channels": channels, "recording.oversampling": 8})
    scenarios = draw_scenarios(recipe, 0, 3)
    response = accelerations_of(simulate(scenarios))
    n_knots = round(recipe.recording.settle_s * FS) + recipe.n_samples
    taps = decimation_taps(8)
    for trip, channels_found in zip(
        march_lanes([input_of(scenario) for scenario in scenarios], n_knots, 8, 1 / FS), response, strict=True
    ):
        full_rate = trip.accelerations
        tilted = math.cos(math.pi / 6) * full_rate[:, 4] + math.sin(math.pi / 6) * full_rate[:, 5]
        for channel, signal in zip(channels_found, (tilted, full_rate[:, 3]), strict=True):
            decimated = np.convolve(signal, taps, mode="same")[::8]
            inside = slice(100, recipe.n_samples)  # the whole filter within the march
            expected = decimated[n_knots - channels_found.shape[1] :][inside]
            single = 8 * np.finfo(np.float32).eps  # rounding of the history, and of sums of a hundred taps
            np.testing.assert_allclose(channel[inside], expected, rtol=0, atol=single * np.abs(signal).max())


@pytest.mark.parametrize("factor", [2, 3, 4, 8, 24])
def test_decimation_passes_the_band_and_stops_what_would_fold_into_it(factor):
    taps = decimation_taps(factor)
    np.testing.assert_allclose(taps, taps[::-1], rtol=0, atol=1e-15)  # linear phase
    cycles = np.arange(len(taps)) - len(taps) // 2
    nyquist = np.linspace(0, factor, 40 * factor + 1)
    gain = np.abs(np.exp(-1j * np.pi * np.outer(nyquist / factor, cycles)) @ taps)
    np.testing.assert_allclose(gain[nyquist <= 0.75], 1, atol=2e-4)
    assert (gain[nyquist >= 1.025] < 1.05e-4).all()


def test_a_step_too_coarse_for_the_stiffest_mode_is_refused_before_it_runs(recipe_with, monkeypatch):
    def never(*_args):
        pytest.fail("the kernel ran")

    monkeypatch.setattr("gen.simulation.batches.integrate", never)
    recipe = recipe_with({"recording.oversampling": 1, "machine.resonator.frequency_hz": 3500})
    need = r"is too fast for a step of 83\.3 us; raise recording\.oversampling to \d+ or leave it out\.$"
    with pytest.raises(SimulationError, match=r"^record 0: its stiffest mode of \d+ Hz " + need):
        simulate(draw_scenarios(recipe))


def test_a_machine_too_stiff_for_any_step_is_refused(recipe_with):
    recipe = recipe_with({"machine.resonator.frequency_hz": 50_000, "recording.sample_rate_hz": 4000})
    scenarios = draw_scenarios(recipe, 0, 1)
    with pytest.raises(SimulationError, match=r"needs more than 96 steps per sample at 4000 Hz; soften the machine"):
        simulate(scenarios)


def test_a_record_that_diverges_is_named_and_leaves_the_others_as_they_are(recipe_with, monkeypatch):
    """Two rigs, one step per sample: a resonance at 5.9 kHz is beyond what Runge-Kutta holds (2.83 / dt), one at 1.5 kHz is not."""
    monkeypatch.setattr("gen.simulation.steps.COARSEST_STEP", math.inf)
    changes = {"corpus.rigs": 2, "recording.oversampling": 1, "machine.resonator.frequency_hz": "grid(1500, 5900)"}
    recipe = recipe_with(changes)
    scenarios = draw_scenarios(recipe)
    runs = simulate(scenarios)
    assert failures_of(runs).keys() == set(range(8, 16))
    for place, sentence in failures_of(runs).items():
        assert sentence.startswith(f"record {place} diverged at t = 0.")
        assert "with 1 steps per sample; raise recording.oversampling" in sentence
    np.testing.assert_array_equal(accelerations_of(runs[:8]), accelerations_of(simulate(scenarios[:8])))


def test_the_waviness_of_a_race_has_the_rms_of_its_specimen_and_nothing_to_do_with_the_record(recipe_with):
    recipe = recipe_with({"specimen.waviness_nm": 25})
    scenarios = draw_scenarios(recipe, 0, 4)
    turn = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    first, again, other = (input_of(scenarios[place]) for place in (0, 1, 2))
    np.testing.assert_array_equal(first.waviness.races, again.waviness.races)
    assert not np.array_equal(first.waviness.races, other.waviness.races)
    for record in (first, other):
        both = waviness(record, turn, turn)
        alone = record.waviness._replace(races=record.waviness.races * [[1], [0]])
        inner = waviness(record._replace(waviness=alone), turn, turn)
        assert np.sqrt(np.mean(inner**2)) == pytest.approx(25e-9, rel=1e-6)
        assert np.sqrt(np.mean((both - inner) ** 2)) == pytest.approx(25e-9, rel=1e-6)


def test_records_of_a_group_share_the_integration_without_their_fault(recipe_with):
    faults = [{"kind": "healthy", "weight": 1}, {"kind": "outer", "width_mm": 1}, {"kind": "ball", "width_mm": 1}]
    recipe = recipe_with({"corpus.rungs": [0, 0.5, 1], "corpus.specimens_per_rig": 3, "faults": faults})
    scenarios = [scenario for scenario in draw_scenarios(recipe) if scenario.origin.pair >= 0][:9]
    runs = runs_of(scenarios)
    assert len({scenario.origin.pair for scenario in scenarios}) == 3
    assert len(open_integrations(runs)) == 9
    assert all(run.healthy is runs[place // 3 * 3].own for place, run in enumerate(runs))
    together = simulate(scenarios)
    for run, scenario in zip(together, scenarios, strict=True):
        (alone,) = simulate([scenario])
        for integration, other in zip(run.integrations, alone.integrations, strict=True):
            np.testing.assert_array_equal(integration.response, other.response)


def test_a_record_does_not_depend_on_whether_its_neighbours_have_waviness(recipe_with):
    recipe = recipe_with({"faults": [{"kind": "inner", "width_mm": 0.5}], "specimen.waviness_nm": "choice(0, 500)"})
    scenarios = draw_scenarios(recipe)
    assert len({input_of(scenario).waviness.races.size for scenario in scenarios}) == 2
    together = simulate(scenarios)
    for place in (0, -1):
        (alone,) = simulate([scenarios[place]])
        np.testing.assert_array_equal(alone.acceleration, together[place].acceleration)


def test_two_rigs_are_enough_to_set_one_aside(recipe_with):
    split = {"by": "rig", "test": 0.2, "validation": 0}
    recipe = recipe_with({"corpus.rigs": 2, "corpus.split": split})
    by_rig = {scenario.origin.rig: scenario.origin.split for scenario in draw_scenarios(recipe)}
    assert sorted(by_rig.values()) == ["test", "train"]
