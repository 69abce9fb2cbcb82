"""Laws of pairs and ladders: the records of a group differ in the severity of their fault alone, and stay on one side of every split."""

from collections import Counter

import numpy as np
import pytest

from features.baselines.splits import grouped_splits
from gen.corpus import FAULTS, open_corpus
from gen.generation.corpus import generate
from gen.generation.plan import plan
from gen.generation.replaying import replay
from gen.scenarios import draw_scenarios, read_scenarios
from raceway.sharing.card.card_page import data_card
from tests.recipes import EVERY_FAULT

RUNGS = (0, 0.25, 0.5, 1)
MANY_HEALTHY = [{"kind": "healthy", "weight": 10}, *EVERY_FAULT[1:]]
LADDERS = {"corpus.rungs": RUNGS, "corpus.rigs": 8, "corpus.records_per_specimen": 3, "faults": MANY_HEALTHY}
SIZES = ("width_mm", "depth_um", "trace_um", "waviness_um", "pitch_error_deg", "knock_n")
SAMPLINGS = ("random", "sobol", "halton")


def groups_of(scenarios):
    """Scenarios of each pair, by its number."""
    groups = {}
    for scenario in scenarios:
        if scenario.origin.pair >= 0:
            groups.setdefault(scenario.origin.pair, []).append(scenario)
    return groups


def at_place_of(scenario, other):
    """The other scenario with the place in the corpus of a scenario."""
    return other.edited(origin=scenario.origin)


@pytest.mark.parametrize("sampling", SAMPLINGS)
def test_the_records_of_a_group_differ_in_severity_alone(recipe_with, sampling):
    recipe = recipe_with(LADDERS | {"corpus.sampling": sampling})
    groups = groups_of(draw_scenarios(recipe))
    assert len(groups) > 20
    for group in groups.values():
        last = group[-1]
        assert [scenario.origin.rung for scenario in group] == [0, 1, 2, 3]
        for scenario in group:
            assert at_place_of(last, scenario) == at_place_of(last, last.at_severity(RUNGS[scenario.origin.rung]))
            for name in ("motion", "noise", "load wander", "knocks"):
                assert scenario.stream(name).random() == last.stream(name).random()


def test_a_rung_is_its_share_of_the_severity(recipe_with):
    faults_seen = set()
    for group in groups_of(draw_scenarios(recipe_with(LADDERS))).values():
        whole = group[-1]
        faults_seen.add(whole.fault)
        assert at_place_of(whole, group[0]) == whole.without_fault()
        assert group[0].fault == "healthy"
        for scenario, share in zip(group[1:], RUNGS[1:], strict=True):
            assert scenario.fault == whole.fault
            for spall, of_whole in zip(scenario.spalls, whole.spalls, strict=True):
                assert (spall.width, spall.depth) == pytest.approx((share * of_whole.width, share * of_whole.depth))
                assert max(spall.trace, default=spall.depth) == pytest.approx(spall.depth)
            for part, of_whole in zip(scenario.components, whole.components, strict=True):
                sizes = {key: value for key in SIZES if (value := getattr(of_whole, key, None)) is not None}
                for key, value in sizes.items():
                    assert getattr(part, key) == pytest.approx(share * np.array(value))
                assert part.model_copy(update=sizes) == of_whole
    assert faults_seen == set(FAULTS) - {"healthy"}


