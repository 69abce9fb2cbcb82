"""Laws of outlines: kernel and steps of a record, found without its kernel input, equal those of the full record."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.generation.plan import plan
from gen.physics.kernel.batch import input_shape
from gen.recipe import read_recipe, shipped_recipes
from gen.scenarios import draw_scenarios, settings_of
from gen.simulation.inputs import kernel_input
from gen.simulation.motion import schedule_of
from gen.simulation.outline import outlined_input
from gen.simulation.steps import steps_per_sample
from gen.simulation.timeline import timeline
from gen.support.errors import SimulationError
from tests.recipes import EVERYTHING

percents = st.floats(10, 1000)
times = st.floats(-0.1, 0.3).map(lambda time: round(time, 5))
profiles = st.one_of(
    st.fixed_dictionaries({"kind": st.just("ramp"), "from_percent": percents, "to_percent": percents}),
    st.fixed_dictionaries(
        {
            "kind": st.just("run_up"),
            "from_percent": percents,
            "to_percent": percents,
            "start_s": st.floats(0, 0.2),
            "lasting_s": st.floats(1e-4, 0.2),
        }
    ),
    st.fixed_dictionaries(
        {"kind": st.just("steps"), "levels_percent": st.lists(percents, min_size=2, max_size=5), "step_s": st.just(0.005)}
    ),
    st.lists(st.tuples(times, percents), min_size=1, max_size=8, unique_by=lambda pair: pair[0]).map(
        lambda pairs: {
            "kind": "table",
            "times_s": [time for time, _ in sorted(pairs)],
            "percent": [share for _, share in sorted(pairs)],
        }
    ),
)  # fmt: skip


def needs(record, scenario, recipe):
    return input_shape(record), steps_per_sample(record, scenario.record, settings_of(recipe))


@settings(deadline=None, max_examples=200)
@given(
    speed=st.none() | profiles,
    load=st.none() | profiles,
    wander=st.sampled_from([0, 1, 50]),
    rpm=st.floats(60, 6000),
    seed=st.integers(0, 1000),
)
def test_the_highest_speed_and_load_are_those_of_the_whole_schedule(recipe_with, speed, load, wander, rpm, seed):
    changes = {"operation.load_wander_percent": wander, "operation.shaft_rpm": rpm, "operation.load_n": 100}
    changes |= {f"operation.{key}_profile": value for key, value in (("speed", speed), ("load", load)) if value}
    recipe = recipe_with(changes | {"seed": seed})
    scenario = draw_scenarios(recipe, 0, 1)[0]
    whole, found = (
        schedule_of(scenario, timeline(settings_of(recipe))),
        outlined_input(scenario, timeline(settings_of(recipe))).schedule,
    )
    assert len(found) == min(len(whole), 1)
    if len(whole):
        np.testing.assert_allclose(found[0], whole.max(axis=0), rtol=1e-12)


@pytest.mark.parametrize("samples_per_turn", [0.5, 1, 3, 16])
def test_the_peak_of_a_wandering_load_is_found_however_sparsely_it_is_looked_at(
    recipe_with, monkeypatch, samples_per_turn
):
    """Between two samples the load rises at most by the bound of its curvature."""
    monkeypatch.setattr("gen.simulation.outline.SAMPLES_PER_TURN", samples_per_turn)
    recipe = recipe_with({"operation.load_wander_percent": 50, "operation.shaft_rpm": 6000, "operation.load_n": 100})
    for scenario in draw_scenarios(recipe):
        found = outlined_input(scenario, timeline(settings_of(recipe))).schedule[0, 1]
        assert found == pytest.approx(schedule_of(scenario, timeline(settings_of(recipe)))[:, 1].max(), rel=1e-12)


@pytest.mark.parametrize("name", shipped_recipes())
def test_shape_and_steps_of_shipped_recipes_are_those_of_whole_records(name):
    recipe = read_recipe(name)
    for scenario in draw_scenarios(recipe, 0, 48):
        whole, found = (
            kernel_input(scenario, timeline(settings_of(recipe))),
            outlined_input(scenario, timeline(settings_of(recipe))),
        )
        assert needs(found, scenario, recipe) == needs(whole, scenario, recipe)


def test_shape_and_steps_of_a_record_with_everything_are_those_of_the_whole_record(recipe_with):
    recipe = recipe_with(EVERYTHING | {"operation.load_wander_percent": 50})
    for scenario in draw_scenarios(recipe):
        whole, found = (
            kernel_input(scenario, timeline(settings_of(recipe))),
            outlined_input(scenario, timeline(settings_of(recipe))),
        )
        assert needs(found, scenario, recipe) == needs(whole, scenario, recipe)


@pytest.mark.parametrize(
    "changes",
    [
        {"operation.load_n": "grid(20000, 500)"},
        {"operation.axial_load_n": 1, "specimen.contact_angle_deg": 10},
        {"contact.lubricant": {"viscosity_40_mm2_s": 2000, "viscosity_100_mm2_s": 200}, "operation.shaft_rpm": 60_000},
    ],
    ids=["load", "axial load", "oil"],
)
def test_a_record_that_cannot_be_has_no_outline_for_the_same_reason(recipe_with, changes):
    recipe = recipe_with(changes)
    scenario = draw_scenarios(recipe, 0, 1)[0]
    sentences = []
    for make in (kernel_input, outlined_input):
        with pytest.raises(SimulationError, match="record 0: ") as caught:
            make(scenario, recipe)
        sentences.append(str(caught.value))
    assert sentences[0] == sentences[1]


def test_a_plan_builds_no_whole_record_outside_its_timed_sample(write_recipe, tmp_path, monkeypatch):
    """With tables of spalls and schedules the plan of 4,000 records of 20 s took 40 s; with outlines it takes a second."""

    def refused(*_args):
        raise AssertionError

    monkeypatch.setattr("gen.generation.plan.measured_pace", lambda *_: None)
    for name in ("spall_inputs", "waviness_of", "schedule_of"):
        monkeypatch.setattr(f"gen.simulation.inputs.{name}", refused)
    assert plan(write_recipe(tmp_path / "r.yaml", EVERYTHING)).steps_per_sample.keys()


def test_a_plan_with_dear_loads_draws_fewer_records_and_says_so(write_recipe, tmp_path):
    changes = {"corpus.rigs": 300, "storage.records_per_part": 100, "operation.load_wander_percent": 1}
    planned = plan(write_recipe(tmp_path / "r.yaml", changes))
    assert (planned.records, planned.drawn) == (2400, 1500)
    assert sum(planned.steps_per_sample.values()) == pytest.approx(2400, abs=2)
