"""Laws of publication: who made a corpus and how it may be used changes no part, and a killed change leaves a corpus that can be read."""

import json
import re
import shutil

import netCDF4
import pytest
from ruamel.yaml import YAML

from gen.corpus import (
    Manifest,
    Publication,
    open_corpus,
    part_name,
    publication_attributes,
    publish,
    read_manifest,
    read_publication,
    validate_corpus,
    write_part,
)
from gen.corpus.finishing import finish_corpus
from gen.corpus.manifest import manifest_content
from gen.corpus.publication import checked_doi, checked_orcid
from gen.errors import CorpusError, RecipeError
from gen.recipe import read_recipe, recipe_hash
from gen.sharing import pack
from gen.sharing.unpacking import unpack
from tests import corpora, kills, tone_corpora
from tests.paths import ROOT

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


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    folder = tmp_path_factory.mktemp("plain") / "corpus"
    tone_corpora.write_corpus(folder, specimens=4, records=1)
    finish_corpus(folder, read_manifest(folder).parts)
    return folder


@pytest.fixture
def folder(plain, tmp_path):
    """A finished corpus without a publication."""
    return shutil.copytree(plain, tmp_path / "corpus")


def contents(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_a_published_corpus_has_the_files_of_one_that_was_made_with_its_publication(folder, tmp_path):
    parts = {name: content for name, content in contents(folder).items() if name.parts[0] == "parts"}
    made = tmp_path / "made"
    shutil.copytree(folder, made)
    finish_corpus(made, read_manifest(made).parts, publication=WHOLE)
    before = contents(folder)
    publish(folder, WHOLE)
    assert contents(folder) == contents(made)
    assert parts.items() <= contents(folder).items()
    assert validate_corpus(folder) == []
    assert read_manifest(folder).publication == WHOLE
    publish(folder, Publication())
    assert contents(folder) == before


def test_the_facts_stand_in_the_attributes_of_the_index(folder):
    publish(folder, WHOLE)
    with open_corpus(folder) as corpus:
        found = corpus.attrs
    assert found["license"] == "CC-BY-4.0 (https://spdx.org/licenses/CC-BY-4.0.html)"
    assert found["creator_name"] == "Jane Doe, Zoë O'Brien"
    assert found["creator_url"] == "https://orcid.org/0000-0002-1825-0097"
    assert found["references"] == "Doe, On bearings, 2026; https://example.org/rig"
    assert (found["id"], found["naming_authority"]) == ("10.1000/182", "https://doi.org")
    assert (found["institution"], found["creator_email"]) == ("Example Institute", "jane@example.org")
    assert found["date_created"] == "2026-03-31"


def test_a_kill_leaves_a_corpus_that_the_same_call_completes(folder, tmp_path):
    publish(folder, WHOLE)
    expected = contents(folder)
    publish(folder, Publication())
    old = tmp_path / "old"
    shutil.copytree(folder, old)
    for _ in kills.killed(lambda: publish(folder, WHOLE), moments=5):
        assert validate_corpus(folder) == []
        assert read_manifest(folder).publication in (Publication(), WHOLE)
        publish(folder, WHOLE)
        found = contents(folder)
        assert {name: found[name] for name in expected} == expected
        shutil.rmtree(folder)
        shutil.copytree(old, folder)


@pytest.mark.parametrize("replaced", [False, True])
def test_both_indices_are_read_while_one_replaces_the_other_and_no_third(folder, replaced):
    """The manifest of the moment between the two renames; later the same call removes the second entry."""
    index, path = folder / "corpus.nc", folder / "manifest.json"
    old = index.read_bytes()
    before = json.loads(path.read_text())
    publish(folder, WHOLE)
    after = json.loads(path.read_text())
    path.write_text(json.dumps(before | {"next_index": after["index"]}))
    if not replaced:
        index.write_bytes(old)
    assert validate_corpus(folder) == []
    index.write_bytes(old[:-1] + bytes([old[-1] ^ 1]))
    assert "altered" in validate_corpus(folder)[0]
    index.write_bytes(old)
    publish(folder, WHOLE)
    assert json.loads(path.read_text()) == after


def test_a_packed_file_has_the_facts_and_gives_them_back(folder, tmp_path, monkeypatch):
    publish(folder, WHOLE)
    before = contents(folder)
    pack(folder, tmp_path / "packed.nc")
    assert read_manifest(tmp_path / "packed.nc").publication == WHOLE
    with open_corpus(folder) as corpus, open_corpus(tmp_path / "packed.nc") as packed:
        assert packed.attrs.items() >= {**corpus.attrs, "comment": packed.attrs["comment"]}.items()
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    unpack(tmp_path / "packed.nc", tmp_path / "again")
    assert contents(tmp_path / "again") == before
    with pytest.raises(CorpusError, match="is one file; unpack it"):
        publish(tmp_path / "packed.nc", WHOLE)


def test_an_altered_or_unfinished_corpus_is_not_published(folder):
    part = next((folder / "parts").iterdir())
    content = part.read_bytes()
    part.write_bytes(content[:-1] + bytes([content[-1] ^ 1]))
    before = contents(folder)
    with pytest.raises(CorpusError, match="is altered"):
        publish(folder, WHOLE)
    assert contents(folder) == before
    with pytest.raises(CorpusError, match=r"no such folder|cannot be opened"):
        publish(folder / "nowhere", WHOLE)


def test_the_date_is_that_of_the_build_if_none_is_given(folder, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1774915200")  # 2026-03-31
    publish(folder, read_publication({}))
    assert read_manifest(folder).publication.date == "2026-03-31"
    publish(folder, read_publication({"date": "2020-02-29"}))
    assert read_manifest(folder).publication.date == "2020-02-29"
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "yesterday")
    with pytest.raises(CorpusError, match=r"^SOURCE_DATE_EPOCH: 'yesterday' is not a time"):
        publish(folder, read_publication({}))


def test_a_recipe_with_another_publication_has_the_same_hash(write_recipe, tmp_path):
    plain = read_recipe(write_recipe(tmp_path / "plain.yaml"))
    published = read_recipe(write_recipe(tmp_path / "published.yaml", {"publication": FACTS}))
    assert published.publication.stored == WHOLE.stored
    assert recipe_hash(plain) == recipe_hash(published)
    assert recipe_hash(plain) != recipe_hash(read_recipe(write_recipe(tmp_path / "other.yaml", {"seed": 4})))


def test_the_check_digit_of_an_orcid_finds_every_wrong_digit():
    """Literature: ISO 7064, MOD 11-2; both numbers are examples in the documentation of ORCID."""
    assert checked_orcid("0000-0002-1694-233X") == "0000-0002-1694-233X"
    right = "0000-0002-1825-0097"
    for place, digit in enumerate(right[:-1]):
        for other in set("0123456789") - {digit, "-"}:
            with pytest.raises(ValueError, match="is not an ORCID"):
                checked_orcid(right[:place] + other + right[place + 1 :])


def test_addresses_of_a_doi_are_one_doi():
    for text in ("10.1000/182", "doi:10.1000/182", "https://doi.org/10.1000/182", "http://dx.doi.org/10.1000/182"):
        assert checked_doi(text) == "10.1000/182"


WRONG = {
    "license": ("CC BY 4.0", "publication.license: 'CC BY 4.0' is not an SPDX identifier"),
    "creators": ([{"name": "A", "orcid": "0000-0002-1825-0098"}], "publication.creators[0].orcid: '0000-0002-1825-0098' is not an ORCID"),
    "institution": ("two\nlines", "publication.institution: 'two\\nlines' has line breaks"),
    "contact": ("jane at example.org", "publication.contact: 'jane at example.org' is not an e-mail address"),
    "doi": ("11.1000/182", "publication.doi: '11.1000/182' is not a DOI"),
    "date": ("31.3.2026", "publication.date: '31.3.2026' is not a date; write year, month and day as 2026-03-31."),
    "licence": ("MIT", "publication.licence: no such key; did you mean license?"),
}  # fmt: skip


@pytest.mark.parametrize("key", WRONG)
def test_a_wrong_fact_is_refused_with_one_sentence(write_recipe, tmp_path, key):
    value, sentence = WRONG[key]
    path = write_recipe(tmp_path / "recipe.yaml", {"publication": {key: value}})
    with pytest.raises(RecipeError) as refused:
        read_recipe(path)
    assert str(refused.value).startswith(f"{path}: {sentence}")
    assert "\n" not in str(refused.value)
    with pytest.raises(CorpusError) as refused:
        read_publication({key: value})
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("text", ["CC-BY", "cc-by-nc-sa", "MIT OR GPL", "Apache"])
def test_a_licence_without_its_version_is_refused(text):
    with pytest.raises(CorpusError, match=r"lacks its version; give it as on spdx\.org/licenses"):
        read_publication({"license": text})


@pytest.mark.parametrize("name", ["Jane Doe 0000-0002-1825-0097", "Jane Doe, https://orcid.org/0000-0002-1825-0097"])
def test_an_orcid_in_a_name_is_refused(name):
    with pytest.raises(CorpusError, match="has an ORCID in the name; give it as orcid, or write 'Jane Doe <0000-0002"):
        read_publication({"creators": [{"name": name}]})


@pytest.mark.parametrize("text", ["CC-BY-4.0", "CC0-1.0", "MIT OR Apache-2.0", "GPL-2.0+", "LicenseRef-ours"])
def test_forms_of_spdx_are_taken(text):
    assert read_publication({"license": text}).license == text


def test_a_title_beyond_ascii_is_read_back_from_index_and_parts(tmp_path):
    """netCDF4 writes it with variable length, which no file of the format has."""
    folder, title = tmp_path / "corpus", "Wälzlager № 1"
    (folder / "parts").mkdir(parents=True)
    row = write_part(corpora.dataset(0, 3).assign_attrs(title=title), folder / "parts" / part_name(0))
    finish_corpus(folder, [row])
    assert validate_corpus(folder) == []
    with open_corpus(folder) as corpus, netCDF4.Dataset(folder / "corpus.nc") as index:
        assert corpus.attrs["title"] == index.title == title
    assert title in (folder / "README.md").read_text()


def test_the_page_names_every_attribute_and_its_example_is_a_publication():
    page = (ROOT / "docs" / "publishing.md").read_text()
    example = YAML(typ="safe", pure=True).load(page.partition("```yaml\n")[2].partition("```")[0])["publication"]
    assert set(example) == set(Publication.model_fields)
    example["date"] = str(example["date"])  # Raceway reads dates as text
    given = read_publication(example)
    table = page.partition("| attribute | from |")[2].partition("\n\n")[0]
    named = {
        name for row in table.splitlines() for name in re.findall(r"`(\w+)`", row.split("|")[1] if "|" in row else "")
    }
    content = manifest_content([], publication=given, importer="test")
    written = publication_attributes(Manifest.model_validate_json(json.dumps(content)))
    assert named - {"title", "history", "source", "Conventions", "comment"} == set(written)
