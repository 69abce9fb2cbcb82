"""The tracks that only a simulator has: areas and shares of made-up answers, and the recipes that they are simulated from."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from benchmarks.ablation import changed
from benchmarks.hard_tracks import CORPORA, RECIPE, WORN, answers_kept, open_set
from gen.recipe import Recipe, find_recipe
from gen.support.errors import RecipeError
from gen.support.yaml_files import read_yaml

FAULTS = np.array(["healthy", "inner", "outer", "ball", "cage", WORN])


def corpus(answers=FAULTS, width=1e-3):
    table = xr.Dataset(
        {
            "recording": ("record", np.arange(6)),
            "width": ("record", np.full(6, 1.0) * width),
            "said": ("record", answers),
        }
    )
    return SimpleNamespace(table=table, fault=FAULTS, some=lambda rows: table.isel(record=rows))


def test_an_open_set_is_found_by_low_probabilities_of_all_known_classes():
    for highest, areas in (((0.9, 0.8, 0.9, 0.8, 0.4, 0.7), (1, 1)), ((0.9, 0.5, 0.9, 0.5, 0.4, 0.7), (1, 0.5))):
        model = SimpleNamespace(predict_proba=lambda _, highest=highest: np.array(highest)[:, None] * [1, 0.1])
        assert open_set(model, corpus()) == {"cage": areas[0], WORN: areas[1], "all": np.mean(areas)}


def test_answers_are_kept_where_the_fault_is_the_same():
    model = SimpleNamespace(predict=lambda table: table["said"].values)
    other = FAULTS.copy()
    other[3:] = "healthy"  # one of the three faults of known classes
    assert answers_kept(model, corpus(), corpus(other)) == pytest.approx(2 / 3)
    wider = corpus(other, width=np.where(np.arange(6) == 3, 2e-3, 1e-3))
    assert answers_kept(model, corpus(), wider) == 1


@pytest.mark.parametrize("name", CORPORA)
def test_each_corpus_is_a_change_of_the_recipe(name):
    seed, changes = CORPORA[name]
    recipe = Recipe.model_validate(changed(read_yaml(find_recipe(RECIPE), RecipeError), {"seed": seed, **changes}))
    assert recipe.seed == seed
