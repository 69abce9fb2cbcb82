"""Laws of publication: who made a corpus and how it may be used changes no part, and a killed change leaves a corpus that can be read."""

import ast
import json

import netCDF4
import pytest
from ruamel.yaml import YAML

from gen.corpus import new_corpus, open_corpus, read_manifest, validate_corpus
from gen.corpus.disk import append_checksum, remove_checksum
from gen.corpus.finishing import finish_corpus
from gen.generation.corpus import generate
from gen.support.errors import CorpusError
from raceway import copy, describe, publish
from raceway.sharing import croissant_problems
from raceway.sharing.acdd import publication_attributes
from raceway.sharing.card.card_page import data_card
from raceway.sharing.croissant import croissant
from raceway.sharing.publication import Publication, check_orcid, publication_of, read_publication
from tests import corpora, tone_corpora
from tests.paths import ROOT
from tests.same_corpora import files

FACTS = {
    "license": "CC-BY-4.0",
    "creators": [{"name": "Jane Doe", "orcid": "0000-0002-1825-0097"}, {"name": "Zoë O'Brien"}],
    "institution": "Example Institute",
    "contact": "jane@example.org",
    "doi": "10.1000/182",
    "references": ["Doe, On bearings, 2026", "https://example.org/rig"],
    "date": "2026-03-31",
}
WHOLE = read_publication(FACTS)


@pytest.fixture(autouse=True)
def _no_clock(monkeypatch):
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)


@pytest.fixture(params=["copied_folder", "copied_file"])
def corpus(request):
    """A finished corpus without a publication: a folder or a single file."""
    return request.getfixturevalue(request.param)


def test_publication_changes_attributes_alone_and_can_be_taken_back(corpus):
    describe(corpus)
    before = files(corpus)
    publish(corpus, {})
    assert files(corpus) == before
    publish(corpus, WHOLE)
    after = files(corpus)
    assert {name: before[name] for name in before if name.parts[:1] == ("parts",)}.items() <= after.items()
    assert validate_corpus(corpus) == []
    assert publication_of(read_manifest(corpus)) == WHOLE
    publish(corpus, WHOLE)
    assert files(corpus) == after
    with open_corpus(corpus) as opened:
        published = opened.attrs
    publish(corpus, Publication())
    assert read_manifest(corpus).publication == {}
    with open_corpus(corpus) as opened:
        assert "license" not in opened.attrs
    publish(corpus, WHOLE)
    with open_corpus(corpus) as opened:
        assert opened.attrs == published


def test_a_finished_corpus_that_is_generated_again_stays_published(tiny_recipe, tmp_path):
    generate(tiny_recipe, tmp_path / "c")
    publish(tmp_path / "c", WHOLE)
    before = files(tmp_path / "c")
    generate(tiny_recipe, tmp_path / "c")
    assert files(tmp_path / "c") == before


def test_the_facts_stand_in_the_attributes(corpus):
    publish(corpus, WHOLE)
    with open_corpus(corpus) as opened:
        found = opened.attrs
    assert found["license"] == "CC-BY-4.0 (https://spdx.org/licenses/CC-BY-4.0.html)"
    assert found["creator_name"] == "Jane Doe, Zoë O'Brien"
    assert found["creator_url"] == "https://orcid.org/0000-0002-1825-0097"
    assert found["references"] == "Doe, On bearings, 2026; https://example.org/rig"
    assert (found["id"], found["naming_authority"]) == ("10.1000/182", "https://doi.org")
    assert (found["institution"], found["creator_email"]) == ("Example Institute", "jane@example.org")
    assert found["date_created"] == "2026-03-31"


def test_an_altered_corpus_is_not_published(corpus):
    part = corpus if corpus.is_file() else next((corpus / "parts").iterdir())
    content = part.read_bytes()
    part.write_bytes(content[:-100] + bytes([content[-100] ^ 1]) + content[-99:])
    before = files(corpus)
    with pytest.raises(CorpusError, match="its bytes do not have the hash"):
        publish(corpus, WHOLE)
    assert files(corpus) == before
    with pytest.raises(CorpusError, match="no such folder or file"):
        publish(corpus.with_name("nowhere"), WHOLE)


STEPS = (
    "raceway.sharing.publishing.write_manifest",
    "raceway.sharing.publishing._write_attributes",
    "raceway.sharing.publishing.write_card",
    "raceway.sharing.publishing.write_croissant",
)


