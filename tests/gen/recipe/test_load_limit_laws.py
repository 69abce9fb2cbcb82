"""Laws of the load limit: an overloaded record is left out, and a recipe that only draws such records is refused."""

import pytest

from gen.generation.corpus import generate
from gen.generation.plan import plan
from gen.physics.catalogue import CATALOGUE
from gen.physics.rating import LEAST_SAFETY, static_rating
from gen.recipe import read_recipe, shipped_recipes
from gen.scenarios import draw_scenarios
from gen.support.errors import RecipeError

LIMIT = CATALOGUE["6205"].static_rating / LEAST_SAFETY
SEVERAL = {"kind": "catalogue", "designations": ["6205", "6309"]}
GEOMETRY = {
    "kind": "geometry",
    "n_balls": "choice(7, 9)",
    "pitch_diameter_mm": "uniform(30, 39.04)",
    "ball_diameter_mm": f"uniform(0.15, {7.94 / 39.04}) * pitch_diameter_mm",
}
STEPS = {"kind": "steps", "levels_percent": [200, 50], "step_s": 0.01}
RISING = {"kind": "ramp", "from_percent": "uniform(50, 250)", "to_percent": 100}
SLANTED = {"specimen.contact_angle_deg": "uniform(5, 10)", "operation.load_n": 10}


@pytest.mark.parametrize(
    ("changes", "key", "bearing"),
    [
        ({"operation.load_n": 1e7}, "load_n", "6205"),
        ({"operation.load_n": f"uniform({LIMIT + 1}, 1e5)"}, "load_n", "6205"),
        ({"operation.load_n": 64_000, "bearing": SEVERAL}, "load_n", "6309"),
        ({"operation.load_n": 15_900, "bearing": GEOMETRY}, "load_n", "geometry"),
        ({"operation.load_n": 8000, "operation.load_profile": {"kind": "table", "times_s": [0, 1], "percent": [1, 200]}}, "load_n", "6205"),
        ({"operation.load_n": 8000, "operation.load_profile": STEPS}, "load_n", "6205"),
        (SLANTED | {"operation.axial_load_n": 13_000}, "axial_load_n", "6205"),
    ],
)  # fmt: skip
def test_a_recipe_whose_every_load_crushes_every_bearing_is_refused_when_it_is_read(recipe_with, changes, key, bearing):
    with pytest.raises(
        RecipeError, match=rf"operation.{key}: gives .* static rating of bearing {bearing}, is the limit"
    ):
        recipe_with(changes)


@pytest.mark.parametrize(
    "changes",
    [
        {"operation.load_n": f"uniform({LIMIT - 1}, 1e5)"},
        {"operation.load_n": 16_000, "bearing": SEVERAL},
        {"operation.load_n": 15_700, "bearing": GEOMETRY},
        {"operation.load_n": 7000, "operation.load_profile": STEPS},
        {"operation.load_n": LIMIT - 100, "operation.load_profile": RISING},
        SLANTED | {"operation.axial_load_n": 12_500},
    ],
)
def test_a_recipe_some_of_whose_draws_may_be_borne_is_read(recipe_with, changes):
    recipe_with(changes)


def test_a_single_record_beyond_the_limit_is_left_out_and_named(write_recipe, tmp_path):
    """Grids follow the number of the record: one record of four is 100 N too heavy."""
    path = write_recipe(tmp_path / "r.yaml", {"operation.load_n": f"grid(500, {LIMIT + 100}, 500, 500)", "records": 4})
    generated = generate(path, tmp_path / "corpus")
    assert generated.records == 3
    (sentence,) = generated.failures
    assert sentence == (
        "record 1: an equivalent static load of 1.59e+04 N is more than 2 times the static rating of its bearing 6205, 7900 N; "
        "lower operation.load_n and axial_load_n, or take a larger bearing."
    )
    assert plan(path).left_out == 1


@pytest.mark.parametrize("name", shipped_recipes())
def test_no_shipped_recipe_asks_for_a_load_near_the_limit(name):
    """The largest load over static rating is 0.3, of domain_randomised."""
    recipe = read_recipe(name)
    if recipe.life is not None and recipe.life.accelerated:
        return
    drawn = draw_scenarios(recipe, 0, min(recipe.n_records, 500))
    highest = 0.35 if recipe.life is None else 0.6  # bearings tire under higher loads alone
    assert max(scenario.conditions["load"] / static_rating(scenario.drawing) for scenario in drawn) < highest
