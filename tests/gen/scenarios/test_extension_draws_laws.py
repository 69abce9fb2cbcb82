"""Laws of drawing for an extended corpus: old draws stay, new numbers are new, shares of classes and splits are met."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.errors import RecipeError
from gen.recipe import recipe_hash
from gen.recipe.extensions import Extension, first_block, with_blocks
from gen.scenarios import draw_scenarios, first_records, scenario_texts
from gen.scenarios.model import Purpose
from gen.scenarios.points import points_of

COUNTS = st.integers(1, 5)
EXTENSIONS = st.lists(st.one_of(COUNTS.map(lambda n: {"rigs": n}), COUNTS.map(lambda n: {"specimens": n})), max_size=4)
RUNGS = {"corpus.rungs": [0, 0.5, 1], "faults": [{"kind": "healthy", "weight": 2}, {"kind": "inner", "width_mm": 0.5}]}


@given(COUNTS, COUNTS, COUNTS, COUNTS, COUNTS, st.integers(1, 3), st.data())
def test_blocks_divide_rigs_specimens_records_and_parts(rigs, per_rig, per_specimen, per_part, n, n_rungs, data):
    per_specimen *= n_rungs
    whole = rigs * per_rig * per_specimen
    records = min(n * n_rungs, whole)
    first = first_block(
        records, whole, per_specimen=per_specimen, specimens_per_rig=per_rig, per_part=per_part, n_rungs=n_rungs
    )
    blocks = with_blocks(first, [Extension(**one) for one in data.draw(EXTENSIONS)])
    for name in ("specimens", "records", "parts"):
        numbers = [number for block in blocks for number in getattr(block, name)]
        assert numbers == list(range(len(numbers)))
    seen = set()
    for block in blocks:
        assert [n for part in block.parts for n in block.records_of_part(part)] == list(block.records)
        assert [n for one in block.specimens for n in block.records_of(one)] == list(block.records)
        assert all(n in block.records_of(block.specimen_of(n)) for n in block.records)
        assert {block.rig_of(one) for one in block.specimens} == set(block.rigs)
        items = {block.item_of(n) for n in block.records}
        assert len(items) == len(block.records)
        assert not items & seen
        seen |= items


@pytest.mark.parametrize("sampling", ["random", "sobol", "halton"])
@pytest.mark.parametrize("by", ["specimen", "rig"])
@pytest.mark.parametrize("changes", [{}, {"records": 15}, RUNGS])
def test_an_extension_changes_no_draw_of_the_corpus(recipe_with, sampling, by, changes):
    recipe = recipe_with({"corpus.sampling": sampling, "corpus.split.by": by, **changes})
    extended = recipe.extended([{"specimens": 2}, {"rigs": 2}, {"specimens": 1}])
    old, new = draw_scenarios(recipe), draw_scenarios(extended)
    assert scenario_texts(new[: len(old)]) == scenario_texts(old)
    assert len(new) == extended.n_records > len(old)
    assert recipe_hash(extended) == recipe_hash(recipe)
    assert {name: first_records(extended)[name] for name in first_records(recipe)} == first_records(recipe)
    middle = len(old) - 3
    assert scenario_texts(draw_scenarios(extended, middle, middle + 9)) == scenario_texts(new[middle : middle + 9])


def test_added_specimens_are_new_bearings_in_the_same_machines(recipe_with):
    recipe = recipe_with().extended([{"specimens": 2}])
    scenarios = draw_scenarios(recipe)
    old, new = scenarios[:24], scenarios[24:]
    machines = {one.rig.number: one.rig for one in old}
    assert all(one.rig == machines[one.rig.number] for one in new)
    assert Counter(one.rig.number for one in new) == {0: 4, 1: 4, 2: 4}
    drawn = {one.specimen.number: one.specimen.properties["diametral_clearance"] for one in scenarios}
    assert len(set(drawn.values())) == len(drawn) == 18


def test_rigs_that_are_added_are_those_that_a_larger_recipe_has(recipe_with):
    """The machine of a number does not depend on when it was added."""
    larger = {one.rig.number: one.rig for one in draw_scenarios(recipe_with({"corpus.rigs": 5}))}
    extended = draw_scenarios(recipe_with({"records": 12}).extended([{"rigs": 3}]))
    assert {one.rig.number: one.rig for one in extended} == larger


@pytest.mark.parametrize("changes", [{}, {"records": 12, **RUNGS}])
def test_quasi_random_points_go_on_and_none_is_used_twice(recipe_with, changes):
    """Speeds of healthy records of the corpus and its extensions are those of different points of one sequence."""
    recipe = recipe_with({"corpus.sampling": "sobol", "corpus.records_per_specimen": 4, **changes})
    recipe = recipe.extended([{"specimens": 3}, {"rigs": 2}])
    items = [block.item_of(number) for block in recipe.blocks for number in block.records]
    assert len(set(items)) == len(items)
    if not changes:
        assert items == list(range(recipe.n_records))
    points = points_of(recipe, Purpose.RECORD, 0, max(items) + 1)
    healthy = [one for one in draw_scenarios(recipe) if one.record.pair < 0]
    for one in healthy:
        block = recipe.block_of(one.record.number)
        u = points[block.item_of(one.record.number)][0]
        speed = (1500 + 500 * u) / 60
        assert one.record.conditions["shaft"] == pytest.approx(speed)


@pytest.mark.parametrize("extension", [{"specimens": 1}, {"specimens": 3}, {"rigs": 40}])
@pytest.mark.parametrize("seed", [1, 2])
def test_classes_and_splits_are_balanced_within_an_extension(recipe_with, extension, seed):
    changes = {"corpus.rigs": 40, "corpus.records_per_specimen": 1, "seed": seed}
    new = draw_scenarios(recipe_with(changes).extended([extension]), 160)
    for counts, shares in (
        (Counter(one.specimen.fault for one in new), {"healthy": 0.25, "inner": 0.25, "outer": 0.25, "ball": 0.25}),
        (Counter(one.specimen.split for one in new), {"train": 0.75, "test": 0.25}),
    ):
        for name, share in shares.items():
            assert abs(counts[name] - share * len(new)) <= 4


@pytest.mark.parametrize("by", ["specimen", "rig"])
def test_many_small_extensions_meet_the_shares_of_the_split_too(recipe_with, by):
    changes = {"corpus.rigs": 2, "corpus.specimens_per_rig": 1, "corpus.records_per_specimen": 1}
    recipe = recipe_with({**changes, "corpus.split": {"by": by, "test": 0.25}})
    new = draw_scenarios(recipe.extended([{"rigs": 1}] * 40), 2)
    assert abs(Counter(one.specimen.split for one in new)["test"] - 10) <= 2
    if by == "specimen":
        new = draw_scenarios(recipe.extended([{"specimens": 1}] * 20), 2)
        assert abs(Counter(one.specimen.split for one in new)["test"] - 10) <= 2


def test_old_rigs_keep_their_split_when_rigs_are_kept_together(recipe_with):
    recipe = recipe_with({"corpus.rigs": 8, "corpus.split": {"by": "rig", "test": 0.25}})
    scenarios = draw_scenarios(recipe.extended([{"specimens": 2}, {"rigs": 8}, {"specimens": 1}]))
    splits = {}
    for one in scenarios:
        assert splits.setdefault(one.rig.number, one.specimen.split) == one.specimen.split
    assert np.sum([splits[rig] == "test" for rig in range(8, 16)]) == 2


def test_an_extension_beyond_the_limits_is_refused(recipe_with):
    with pytest.raises(RecipeError, match="the extended corpus has 16000000 records, and the limit is 10000000"):
        recipe_with().extended([{"rigs": 1999997}])
    with pytest.raises(RecipeError, match="the extension: asks for 200000 specimens, and the limit is 100000"):
        recipe_with().extended([{"specimens": 200000}])
