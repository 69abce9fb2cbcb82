"""Laws of the faults that can be seen: what a record without its fault tells, and what becomes of a fault that cannot be seen."""

import math

import numpy as np
import pytest

from gen.generation.labels import part_dataset
from gen.generation.undetected import FAULT_TRIES, made_from, made_of, make_records
from gen.measurement.measure import Measured
from gen.recipe.sensing import FloatConverter
from gen.scenarios import draw_scenarios, further_ratios
from gen.simulation import simulate as simulation
from gen.simulation.hits import felt_places
from gen.simulation.simulate import simulate
from tests.responses import accelerations_of

FLOAT = FloatConverter(kind="float32")
OUTER = {"kind": "outer", "width_mm": 0.5, "angle_deg": "uniform(-180, 180)"}
LEVEL = {"kind": "snr", "faulty_db": "uniform(-15, 10)", "healthy_db": "uniform(-15, 10)"}
TRAINING = {
    "level": LEVEL,
    "recording.duration_s": 0.25,
    "corpus.rigs": 4,
    "faults": [{"kind": "healthy"}, OUTER, {"kind": "inner", "width_mm": 0.5}],
}


def scenarios_of(records):
    return [record.scenario for record in records if isinstance(record, Measured)]


@pytest.fixture(scope="module")
def redrawing(recipe_with):
    recipe = recipe_with(TRAINING | {"truth.undetected": "redraw"})
    records = make_records(recipe, range(recipe.n_records))
    assert all(isinstance(record, Measured) for record in records)
    return recipe, records


def assert_same(records, others):
    for record, other in zip(records, others, strict=True):
        np.testing.assert_array_equal(record.signal, other.signal)
        assert (record.fault_snr == other.fault_snr) or math.isnan(record.fault_snr)
        assert record.scenario == other.scenario


def test_every_fault_of_a_recipe_that_redraws_can_be_seen(redrawing):
    _, records = redrawing
    faulty = [record for record in records if record.scenario.fault != "healthy"]
    assert len(faulty) > 10
    assert all(record.detectable == 1 for record in faulty)
    assert any(record.scenario.origin.fault_try for record in records)
    assert any(record.scenario.origin.level_try for record in records)


def test_a_fault_that_is_drawn_again_leaves_everything_else_as_it_was(redrawing):
    recipe, records = redrawing
    for first, final in zip(draw_scenarios(recipe), scenarios_of(records), strict=True):
        others = set(type(recipe).model_fields) - {"faults", "level", "origin"}
        for section in others:
            assert getattr(final.recipe, section) == getattr(first.recipe, section)
        assert final.fault == first.fault
        assert (final.recipe.level == first.recipe.level) == (final.origin.level_try == 0)
        assert (final.spalls == first.spalls) == (final.origin.fault_try == 0 or not first.spalls)


def test_a_fault_that_is_drawn_again_keeps_the_conditions_of_its_entry(recipe_with):
    """Of two entries of a class with conditions of their own, the second is not taken where the first cannot be seen."""
    slow = OUTER | {"operation": {"shaft_rpm": 600}}
    recipe = recipe_with({"faults": [OUTER, slow], "corpus.rigs": 8})
    first = draw_scenarios(recipe)
    assert len({scenario.origin.entry for scenario in first}) == 2
    for fault_try in (1, 2):
        again = draw_scenarios(recipe, fault_tries=dict.fromkeys(range(32), fault_try))
        assert [scenario.conditions for scenario in again] == [scenario.conditions for scenario in first]
        assert [scenario.spalls for scenario in again] != [scenario.spalls for scenario in first]


def test_a_record_does_not_depend_on_the_part_in_which_it_is_made(redrawing):
    """Also the last record of a specimen, alone, has the fault that can be seen in all of its records."""
    recipe, whole = redrawing
    redrawn = {scenario.origin.specimen for scenario in scenarios_of(whole) if scenario.origin.fault_try}
    assert redrawn
    for numbers in (range(3, 9), range(24, 32), *(recipe.records_of(specimen)[-1:] for specimen in redrawn)):
        assert_same(make_records(recipe, numbers), whole[numbers.start : numbers.stop])


def test_a_record_does_not_depend_on_the_number_of_records(recipe_with):
    """Also in a corpus that ends within a specimen whose fault is drawn again for a record beyond the end."""
    wide = {
        "level": {"kind": "physical", "background_m_s2": "loguniform(0.3, 10)"},
        "operation.load_n": "loguniform(30, 2000)",
        "operation.shaft_rpm": "uniform(900, 6000)",
        "faults": [OUTER | {"width_mm": "loguniform(0.2, 1)"}],
    }
    recipe = recipe_with(TRAINING | wide | {"truth.undetected": "redraw"})
    whole = make_records(recipe, range(recipe.n_records))
    redrawn = {scenario.origin.specimen for scenario in scenarios_of(whole) if scenario.origin.fault_try}
    for first, _ in map(recipe.records_of, redrawn):
        cut = recipe.model_copy(update={"records": first + 1})
        assert_same(make_records(cut, range(first, first + 1)), whole[first : first + 1])


