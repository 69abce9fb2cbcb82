"""Laws of corpora of lives: labels, ends that are seen in the signal, replay, resumption, workers."""

import re
import shutil
from dataclasses import replace

import numpy as np
import pytest
from ruamel.yaml import YAML

import gen
from gen.corpus import LIFE, open_corpus
from gen.generation.corpus import generate
from gen.generation.replaying import replay
from gen.generation.undetected import make_records
from gen.physics.trace import spall_positions
from gen.recipe import Recipe
from gen.recipe.finding import shipped_recipes
from gen.scenarios import Scenario, draw_scenarios
from gen.simulation.damage import spall_paths
from gen.support.errors import RecipeError
from tests.recipes import LIVES
from tests.same_corpora import files

PEAK = 150
SHORT = LIVES | {"corpus": LIVES["corpus"] | {"rigs": 1}, "life": LIVES["life"] | {"end": {"peak_m_s2": PEAK}}}


@pytest.fixture(scope="module")
def lives(recipe_with, tmp_path_factory):
    folder = tmp_path_factory.mktemp("lives") / "c"
    generated = generate(recipe_with(SHORT), folder)
    assert generated.failures == ()
    return folder


@pytest.fixture(scope="module")
def records(lives):
    with open_corpus(lives) as corpus:
        return corpus.load()


def bearings(records):
    return [of for _, of in records.groupby("bearing")]


def test_a_corpus_of_lives_has_its_variables_and_is_valid(records, lives):
    assert {variable.name for variable in LIFE} <= set(records.variables)
    assert list(gen.validate_corpus(lives)) == []
    assert records.sizes["record"] < 160


def test_the_bearing_groups_the_snapshots_of_a_life(records):
    assert len(bearings(records)) == 4
    for of in bearings(records):
        assert len(np.unique(of.specimen)) == len(np.unique(of.event)) == len(np.unique(of.split)) == 1
        np.testing.assert_array_equal(of.age, 40 * 3600 * np.arange(of.sizes["record"]))


def test_a_test_ends_at_the_first_snapshot_beyond_its_limit(records):
    failed = 0
    for of in bearings(records):
        centred = of.acceleration - of.acceleration.mean("elapsed_time")
        peaks = np.abs(centred).max(("channel", "elapsed_time")).values
        assert (peaks[:-1] < PEAK).all()
        if peaks[-1] >= PEAK:
            failed += 1
            assert of.event[-1] == 1
            np.testing.assert_allclose(of.rul, of.age[-1] - of.age)
            assert of.rul_revolutions[-1] == 0
        elif of.event[0] == 0:
            assert np.isnan(of.rul).all()
    assert failed


def test_the_first_detection_is_that_of_the_record(records):
    for of in bearings(records):
        seen = of.age.values[of.detectable.values == 1]
        np.testing.assert_array_equal(of.first_detectable_time, seen[0] if len(seen) else np.nan)


def test_what_is_seen_behind_the_end_of_a_test_is_not_known(recipe_with, monkeypatch):
    monkeypatch.setattr(
        "gen.measurement.ends_of_life._is_beyond", lambda record, _: record.scenario.origin.life.age > 0
    )
    for record in filter(None, make_records(recipe_with(SHORT), range(40))):
        first, age = record.scenario.origin.life.first_detectable_time, record.scenario.origin.life.age
        assert age <= 40 * 3600
        assert first is None or first <= 40 * 3600


def test_a_snapshot_in_the_middle_of_a_life_is_made_again(lives, records):
    damaged = np.flatnonzero(records.stage.values > 0)
    again = replay(lives, int(damaged[len(damaged) // 2]))
    assert again.identical
    for variable in LIFE:
        np.testing.assert_array_equal(
            again.dataset[variable.name], records[variable.name][[damaged[len(damaged) // 2]]]
        )


@pytest.mark.usefixtures("started_processes")
def test_two_workers_and_an_interrupted_call_give_the_same_files(lives, recipe_with, tmp_path):
    generate(recipe_with(SHORT), tmp_path / "two", workers=2)
    assert files(tmp_path / "two") == files(lives)
    shutil.copytree(lives, tmp_path / "half")
    (tmp_path / "half" / "parts" / "part-00001.nc").unlink()
    generate(recipe_with(SHORT), tmp_path / "half")
    assert files(tmp_path / "half") == files(lives)


def test_wear_that_no_recipe_of_a_record_can_have_is_refused():
    text = shipped_recipes()["run_to_failure"].read_text(encoding="utf-8")
    recipe = Recipe(YAML(typ="safe").load(re.sub("waviness_nm_per_mrev: .*", "waviness_nm_per_mrev: 100", text)))
    with pytest.raises(
        RecipeError, match=r"^record \d+: specimen\.waviness_nm: .*; lower the wear or the histories of life\.$"
    ):
        draw_scenarios(recipe, 0, recipe.corpus.records_per_specimen)


def test_a_spall_that_grows_lays_bare_more_of_the_same_floor(recipe_with):
    scenario = next(of for of in draw_scenarios(recipe_with(LIVES)) if of.fault == "inner")

    class PointBall(Scenario):
        """A scenario with a ball that reaches every point of the floor."""

        bearing = replace(scenario.bearing, ball_diameter=1e-9)

    def floor_at(places, width):
        grown = {"width_mm": (1e3 * width,), "depth_um": (100.0,)}
        fault = scenario.recipe.faults[0].model_copy(update=grown)
        (path,) = spall_paths(PointBall(scenario.recipe).edited(faults=(fault,)), 0)
        return np.interp(places, spall_positions(width), path)

    places = np.linspace(-4e-4, 4e-4, 100)
    young = floor_at(places, 1e-3)
    assert young.std() > 1e-7
    for width in (2e-3, 5e-3):
        np.testing.assert_allclose(floor_at(places, width), young, atol=3e-8)


def test_whole_lives_in_memory_are_written_with_their_recipe_and_others_without(lives, records, tmp_path):
    whole = gen.write_corpus(records, tmp_path / "whole")
    with gen.open_corpus(whole) as written, gen.open_corpus(lives) as generated:
        assert written.drop_attrs().equals(generated.drop_attrs())
    assert (whole / "recipe.yaml").exists()
    young = gen.write_corpus(records.isel(record=records.age.values < 400 * 3600), tmp_path / "young")
    assert not (young / "recipe.yaml").exists()
    assert replay(young, 12).identical
