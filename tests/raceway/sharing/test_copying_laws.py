"""Laws of copies: records stay as they are in every form of a corpus, and a killed call leaves the whole copy or none."""

import shutil

import numpy as np
import pytest
from xarray.conventions import encode_cf_variable

from gen import open_corpus, validate_corpus
from gen.corpus import SIGNAL, open_records, read_manifest
from gen.support.errors import CorpusError
from raceway import copy, publish
from raceway.console.ending import BAD_INPUT
from raceway.sharing.publication import Publication
from tests import corpora
from tests.same_corpora import files
from tests.tampering import edit_manifest

NAMES = ("copy", "copy.nc")


@pytest.fixture
def source(nine, tmp_path):
    """Folder of a corpus of nine records in parts of three, four and two."""
    return shutil.copytree(nine / "c", tmp_path / "source")


def contents(path, records=slice(None)):
    """Values of all variables of some records, with the stored counts in place of accelerations."""
    with open_corpus(path) as corpus:
        some = corpus.isel(record=records).load()
        signal = encode_cf_variable(some[SIGNAL].variable).values
        return {str(name): some[name].values for name in some.variables if name != SIGNAL} | {SIGNAL: signal}


def assert_same(found, expected):
    assert found.keys() == expected.keys()
    for name, values in expected.items():
        assert found[name].dtype.kind == values.dtype.kind, name
        np.testing.assert_array_equal(found[name], values, err_msg=name)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(
    ("kind", "stored", "codec"),
    [("counts", "zlib", None), ("counts", "zstd", "none"), ("counts", "none", "zstd"), ("float32", "zlib", "zlib")],
)
def test_a_whole_copy_has_every_record_bit_for_bit(tmp_path, name, kind, stored, codec):
    corpora.write_corpus(tmp_path / "source", kind=kind, codec=stored)
    made = copy(tmp_path / "source", tmp_path / name, codec=codec)
    assert (made.records, made.of, made.channels, made.filled) == (9, 9, ("a", "b"), ())
    assert made.bytes == sum(map(len, files(tmp_path / name).values()))
    assert validate_corpus(tmp_path / name) == []
    assert_same(contents(tmp_path / name), contents(tmp_path / "source"))


def test_copying_there_and_back_gives_the_same_bytes_and_the_recipe_of_the_index(tiny_corpus, tmp_path):
    """A folder, a single file of it, a folder of that: nothing is lost on the way, and nothing is added."""
    source = shutil.copytree(tiny_corpus, tmp_path / "source")
    publish(source, Publication(license="CC-BY-4.0", date="2026-01-02"))
    (source / "recipe.yaml").write_text("name: altered\n")
    copy(source, tmp_path / "one")
    copy(tmp_path / "one", tmp_path / "one.nc")
    copy(tmp_path / "one.nc", tmp_path / "two")
    copy(tmp_path / "two", tmp_path / "two.nc")
    assert files(tmp_path / "two") == files(tmp_path / "one")
    assert files(tmp_path / "two.nc") == files(tmp_path / "one.nc")
    assert (tmp_path / "two" / "recipe.yaml").read_bytes() == (tiny_corpus / "recipe.yaml").read_bytes()
    assert read_manifest(tmp_path / "two.nc").publication["license"] == "CC-BY-4.0"


@pytest.mark.parametrize("name", NAMES)
def test_wrong_facts_of_publication_go_into_no_copy(source, tmp_path, name):
    edit_manifest(source, publication={"license": "my own"})
    with pytest.raises(CorpusError, match="publication of A corpus: license: 'my own' is not an SPDX identifier"):
        copy(source, tmp_path / name)
    assert [path.name for path in tmp_path.iterdir()] == ["source"]


@pytest.mark.parametrize("name", NAMES)
def test_condition_split_and_channels_apply_together_and_chosen_records_keep_all_numbers_and_labels(
    source, tmp_path, name
):
    made = copy(source, tmp_path / name, where="rig > 0", channels=["b"], split="train")
    assert (made.records, made.of, made.channels) == (2, 9, ("b",))
    assert validate_corpus(tmp_path / name) == []
    expected = contents(source, [3, 6])
    expected[SIGNAL], expected["channel"] = expected[SIGNAL][:, 1:], expected["channel"][1:]
    assert_same(contents(tmp_path / name), expected)


def test_a_missing_sample_stays_missing(tmp_path, monkeypatch):
    usual = corpora.dataset

    def with_a_gap(*part, **how):
        made = usual(*part, **how)
        made[SIGNAL].values[0, 0, 7] = -32768
        return made

    monkeypatch.setattr(corpora, "dataset", with_a_gap)
    corpora.write_corpus(tmp_path / "source", (2,))
    copy(tmp_path / "source", tmp_path / "counts")
    copy(tmp_path / "source", tmp_path / "single", float32=True)
    assert contents(tmp_path / "counts")[SIGNAL][0, 0, 7] == -32768
    assert np.flatnonzero(np.isnan(contents(tmp_path / "single")[SIGNAL])).tolist() == [7]


