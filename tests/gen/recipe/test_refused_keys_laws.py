"""Every key of a recipe, from the list of keys: misspelt, missing, of another type or out of its range, it gets one sentence."""

import re

import pytest

from gen.recipe import Recipe
from gen.recipe.keys import fields_below, recipe_keys
from gen.scenarios import draw_scenarios
from gen.support.errors import RecipeError
from tests.cases import for_each
from tests.conftest import small_with

KEYS = {key.key: key for key in recipe_keys() if not key.key.startswith("distribution.")}
LEAVES = [key for key in KEYS.values() if not key.key.endswith("kind")]
RANGE = re.compile(r"(?P<low_end>[\[(])(?P<low>[^,]+), (?P<high>[^\])]+)(?P<high_end>[\])])")
QUANTITY = "is neither a number nor a distribution"
EACH = {
    ".".join([*path, key]).replace("[]", "")
    for path, section, key in fields_below((Recipe,))
    if "each" in (section.model_fields[key].json_schema_extra or {})
}
"""Keys that can be lists, with a number for each item that their section counts."""
named = for_each(LEAVES, lambda key: "-".join([key.key, *key.kinds]))


def written(key, value):
    """Sections of a recipe with this key alone, and its place in the words of an error."""
    names, sections, place = key.key.split("."), value, ""
    for depth in range(len(names), 0, -1):
        above = ".".join(names[:depth])
        name = "mine" if names[depth - 1] == "NAME" else names[depth - 1]
        allowed = KEYS[above].allowed if above in KEYS and depth < len(names) else ""
        if "section: " in allowed or "sections: " in allowed:
            below = KEYS[".".join(names[: depth + 1])].kinds
            sections = {"kind": (below or (allowed.partition(": ")[2].partition(",")[0],))[0], **sections}
        if allowed.startswith("list of sections"):
            sections, name_there = [sections], f"{name}[0]"
        else:
            name_there = name
        place = f"{name_there}.{place}" if place else name_there
        sections = {name: sections}
    return sections, place


def sentences_about(key, value):
    """Sentences on the place of a key, without the place."""
    sections, place = written(key, value)
    with pytest.raises(RecipeError) as caught:
        Recipe(sections)
    lines = str(caught.value).split("\n")
    assert all(line.endswith((".", "?")) for line in lines)
    return [line.removeprefix(place) for line in lines if re.match(rf"{re.escape(place)}(\.\w+|\[\d+\])*: ", line)]


def beside(allowed):
    """Numbers just out of a range."""
    ends = RANGE.search(allowed)
    if ends is None:
        least = re.search(r"(>=?) (\d+)", allowed)
        return [int(least[2]) - (least[1] == ">=")] if least else []
    low, high = float(ends["low"]), float(ends["high"])
    step = 1 if "whole" in allowed else max(abs(low), 1) / 100
    above = high if ends["high_end"] == ")" else high + max(abs(high) / 100, step)
    return [low if ends["low_end"] == "(" else low - step, int(above) if "whole" in allowed else above]


def wrong_values(key):
    """Values that a key does not take, each with a part of the sentence."""
    allowed = key.allowed
    if allowed.startswith("list"):
        return [({"odd": 1}, "a list")]
    if "section" in allowed:
        return [(3, ""), ([3], "")]
    if allowed.startswith(("number", "whole number")):
        outside = [(value, "it must be ") for value in beside(allowed)]
        halves = [(2.5, "it must be a whole number")] if "whole" in allowed else []
        return [("wide", "it must be a "), ([1], "it must be a "), (float("nan"), "it must be "), *halves, *outside]
    if RANGE.fullmatch(allowed):
        outside = [(value, f"is not in {allowed}") for value in beside(allowed)]
        listed = (
            []
            if key.key in EACH
            else [([1, 2], "is a list; give one number, or a distribution such as uniform(1, 2).")]
        )
        return [("wide", QUANTITY), *listed, (True, QUANTITY), (float("nan"), "finite"), *outside]
    return [({"odd": 1}, ""), ([], "")]


@named
def test_a_misspelt_key_is_told_with_the_right_one_or_with_those_that_are_allowed(key):
    right = key.key.rpartition(".")[2]
    misspelt = key._replace(key=f"{key.key}x")
    KEYS[misspelt.key] = misspelt
    try:
        (said,) = sentences_about(misspelt, 1)
    finally:
        del KEYS[misspelt.key]
    assert said.startswith(": no such key; ")
    assert right in said


@named
def test_a_value_of_another_type_or_out_of_the_range_is_told_with_what_is_allowed(key):
    for value, part in wrong_values(key):
        said = sentences_about(key, value)
        assert said, f"{key.key} takes {value!r}"
        assert any(part in sentence for sentence in said), (value, said)


@for_each(
    [key for key in LEAVES if key.default == "required" and "." in key.key], lambda key: "-".join([key.key, *key.kinds])
)
def test_a_missing_key_is_told(key):
    section, place = written(key, None)
    inner = section
    for name in key.key.split(".")[:-1]:
        inner = inner["mine" if name == "NAME" else name]
        inner = inner[0] if isinstance(inner, list) else inner
    del inner[key.key.rpartition(".")[2]]
    with pytest.raises(RecipeError) as caught:
        Recipe(section)
    assert f"{place}: is missing; give it." in str(caught.value).split("\n")


def test_a_list_has_as_many_numbers_as_its_section_counts():
    modes = {"count": 3, "frequency_hz": [500, 900], "damping_percent": 3}
    with pytest.raises(RecipeError, match=r"frequency_hz: is a list of 2 numbers, so count must say 2 too"):
        Recipe(small_with({"path.modes": modes}))
    for scenario in draw_scenarios(Recipe(small_with({"path.modes": modes | {"count": 2}}))):
        assert scenario.recipe.path.modes.frequency_hz == (500, 900)
