"""``raceway copy``: its forms, its output and its errors."""

import pytest

from raceway.console.ending import BAD_INPUT
from tests import tone_corpora


@pytest.fixture(scope="module")
def tones(tmp_path_factory):
    """Folders of two corpora of 12 records."""
    place = tmp_path_factory.mktemp("tones")
    folders = [place / "one", place / "other"]
    for seed, folder in enumerate(folders):
        tone_corpora.write_corpus(folder, specimens=4, parts=1, seed=seed)
    return folders


def test_a_choice_is_copied_and_described(run, tones, tmp_path):
    where = "fault in ('inner', 'outer')"
    result = run("copy", tones[0], "--where", where, "--rename-channel", "housing=a", "-o", tmp_path / "s.nc")
    assert result.exit_code == 0, result.output
    assert f"{tmp_path / 's.nc'}: 6 of 12 records, 1 channel (a) in 1 file, " in result.stdout
    assert f"Next: raceway info {tmp_path / 's.nc'}" in result.stdout
    assert "copying: 6 of 6 records" in result.stderr


def test_a_form_for_another_program_says_where_to_read_on(run, tones, tmp_path):
    done = run("copy", tones[0], "-o", tmp_path / "out", "--to", "huggingface", "--where", "fault == 'inner'")
    assert done.exit_code == 0
    assert "3 of 12 records, 1 channel (housing) as huggingface in" in done.stdout
    assert f"Next: read {tmp_path / 'out'}/README.md" in done.stdout


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (
            "{one} --where fualt=='inner' -o {out}",
            "there is no column fualt; the nearest are fault",
        ),
        ("{one} --split tets -o {out}", "there is no split 'tets'"),
        ("{one} --channels a,b -o {out}", "there is no channel 'a'"),
        ("{one} --split train -o {other}", "exists and is not an empty folder"),
        ("{one} {one} -o {out}", "has the same samples as record 0"),
        ("{one} -o {one}/parts/part-00000.nc", "choose a place outside it"),
        ("{one} --to xls -o {out}", "there is no form 'xls'; allowed is huggingface"),
        ("{one} --rename-channel housing -o {out}", "give OLD=NEW, once for each channel"),
        ("{one} --rename-channel house=a -o {out}", "there is no channel 'house'; the nearest is housing."),
        ("-o {out}", "Missing argument"),
    ],
)
def test_what_cannot_be_done_is_one_sentence_and_leaves_nothing(run, tones, tmp_path, words, sentence):
    places = {"one": tones[0], "other": tones[1], "out": tmp_path / "out"}
    result = run("copy", *(word.format(**places) for word in words.split(" ")))
    assert result.exit_code == BAD_INPUT
    assert sentence in result.stderr
    assert result.stderr.count("\n") <= 4
    assert list(tmp_path.iterdir()) == []