@pytest.mark.parametrize("step", STEPS)
def test_a_call_that_ends_between_two_files_is_found_and_repaired(copied_folder, monkeypatch, step):
    def killed(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(step, killed)
        with pytest.raises(KeyboardInterrupt):
            publish(copied_folder, WHOLE)
    open_corpus(copied_folder).close()
    assert (validate_corpus(copied_folder) == []) == (not step.endswith("attributes"))
    publish(copied_folder, WHOLE)
    assert validate_corpus(copied_folder) == []
    assert publication_of(read_manifest(copied_folder)) == WHOLE


def test_the_date_is_that_of_the_build_if_none_is_given(corpus, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1774915200")  # 2026-03-31
    publish(corpus, read_publication({}))
    assert publication_of(read_manifest(corpus)).date == "2026-03-31"
    publish(corpus, read_publication({"date": "2020-02-29"}))
    assert publication_of(read_manifest(corpus)).date == "2020-02-29"
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "yesterday")
    with pytest.raises(CorpusError, match=r"^SOURCE_DATE_EPOCH: 'yesterday' is not a time"):
        publish(corpus, read_publication({}))


def test_the_check_digit_of_an_orcid_finds_every_wrong_digit():
    """Literature: ISO 7064, MOD 11-2; both numbers are examples in the documentation of ORCID."""
    assert check_orcid("0000-0002-1694-233X") == "0000-0002-1694-233X"
    right = "0000-0002-1825-0097"
    for place, digit in enumerate(right[:-1]):
        for other in set("0123456789") - {digit, "-"}:
            with pytest.raises(ValueError, match="is not an ORCID"):
                check_orcid(right[:place] + other + right[place + 1 :])


WRONG = {
    "license": ("CC BY 4.0", "license: 'CC BY 4.0' is not an SPDX identifier"),
    "creators": ([{"name": "A", "orcid": "0000-0002-1825-0098"}], "creators[0].orcid: '0000-0002-1825-0098' is not an ORCID"),
    "institution": ("two\nlines", "institution: 'two\\nlines' has line breaks"),
    "contact": ("jane at example.org", "contact: 'jane at example.org' is not an e-mail address"),
    "doi": ("11.1000/182", "doi: '11.1000/182' is not a DOI"),
    "date": ("31.3.2026", "date: '31.3.2026' is not a date; write year, month and day as 2026-03-31."),
    "licence": ("MIT", "licence: no such key; did you mean license?"),
}  # fmt: skip


@pytest.mark.parametrize("key", WRONG)
def test_a_wrong_fact_is_refused_with_one_sentence(key):
    value, sentence = WRONG[key]
    with pytest.raises(CorpusError) as refused:
        read_publication({key: value})
    assert str(refused.value).startswith(sentence)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("text", ["CC-BY-4.0", "CC0-1.0", "MIT OR Apache-2.0", "GPL-2.0+", "LicenseRef-ours"])
def test_forms_of_spdx_are_taken(text):
    assert read_publication({"license": text}).license == text


@pytest.mark.parametrize("form", ["c", "c.nc"])
def test_a_title_beyond_ascii_is_read_back_from_every_file(tmp_path, form):
    """netCDF4 writes it with variable length, which no file of the format has."""
    title = "Wälzlager № 1"
    with new_corpus(tmp_path / form, title=title) as new:
        new.write(corpora.dataset(0, 3).assign_attrs(title=title))
    assert validate_corpus(tmp_path / form) == []
    assert read_manifest(tmp_path / form).title == title
    for file in [tmp_path / form] if form == "c.nc" else (tmp_path / form).rglob("*.nc"):
        with netCDF4.Dataset(file) as opened:
            assert opened.title == title
    assert title in data_card(tmp_path / form)


def test_the_example_of_the_page_has_every_fact_of_a_publication():
    page = (ROOT / "docs" / "sharing.md").read_text()
    example = ast.literal_eval(page.partition('raceway.publish("corpus", ')[2].partition(")\n\n")[0])
    assert set(example) == set(Publication.model_fields)
    read_publication(example)


def test_croissant_has_no_marks_that_are_not_seen(tmp_path):
    part = corpora.dataset(0, 3, channels=("a\u202eb", "c"))
    with new_corpus(tmp_path / "c", title="balls\u202e and\x1b[2J \u2066rings") as writer:
        writer.write(part)
    publish(tmp_path / "c", WHOLE)
    text = (tmp_path / "c" / "croissant.json").read_text("utf-8")
    assert json.loads(text)["name"] == "balls and[2J rings"
    assert "channels of the signal: ab, c." in text
    assert {letter for letter in text if not letter.isprintable()} == {"\n"}
    assert croissant_problems(tmp_path / "c") == []


def test_only_corpora_with_simulated_records_are_called_synthetic(nine, tmp_path):
    tone_corpora.write_corpus(tmp_path / "recorded")
    told = {}
    for path in (nine / "c", tmp_path / "recorded"):
        hub = tmp_path / f"hub of {path.name}"
        copy(path, hub, to="huggingface")
        header = (hub / "README.md").read_text().split("---\n")[1]
        facts = {name.removeprefix("rai:"): value for name, value in croissant(path).items() if name[:4] == "rai:"}
        told[path.name] = facts, YAML(typ="safe").load(header)
    (facts, hub), (of_recorded, hub_of_recorded) = told["c"], told["recorded"]
    assert facts["hasSyntheticData"] is True
    assert ("synthetic" in hub["tags"], hub["annotations_creators"]) == (True, ["machine-generated"])
    # labels of recordings may be a person's
    assert not {"hasSyntheticData", "dataLimitations", "dataAnnotationProtocol"} & of_recorded.keys()
    assert ("synthetic" in hub_of_recorded["tags"], "annotations_creators" in hub_of_recorded) == (False, False)
    assert of_recorded["dataBiases"].startswith("12 of 48 records are healthy")


def test_a_card_of_another_content_is_removed_and_a_changed_croissant_is_found(copied_folder):
    describe(copied_folder)
    assert croissant_problems(copied_folder) == []
    croissant = copied_folder / "croissant.json"
    croissant.write_bytes(croissant.read_bytes().replace(b"i", b"j", 1))
    (problem,) = croissant_problems(copied_folder)
    assert problem.endswith("croissant.json: is not that of the corpus; run raceway card again.")
    finish_corpus(copied_folder, read_manifest(copied_folder).parts, title="Another")
    assert not croissant.exists()
    assert not (copied_folder / "README.md").exists()


def test_a_copy_of_a_published_corpus_to_one_file_has_the_attributes_of_a_published_file(copied_folder, tmp_path):
    copy(copied_folder, tmp_path / "unpublished.nc")
    publish(copied_folder, WHOLE)
    copy(copied_folder, tmp_path / "published.nc")
    attributes = {}
    for name in ("published", "unpublished"):
        with netCDF4.Dataset(tmp_path / f"{name}.nc") as opened:
            attributes[name] = {key: opened.getncattr(key) for key in opened.ncattrs()}
    copied = read_manifest(tmp_path / "published.nc")
    assert publication_attributes(copied).items() <= attributes["published"].items()
    assert attributes["published"].keys() - publication_attributes(copied).keys() == {
        *attributes["unpublished"], "publication"
    }  # fmt: skip
    assert validate_corpus(tmp_path / "published.nc") == []


def test_a_published_file_that_lost_its_attributes_gets_them_back(copied_file):
    """A file that an earlier version copied has the facts of its publication in ``publication`` alone."""
    publish(copied_file, WHOLE)
    before = files(copied_file)
    remove_checksum(copied_file)
    with netCDF4.Dataset(copied_file, "a") as opened:
        opened.delncattr("license")
    append_checksum(copied_file)
    publish(copied_file, WHOLE)
    with netCDF4.Dataset(copied_file) as opened:
        assert opened.license.startswith("CC-BY-4.0")
    assert files(copied_file).keys() == before.keys()
    assert validate_corpus(copied_file) == []


@pytest.mark.parametrize(
    ("creator", "of_croissant", "of_acdd"),
    [
        ({"name": "Jane Doe", "orcid": "0000-0002-1825-0097"}, "sc:Person", "person"),
        ({"name": "Example Institute"}, "sc:Organization", "institution"),
        ({"name": "Example Lab"}, ["sc:Person", "sc:Organization"], None),
    ],
)
def test_a_creator_is_called_a_person_or_an_organisation_only_if_it_is_known(
    copied_folder, creator, of_croissant, of_acdd
):
    publish(copied_folder, {"creators": [creator], "institution": "Example Institute"})
    (stated,) = croissant(copied_folder)["creator"]
    assert stated["@type"] == of_croissant
    assert publication_attributes(read_manifest(copied_folder)).get("creator_type") == of_acdd
