"""Laws of the drawn sensor faults and gears: they move no other drawn value, and each comes as often as its probability says."""

from collections import Counter
from dataclasses import replace

import pytest

from gen.scenarios import check_scenario, draw_scenarios
from gen.support.errors import RecipeError
from tests.sensor_faults import GEAR_MESH, SENSOR_FAULTS, rarely

OF_RECORDS = ("drift", "dropped_samples", "gain_steps", "emi_bursts")


def drawn(recipe_with, sections, **changes):
    return draw_scenarios(recipe_with({"sensor_faults": sections, **changes}))


def faults_of(scenario):
    """Sensor faults that a scenario has, by name; of hum without the deviation, which is drawn for every record."""
    return scenario.record.sensor_faults | scenario.rig.sensor_faults


def deviation_of(scenario):
    return scenario.record.sensor_faults["mains_hum"]["deviation"]


def without_sensor_faults(scenario):
    return replace(
        scenario,
        settings=None,
        rig=replace(scenario.rig, sensor_faults={}, background={**scenario.rig.background, "gear_mesh": None}),
        record=replace(scenario.record, sensor_faults={}),
    )


@pytest.mark.parametrize("sampling", ["random", "sobol", "halton"])
def test_sensor_faults_and_gears_move_no_other_drawn_value(recipe_with, sampling):
    changes = {"corpus.sampling": sampling}
    clean = draw_scenarios(recipe_with(changes))
    dirty = drawn(recipe_with, SENSOR_FAULTS, **changes, **{"background.gear_mesh": GEAR_MESH})
    assert not any(
        one.rig.sensor_faults or one.record.sensor_faults or one.rig.background.get("gear_mesh") for one in clean
    )
    assert all(
        one.rig.sensor_faults and one.record.sensor_faults and one.rig.background.get("gear_mesh") for one in dirty
    )
    assert [without_sensor_faults(scenario) for scenario in dirty] == [without_sensor_faults(one) for one in clean]


@pytest.mark.parametrize("name", SENSOR_FAULTS)
def test_a_sensor_fault_that_is_left_out_moves_no_other(recipe_with, name):
    rest = {key: section for key, section in rarely(SENSOR_FAULTS, 0.5).items() if key != name}
    for one, other in zip(drawn(recipe_with, rarely(SENSOR_FAULTS, 0.5)), drawn(recipe_with, rest), strict=True):
        whole = faults_of(one)
        whole.pop(name, None)
        assert faults_of(other) == whole


def test_a_sensor_fault_does_not_know_the_fault_of_the_bearing(recipe_with):
    sections, inner = rarely(SENSOR_FAULTS, 0.5), [{"kind": "inner", "width_mm": 0.5}]
    for one, other in zip(drawn(recipe_with, sections), drawn(recipe_with, sections, faults=inner), strict=True):
        assert faults_of(one) == faults_of(other) == faults_of(one.without_fault())


@pytest.mark.parametrize(("probability", "present"), [(0, False), (1, True)])
def test_a_probability_of_none_or_all_is_kept_exactly(recipe_with, probability, present):
    changes = {"background.gear_mesh": {**GEAR_MESH, "probability": probability}}
    for scenario in drawn(recipe_with, rarely(SENSOR_FAULTS, probability), **changes):
        found = faults_of(scenario).keys() - ({"mains_hum"} if not present else set())
        assert found == (SENSOR_FAULTS.keys() if present else set())
        assert (scenario.rig.background.get("gear_mesh") is not None) == present


def test_faults_of_installations_come_by_rig_and_faults_that_come_and_go_by_record(recipe_with):
    size = {"corpus.rigs": 200, "corpus.specimens_per_rig": 2, "corpus.records_per_specimen": 1}
    scenarios = drawn(recipe_with, rarely(SENSOR_FAULTS, 0.3), **size)
    rigs = {scenario.rig.number: scenario.rig.sensor_faults for scenario in scenarios}
    counts = Counter(name for scenario in scenarios for name in OF_RECORDS if name in scenario.record.sensor_faults)
    for name in OF_RECORDS:
        assert counts[name] / len(scenarios) == pytest.approx(0.3, abs=0.1)  # 4 sigma of 400 records
    for name in ("saturation", "mains_hum", "loose_mount"):
        share = sum(name in of_rig for of_rig in rigs.values()) / len(rigs)
        assert share == pytest.approx(0.3, abs=0.13)  # 4 sigma of 200 rigs
    assert all(scenario.rig.sensor_faults == rigs[scenario.rig.number] for scenario in scenarios)


