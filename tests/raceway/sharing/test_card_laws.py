"""Laws of the data card: it follows from the folder alone, its programs run, and its commands make the corpus again."""

import re
import shutil

import numpy as np
import pytest

from gen.corpus import FAULTS, open_corpus, read_manifest
from gen.corpus.manifest import Manifest
from gen.corpus.schema import FORMAT
from gen.support.errors import CorpusError
from raceway import publish
from raceway.sharing.card.additions import CardAdditions, CardPicture, write_additions
from raceway.sharing.card.card_facts import ranges, rebuilding
from raceway.sharing.card.card_page import data_card
from raceway.sharing.publication import read_publication
from tests.corpora import write_corpus as write_several_parts
from tests.tone_corpora import write_corpus


def made_corpus(path):
    rng = np.random.default_rng(1)
    write_corpus(path, load=rng.uniform(100, 900, 48), depth=1e-5 * (np.repeat(np.arange(16), 3) % 4))
    return path


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    return made_corpus(tmp_path_factory.mktemp("card") / "corpus")


@pytest.fixture(scope="module", params=["corpus", "corpus.nc"])
def either(request, tmp_path_factory):
    """The same corpus as a folder and as a single file."""
    return made_corpus(tmp_path_factory.mktemp("card") / request.param)


def blocks(card, language):
    """Programs of a data card in one language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", card, re.MULTILINE | re.DOTALL)


def test_the_tables_count_the_records_of_the_corpus(corpus):
    card = data_card(corpus)
    for fault in FAULTS[:4]:
        assert f"| {fault} | 12 | 12 | 4 | 4 | 12 | 0 | 0 |" in card
    assert "| all | 48 | 48 | 16 | 4 | 48 | 0 | 0 |" in card
    assert "All records belong to the split train" in card


def range_rows(opened):
    """Cells of the table of ranges by variable and column."""
    found = ranges(opened)
    return {name: dict(zip(["unit", *found["classes"]], row, strict=True)) for name, row in found["vary"].items()}


def test_every_variable_is_listed_with_its_range_by_class_or_its_one_value(corpus):
    with open_corpus(corpus) as opened:
        rows = range_rows(opened)
        load = opened["load"].values[opened["fault"].values == FAULTS.index("outer")]
    assert rows["load"]["outer"] == f"{load.min():.4g} / {np.median(load):.4g} / {load.max():.4g}"
    assert (rows["load"]["unit"], rows["depth"]["outer"]) == ("N", "2e-05")
    card = data_card(corpus)
    assert f"| `depth` | m | {' | '.join(cell for name, cell in rows['depth'].items() if name != 'unit')} |" in card
    assert "`sample_rate` 4000 Hz" in card


def rms_of_first(corpus):
    with open_corpus(corpus) as opened:
        return float(np.sqrt(np.mean(opened["acceleration"].values[0, 0].astype(float) ** 2)))


@pytest.mark.parametrize("place", [0, 1], ids=["raceway", "xarray alone"])
def test_the_python_programs_of_the_card_read_the_first_record(either, place, monkeypatch, capsys):
    program = blocks(data_card(either), "python")[place]
    monkeypatch.chdir(either if either.is_dir() else either.parent)
    exec(program, {})  # noqa: S102 - our own page
    assert float(capsys.readouterr().out) == pytest.approx(rms_of_first(either), rel=1e-5)


def test_xarray_alone_joins_all_parts_as_the_card_says(tmp_path, monkeypatch):
    write_several_parts(tmp_path / "c", (3, 4, 2))
    monkeypatch.chdir(tmp_path / "c")
    names = {}
    exec(blocks(data_card(tmp_path / "c"), "python")[1], names)  # noqa: S102 - our own page
    with open_corpus(tmp_path / "c") as corpus:
        for name in ("acceleration", "fault", "width"):
            np.testing.assert_array_equal(names["corpus"][name].values, corpus[name].values)


def test_licence_and_creators_are_on_the_card_and_in_the_citation(corpus, tmp_path):
    folder = shutil.copytree(corpus, tmp_path / "copy")
    facts = {
        "license": "CC-BY-4.0",
        "creators": [{"name": "Jane Doe", "orcid": "0000-0002-1825-0097"}, {"name": "A & B"}],
    }
    publish(folder, read_publication(facts | {"doi": "10.1000/182", "date": "2026-03-31"}))
    card = (folder / "README.md").read_text()
    assert card == data_card(folder)
    assert "| licence | CC-BY-4.0 |" in card
    assert "| creator | Jane Doe, https://orcid.org/0000-0002-1825-0097 |" in card
    assert "\nJane Doe and A & B (2026): tones. Bearing vibration corpus of 48 records, made with Raceway." in card
    assert "No licence is stated" in data_card(corpus)


def command(corpus, **facts):
    return rebuilding(corpus, Manifest.model_validate({"raceway_format": FORMAT, "records": 0, **facts}))


def test_a_corpus_that_no_command_makes_has_its_history_instead(corpus):
    with open_corpus(corpus) as opened:
        assert command(opened, recipe="small") == []
    card = data_card(corpus)
    assert "\n## How to make it again\n\nHistory of the corpus: not known.\n" in card
    assert blocks(card, "sh") == []


def test_pictures_and_scores_of_other_parts_are_left_out(corpus, tmp_path):
    folder = shutil.copytree(corpus, tmp_path / "copy")
    picture = CardPicture(name="record-inner.png", title="One record", caption="A caption")
    write_additions(folder, CardAdditions(parts=read_manifest(folder).parts_sha256, pictures=(picture,)))
    assert "![One record](pictures/record-inner.png)" in data_card(folder)
    write_additions(folder, CardAdditions(parts="0" * 64, pictures=(picture,)))
    assert data_card(folder) == data_card(corpus)


def test_a_damaged_list_of_pictures_is_refused_with_a_sentence(corpus, tmp_path):
    folder = shutil.copytree(corpus, tmp_path / "copy")
    (folder / "card.json").write_text('{"parts": 3}')
    with pytest.raises(CorpusError, match=r"card\.json: .*; delete it and run raceway card again\.$"):
        data_card(folder)
