"""The command ``raceway card``: facts of a publication, pictures and scores on the data card of a corpus."""

import json
import shlex
import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from gen.corpus import open_corpus, read_manifest, validate_corpus
from raceway.commands.publishing import card
from raceway.studies import card_pictures
from raceway.studies.card_pictures import complete_card
from tests.kills import killed
from tests.tone_corpora import write_corpus

ORDERS = {"ftf": 0.4, "bpfo": 9.0, "bpfi": 4.0, "bsf": 2.4}  # so that the lines of the pictures are those of the tones


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    folder = tmp_path_factory.mktemp("card") / "corpus"
    write_corpus(folder, specimens=2, records=2, **{name: np.full(4, order) for name, order in ORDERS.items()})
    return folder


@pytest.fixture
def undrawn(monkeypatch):
    """Pictures that take no time: other files are tested, and most kills meet a file that is being written."""
    monkeypatch.setattr(card_pictures, "small_png", lambda _figure: b"picture" * 10_000)


@pytest.fixture
def copied(corpus, tmp_path):
    return shutil.copytree(corpus, tmp_path / "copy")


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def results_of(folder, **changed):
    """``results.json`` of a benchmark as far as the card reads it."""
    with open_corpus(folder) as opened:
        title, records = opened.attrs["title"], opened.sizes["record"]
    scores = {"balanced_accuracy": 0.8125, "interval": [0.7, 0.9]}
    baseline = {
        "grouped": scores,
        "leaky": scores | {"balanced_accuracy": 0.95},
        "null": scores | {"balanced_accuracy": 0.25},
    }
    about = {"title": title, "records": records, "classes": {"healthy": 2, "inner": 2}}
    return {
        "corpus": about | changed, "track": "specimen", "folds": 5, "seed": 0, "groups": ["lines"],
        "versions": {"raceway": "0.1.0"}, "baselines": {"linear": baseline},
    }  # fmt: skip


def test_facts_pictures_and_scores_reach_the_card_and_no_part_changes(told, copied, tmp_path):
    (tmp_path / "results.json").write_text(json.dumps(results_of(copied)))
    before = {name: content for name, content in contents(copied).items() if name.startswith("parts")}
    found = told(
        "card", copied, "--license", "CC-BY-4.0", "--creator", "Jane Doe <0000-0002-1825-0097>", "--creator", "Sons",
        "--date", "2026-03-31", "--references", "One", "--references", "Two", "--scores", tmp_path / "results.json",
    )  # fmt: skip
    after = contents(copied)
    assert {name: content for name, content in after.items() if name.startswith("parts")} == before
    assert validate_corpus(copied) == []
    text = after["README.md"].decode()
    for sentence in (
        "| licence | CC-BY-4.0 |",
        "| creator | Sons |",
        "| reference | Two |",
        "| linear | 0.812 | 0.700 to 0.900 | 0.950 |",
    ):
        assert sentence in text
    assert len(found["pictures"]) == 3
    assert found["scores"] == {"linear": 0.8125}
    assert read_manifest(copied).publication.stored == found["publication"]
    for path in map(Path, found["pictures"]):
        assert f"](pictures/{path.name})" in text
        assert path.stat().st_size < 100_000
        with Image.open(path) as drawn:
            assert drawn.width > 600
            assert len(drawn.convert("RGB").getcolors() or ()) > 10  # more than a background


def test_a_second_call_changes_no_byte(told, copied):
    told("card", copied, "--license", "CC-BY-4.0")
    before = contents(copied)
    told("card", copied)
    assert contents(copied) == before


@pytest.mark.usefixtures("undrawn")
def test_later_facts_join_the_others_and_the_scores_stay(told, copied, tmp_path):
    (tmp_path / "results.json").write_text(json.dumps(results_of(copied)))
    told("card", copied, "--license", "CC-BY-4.0", "--scores", tmp_path / "results.json")
    found = told("card", copied, "--institution", "Works")
    assert found["publication"] == {"license": "CC-BY-4.0", "institution": "Works"}
    assert "| linear |" in (copied / "README.md").read_text()


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--license", "my own"), "is not an SPDX identifier"),
        (("--creator", "Jane <0000-0002-1825-0098>"), "its last digit does not fit"),
        (("--creator", "<0000-0002-1825-0097>"), "is not a name"),
        (("--doi", "182"), "is not a DOI"),
        (("--date", "yesterday"), "is not a date"),
        (("--scores", "/dev/zero"), "is a folder, a pipe or a device"),
        (("--scores", "missing.json"), "give results.json of raceway benchmark"),
    ],
)
def test_a_wrong_fact_is_one_sentence_and_changes_nothing(run, copied, options, sentence):
    before = contents(copied)
    result = run("card", copied, *options)
    assert result.exit_code == 2
    assert sentence in result.stderr
    assert result.stderr.count("\n") == 1
    assert contents(copied) == before


def test_scores_of_another_corpus_are_refused(run, copied, tmp_path):
    for changed in ({"title": "another"}, {"classes": {"healthy": 4}}):
        (tmp_path / "results.json").write_text(json.dumps(results_of(copied, **changed)))
        result = run("card", copied, "--scores", tmp_path / "results.json")
        assert (result.exit_code, "has scores of another corpus" in result.stderr) == (2, True)
    for text in ("[1]", "[" * 100_000):
        (tmp_path / "results.json").write_text(text)
        assert "is not a file of scores" in run("card", copied, "--scores", tmp_path / "results.json").stderr


@pytest.mark.usefixtures("undrawn")
def test_a_killed_call_leaves_a_readable_corpus_and_whole_files(copied):
    complete_card(copied)
    expected = contents(copied)
    for _ in killed(lambda: complete_card(copied), moments=5):
        assert validate_corpus(copied) == []
        found = {
            name: content for name, content in contents(copied).items() if not name.rpartition("/")[2].startswith(".")
        }
        assert all(expected[name] == content for name, content in found.items())
        for name in ("README.md", "card.json"):
            (copied / name).unlink(missing_ok=True)
    complete_card(copied)
    assert contents(copied) == expected


def test_the_help_has_examples_and_names_the_next_step():
    assert card.help is not None
    assert card.help.count("\n  raceway ") >= 3
    assert "Next:" in card.help


def test_the_commands_on_the_card_of_a_selection_make_the_same_parts_again(run, tiny_corpus, tmp_path, monkeypatch):
    assert (
        run("select", tiny_corpus, "--where", "fault == 'inner' or load > 500", "-o", tmp_path / "chosen").exit_code
        == 0
    )
    monkeypatch.chdir(tmp_path / "chosen")
    block = (
        Path("README.md")
        .read_text()
        .partition("## How to make it again")[2]
        .partition("```sh\n")[2]
        .partition("```")[0]
    )
    lines = [shlex.split(line) for line in block.splitlines()]
    for words in lines:
        assert run(*words[1:]).exit_code == 0
    again = Path(lines[-1][-1])
    assert read_manifest(again).parts == read_manifest(Path()).parts


@pytest.mark.usefixtures("undrawn")
def test_pictures_and_card_travel_in_a_packed_file(run, told, copied, tmp_path):
    told("card", copied, "--license", "CC-BY-4.0")
    assert run("pack", copied, "-o", tmp_path / "one.nc").exit_code == 0
    assert run("unpack", tmp_path / "one.nc", "-o", tmp_path / "again").exit_code == 0
    assert (tmp_path / "again" / "README.md").read_text() == (copied / "README.md").read_text()
    assert "is one file, and a data card belongs to a folder" in run("card", tmp_path / "one.nc").stderr
