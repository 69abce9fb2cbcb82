"""Laws of generation: a corpus is the same for any number of workers."""

import json

import pytest
from distributed import LocalCluster

from gen.corpus import open_corpus, read_manifest, recipe_text, validate_corpus
from gen.generation.corpus import generate
from gen.support.errors import CorpusError
from raceway.sharing.card.card_page import data_card
from tests.same_corpora import assert_the_same_corpus


def test_one_call_makes_a_complete_and_valid_corpus(whole):
    assert (whole.records, whole.parts, whole.kept, whole.failures) == (24, 3, 0, ())
    assert validate_corpus(whole.path) == []
    manifest = read_manifest(whole.path)
    assert manifest.complete
    assert manifest.recipe == "small"
    assert [row.records for row in manifest.parts] == [8, 8, 8]
    assert "A small corpus for tests" in data_card(whole.path)
    leftovers = [path.name for path in whole.path.rglob(".*")]
    assert leftovers == []


def test_one_call_makes_one_file_with_the_same_records(single, whole):
    assert (single.path.name, single.records, single.parts, single.kept, single.failures) == ("corpus.nc", 24, 3, 0, ())
    assert [path.name for path in single.path.parent.iterdir()] == ["corpus.nc"]
    assert validate_corpus(single.path) == []
    facts = read_manifest(whole.path).model_copy(update={"parts": ()})
    assert read_manifest(single.path) == facts
    assert recipe_text(single.path) == recipe_text(whole.path)
    with open_corpus(single.path) as file, open_corpus(whole.path) as folder:
        assert file.identical(folder)


@pytest.mark.usefixtures("started_processes")
def test_processes_make_the_same_corpus_as_one(recipe_file, whole, tmp_path):
    done = []
    generate(recipe_file, tmp_path / "c", workers=2, progress=lambda *counts: done.append(counts))
    assert_the_same_corpus(tmp_path / "c", whole)
    assert done == [(8, 24), (16, 24), (24, 24)]


def test_workers_of_a_given_scheduler_make_the_same_corpus(recipe_file, whole, tmp_path):
    done = []

    def note(count, total):
        done.append((count, total))
        assert len(list((tmp_path / "given" / "parts").glob("part-*.nc"))) * 8 >= count

    with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=":0") as cluster:
        generate(recipe_file, tmp_path / "given", scheduler=cluster.scheduler_address, progress=note)
    assert_the_same_corpus(tmp_path / "given", whole)
    assert done == [(8, 24), (16, 24), (24, 24)]


def test_a_folder_with_somebody_elses_manifest_is_left_alone(tmp_path):
    (tmp_path / "manifest.json").write_text(json.dumps({"name": "an app"}))
    (tmp_path / "README.md").write_text("mine")
    with pytest.raises(CorpusError, match=r"manifest\.json"):
        generate("quickstart", tmp_path, records=8)
    assert (tmp_path / "README.md").read_text() == "mine"
