"""Laws of growth: a corpus with more records than it had is the one made at once, and no record depends on their number."""

import shutil

import pytest

from gen.corpus import RECIPE_NAME, open_corpus, part_name, read_manifest, validate_corpus
from gen.corpus.manifest import manifest_of_parts, write_manifest
from gen.generation.corpus import generate
from gen.recipe import read_recipe
from gen.support.errors import CorpusError, RecipeError
from raceway import copy
from tests.same_corpora import assert_the_same_corpus

CHANGES = {
    "specimens": {},
    "rigs": {"corpus.split": {"by": "rig", "test": 0.5}},
    "groups": {"corpus.rungs": [0.5, 1], "corpus.records_per_specimen": 1},
}
SHORT_PARTS = {"storage.records_per_part": 4, "corpus.rigs": 2, "corpus.specimens_per_rig": 2}


@pytest.mark.parametrize("name", CHANGES)
def test_a_grown_corpus_is_the_one_made_at_once(write_recipe, tmp_path, name):
    """From a part that is not full and from full ones, up to rigs beyond those of the recipe."""
    recipe = write_recipe(tmp_path / "r.yaml", SHORT_PARTS | CHANGES[name])
    assert read_recipe(recipe).n_records < 12
    for records, kept in ((6, 0), (8, 1), (12, 2)):
        assert generate(recipe, tmp_path / "grown", records=records).kept == kept
    at_once = generate(recipe, tmp_path / "at_once", records=12)
    assert_the_same_corpus(tmp_path / "grown", at_once)


def test_a_corpus_stays_whole_until_the_larger_one_is(write_recipe, tmp_path):
    recipe = write_recipe(tmp_path / "r.yaml", SHORT_PARTS)
    generate(recipe, tmp_path / "c", records=6)
    with open_corpus(tmp_path / "c") as corpus:
        before = corpus.load()

    def interrupted(done, _whole):
        if done > 8:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        generate(recipe, tmp_path / "c", records=12, progress=interrupted)
    parts = {path.name for path in (tmp_path / "c" / "parts").iterdir()}
    assert {"part-00001-2.nc", "part-00001.nc", "part-00002.nc"} <= parts
    assert validate_corpus(tmp_path / "c") == []
    with open_corpus(tmp_path / "c") as same:
        assert same.identical(before)
    assert generate(recipe, tmp_path / "c", records=6).records == 6
    generate(recipe, tmp_path / "c", records=12)
    assert_the_same_corpus(tmp_path / "c", generate(recipe, tmp_path / "at_once", records=12))


def test_parts_of_one_corpus_made_apart_are_completed_or_joined(recipe_file, whole, tmp_path):
    assert generate(recipe_file, tmp_path / "a", parts=range(2, 3)).records == 8
    generate(recipe_file, tmp_path / "b", parts=range(1))
    both = generate(recipe_file, tmp_path / "b", parts=range(1, 2))
    assert (both.records, both.parts, both.kept) == (16, 2, 1)
    copy([tmp_path / "b", tmp_path / "a"], tmp_path / "joined")
    with open_corpus(whole.path) as at_once, open_corpus(tmp_path / "joined") as joined:
        assert joined.drop_attrs().equals(at_once.drop_attrs())
    generate(recipe_file, tmp_path / "b")
    assert_the_same_corpus(tmp_path / "b", whole)


@pytest.mark.parametrize("parts", [range(3, 4), range(0), range(2, 1), range(0, 3, 2), range(-1, 2)])
def test_parts_that_a_corpus_does_not_have_are_refused(recipe_file, tmp_path, parts):
    with pytest.raises(
        RecipeError, match=r"^parts: .* is not allowed; small has the parts 0-2, give a range of them\.$"
    ):
        generate(recipe_file, tmp_path / "c", parts=parts)
    with pytest.raises(CorpusError, match="is one file, which has all parts; give a folder"):
        generate(recipe_file, tmp_path / "c.nc", parts=range(1))


def test_parts_beyond_the_hundred_thousandth_are_in_the_order_of_their_records(copied):
    names = [part_name(number) for number in (99_999, 100_000)]
    for name in names:
        shutil.copy(copied / "parts" / part_name(0), copied / "parts" / name)
    for number in range(3):
        (copied / "parts" / part_name(number)).unlink()
    write_manifest(copied, manifest_of_parts([], {"title": "unfinished"}, complete=False).content)
    assert (copied / RECIPE_NAME).is_file()
    assert [row.name for row in read_manifest(copied).parts] == names
