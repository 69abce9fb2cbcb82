"""Laws of the drawn sensor faults and gears: they move no other drawn value, and each comes as often as its probability says."""

from collections import Counter, defaultdict

import pytest

from gen.mechanisms.chain.measuring_chain import CHAIN
from gen.mechanisms.mechanism import mechanisms_of
from gen.scenarios import draw_scenarios
from gen.support.errors import RecipeError
from tests.sensor_faults import GEAR_MESH, SENSOR_FAULTS, rarely

OF_RECORDS = [fault.place for fault in CHAIN if fault.drawn_per == "record"]


def drawn(recipe_with, sections, **changes):
    return draw_scenarios(recipe_with({"sensor_faults": sections, **changes}))


def faults_of(scenario):
    """Sensor faults that a scenario has, by name."""
    return {fault.place: fault for fault in mechanisms_of(scenario.recipe.sensor_faults)}


def test_a_sensor_fault_does_not_know_the_fault_of_the_bearing(recipe_with):
    sections, inner = rarely(SENSOR_FAULTS, 0.5), [{"kind": "inner", "width_mm": 0.5}]
    for one, other in zip(drawn(recipe_with, sections), drawn(recipe_with, sections, faults=inner), strict=True):
        assert faults_of(one) == faults_of(other) == faults_of(one.without_fault())


@pytest.mark.parametrize(("probability", "present"), [(0, False), (1, True)])
def test_a_probability_of_none_or_all_is_kept_exactly(recipe_with, probability, present):
    changes = {"background.gear_mesh": {**GEAR_MESH, "probability": probability}}
    for scenario in drawn(recipe_with, rarely(SENSOR_FAULTS, probability), **changes):
        assert faults_of(scenario).keys() == (SENSOR_FAULTS.keys() if present else set())
        assert (scenario.recipe.background.gear_mesh is not None) == present


def test_faults_of_installations_come_by_rig_and_faults_that_come_and_go_by_record(recipe_with):
    size = {"corpus.rigs": 200, "corpus.specimens_per_rig": 2, "corpus.records_per_specimen": 1}
    scenarios = drawn(recipe_with, rarely(SENSOR_FAULTS, 0.3), **size)
    counts = Counter(name for scenario in scenarios for name in faults_of(scenario))
    of_rigs = defaultdict(set)
    for scenario in scenarios:
        for name in SENSOR_FAULTS.keys() - set(OF_RECORDS):
            of_rigs[scenario.origin.rig, name].add(name in faults_of(scenario))
    assert all(len(seen) == 1 for seen in of_rigs.values())
    for name in SENSOR_FAULTS:
        # 4 sigma of 400 records or 200 rigs
        assert counts[name] / len(scenarios) == pytest.approx(0.3, abs=0.1 if name in OF_RECORDS else 0.13)


def test_each_channel_has_a_mount_of_its_own(recipe_with):
    channels = [{"name": name, "body": "sensor"} for name in "abc"]
    sections = {"loose_mount": {**SENSOR_FAULTS["loose_mount"], "frequency_hz": "uniform(500, 900)"}}
    for scenario in drawn(recipe_with, sections, **{"recording.channels": channels}):
        mount = faults_of(scenario)["loose_mount"]
        assert mount.loose_channels == (0, 1, 2)
        assert len(set(mount.frequency_hz)) == 3


def test_sensor_faults_of_an_installation_are_the_same_in_all_records_of_a_rig_but_for_the_deviation_of_the_mains(
    recipe_with,
):
    ranges = {
        "mains_hum": {"rms_m_s2": "uniform(1, 3)"},
        "saturation": {"limit_m_s2": "uniform(10, 90)"},
        "loose_mount": {"frequency_hz": "uniform(500, 900)"},
    }
    scenarios = drawn(recipe_with, {name: SENSOR_FAULTS[name] | keys for name, keys in ranges.items()})
    first = {scenario.origin.rig: faults_of(scenario) for scenario in reversed(scenarios)}
    for scenario in scenarios:
        found, expected = faults_of(scenario), first[scenario.origin.rig]
        steady = {"deviation_percent": expected["mains_hum"].deviation_percent}
        assert found | {"mains_hum": found["mains_hum"].model_copy(update=steady)} == expected
    deviations = [faults_of(scenario)["mains_hum"].deviation_percent for scenario in scenarios]
    assert len(set(deviations)) == len(deviations)
    assert 0.5 < max(map(abs, deviations)) <= 1


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
