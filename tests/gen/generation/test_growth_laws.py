"""Laws of growth: a corpus of many parts is like one of few."""

import shutil

import pytest

from gen.corpus import RECIPE_NAME, part_name, read_manifest, recipe_text
from gen.corpus.index import corpus_attributes, write_index
from gen.corpus.manifest import facts_of_parts, write_manifest
from tests.corpora import write_corpus


@pytest.mark.parametrize("held", [1, 10**9])
def test_the_index_has_the_same_bytes_however_many_parts_are_copied_together(tmp_path, monkeypatch, held):
    write_corpus(tmp_path / "c", [3, 1, 4, 1, 5])
    manifest, before = read_manifest(tmp_path / "c"), (tmp_path / "c" / "index.nc").read_bytes()
    facts = manifest.model_dump(mode="json", by_alias=True, exclude_unset=True) | {"publication": manifest.publication}
    attributes = corpus_attributes(facts_of_parts(manifest.parts, facts), recipe_text(tmp_path / "c"), tmp_path)
    monkeypatch.setattr("gen.corpus.index._COPIED_BYTES", held)
    write_index(tmp_path / "c", manifest.parts, attributes)
    assert (tmp_path / "c" / "index.nc").read_bytes() == before


def test_parts_beyond_the_hundred_thousandth_are_in_the_order_of_their_records(copied):
    names = [part_name(number) for number in (99_999, 100_000)]
    for name in names:
        shutil.copy(copied / "parts" / part_name(0), copied / "parts" / name)
    for number in range(3):
        (copied / "parts" / part_name(number)).unlink()
    write_manifest(copied, facts_of_parts([], {"title": "unfinished"}, complete=False))
    assert (copied / RECIPE_NAME).is_file()
    assert [row.name for row in read_manifest(copied).parts] == names
