"""The command ``raceway card``: facts of a publication, pictures and scores on the data card of a corpus."""

import shlex
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

from gen.corpus import open_corpus, read_manifest, validate_corpus
from raceway import describe
from raceway.sharing.card.card_page import card_folder
from tests.same_corpora import files
from tests.tone_corpora import write_corpus

ORDERS = {"ftf": 0.4, "bpfo": 9.0, "bpfi": 4.0, "bsf": 2.4}  # so that the lines of the pictures are those of the tones


@pytest.fixture(scope="module", params=["corpus", "corpus.nc"])
def corpus(request, tmp_path_factory):
    """A corpus as a folder, and as a single file."""
    path = tmp_path_factory.mktemp("card") / request.param
    write_corpus(path, specimens=2, records=2, **{name: np.full(4, order) for name, order in ORDERS.items()})
    return path


@pytest.fixture
def copied(corpus, tmp_path):
    (tmp_path / "place").mkdir()
    target = tmp_path / "place" / corpus.name
    return shutil.copytree(corpus, target) if corpus.is_dir() else shutil.copyfile(corpus, target)


def contents(corpus):
    """Bytes of a folder, or of a single file with the folder of its card."""
    return files(corpus if corpus.is_dir() else corpus.parent)


@pytest.fixture
def results(monkeypatch, copied, tmp_path):
    """Function that makes ``results.json`` be read as a benchmark of the corpus, with other facts about that if they are given."""

    def make(**changed):
        with open_corpus(copied) as opened:
            title, records = opened.attrs["title"], opened.sizes["record"]
        about = {"title": title, "records": records, "classes": {"healthy": 2, "inner": 2}}
        scores = [SimpleNamespace(balanced_accuracy=score, interval=(0.7, 0.9)) for score in (0.8125, 0.95, 0.25)]
        baseline = SimpleNamespace(**dict(zip(("grouped", "leaky", "null"), scores, strict=True)))
        read = SimpleNamespace(
            corpus=SimpleNamespace(**about | changed), track="specimen", folds=5, seed=0, groups=("lines",),
            versions={"raceway": "0.1.0"}, baselines={"linear": baseline},
        )  # fmt: skip
        of_file = SimpleNamespace(validate_json=lambda _: read)
        monkeypatch.setattr("raceway.sharing.card_pictures.TypeAdapter", lambda _: of_file)
        path = tmp_path / "results.json"
        path.touch()
        return path

    return make


def test_facts_pictures_and_scores_reach_the_card_and_no_part_changes(told, copied, results):
    before = {name: content for name, content in contents(copied).items() if name.parts[0] == "parts"}
    with open_corpus(copied) as opened:
        records = opened.load()
    found = told(
        "card", copied, "--license", "CC-BY-4.0", "--creator", "Jane Doe <0000-0002-1825-0097>", "--creator", "Sons",
        "--date", "2026-03-31", "--references", "One", "--references", "Two", "--scores", results(),
    )  # fmt: skip
    after = contents(copied)
    assert {name: content for name, content in after.items() if name.parts[0] == "parts"} == before
    with open_corpus(copied) as opened:
        assert records.equals(opened)
    assert validate_corpus(copied) == []
    text = (card_folder(copied) / "README.md").read_text()
    for sentence in (
        "| licence | CC-BY-4.0 |",
        "| creator | Sons |",
        "| reference | Two |",
        "| linear | 0.812 | 0.700 to 0.900 | 0.950 |",
    ):
        assert sentence in text
    assert len(found["pictures"]) == 3
    assert found["scores"] == {"linear": 0.8125}
    assert read_manifest(copied).publication == found["publication"]
    for path in map(Path, found["pictures"]):
        assert f"](pictures/{path.name})" in text
        assert path.stat().st_size < 100_000
        with Image.open(path) as drawn:
            assert drawn.width > 600
            assert len(drawn.convert("RGB").getcolors() or ()) > 10  # more than a background


@pytest.mark.usefixtures("undrawn")
def test_a_second_call_changes_no_byte_and_removes_what_a_killed_one_left(told, copied):
    told("card", copied, "--license", "CC-BY-4.0")
    before = contents(copied)
    for name in ("README.md", "croissant.json", "pictures/record-inner.png"):
        path = card_folder(copied) / name
        path.with_name(f".{path.name}.host.1.1.tmp").write_bytes(b"half")
    told("card", copied)
    assert contents(copied) == before


def test_a_wrong_fact_is_one_sentence_and_changes_nothing(run, copied):
    """Which facts are wrong is tested in tests/gen/corpus/test_publication_laws.py."""
    describe(copied)
    before = contents(copied)
    for option, value, sentence in (
        ("--license", "my own", "is not an SPDX identifier"),
        ("--creator", "Jane <0000-0002-1825-0098>", "its last digit does not fit"),
        ("--scores", "/dev/zero", "is not a file of scores"),
        ("--scores", "missing.json", "give results.json of raceway benchmark"),
    ):
        result = run("card", copied, option, value)
        assert (result.exit_code, result.stderr.count("\n")) == (2, 1)
        assert sentence in result.stderr
    assert contents(copied) == before


def test_scores_of_another_corpus_are_refused(run, copied, results):
    for changed in ({"title": "another"}, {"classes": {"healthy": 4}}):
        result = run("card", copied, "--scores", results(**changed))
        assert (result.exit_code, "has scores of another corpus" in result.stderr) == (2, True)


def test_a_file_that_is_no_result_of_a_benchmark_is_refused(run, copied, tmp_path):
    for text in ("[1]", "[" * 100_000):
        (tmp_path / "results.json").write_text(text)
        assert "is not a file of scores" in run("card", copied, "--scores", tmp_path / "results.json").stderr


@pytest.mark.usefixtures("undrawn")
def test_the_command_on_the_card_makes_the_same_parts_again(run, told, tiny_recipe, tmp_path, monkeypatch):
    corpus = tmp_path / "again_in.nc"
    assert run("generate", tiny_recipe, "--records", 24, "-o", corpus).exit_code == 0
    told("card", corpus)
    card = card_folder(corpus)
    monkeypatch.chdir(card)
    block = (card / "README.md").read_text().partition("## How to make it again")[2].partition("```sh\n")[2]
    (line,) = block.partition("```")[0].splitlines()
    assert run(*shlex.split(line)[1:]).exit_code == 0
    assert read_manifest(tmp_path / "again").parts_sha256 == read_manifest(corpus).parts_sha256


@pytest.mark.parametrize("foreign", ["README.md", "pictures/record-inner.png"])
def test_a_folder_of_the_user_is_no_place_for_a_card(run, copied, foreign):
    if copied.is_dir():
        pytest.skip("the card of a folder is in it")
    note = card_folder(copied) / foreign
    note.parent.mkdir(parents=True)
    note.write_text("mine")
    before = contents(copied)
    result = run("card", copied, "--license", "MIT")
    assert "holds no data card of raceway; move it, or give the corpus another name." in result.stderr
    assert contents(copied) == before


def test_a_file_of_a_corpus_gets_no_card(run, copied):
    if copied.is_file():
        pytest.skip("a single file has no parts")
    before = contents(copied)
    result = run("card", copied / "parts" / "part-00000.nc", "--license", "MIT")
    assert f"is a file of the corpus {copied.resolve()}; give that corpus." in result.stderr
    assert contents(copied) == before
