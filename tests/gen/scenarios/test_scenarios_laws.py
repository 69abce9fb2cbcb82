"""Laws of the draws: only fault values depend on the fault, any range of records equals that part of the whole, splits do not leak."""

from collections import Counter
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import gen
from gen.mechanisms.background.bursts import Bursts
from gen.mechanisms.background.looseness import Looseness
from gen.mechanisms.chain.drift import Drift
from gen.recipe import Recipe
from gen.recipe.faults import OF_KIND
from gen.scenarios import draw_scenarios
from gen.support.errors import RecipeError
from tests.conftest import small_with
from tests.drawn_values import anywhere

SAMPLINGS = ("random", "sobol", "halton")
FAULTY = ("inner", "outer", "ball")


def faults(**weights):
    entries = {"healthy": {}} | {kind: {"width_mm": 0.5} for kind in FAULTY}
    return [{"kind": kind, "weight": weights.get(kind, 0.0), **entry} for kind, entry in entries.items()]


@pytest.mark.parametrize("sampling", SAMPLINGS)
@pytest.mark.parametrize("only", ["healthy", *FAULTY])
def test_nothing_but_the_fault_knows_the_fault(recipe_with, only, sampling):
    changes = {"corpus.sampling": sampling}
    mixed = draw_scenarios(recipe_with(changes))
    alike = draw_scenarios(recipe_with(changes | {"faults": faults(**{only: 1.0})}))
    assert {scenario.fault for scenario in alike} == {only}
    for scenario, other in zip(mixed, alike, strict=True):
        origin = scenario.origin.model_copy(update={"entry": other.origin.entry})
        assert anywhere(scenario.edited(faults=other.recipe.faults, origin=origin)) == anywhere(other)


@given(*[st.integers(1, 5)] * 5, st.integers(2, 3) | st.none())
def test_rigs_specimens_records_and_parts_are_numbered_without_gaps(rigs, per_rig, per_specimen, per_part, n, n_rungs):
    rungs = None if n_rungs is None else [rung / n_rungs for rung in range(1, n_rungs + 1)]
    numbers = {"rigs": rigs, "specimens_per_rig": per_rig, "records_per_specimen": per_specimen}
    recipe = Recipe(
        small_with(
            {
                "corpus": {**numbers, "rungs": rungs},
                "storage": {"records_per_part": per_part},
                "records": n * (n_rungs or 1),
            }
        )
    )
    every = list(range(recipe.n_records))
    assert [number for part in range(recipe.n_parts) for number in recipe.records_of_part(part)] == every
    assert [number for specimen in range(recipe.n_specimens) for number in recipe.records_of(specimen)] == every
    assert all(number in recipe.records_of(recipe.specimen_of(number)) for number in every)
    assert {recipe.rig_of(specimen) for specimen in range(recipe.n_specimens)} == set(range(recipe.n_rigs))
    assert len({recipe.item_of(number) for number in every}) == len(every)


@pytest.mark.parametrize("sampling", SAMPLINGS)
def test_the_end_of_a_large_corpus_can_be_drawn_alone(recipe_with, sampling):
    recipe = recipe_with({"corpus.sampling": sampling, "corpus.rigs": 10**6})
    last = draw_scenarios(recipe, recipe.n_records - 3)
    assert [scenario.origin.record for scenario in last] == list(range(recipe.n_records - 3, recipe.n_records))


@pytest.mark.parametrize("sampling", SAMPLINGS)
@pytest.mark.parametrize("rungs", [None, (0.25, 0.5, 1)])
def test_any_range_of_records_and_a_corpus_that_ends_early_are_pieces_of_the_whole(recipe_with, sampling, rungs):
    changes = {"corpus.sampling": sampling, "corpus.rungs": rungs}
    recipe, early = recipe_with(changes), recipe_with(changes | {"records": 9})
    whole = draw_scenarios(recipe)
    assert len(whole) == recipe.n_records
    for first, stop in ((0, 1), (1, 2), (5, 6), (7, 12), (13, 23), (23, 24), (20, 100)):
        assert draw_scenarios(recipe, first, stop) == whole[first:stop]
    assert draw_scenarios(early) == whole[:9]


@pytest.mark.parametrize("sampling", SAMPLINGS)
def test_what_was_drawn_for_a_rig_or_a_specimen_says_nothing_about_what_runs_on_it(recipe_with, sampling):
    size = {"corpus.rigs": 256, "corpus.specimens_per_rig": 2, "corpus.records_per_specimen": 1}
    values = np.array(
        [
            (
                np.log(scenario.machine["shaft_mass"]),
                scenario.properties["diametral_clearance"],
                scenario.conditions["shaft_rate"],
            )
            for scenario in draw_scenarios(recipe_with(size | {"corpus.sampling": sampling}))
        ]
    )
    correlation = np.corrcoef(values.T)
    assert np.abs(correlation - np.eye(3)).max() < 0.25  # 4 sigma of 256 independent rigs


def test_records_of_a_specimen_share_it_and_specimens_of_a_rig_share_it(recipe_with):
    whole = draw_scenarios(recipe_with())
    for scenario in whole:
        specimen, rig = divmod(scenario.origin.record, 2)[0], scenario.origin.record // 8
        assert (scenario.origin.specimen, scenario.origin.rig) == (specimen, rig)
    assert len({id(scenario.recipe.specimen) for scenario in whole}) == 12
    assert len({id(scenario.recipe.machine) for scenario in whole}) == 3


