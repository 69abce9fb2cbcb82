"""Laws of recipes made in Python: keys by their own names, calls for faults and distributions, and the text of a recipe."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import gen
from gen.drawing.section import plain
from gen.recipe import Recipe, corpus_identity, read_recipe, recipe_hash, shipped_recipes
from gen.recipe.keywords import _places
from gen.recipe.life import LifeSection
from gen.support.errors import RecipeError
from tests.conftest import small_with

OUTER = gen.outer(width_mm=0.5)
text = st.text(st.characters(codec="utf-8", exclude_characters="\0"), min_size=1, max_size=30)


def sentences_of(make):
    with pytest.raises(RecipeError) as caught:
        make()
    return str(caught.value)


def test_a_key_by_its_own_name_is_that_of_its_section():
    named = gen.make_recipe(
        OUTER, shaft_rpm=1480, support_frequency_hz=300, viscosity_40_mm2_s=30, validation=0.1, gain=2
    )
    sections = {
        "operation": {"shaft_rpm": 1480},
        "machine": {"support_frequency_hz": 300},
        "contact": {"lubricant": {"viscosity_40_mm2_s": 30}},
        "corpus": {"split": {"validation": 0.1}},
        "level": {"kind": "physical", "gain": 2},
    }
    assert named == gen.make_recipe(OUTER, **sections)


def test_every_name_has_a_section_unless_several_share_it():
    shared = [name for name, places in _places().items() if len(places) > 1]
    assert len(_places()) > 100
    for name in shared:
        message = sentences_of(lambda name=name: gen.make_recipe(**{name: 1}))
        sections = [".".join(place) for place in _places()[name]]
        assert message.startswith(f"{name}: is a key of ")
        assert all(section in message for section in sections)


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"shaft_rmp": 1480}, "shaft_rmp: no such key; did you mean shaft_rpm?"),
        ({"width_mm": 1}, "width_mm: no such key; it is a key of faults; give it there, as in"),
        ({"operation": {"shaft_rpm": 1}, "shaft_rpm": 1}, "shaft_rpm: is given twice, also in operation; give it"),
        ({"operation": 3, "load_n": 3}, "load_n: operation is given and is no section; give one of the two."),
        ({"faults": []}, "faults: is given twice, also as fault; give it once."),
        ({"n": 0}, "n: 0 is not allowed; it must be a whole number of records, 1 or more."),
        ({"n": 7, "rigs": 2}, "n: 7 records of each of 1 faults take 7 specimens, which cannot be divided by rigs"),
        ({"n": 6, "rigs": 2, "specimens_per_rig": 6}, "n: 6 records of each of 1 faults take 6 specimens, and rigs"),
        ({"n": 7, "records_per_specimen": 2}, "are no whole number of specimens of 2 records; use a multiple of 2."),
    ],
)
def test_a_wrong_key_is_one_sentence_that_says_what_to_do(keys, sentence):
    assert sentence in sentences_of(lambda: gen.make_recipe(OUTER, **keys))


@given(st.integers(1, 12), st.integers(1, 3), st.integers(1, 4), st.integers(1, 3), st.sampled_from([None, [0, 1]]))
def test_each_fault_has_n_records_or_the_error_is_about_n(n, n_faults, rigs, per_specimen, rungs):
    faults = [gen.outer(width_mm=0.1 * (place + 1)) for place in range(n_faults)]
    keys = {"rigs": rigs, "records_per_specimen": per_specimen, "rungs": rungs}
    of_a_specimen = per_specimen * len(rungs or [1])
    if n % of_a_specimen or n * n_faults // of_a_specimen % rigs:
        assert sentences_of(lambda: gen.make_recipe(faults, n, **keys)).startswith("n: ")
        return
    recipe = gen.make_recipe(faults, n, **keys)
    entries = [scenario.origin.entry for scenario in gen.draw_scenarios(recipe)]
    assert [entries.count(place) for place in range(n_faults)] == [n] * n_faults
    assert recipe.corpus.rigs == rigs


def test_faults_in_turn_have_no_weights():
    heavy = gen.outer(width_mm=1, weight=2)
    assert "faults[0].weight: has no effect with corpus.fault_choice: in_turn" in sentences_of(
        lambda: gen.make_recipe(heavy)
    )
    assert gen.make_recipe(heavy, fault_choice="by_weight").faults[0].weight == 2


def test_a_fault_in_turn_that_is_drawn_again_keeps_its_entry():
    recipe = gen.make_recipe([gen.outer(width_mm=gen.uniform(0.1 + n, 0.5 + n)) for n in range(3)], n=4)
    first, again = gen.draw_scenarios(recipe), gen.draw_scenarios(recipe, fault_tries=dict.fromkeys(range(12), 1))
    assert (
        [scenario.origin.entry for scenario in first] == [scenario.origin.entry for scenario in again] == [0, 1, 2] * 4
    )
    assert all(a.spalls[0].width != b.spalls[0].width for a, b in zip(first, again, strict=True))


def test_numbers_and_arrays_of_numpy_are_taken_as_numbers():
    recipe = gen.make_recipe(
        gen.outer(width_mm=np.float32(0.5)), shaft_rpm=gen.grid(np.array([1000, 1200])), seed=np.int64(3)
    )
    assert recipe == gen.make_recipe(gen.outer(width_mm=0.5), shaft_rpm=gen.grid([1000, 1200]), seed=3)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (gen.outer, "outer fault: width_mm: is missing; give it."),
        (lambda: gen.ball(width_mm=0), "ball fault: width_mm: 0 is not in [0.001, 60]; for a bearing without a fault"),
        (
            lambda: gen.compound(gen.cage(), {"kind": "inner", "width_mm": 1, "depth": 1}),
            "compound fault: parts[1].depth: no such key; did you mean depth_um?",
        ),
    ],
)
def test_a_wrong_fault_is_one_sentence_at_its_call(make, sentence):
    assert sentences_of(make).startswith(sentence)


@pytest.mark.parametrize("name", [*shipped_recipes()])
def test_a_recipe_survives_its_text_and_its_dict(name, tmp_path):
    recipe = read_recipe(name)
    gen.write_recipe(recipe, tmp_path / "r.yaml")
    as_json = json.loads(json.dumps(plain(recipe)))
    for same in (read_recipe(tmp_path / "r.yaml"), Recipe(**as_json), read_recipe(as_json)):
        assert same == recipe
        assert recipe_hash(same) == recipe_hash(recipe)


class Larger(Recipe):
    """A recipe with a section that others do not have."""

    further: LifeSection | None = None


def test_a_section_that_a_recipe_leaves_out_changes_neither_its_hash_nor_the_identity_of_its_machines():
    recipe, larger = Recipe(small_with({})), Larger(small_with({}))
    assert recipe_hash(larger) == recipe_hash(recipe)
    assert corpus_identity(larger) == corpus_identity(recipe)


def test_a_recipe_from_a_dict_has_the_errors_of_the_file(tmp_path):
    data = plain(read_recipe("quickstart")) | {"sed": 3, "bearing": {"kind": "catalog"}}
    path = tmp_path / "r.yaml"
    path.write_text(json.dumps(data), encoding="utf-8")
    expected = sentences_of(lambda: Recipe(**data))
    assert sentences_of(lambda: read_recipe(data)) == sentences_of(lambda: Recipe.model_validate(data)) == expected
    assert sentences_of(lambda: read_recipe(path)) == "\n".join(f"{path}: {line}" for line in expected.split("\n"))
    assert "sed: no such key; did you mean seed?" in expected