def test_each_channel_has_a_mount_of_its_own(recipe_with):
    channels = [{"name": name, "body": "sensor"} for name in "abc"]
    sections = {"loose_mount": {**SENSOR_FAULTS["loose_mount"], "frequency_hz": "uniform(500, 900)"}}
    for scenario in drawn(recipe_with, sections, **{"recording.channels": channels}):
        mounts = scenario.rig.sensor_faults["loose_mount"]
        assert len({mount["frequency"] for mount in mounts}) == 3


def test_drawn_sensor_faults_are_in_si_units(recipe_with):
    (scenario, *_) = drawn(recipe_with, SENSOR_FAULTS, **{"background.gear_mesh": {**GEAR_MESH, "level_db": 6}})
    rig, record, gear = (
        scenario.rig.sensor_faults,
        scenario.record.sensor_faults,
        scenario.rig.background.get("gear_mesh"),
    )
    assert rig["loose_mount"] == ({"frequency": 1500, "damping": pytest.approx(0.04), "holding": 8},)
    assert rig["saturation"] == {"limit": 20, "knee": pytest.approx(0.2), "recovery": 0.01}
    assert rig["mains_hum"] == {"frequency": 60, "rms": 2, "count": 3, "third": -10}
    assert abs(deviation_of(scenario)) <= 0.01
    assert record["dropped_samples"]["held"] == pytest.approx(0.5)
    assert {step["gain"] for step in record["gain_steps"]} <= {10 ** (6 / 20), 10 ** (-6 / 20)}
    assert [line["level"] for line in gear["lines"]] == [10 ** (6 / 20)] * 3
    assert gear["phase_modulation"] == pytest.approx(0.349066, rel=1e-5)
    assert (gear["teeth"], gear["mate_teeth"]) == (20, 40)


def test_the_mains_deviates_anew_in_each_record(recipe_with):
    deviations = [deviation_of(scenario) for scenario in drawn(recipe_with, SENSOR_FAULTS)]
    assert len(set(deviations)) == len(deviations)
    assert 0.005 < max(map(abs, deviations)) <= 0.01


def test_gain_steps_are_in_order_of_time(recipe_with):
    for scenario in drawn(recipe_with, SENSOR_FAULTS):
        first, second = scenario.record.sensor_faults["gain_steps"]
        assert 0 <= first["share"] <= second["share"] < 1


FOREIGN = [{"hum": {"rms": 1.0}}, {"saturation": ()}, {"loose_mount": {}}, {"loose_mount": ()}, {"gain_steps": (None,)}]


@pytest.mark.parametrize("level", ["rig", "record"])
@pytest.mark.parametrize("faults", FOREIGN, ids=str)
def test_a_scenario_with_a_sensor_fault_that_no_recipe_draws_is_refused(recipe_with, level, faults):
    for scenario in drawn(recipe_with, SENSOR_FAULTS)[:2]:
        check_scenario(scenario)
        changed = replace(getattr(scenario, level), sensor_faults=faults)
        with pytest.raises(RecipeError, match=f"sensor_faults: '{next(iter(faults))}' is not as a recipe draws it"):
            check_scenario(replace(scenario, **{level: changed}))


@pytest.mark.parametrize(
    ("path", "value", "sentence"),
    [
        ("sensor_faults.saturation.limit_m_s2", 500, "limit_m_s2: 500 is not below recording.converter.full_scale_m_s2 500"),
        ("sensor_faults.dropped_samples.gap_s", 0.1, "gap_s: 0.1 s leaves nothing of a record"),
    ],
)  # fmt: skip
def test_a_sensor_fault_without_effect_or_place_is_refused(recipe_with, path, value, sentence):
    with pytest.raises(RecipeError, match=sentence):
        recipe_with({"sensor_faults": {name: dict(section) for name, section in SENSOR_FAULTS.items()}, path: value})


def test_an_amplifier_before_no_converter_may_have_any_limit(recipe_with):
    recipe_with(
        {
            "recording.converter": {"kind": "float32"},
            "sensor_faults": {"saturation": {**SENSOR_FAULTS["saturation"], "limit_m_s2": 9000}},
        }
    )