@pytest.mark.parametrize("by", ["specimen", "rig"])
def test_no_specimen_or_rig_is_on_both_sides_of_a_split(recipe_with, by):
    split = {"by": by, "validation": 0.25, "test": 0.25}
    recipe = recipe_with({"corpus.rigs": 20, "corpus.split": split})
    sides: dict[int, set[str]] = {}
    for scenario in draw_scenarios(recipe):
        sides.setdefault(getattr(scenario.origin, by), set()).add(scenario.origin.split)
    assert all(len(side) == 1 for side in sides.values())
    shares = Counter(next(iter(side)) for side in sides.values())
    assert shares["test"] / len(sides) == pytest.approx(0.25, abs=0.02)
    assert shares["validation"] / len(sides) == pytest.approx(0.25, abs=0.02)


def test_the_first_rigs_of_a_corpus_set_aside_the_share_of_their_specimens_whatever_their_number(recipe_with):
    share, n_rigs, per_rig = 0.1, 50, 4
    corpus = {
        "rigs": n_rigs,
        "specimens_per_rig": per_rig,
        "records_per_specimen": 1,
        "split": {"by": "specimen", "test": share},
    }
    scenarios = draw_scenarios(recipe_with({"corpus": corpus}))
    chosen = np.array([scenario.origin.split == "test" for scenario in scenarios]).reshape(n_rigs, per_rig).sum(axis=1)
    excess = np.cumsum(chosen) - share * per_rig * np.arange(1, n_rigs + 1)
    assert np.abs(excess).max() < 1.5


@pytest.mark.parametrize("sampling", ["sobol", "halton"])
def test_quasi_random_records_fill_the_range_of_a_value_evenly(recipe_with, sampling):
    changes = {"corpus.sampling": sampling, "corpus.rigs": 8, "operation.shaft_rpm": "uniform(1, 64)"}
    drawn = draw_scenarios(recipe_with(changes))
    quantiles = [(scenario.conditions["shaft_rate"] * 60 - 1) / 63 for scenario in drawn]
    assert len(quantiles) == 64
    assert Counter(int(64 * u) for u in quantiles) == dict.fromkeys(range(64), 1)


def test_grids_of_one_level_give_every_combination_once_before_they_come_again(recipe_with):
    rpm, load, clearance = [1000, 1500, 2000], [100, 400], [-2, 3, 8]
    recipe = recipe_with(
        {
            "corpus.specimens_per_rig": 3,
            "corpus.records_per_specimen": 6,
            "operation.shaft_rpm": gen.grid(*rpm),
            "operation.load_n": gen.grid(*load),
            "specimen.diametral_clearance_um": gen.grid(*clearance),
        }
    )
    combinations: dict[int, list[tuple[float, float]]] = {}
    clearances: dict[int, set[float]] = {}
    for scenario in draw_scenarios(recipe):
        conditions = scenario.conditions
        combination = round(conditions["shaft_rate"] * 60), conditions["load"]
        combinations.setdefault(scenario.origin.specimen, []).append(combination)
        of_rig = clearances.setdefault(scenario.origin.rig, set())
        of_rig.add(round(scenario.properties["diametral_clearance"] * 1e6))
    assert all(sorted(of_specimen) == sorted(product(rpm, load)) for of_specimen in combinations.values())
    assert all(of_rig == set(clearance) for of_rig in clearances.values())


MECHANISMS = {
    "faults": (OF_KIND["inner"], {"kind": "inner", "width_mm": 0.5}, "angle_deg", (400.0,)),
    "background": (Bursts, {"probability": 1, "level_db": 0}, "length_deg", 181.0),
    "machine_conditions": (Looseness, {"probability": 1, "lift": 3, "frequency_hz": 500, "level_db": 0}, "lift", 1.0),
    "sensor_faults": (Drift, {"probability": 1}, "wander_m_s2", -0.1),
}


@pytest.mark.parametrize("wrong", ["outside", None, "text", True, np.nan, np.zeros((9, 9))], ids=str)
@pytest.mark.parametrize("place", MECHANISMS)
def test_a_plug_in_that_draws_what_its_keys_do_not_allow_is_refused_by_the_key(recipe_with, monkeypatch, place, wrong):
    base, keys, key, value = MECHANISMS[place]
    value = value if isinstance(wrong, str) and wrong == "outside" else wrong
    monkeypatch.setattr("gen.scenarios.draw.plugins_of", lambda *_: ["mechanism"])

    class Mechanism(base):
        def draw(self, of):
            return super().draw(of).model_copy(update={key: value})

    mechanism, recipe = Mechanism(**keys), recipe_with()
    section = (mechanism,) if place == "faults" else getattr(recipe, place).model_copy(update={base.place: mechanism})
    with pytest.raises(
        RecipeError,
        match=rf"^(record|specimen) 0: {place}\.(\w+\.)?{key}: .* was drawn, which is not in [\[(].*class\.$",
    ):
        draw_scenarios(recipe.model_copy(update={place: section}))
