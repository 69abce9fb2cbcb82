"""Shipped recipes, which need kernels for each number of balls."""

import pytest

from gen import generate, open_corpus
from gen.corpus import clipped_records
from gen.recipe import read_recipe, shipped_recipes
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import simulate
from tests.gen.measurement.test_record_rms_laws import check
from tests.responses import accelerations_of


def test_the_records_for_training_have_the_drawn_rms():
    scenarios = draw_scenarios(read_recipe("domain_randomised"), 0, 24)
    check(accelerations_of(simulate(scenarios)), scenarios)


@pytest.mark.parametrize("name", sorted(shipped_recipes().keys() - {"dirty_sensors"}))
def test_no_sample_of_a_shipped_recipe_is_clipped(tmp_path, name):
    """All but the recipe with faults of the sensors: a peak at the full scale would tell that a bearing is damaged."""
    with open_corpus(generate(name, tmp_path / "corpus").path) as corpus:
        assert clipped_records(corpus) == {}