def test_groups_are_neighbours_and_specimens_are_whole(recipe_with):
    recipe = recipe_with(LADDERS)
    scenarios = draw_scenarios(recipe)
    assert recipe.n_records == len(scenarios) == 8 * 4 * 3 * 4
    assert [scenario.origin.record for scenario in scenarios] == list(range(len(scenarios)))
    assert [scenario.origin.specimen for scenario in scenarios] == [number // 12 for number in range(len(scenarios))]
    for pair, group in groups_of(scenarios).items():
        assert [scenario.origin.record for scenario in group] == list(range(4 * pair, 4 * pair + 4))
    healthy = [scenario for scenario in scenarios if scenario.origin.pair < 0]
    assert {scenario.fault for scenario in healthy} == {"healthy"}
    assert {scenario.origin.rung for scenario in healthy} == {-1}
    speeds = Counter(scenario.conditions["shaft_rate"] for scenario in healthy)
    assert max(speeds.values()) == 1  # each record of a healthy specimen has conditions of its own


def test_the_last_rung_of_a_ladder_is_the_record_without_rungs(recipe_with):
    """The weights are such that the classes of the specimens are the same with rungs and without."""
    without = recipe_with({"faults": [{"kind": "inner", "width_mm": 0.5}]})
    ladder = recipe_with({"faults": [{"kind": "inner", "width_mm": 0.5}], "corpus.rungs": (0.5, 1)})
    for scenario, other in zip(draw_scenarios(without), draw_scenarios(ladder)[1::2], strict=True):
        drawn_per_record = {"operation": other.recipe.operation, "level": other.recipe.level, "origin": other.origin}
        assert scenario.edited(**drawn_per_record) == other
    assert all(scenario.origin.pair == scenario.origin.rung == -1 for scenario in draw_scenarios(without))


@pytest.mark.parametrize("sampling", SAMPLINGS)
def test_the_conditions_of_faulty_specimens_cover_their_ranges(recipe_with, sampling):
    """A sequence of which faulty specimens took every second point would leave half of the range of their speeds empty."""
    recipe = recipe_with(
        {"corpus.rungs": (0, 1), "corpus.rigs": 32, "corpus.sampling": sampling, "faults": MANY_HEALTHY}
    )
    drawn = draw_scenarios(recipe)
    for groups in (
        [scenario for scenario in drawn if scenario.origin.pair >= 0],
        [scenario for scenario in drawn if scenario.origin.pair < 0],
    ):
        quantiles = [(60 * scenario.conditions["shaft_rate"] - 1500) / 500 for scenario in groups]
        assert set(np.digitize(quantiles, np.arange(1, 8) / 8)) == set(range(8))


@pytest.mark.parametrize("by", ["specimen", "rig"])
def test_the_rungs_of_a_pair_are_on_one_side_of_every_split(recipe_with, by):
    recipe = recipe_with(LADDERS | {"corpus.split": {"by": by, "test": 0.25, "validation": 0.25}})
    scenarios = draw_scenarios(recipe)
    for group in groups_of(scenarios).values():
        assert len({scenario.origin.split for scenario in group}) == 1
    fault = np.array([FAULTS.index(scenario.fault) for scenario in scenarios])
    unit = np.array([getattr(scenario.origin, by) for scenario in scenarios])
    pair = np.array([scenario.origin.pair for scenario in scenarios])
    for train, test in grouped_splits(fault, unit, 3, 0):
        assert not set(pair[train][pair[train] >= 0]) & set(pair[test])


def test_a_generated_ladder_is_labelled_planned_and_replayed(write_recipe, tmp_path):
    changes = {
        "corpus": {"rigs": 1, "specimens_per_rig": 4, "records_per_specimen": 1, "rungs": [0, 0.5, 1]},
        "storage": {"records_per_part": 4},
        "faults": [{"kind": "healthy"}, {"kind": "inner", "width_mm": 0.5}],
    }  # fmt: skip
    path = write_recipe(tmp_path / "r.yaml", changes)
    planned = plan(path)
    generated = generate(path, tmp_path / "c")
    assert (generated.records, planned.records, planned.specimens, planned.parts) == (12, 12, 4, 3)
    with open_corpus(generated.path) as corpus:
        records = corpus[["fault", "pair", "rung", "specimen", "recording", "draws"]].load()
    assert records["recording"].values.tolist() == list(range(12))
    in_pair = records["pair"].values >= 0
    assert (records["pair"].values[in_pair] == np.arange(12)[in_pair] // 3).all()
    assert (records["rung"].values[in_pair] == np.arange(12)[in_pair] % 3).all()
    healthy = records["fault"].values == 0
    assert (healthy == (~in_pair | (records["rung"].values == 0))).all()
    assert planned.classes == {"healthy": healthy.sum(), "inner": (~healthy).sum()}
    card = data_card(generated.path)
    assert f"\n{in_pair.sum() // 3} groups of records (`pair`) differ in the severity" in card
    assert f"\n| healthy | {healthy.sum()} | " in card
    for record in (int(np.flatnonzero(in_pair)[0]), int(np.flatnonzero(in_pair)[-1])):
        again = replay(generated.path, record)
        assert again.identical
        assert read_scenarios(records.isel(record=record))[0].origin.rung == int(records["rung"][record])
        assert again.dataset["pair"][0] == records["pair"][record].item()
