"""The benchmark of mechanisms: its variants are recipes that differ, and its table holds their scores."""

import pytest
from ruamel.yaml import YAML

from benchmarks.ablation import changed, plain, read_mechanisms, scores_of, table, variants
from features import feature_table
from gen.recipe import find_recipe, read_recipe
from tests.pulses import write_pulses


def test_every_variant_is_a_recipe_that_differs_from_the_one_that_ships():
    shipped = YAML(typ="safe").load(find_recipe("domain_randomised"))
    for name, changes in variants(read_mechanisms()).items():
        made = changed(shipped, changes)
        assert (made == shipped) == (name == "the recipe"), name
        read_recipe(made)


@pytest.mark.usefixtures("few_trees")
def test_a_recipe_is_scored_on_recordings_and_shown_as_means_over_seeds(tmp_path):
    recipe = YAML(typ="safe").load(find_recipe("quickstart")) | {"records": 28}
    tests = {"pulses": feature_table(write_pulses(tmp_path / "pulses"), groups=("lines", "shape"))}
    figures = plain(scores_of(recipe, 1, tests, 1)["pulses"])
    assert {"balanced accuracy", "by recording", "AUC", "log-loss", "false alarms"} < set(figures)
    lines = list(table({"the recipe": {"pulses": [figures, figures | {"AUC": figures["AUC"] + 0.5}]}}))
    assert lines[0] == "| variant | pulses BA | pulses AUC | pulses log-loss | pulses false alarms |"
    assert f"| {figures['AUC'] + 0.25:.3f} |" in lines[2]
