"""The schema for editors accepts what Raceway accepts, and refuses what one key shows to be wrong."""

import copy
import json
import re

import pytest

from gen.recipe import Recipe, find_recipe, read_recipe, recipe_schema, shipped_recipes
from gen.support.errors import RecipeError
from gen.support.yaml_files import parse_yaml, read_yaml
from tests.paths import ROOT

jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is in the extra test")
SCHEMA = jsonschema.Draft202012Validator(json.loads(recipe_schema()))
FIRST = read_yaml(find_recipe("quickstart"), RecipeError)
ANGULAR = {"specimen": {"contact_angle_deg": 15}}


def refused(recipe):
    """Whether Raceway refuses a recipe."""
    try:
        read_recipe(recipe)
    except RecipeError:
        return True
    return False


def page_recipes():
    """YAML blocks of all pages, fenced or indented, that are recipes or parts of one, in place of the same keys of a recipe."""
    for page in sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("recipes/*.md")]):
        text = page.read_text(encoding="utf-8")
        fenced = re.findall(r"```[^\n]*\n(?:%%writefile[^\n]*\n)?(.*?)```", text, re.DOTALL)
        for place, block in enumerate([*fenced, *re.findall(r"\n\n((?: {4}.*\n+)+)", text)]):
            try:
                keys = parse_yaml(block, page, RecipeError)
            except RecipeError:  # another language
                continue
            if isinstance(keys, dict) and keys and keys.keys() <= Recipe.model_fields.keys():
                # a page may show some keys of an operation alone, such as an axial load, which needs a contact angle
                operation = {"operation": FIRST["operation"] | keys.get("operation", {})}
                yield pytest.param(FIRST | ANGULAR | keys | operation, id=f"{page.relative_to(ROOT)}-{place}")


PAGES = list(page_recipes())
SHIPPED = [pytest.param(read_yaml(find_recipe(name), RecipeError), id=name) for name in shipped_recipes()]
SHORT_FORMS = [
    {"bearing": 6205},
    {"bearing": ["6205", 6206]},
    {"bearing": {"kind": "catalogue", "designations": "6205-2RS/C3"}},
    {"bearing": {"n_rollers": 14, "pitch_diameter_mm": 39, "roller_diameter_mm": 7.5, "roller_length_mm": 9}},
    {"operation": {"shaft_rpm": "1500", "load_n": " uniform( 1,2 )*static_rating_n"}},
    {"faults": {"defaults": {"width_mm": 1}, "entries": [{"kind": "inner"}, {"kind": "healthy"}]}},
]


@pytest.mark.parametrize("recipe", [*SHIPPED, *PAGES, *(FIRST | form for form in SHORT_FORMS)])
def test_the_schema_accepts_what_raceway_accepts(recipe):
    assert not refused(recipe)
    assert [error.message for error in SCHEMA.iter_errors(recipe)] == []


def test_whole_recipes_of_the_pages_and_parts_of_them_are_checked():
    assert {"docs/python.md", "docs/labels.md", "recipes/README.md"} <= {case.id.rpartition("-")[0] for case in PAGES}


@pytest.mark.parametrize(
    "keys",
    [
        {"tite": "x"},
        {"seed": "one"},
        {"bearing": {}},
        {"bearing": []},
        {"bearing": {"kind": "own"}},
        {"bearing": {"n_balls": 8, "pitch_diameter_mm": 39}},
        {"bearing": {"n_balls": 3, "pitch_diameter_mm": 39, "ball_diameter_mm": 8}},
        {"bearing": {"n_rollers": 14, "pitch_diameter_mm": 39, "roller_diameter_mm": 7.5}},
        {
            "bearing": {
                "n_balls": 14,
                "n_rollers": 14,
                "pitch_diameter_mm": 39,
                "ball_diameter_mm": 7,
                "roller_length_mm": 9,
            }
        },
        {"operation": {"shaft_rpm": [1400, 1500]}},
        {"operation": {"shaft_rpm": 0}},
        {"operation": {"shaft_rpm": "1400 to 1500"}},
        {"faults": []},
        {"faults": [{"kind": "inner"}]},
        {"faults": [{"kind": "rust"}]},
        {"faults": {"defaults": {"width_mm": 1}}},
        {"faults": {"defaults": {"width_mm": 1}, "entries": [{"kind": "inner", "widht_mm": 1}]}},
        {"faults": {"defaults": {"width_mm": 1}, "entries": [{"kind": "inner", "depth_um": -1}]}},
        {"faults": {"defaults": {"width_mm": 1}, "entries": [{"kind": "inner"}, {"kind": "compound"}]}},
    ],
    ids=str,
)
def test_schema_and_raceway_refuse_the_same_wrong_keys(keys):
    assert refused(FIRST | keys)
    assert not SCHEMA.is_valid(FIRST | keys)


GEOMETRY = {"n_balls": 9, "pitch_diameter_mm": 39, "ball_diameter_mm": 7.9}


@pytest.mark.parametrize(
    ("keys", "path", "sentence"),
    [
        ({"faults": [{"kind": "innr", "width_mm": 1}]}, "faults[0].kind", r"'innr' is not one of \['ball', 'cage'"),
        ({"faults": [{"kind": "inner", "width_mm": 1, "widht_mm": 1}]}, "faults[0]", "'widht_mm' was unexpected"),
        ({"faults": [{"kind": "inner", "width_mm": 0.0005}]}, "faults[0].width_mm", "0.0005 is less than the minimum of 0.001"),
        ({"bearing": GEOMETRY | {"ball_diameter_in": 1}}, "bearing", "'ball_diameter_in' was unexpected"),
        ({"bearing": GEOMETRY | {"ball_diameter_mm": 0.0079}}, "bearing.ball_diameter_mm", "0.0079 is less than"),
        ({"bearing": GEOMETRY | {"n_balls": 11.5}}, "bearing.n_balls", "11.5 is not of type 'integer'"),
        ({"machine": {"resonator": {"mas_kg": 1}}}, "machine.resonator", "'mas_kg' was unexpected"),
    ],
)  # fmt: skip
def test_the_key_that_is_wrong_is_named(keys, path, sentence):
    assert refused(FIRST | keys)
    error = jsonschema.exceptions.best_match(SCHEMA.iter_errors(FIRST | keys))
    assert error.json_path == f"$.{path}"
    assert re.search(sentence, error.message), error.message


def places(value, path=()):
    """Path of each value of a recipe that holds no other values."""
    below = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    inner = [place for key, item in below for place in places(item, (*path, key))]
    return inner or [path]


def replaced(recipe, path, value):
    """Copy of a recipe with another value in one place."""
    changed = copy.deepcopy(recipe)
    section = changed
    for key in path[:-1]:
        section = section[key]
    section[path[-1]] = value
    return changed


@pytest.mark.parametrize("recipe", SHIPPED)
def test_raceway_refuses_what_the_schema_refuses(recipe):
    values = [0, 1, 1.5, -1e9, 1e15, "6205", "uniform(1, 2)", "2 * load_n", [1, 2], {}, None, True]
    for number, path in enumerate(places(recipe)):
        changed = replaced(recipe, path, value := values[number % len(values)])
        assert SCHEMA.is_valid(changed) or refused(changed), (path, value)
