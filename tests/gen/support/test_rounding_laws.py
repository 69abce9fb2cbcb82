"""A printed limit is allowed: rounded up where it is the least, rounded down where it is the most."""

import math
import re

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from gen.recipe import find_recipe, read_recipe
from gen.support.errors import RecipeError
from gen.support.rounding import rounded_down, rounded_up
from gen.support.yaml_files import read_yaml

QUICKSTART = read_yaml(find_recipe("quickstart"), RecipeError)


@given(st.floats(-1e15, 1e15), st.integers(1, 9))
@example(0.1, 4)
@example(2.3, 4)
def test_a_printed_limit_is_on_the_allowed_side_and_within_one_digit(limit, digits):
    least, most = float(rounded_up(limit, digits)), float(rounded_down(limit, digits))
    assert most <= limit <= least
    assert least - most <= 1.01 * abs(limit) * 10 ** (1 - digits) + 1e-300
    if most == limit or least == limit:
        assert most == least
    if float(f"{limit:.{digits}g}") == limit:  # a number of few digits is its own limit
        assert most == least == limit


def limit_in(pattern, recipe):
    """Number that the error of a recipe names as its limit."""
    with pytest.raises(RecipeError) as error:
        read_recipe(recipe)
    return float(re.search(pattern, str(error.value))[1])


@pytest.mark.parametrize("rungs", range(3, 12))
def test_the_weight_that_rungs_ask_for_is_accepted(rungs):
    corpus = {**QUICKSTART["corpus"], "rungs": [place / (rungs - 1) for place in range(rungs)]}
    faulty = {"kind": "outer", "width_mm": 1, "weight": 2}
    recipe = {**QUICKSTART, "corpus": corpus, "faults": [{"kind": "healthy", "weight": 0.01}, faulty]}
    least = limit_in(r"a weight of (\S+) or more", recipe)
    read_recipe({**recipe, "faults": [{"kind": "healthy", "weight": least}, faulty]})


@pytest.mark.parametrize("n_balls", range(8, 20))
def test_the_diameter_that_balls_have_room_for_is_accepted(n_balls):
    bearing = {"n_balls": n_balls, "pitch_diameter_mm": 37.7, "ball_diameter_mm": 16.9}
    recipe = {**QUICKSTART, "bearing": bearing, "recording": {**QUICKSTART["recording"], "duration_s": 0.1}}
    most = limit_in(r"keep ball_diameter_mm below (\S+)\.$", recipe)
    assert math.isclose(most, min(0.45 * 37.7, 0.95 * math.pi * 37.7 / n_balls), rel_tol=1e-3)
    read_recipe({**recipe, "bearing": {**bearing, "ball_diameter_mm": most}})
