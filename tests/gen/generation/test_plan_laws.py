"""Laws of a plan: it counts a small corpus exactly, and estimates a large one from parts spread over it."""

from collections import Counter
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.generation.corpus import generate
from gen.generation.plan import MOST_CHECKED, MOST_DRAWN, plan, some_ranges
from gen.recipe import read_recipe
from gen.scenarios import draw_scenarios


@given(per_part=st.integers(1, 20_000), rigs=st.integers(1, 5000))
def test_the_parts_a_plan_looks_at_are_in_the_corpus_and_do_not_overlap(recipe_with, per_part, rigs):
    recipe = recipe_with({"storage.records_per_part": per_part, "corpus.rigs": rigs})
    ranges = some_ranges(recipe)
    assert all(0 <= first < stop <= recipe.n_records for first, stop in ranges)
    assert all(stop <= following for (_, stop), (following, _) in pairwise(ranges))
    drawn = sum(stop - first for first, stop in ranges)
    assert drawn == recipe.n_records or 0 < drawn <= MOST_DRAWN


def test_all_lives_are_looked_at():
    recipe = read_recipe("run_to_failure")
    assert sum(stop - first for first, stop in some_ranges(recipe)) == recipe.n_records > MOST_DRAWN


def test_a_large_corpus_is_counted_from_a_part_of_it(write_recipe, tmp_path):
    path = write_recipe(tmp_path / "large.yaml", {"corpus.rigs": 2500, "storage.records_per_part": 250})
    planned = plan(path)
    assert (planned.records, planned.rigs, planned.specimens, planned.drawn) == (20_000, 2500, 10_000, MOST_DRAWN)
    assert sum(planned.splits.values()) == pytest.approx(20_000, abs=3)
    assert planned.classes == pytest.approx(dict.fromkeys(("healthy", "inner", "outer", "ball"), 5000), abs=2)


def test_rungs_of_a_large_corpus_are_counted_as_they_are_drawn(recipe_with):
    ladder = recipe_with({"corpus.rungs": [0, 0.3, 0.6, 1], "storage.records_per_part": 24, "corpus.rigs": 80})
    drawn = Counter(scenario.fault for scenario in draw_scenarios(ladder))
    planned = plan(ladder)
    assert planned.drawn < planned.records == drawn.total()
    assert planned.classes == drawn


def test_a_plan_checks_some_of_its_records_and_says_so(write_recipe, tmp_path):
    planned = plan(write_recipe(tmp_path / "r.yaml", {"corpus.rigs": 300, "operation.load_n": "grid(20000, 500)"}))
    assert (planned.records, planned.drawn) == (2400, 2000)
    assert planned.checked <= MOST_CHECKED
    assert planned.left_out + sum(planned.steps_per_sample.values()) == pytest.approx(2400, abs=2)
    assert planned.left_out > 0


@pytest.mark.parametrize("converter", [{"kind": "adc", "full_scale_m_s2": 20}, {"kind": "adc"}, {"kind": "float32"}])
@pytest.mark.parametrize("storage", [{"records_per_part": 9}, {"codec": "zstd"}, {"codec": "none"}])
def test_a_plan_tells_the_size_of_the_corpus(recipe_with, tmp_path, converter, storage):
    recipe = recipe_with({"recording.converter": converter, "storage": storage, "corpus.rigs": 6})
    made = generate(recipe, tmp_path / "corpus").path
    size = sum(file.stat().st_size for file in made.rglob("*") if file.is_file())
    assert plan(recipe).bytes == pytest.approx(size, rel=0.1)


def test_a_plan_that_makes_no_records_tells_at_most_too_much(recipe_with, monkeypatch):
    sizes = [plan(recipe_with({})).bytes]
    monkeypatch.setattr("gen.generation.trial.is_compiled", lambda: False)
    assert plan(recipe_with({})).bytes > sizes[0]


def test_a_plan_tells_faults_that_cannot_be_seen_and_spalls_under_two_balls(recipe_with):
    faults = [{"kind": "inner", "width_mm": 0.001}, {"kind": "outer", "width_mm": 20, "profile": "half_sine"}]
    planned = plan(recipe_with({"faults": faults}))
    assert planned.seen["inner"][0] == 0 < planned.seen["inner"][1]
    assert planned.seen["outer"][0] == planned.seen["outer"][1] > 0
    assert planned.wide_spalls == planned.classes["outer"]
    assert planned.first_wide_spall.endswith("20 mm on the outer race, where neighbouring balls are 16.4 mm apart.")
    redrawn = {"faults": [{"kind": "healthy"}, faults[0]], "truth.undetected": "redraw"}
    assert "faults of class inner can be seen" in plan(recipe_with(redrawn)).left_out_example


def test_splits_by_rig_of_a_large_corpus_are_those_that_it_will_have(recipe_with):
    recipe = recipe_with({"corpus.rigs": 500, "corpus.split": {"by": "rig", "test": 0.2}})
    planned = plan(recipe)
    assert planned.drawn < planned.records
    assert planned.splits == {"train": 3200, "test": 800}


def test_a_plan_tells_that_a_converter_is_too_small(recipe_with):
    level = {"kind": "physical", "background_m_s2": 1}
    planned = [
        plan(recipe_with({"level": level, "recording.converter": {"kind": "adc", "full_scale_m_s2": scale}}))
        for scale in (1, 1e5)
    ]
    assert planned[0].clipping.endswith("records are clipped at least once; raise recording.converter.full_scale_m_s2.")
    assert planned[1].clipping is None
