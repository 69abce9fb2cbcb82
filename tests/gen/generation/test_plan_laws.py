"""Laws of a plan: it counts a small corpus exactly, and estimates a large one from parts spread over it."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.generation.plan import BYTES_PER_FILE, MOST_CHECKED, MOST_DRAWN, plan, some_ranges
from gen.generation.plan import _bytes as plan_bytes
from gen.scenarios import draw_scenarios


@given(per_part=st.integers(1, 20_000), rigs=st.integers(1, 5000))
def test_the_parts_a_plan_looks_at_are_in_the_corpus_and_do_not_overlap(recipe_with, per_part, rigs):
    recipe = recipe_with({"storage.records_per_part": per_part, "corpus.rigs": rigs})
    ranges = some_ranges(recipe)
    assert all(0 <= first < stop <= recipe.n_records for first, stop in ranges)
    assert all(stop <= following for (_, stop), (following, _) in pairwise(ranges))
    drawn = sum(stop - first for first, stop in ranges)
    assert drawn == recipe.n_records or 0 < drawn <= MOST_DRAWN


def test_a_large_corpus_is_counted_from_a_part_of_it(write_recipe, tmp_path):
    path = write_recipe(tmp_path / "large.yaml", {"corpus.rigs": 2500, "storage.records_per_part": 250})
    planned = plan(path)
    assert (planned.records, planned.rigs, planned.specimens, planned.drawn) == (20_000, 2500, 10_000, MOST_DRAWN)
    assert sum(planned.splits.values()) == pytest.approx(20_000, abs=3)
    assert planned.classes == pytest.approx(dict.fromkeys(("healthy", "inner", "outer", "ball"), 5000), rel=0.05)


def test_a_plan_checks_some_of_its_records_and_says_so(write_recipe, tmp_path):
    planned = plan(write_recipe(tmp_path / "r.yaml", {"corpus.rigs": 300, "operation.load_n": "grid(20000, 500)"}))
    assert (planned.records, planned.drawn) == (2400, 2000)
    assert planned.checked <= MOST_CHECKED
    assert planned.left_out + sum(planned.steps_per_sample.values()) == pytest.approx(2400, abs=2)
    assert planned.left_out > 0


@pytest.mark.parametrize("per_part", [1, 5, 24])
def test_the_size_of_a_plan_has_one_overhead_for_each_part_and_one_for_the_index(recipe_with, per_part):
    recipe = recipe_with({"storage.records_per_part": per_part})
    lean, some = recipe_with({"storage.records_per_part": 1000}), draw_scenarios(recipe)
    assert plan_bytes(recipe, 24, some) - plan_bytes(lean, 24, some) == (recipe.n_parts - 1) * BYTES_PER_FILE
    assert plan_bytes(lean, 24, some) > 2 * BYTES_PER_FILE


def test_splits_by_rig_of_a_large_corpus_are_those_that_it_will_have(recipe_with):
    recipe = recipe_with({"corpus.rigs": 500, "corpus.split": {"by": "rig", "test": 0.2}})
    planned = plan(recipe)
    assert planned.drawn < planned.records
    assert planned.splits == {"train": 3200, "test": 800}