@pytest.mark.parametrize(("waviness", "kinds"), [(0, ["inner"]), (20, ["inner", "outer"])])
def test_the_twin_of_a_record_is_the_record_without_its_fault(recipe_with, waviness, kinds):
    worn = {"kind": "distributed", "site": "outer", "waviness_um": 0.5}
    faults = [{"kind": "inner", "width_mm": 0.5}, worn][: len(kinds)]
    recipe = recipe_with({"specimen.waviness_nm": waviness, "faults": faults, "corpus.specimens_per_rig": len(kinds)})
    scenarios = draw_scenarios(recipe, 0, 2 * len(kinds))
    twins = [run.twin.response for run in simulate(scenarios)]
    alone = simulate([scenario.without_fault() for scenario in scenarios])
    assert {scenario.fault for scenario in scenarios} == set(kinds)
    np.testing.assert_array_equal(twins, accelerations_of(alone))


def test_a_record_is_the_same_whether_its_fault_is_known_apart_or_not(recipe_with):
    """Bearing without the fault plus what the fault adds is the bearing with the fault, in every channel."""
    changes = {
        "recording.converter": {"kind": "float32"},
        "recording.channels": [
            {"name": "a", "body": "sensor"},
            {"name": "b", "body": "housing", "path": {"direct": 2}},
        ],
        "path.modulation": {"probability": 1, "first": 0.5, "second": 0.2},
        "level": {"kind": "physical", "background_m_s2": 0.1, "gain": 3},
    }
    whole, apart = (make_records(recipe_with(changes | {"truth.twins": twins}), range(8)) for twins in (False, True))
    assert any(record.fault_snr > 0 for record in apart)
    for record, other in zip(apart, whole, strict=True):
        np.testing.assert_allclose(record.signal, other.signal, rtol=0, atol=2e-6 * np.abs(other.signal).max())
        assert record.snr == pytest.approx(other.snr, abs=1e-4)


def test_a_record_whose_twin_diverged_is_left_out(recipe_with, monkeypatch):
    recipe = recipe_with({"faults": [{"kind": "inner", "width_mm": 0.5}]})
    integrate = simulation.integrate_all

    def second_twin_diverges(integrations, *axis):
        integrate(integrations, *axis)
        (_, twin) = (integration for integration in integrations if not integration.kernel_input.spalls)
        twin.diverged = 100

    monkeypatch.setattr(simulation, "integrate_all", second_twin_diverges)
    first, second = simulate(draw_scenarios(recipe, 0, 2))
    assert first.failure is None
    assert "record 1 diverged at t = 0.008333 s" in second.failure


def test_without_truth_nothing_is_simulated_twice_and_nothing_judged(recipe_with):
    recipe = recipe_with({"truth.twins": False})
    records = make_records(recipe, range(8))
    for record in records:
        assert record.run.twin is None
        assert math.isnan(record.fault_snr)
        assert record.detectable == (0 if record.scenario.fault == "healthy" else 2)


def hidden(recipe_with, undetected):
    unloaded = {"kind": "outer", "width_mm": 0.5, "angle_deg": 170}
    changes = {"faults": [unloaded], "corpus.specimens_per_rig": 1, "specimen.diametral_clearance_um": 30}
    recipe = recipe_with(changes | {"truth.undetected": undetected})
    return recipe, make_records(recipe, range(2))


@pytest.mark.parametrize(("undetected", "spalls"), [("keep", 1), ("healthy", 0)])
def test_a_fault_that_adds_exactly_nothing_keeps_its_label_or_is_called_healthy(recipe_with, undetected, spalls):
    """Records with and without a spall that no loaded ball meets have the same bits."""
    dataset = part_dataset(*hidden(recipe_with, undetected))
    expected = {"fault_snr": -np.inf, "fault": 2 * spalls, "n_spalls": spalls, "detectable": 0, "loaded_hits": 0}
    for name, value in expected.items():
        assert dataset[name].values.tolist() == [value, value], name
    assert ((dataset["width"] > 0) == bool(spalls)).all()
    assert (dataset["fault_share"] == 0).all()


def test_a_fault_that_no_draw_makes_visible_is_left_out_with_a_sentence(recipe_with):
    _, sentences = hidden(recipe_with, "redraw")
    for sentence in sentences:
        assert f"none of {FAULT_TRIES} drawn faults of class outer" in sentence


LADDER = {
    "level": LEVEL,
    "recording.duration_s": 0.25,
    "corpus.rungs": [0, 0.5, 1],
    "corpus.specimens_per_rig": 3,
    "faults": [{"kind": "healthy", "weight": 1}, OUTER | {"angle_deg": 0}, {"kind": "inner", "width_mm": 0.5}],
}


