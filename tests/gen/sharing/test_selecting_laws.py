"""Laws of selections: records and numbers stay as they are, and a killed call leaves no corpus."""

import json

import numpy as np
import pytest

from gen import generate, open_corpus, pack, replay, select, validate_corpus
from gen.corpus import Publication, open_part, publish, read_manifest
from gen.corpus.record_hashes import record_hashes
from gen.errors import CorpusError
from tests import corpora
from tests.kills import killed


@pytest.fixture
def source(tmp_path):
    """Folder of a corpus of nine records in parts of three, four and two."""
    corpora.write_corpus(tmp_path / "source")
    return tmp_path / "source"


@pytest.mark.parametrize("kind", ["counts", "float32"])
def test_selected_records_are_those_of_the_corpus_bit_for_bit(tmp_path, kind):
    corpora.write_corpus(tmp_path / "source", kind=kind)
    made = select(tmp_path / "source", tmp_path / "some", where="fault in ('inner', 'outer', 'cage')")
    assert (made.records, made.of, made.parts) == (5, 9, 2)
    assert validate_corpus(tmp_path / "some") == []
    with open_corpus(tmp_path / "source") as whole, open_corpus(tmp_path / "some") as some:
        assert some["recording"].values.tolist() == [1, 2, 4, 7, 8]
        assert record_hashes(some) == [record_hashes(whole)[number] for number in some["recording"].values]
        for name in ("rig", "specimen", "acceleration"):
            assert np.array_equal(some[name].values, whole[name].values[[1, 2, 4, 7, 8]])


def test_a_selection_of_everything_has_the_same_records_in_parts_of_the_largest_size(source, tmp_path):
    select(source, tmp_path / "all", where="rig >= 0")
    assert [row.records for row in read_manifest(tmp_path / "all").parts] == [4, 4, 1]
    with open_corpus(source) as whole, open_corpus(tmp_path / "all") as found:
        assert record_hashes(found) == record_hashes(whole)


def test_the_same_selection_has_the_same_bytes(source, tmp_path):
    rows = [(select(source, tmp_path / name, split="test"), read_manifest(tmp_path / name))[1] for name in "ab"]
    assert rows[0] == rows[1]


def test_selected_channels_keep_their_samples_and_names(source, tmp_path):
    made = select(source, tmp_path / "b", channels=["b"], split="train")
    assert made.channels == ("b",)
    with open_corpus(source) as whole, open_corpus(tmp_path / "b") as found:
        assert found["channel"].values.tolist() == ["b"]
        assert np.array_equal(found["acceleration"].values, whole["acceleration"].values[[0, 3, 6], 1:])


def test_the_manifest_tells_every_choice_and_keeps_the_publication(source, tmp_path):
    publish(source, Publication(license="CC-BY-4.0"))
    select(source, tmp_path / "one", where="rig < 8", channels=["a"])
    select(tmp_path / "one", tmp_path / "two", split="test")
    manifest = read_manifest(tmp_path / "two")
    assert [(choice.records, str(choice)) for choice in manifest.selections] == [
        (9, "where: rig < 8; channels: a"),
        (8, "split: test"),
    ]
    assert manifest.publication.license == "CC-BY-4.0"
    card = (tmp_path / "two" / "README.md").read_text()
    assert "Selected from 9 records" in card
    assert "Selected from 8 records" in card
    with open_part(tmp_path / "two" / "parts" / "part-00000.nc") as part:  # terms can change, and parts cannot
        assert not {"license", "comment"} & set(part.attrs)


def test_far_apart_records_are_read_and_written_like_near_ones(tmp_path):
    corpora.write_corpus(tmp_path / "source", (1,) * 40)
    select(tmp_path / "source", tmp_path / "ends", where="rig in (0, 39)")
    with open_corpus(tmp_path / "ends") as found:
        assert found["rig"].values.tolist() == [0, 39]
        assert found["bearing"].values.tolist() == ["6205", "6205" + "y" * 39]


