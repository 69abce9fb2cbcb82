"""Merging of corpora that were extended, and of records whose scenarios were made by hand."""

from dataclasses import replace

import pytest

from gen import merge, replay, write_corpus
from gen.corpus import read_manifest, write_manifest
from gen.errors import CorpusError
from gen.in_memory import simulate_scenarios
from gen.scenarios import draw_scenarios
from tests import tone_corpora


@pytest.mark.parametrize(
    ("one", "other", "refused"),
    [
        ([], [{"rigs": 1}], False),
        ([{"rigs": 1}], [{"rigs": 1}, {"specimens": 2}], False),
        ([{"rigs": 1}], [{"specimens": 1}], True),
        ([{"rigs": 1}, {"specimens": 2}], [{"rigs": 2}], True),
    ],
)
def test_corpora_of_one_recipe_merge_unless_they_were_extended_in_different_ways(tmp_path, one, other, refused):
    """Otherwise two bearings would have one number."""
    folders = [tmp_path / "one", tmp_path / "other"]
    for seed, (folder, extensions) in enumerate(zip(folders, (one, other), strict=True)):
        tone_corpora.write_corpus(folder, specimens=4, parts=1, seed=seed)
        facts = {"recipe_sha256": "0" * 64, "overrides": {"extensions": extensions}}
        write_manifest(folder, read_manifest(folder).parts, complete=True, **facts)
    if refused:
        with pytest.raises(CorpusError, match="was extended in another way than a corpus of the same recipe"):
            merge(folders, tmp_path / "merged")
    else:
        assert merge(folders, tmp_path / "merged").records == 24


def test_records_of_scenarios_made_by_hand_are_replayed_after_a_merge(recipe_with, tmp_path):
    """Their speeds were changed after they were drawn, so the recipe alone does not give them."""
    folders = []
    for seed in (3, 4):
        recipe = recipe_with({"seed": seed, "corpus.rigs": 1, "records": 2})
        drawn = draw_scenarios(recipe)
        faster = [
            replace(one, record=replace(one.record, conditions=one.record.conditions | {"shaft": 30.0}))
            for one in drawn
        ]
        folders.append(write_corpus(simulate_scenarios(faster, recipe), tmp_path / str(seed)))
    merge(folders, tmp_path / "merged")
    assert [origin.scenarios for origin in read_manifest(tmp_path / "merged").origins] == ["given", "given"]
    assert all(replay(tmp_path / "merged", record).identical for record in range(4))
