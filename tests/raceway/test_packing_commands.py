"""The commands pack and unpack, and commands that take a packed file in place of a folder."""

import h5py
import pytest

from tests import tone_corpora


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    found = tmp_path_factory.mktemp("packing") / "tones"
    tone_corpora.write_corpus(found)
    return found


def test_a_corpus_is_packed_looked_at_and_unpacked(folder, tmp_path, told):
    made = told("pack", folder, "-o", tmp_path / "tones.nc")
    assert (made["records"], made["parts"]) == (48, 2)
    assert told("validate", tmp_path / "tones.nc")["valid"]
    one, other = told("info", folder), told("info", tmp_path / "tones.nc")
    assert {key for key in one if one[key] != other[key]} == {"corpus", "bytes"}
    assert told("features", tmp_path / "tones.nc", "-o", tmp_path / "features.nc")["records"] == 48
    again = told("unpack", tmp_path / "tones.nc", "-o", tmp_path / "again")
    assert (again["records"], again["same_bytes"]) == (48, True)


def test_a_choice_is_packed(folder, tmp_path, told):
    made = told("pack", folder, "-o", tmp_path / "x.nc", "--where", "shaft_rate > 30", "--float32")
    assert 0 < made["records"] < 48


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ("pack {folder} -o {packed}", "exists; give another name, or remove it first."),
        ("pack {folder} -o {new}.nc --where 'speed > 3'", "speed"),
        ("pack {packed} -o {new}.nc", "is one file already; copy it, or say which records with --where or --split."),
        ("unpack {packed} -o {folder}", "exists and is not an empty folder; give a new folder"),
        ("unpack {folder} -o {new}", "is no file; give a file that raceway pack made."),
        ("info {alone}", "is the index of a corpus without its parts, so it holds no signals; copy the whole folder"),
        ("generate quickstart -o {packed}", "is a file; give a folder"),
    ],
)
def test_a_refusal_is_a_sentence(folder, tmp_path, run, arguments, sentence):
    run("pack", folder, "-o", tmp_path / "packed.nc")
    (tmp_path / "corpus.nc").write_bytes((folder / "corpus.nc").read_bytes())
    places = {
        "folder": folder,
        "packed": tmp_path / "packed.nc",
        "new": tmp_path / "new",
        "alone": tmp_path / "corpus.nc",
    }
    words = [word.strip("'") for word in arguments.replace("'speed > 3'", "speed>3").split()]
    result = run(*(word.format(**places) for word in words))
    assert result.exit_code == 2
    assert sentence in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1


def test_a_damaged_record_is_found_wanting(folder, tmp_path, run, told):
    run("pack", folder, "-o", tmp_path / "x.nc")
    with h5py.File(tmp_path / "x.nc", "r+") as file:
        file["width"][40] = 1.0
    problems = told("validate", tmp_path / "x.nc", exit_code=1)["problems"]
    assert problems == [
        f"{tmp_path / 'x.nc'}: record 40 is damaged: its hash differs; copy the file again, or pack again."
    ]