def test_the_history_tells_the_choice_and_the_manifest_keeps_the_publication(source, tmp_path):
    publish(source, Publication(license="CC-BY-4.0", date="2026-01-02"))
    copy(source, tmp_path / "one.nc", where="rig < 8", channels=["a"])
    copy(tmp_path / "one.nc", tmp_path / "two", split="test")
    with open_corpus(tmp_path / "two") as corpus:
        assert corpus.attrs["history"].splitlines() == [
            "made by a test",
            "copied by raceway copy: where rig < 8; channels a",
            "copied by raceway copy: split test",
        ]
    assert read_manifest(tmp_path / "two").publication["license"] == "CC-BY-4.0"
    with open_records([tmp_path / "two" / "parts" / "part-00000.nc"]) as part:  # terms can change, and parts cannot
        assert not {"license", "comment"} & set(part.attrs)


def test_far_apart_records_are_read_and_written_like_near_ones(tmp_path, monkeypatch):
    corpora.write_corpus(tmp_path / "source", (1,) * 12)
    monkeypatch.setattr("raceway.sharing.copying._SPAN", 2)
    monkeypatch.setattr("raceway.sharing.copying._MOST_IN_BLOCK", 3)
    copy(tmp_path / "source", tmp_path / "some", where="rig in (0, 1, 6, 11)")
    assert_same(contents(tmp_path / "some"), contents(tmp_path / "source", [0, 1, 6, 11]))
    assert [row.records for row in read_manifest(tmp_path / "some").parts] == [3, 1]


@pytest.mark.parametrize(
    ("choice", "sentence"),
    [
        ({"where": "shaft_rate > 1e6"}, r"choose others \(shaft_rate is [0-9,.]+ to [0-9,.]+ rpm \(.* Hz\)\)"),
        ({"channels": ["c"]}, "source: channels: there is no channel 'c'"),
        ({"rename": {"c": "d"}}, "rename: there is no channel 'c'; allowed are a, b."),
        ({"rename": {"a": "b"}}, "rename: two channels would be named b; give each its own name."),
        ({"codec": "lz4"}, "codec: there is no codec 'lz4'; allowed are zlib, zstd, none."),
        ({"to": "huggingface", "codec": "zlib"}, "codec: --codec is for corpora; leave it out for huggingface."),
    ],
    ids=str,
)
def test_a_choice_of_nothing_is_refused_and_leaves_nothing(source, tmp_path, choice, sentence):
    with pytest.raises(CorpusError, match=sentence):
        copy(source, tmp_path / "out", **choice)
    assert [path.name for path in tmp_path.iterdir()] == ["source"]


@pytest.mark.parametrize("target", ["there.nc", "there.parquet", "there", "table.nc"])
def test_nothing_is_overwritten(source, tmp_path, target):
    (tmp_path / "there").mkdir()
    (tmp_path / "table.nc").mkdir()
    for name in ("there.nc", "there.parquet", "there/note"):
        (tmp_path / name).write_text("mine")
    with pytest.raises(CorpusError, match=r"exists( and is not an empty folder)?; give a new name, or remove it first"):
        copy(source, tmp_path / target)
    assert (tmp_path / "there.nc").read_text() == (tmp_path / "there/note").read_text() == "mine"


def test_a_choice_is_copied_and_described(run, tones, tmp_path):
    where = "fault in ('inner', 'outer')"
    result = run("copy", tones[0], "--where", where, "--rename-channel", "housing=a", "-o", tmp_path / "s.nc")
    assert result.exit_code == 0, result.output
    assert f"{tmp_path / 's.nc'}: 6 of 12 records, 1 channel (a) in 1 file, " in result.stdout
    assert f"Next: raceway info {tmp_path / 's.nc'}" in result.stdout
    assert "copying: 6 of 6 records" in result.stderr


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("{one} --split train -o {other}", "exists and is not an empty folder"),
        ("{one} {one}/../{one_name} -o {out}", "is given twice; give each corpus once"),
        ("{one} -o {out}.hdf5", "docs/sharing.md writes CSV, Zarr and Parquet"),
        ("{one} --rename-channel housing -o {out}", "give OLD=NEW, once for each channel"),
        ("-o {out}", "Missing argument"),
    ],
)
def test_what_cannot_be_done_is_one_sentence_and_leaves_nothing(run, tones, tmp_path, words, sentence):
    places = {"one": tones[0], "one_name": tones[0].name, "other": tones[1], "out": tmp_path / "out"}
    result = run("copy", *(word.format(**places) for word in words.split(" ")))
    assert result.exit_code == BAD_INPUT
    assert sentence in result.stderr
    assert result.stderr.count("\n") <= 4
    assert list(tmp_path.iterdir()) == []
