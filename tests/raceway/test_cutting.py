"""The commands select and merge: results, sentences and exit codes."""

import pytest

from gen.corpus import validate_corpus
from raceway.console.ending import BAD_INPUT
from tests import tone_corpora


@pytest.fixture
def tones(tmp_path):
    """Folders of two corpora of 12 records."""
    folders = [tmp_path / "one", tmp_path / "other"]
    for seed, folder in enumerate(folders):
        tone_corpora.write_corpus(folder, specimens=4, parts=1, seed=seed)
    return folders


def test_a_selection_is_made_and_described(run, told, tones, tmp_path):
    result = run(
        "select", tones[0], "--where", "fault in ('inner', 'outer')", "--channels", "housing", "-o", tmp_path / "s"
    )
    assert result.exit_code == 0, result.output
    assert f"{tmp_path / 's'}: 6 of 12 records in 1 part, 1 channel (housing)." in result.stdout
    assert "selecting: 6 of 6 records" in result.stderr
    assert "where: fault in ('inner', 'outer'); channels: housing" in run("info", tmp_path / "s").stdout
    assert told("info", tmp_path / "s")["selections"][0]["records"] == 12


def test_a_merge_is_made_and_described(told, run, tones, tmp_path):
    found = told("merge", *tones, "-o", tmp_path / "m", "--title", "Both")
    assert {name: found[name] for name in ("records", "parts", "origins", "filled")} == {
        "records": 24,
        "parts": 2,
        "origins": 2,
        "filled": [],
    }
    assert validate_corpus(tmp_path / "m") == []
    shown = run("info", tmp_path / "m").stdout
    assert shown.startswith("Both\n")
    assert "merge of tones, tones" in shown


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("select {one} -o {out}", "no choice is given"),
        (
            "select {one} --where fualt=='inner' -o {out}",
            "character 1: there is no variable fualt; the nearest is fault.",
        ),
        ("select {one} --split tets -o {out}", "there is no split 'tets'"),
        ("select {one} --channels a, -o {out}", "there is no channel 'a'"),
        ("select {one} --split train -o {other}", "exists and is not an empty folder"),
        ("merge {one} -o {out}", "give two or more corpora"),
        ("merge {one} {one} -o {out}", "has the same samples as record 0"),
        ("merge {one} {other}/corpus.nc -o {one}", "exists and is not an empty folder"),
    ],
)
def test_what_cannot_be_done_is_one_sentence_and_leaves_nothing(run, tones, tmp_path, words, sentence):
    places = {"one": tones[0], "other": tones[1], "out": tmp_path / "out"}
    result = run(*(word.format(**places) for word in words.split(" ")))
    assert result.exit_code == BAD_INPUT
    assert sentence in result.stderr
    assert result.stderr.count("\n") <= 2
    assert not (tmp_path / "out").exists()


def test_a_full_disk_is_one_sentence_and_leaves_nothing(start, tones, tmp_path):
    for words in (("select", tones[0], "--split", "train"), ("merge", *tones)):
        process = start(*words, "-o", tmp_path / "out", LARGEST_FILE="40000")
        error = process.communicate()[1]
        assert process.returncode == BAD_INPUT, error
        assert "could not be written" in error
        assert not list(tmp_path.glob("*out*"))