@pytest.mark.parametrize(
    ("choice", "sentence"),
    [
        ({}, "no choice is given"),
        ({"where": "rig > 100"}, "none of 9 records is chosen; choose others."),
        ({"where": "shaft_rate > 1e6"}, r"choose others \(shaft_rate is [0-9.]+ to [0-9.]+ Hz\)"),
        ({"channels": ["c"]}, "there is no channel 'c'"),
    ],
)
def test_a_choice_of_nothing_is_refused_and_leaves_nothing(source, tmp_path, choice, sentence):
    with pytest.raises(CorpusError, match=sentence):
        select(source, tmp_path / "out", **choice)
    assert [path.name for path in tmp_path.iterdir()] == ["source"]


def test_an_existing_corpus_is_not_replaced_and_an_altered_one_not_copied(source, tmp_path):
    with pytest.raises(CorpusError, match="exists and is not an empty folder"):
        select(source, source, split="test")
    part = source / "parts" / "part-00001.nc"
    part.write_bytes(part.read_bytes()[:-1] + b"\x01")
    with pytest.raises(CorpusError, match=r"part-00001\.nc: is altered"):
        select(source, tmp_path / "out", split="test")


def test_a_selection_is_not_completed_by_generate(tiny_corpus, tiny_recipe, tmp_path):
    select(tiny_corpus, tmp_path / "some", where="specimen < 3")
    with pytest.raises(CorpusError, match="was selected from a larger corpus, so it cannot be generated"):
        generate(tiny_recipe, tmp_path / "some")
    assert validate_corpus(tmp_path / "some") == []


def test_selected_records_are_replayed(tiny_corpus, tmp_path):
    made = select(tiny_corpus, tmp_path / "some", where="fault != 'healthy' and rig == 1", split="train")
    again = [replay(tmp_path / "some", record) for record in range(0, made.records, 4)]
    assert all(one.identical for one in again)
    with open_part(tmp_path / "some" / "parts" / "part-00000.nc") as part:
        assert part["recording"].values[0] == again[0].dataset["recording"].values[0] > 0


def test_a_packed_file_is_selected_from_and_replayed_like_its_folder(tiny_corpus, tmp_path):
    pack(tiny_corpus, tmp_path / "tiny.nc")
    assert replay(tmp_path / "tiny.nc", 17).identical
    for source, name in ((tiny_corpus, "of_folder"), (tmp_path / "tiny.nc", "of_file")):
        select(source, tmp_path / name, where="specimen in (9, 12)")
    assert replay(tmp_path / "of_file", 3).identical
    one, other = ([row.sha256 for row in read_manifest(tmp_path / name).parts] for name in ("of_folder", "of_file"))
    assert one == other


def test_the_chosen_channels_are_replayed(write_recipe, tmp_path):
    channels = [{"name": name, "body": "sensor"} for name in ("one", "two")]
    changes = {"recording.channels": channels, "corpus.rigs": 1, "corpus.specimens_per_rig": 2}
    generate(write_recipe(tmp_path / "r.yaml", changes), tmp_path / "whole", records=2)
    select(tmp_path / "whole", tmp_path / "two", channels=["two"])
    again = replay(tmp_path / "two", 1)
    assert again.identical
    assert again.dataset["channel"].values.tolist() == ["two"]


def test_a_killed_selection_leaves_the_whole_corpus_or_none(source, tmp_path):
    output, wholes = tmp_path / "out", 0
    for _ in killed(lambda: select(source, output, where="rig != 4"), moments=5):
        if output.exists():
            assert validate_corpus(output) == []
            assert json.loads((output / "manifest.json").read_text())["records"] == 8
            (output / "README.md").stat()
            output.rename(tmp_path / f"whole-{wholes}")
            wholes += 1
    assert wholes >= 1
    select(source, output, where="rig != 4")
    assert not list(tmp_path.glob(".out*"))