@pytest.fixture(scope="module", params=["keep", "redraw"])
def ladders(recipe_with, request):
    recipe = recipe_with(LADDER | {"truth.undetected": request.param})
    return recipe, make_records(recipe, range(18))


def groups_of(records):
    groups = {}
    for place, record in enumerate(records):
        if isinstance(record, Measured) and record.scenario.origin.pair >= 0:
            groups.setdefault(record.scenario.origin.pair, []).append(place)
    return list(groups.values())


def test_records_of_a_group_differ_in_what_the_fault_adds_alone(ladders):
    """Background and bearing have the same gains at every severity, so the difference to the first rung is the fault."""
    recipe, records = ladders
    exact = recipe.model_copy(update={"recording": recipe.recording.model_copy(update={"converter": FLOAT})})
    signal = [record.signal.astype(float) for record in make_records(exact, range(18))]
    groups = groups_of(records)
    assert groups
    for group in groups:
        healthy, *damaged = (signal[place] for place in group)
        rest = np.sqrt(np.mean(healthy**2))
        for place, record in zip(group[1:], damaged, strict=True):
            added = np.sqrt(np.mean((record - healthy) ** 2))
            assert 20 * np.log10(added / rest) == pytest.approx(records[place].fault_snr, abs=0.05)


def test_the_largest_severity_of_a_group_has_the_drawn_level(ladders):
    recipe, records = ladders
    for *_, largest in groups_of(records):
        (drawn,) = draw_scenarios(recipe, largest, largest + 1)
        level_try = records[largest].scenario.origin.level_try
        ratios = [drawn.recipe.level.faulty_db, *further_ratios(recipe, drawn, level_try)]
        assert records[largest].fault_snr == pytest.approx(ratios[-1], abs=0.05)


def test_the_level_of_a_group_is_drawn_again_for_all_of_its_records(recipe_with):
    quiet = LEVEL | {"faulty_db": "uniform(-40, 10)"}
    recipe = recipe_with(LADDER | {"level": quiet, "truth.undetected": "redraw"})
    records = make_records(recipe, range(18))
    tried = 0
    for group in groups_of(records):
        scenarios = [records[place].scenario for place in group]
        levels = {
            (scenario.recipe.level.gain, scenario.recipe.level.background_m_s2, scenario.origin.level_try)
            for scenario in scenarios
        }
        assert len(levels) == 1
        (again,) = made_from(scenarios[:1])
        np.testing.assert_array_equal(again.signal, records[group[0]].signal)
        tried += levels.pop()[-1] > 0
    assert tried > 0


def test_a_smaller_severity_that_misses_the_load_zone_does_not_change_the_fault_of_its_group(recipe_with):
    """Of the widest spalls at the edge of the load zone, half the width may lie outside."""
    angles = "uniform(20, 180)"
    changes = {"faults": [{"kind": "outer", "width_mm": 12, "angle_deg": angles}], "truth.undetected": "redraw"}
    recipe = recipe_with(LADDER | {"corpus.rungs": [0.1, 1], "corpus.rigs": 6} | changes)
    records = make_records(recipe, range(recipe.n_records))
    tries = {scenario.origin.specimen: scenario.origin.fault_try for scenario in scenarios_of(records)}
    drawn = draw_scenarios(recipe, fault_tries=tries)
    missed = {scenario.origin.record for scenario, felt in zip(drawn, felt_places(drawn), strict=True) if not felt}
    assert any(
        scenario.origin.record in missed and scenario.origin.record + 1 not in missed
        for scenario in drawn
        if scenario.origin.rung == 0
    )


def test_the_rest_of_a_group_has_the_level_of_its_largest_severity_that_did_not_diverge(recipe_with):
    recipe = recipe_with(LADDER)
    scenarios = [scenario for scenario in draw_scenarios(recipe, 0, 18) if scenario.origin.pair >= 0][:6]
    runs = simulate(scenarios)
    runs[2].own.diverged = 100
    records = made_of(runs)
    drawn = scenarios[1].recipe.level
    assert records[1].fault_snr == pytest.approx(drawn.faulty_db, abs=0.05)
    scale = recipe.recording.converter.full_scale_m_s2 / 32767
    rms = np.sqrt(np.mean((records[1].signal * scale) ** 2))
    assert rms == pytest.approx(drawn.rms_m_s2, rel=1e-3)
    assert records[0].signal.any()
    assert "record 2 diverged" in records[2]


def test_a_group_is_not_cut_by_a_part(ladders):
    recipe, whole = ladders
    for number in (1, 4, 11):
        assert_same(make_records(recipe, range(number, number + 2)), whole[number : number + 2])
        (again,) = made_from([whole[number].scenario])
        np.testing.assert_array_equal(again.signal, whole[number].signal)
