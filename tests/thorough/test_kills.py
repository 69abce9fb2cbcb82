"""A process killed at any moment leaves the whole of what it writes or nothing, and the same call completes it."""

import json
import shutil

import pytest

import gen
import raceway
from gen.corpus import open_corpus, sha256, validate_corpus
from raceway.sharing import FORMS, card_pictures, croissant_problems
from raceway.sharing.card.card_page import card_folder
from tests import corpora
from tests.kills import killed
from tests.same_corpora import files
from tests.tone_corpora import write_corpus


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    folder = tmp_path_factory.mktemp("source") / "corpus"
    corpora.write_corpus(folder)
    return folder


@pytest.fixture(scope="module")
def records():
    return gen.records(gen.outer(width_mm=0.8), 6, records_per_part=4, waviness_nm=20, duration_s=0.1, settle_s=0.06)


ACTIONS = {
    "write": lambda _, records, output: gen.write_corpus(records, output),
    "copy": lambda corpus, _, output: raceway.copy(corpus, output, where="rig != 4", float32=True),
    **{form: lambda corpus, _, output, form=form: raceway.copy(corpus, output, to=form) for form in FORMS},
}


@pytest.mark.parametrize(("action", "name"), [*((action, "out") for action in ACTIONS), ("copy", "out.nc")])
def test_a_killed_call_leaves_its_whole_output_or_none(source, records, tmp_path, action, name):
    output, whole = tmp_path / name, None
    for _ in killed(lambda: ACTIONS[action](source, records, output), moments=5):
        if output.exists():
            whole = whole or files(output)
            assert files(output) == whole
            output.unlink() if output.is_file() else shutil.rmtree(output)
    ACTIONS[action](source, records, output)
    assert files(output) == whole
    assert [path for path in tmp_path.iterdir() if not path.name.startswith(".")] == [output]


@pytest.mark.parametrize("name", ["corpus", "corpus.nc"])
def test_a_killed_card_leaves_a_readable_corpus_that_the_same_call_completes(run, monkeypatch, tmp_path, name):
    """Validation is silent only about a corpus whose files agree: an old or a new one. Pictures take no time, so that most kills meet
    a file that is being written."""
    monkeypatch.setattr(card_pictures, "small_png", lambda _figure: b"picture" * 10_000)
    place = tmp_path / "place"
    corpus = place / name
    place.mkdir()
    write_corpus(corpus, specimens=2, records=2)
    old = shutil.copytree(place, tmp_path / "old")
    root = corpus if corpus.is_dir() else place

    def call():
        assert run("card", corpus, "--license", "MIT").exit_code == 0

    def reset():
        shutil.rmtree(place)
        shutil.copytree(old, place)

    call()
    expected = files(place)
    reset()
    for _ in killed(call, moments=8):
        open_corpus(corpus).close()
        listing = card_folder(corpus) / "croissant.json"
        listed = json.loads(listing.read_text()) if listing.exists() else {}
        digests = {file["@id"]: file.get("sha256") for file in listed.get("distribution", ())}
        wrong = [file for file, digest in digests.items() if digest and sha256(root / file) != digest]
        assert not wrong or validate_corpus(corpus) + croissant_problems(corpus) != []
        call()
        assert files(place) == expected
        assert validate_corpus(corpus) == []
        reset()
