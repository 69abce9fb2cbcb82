"""Messages of the commands about records that cannot be used."""

import pytest

from gen.corpus import validate_corpus
from raceway.console.ending import DONE, FOUND_WANTING

SENTENCE = (
    "48 of 48 records cannot be used (48 clipped): raise recording.converter.full_scale_m_s2, or lower operation.load_n, level.gain or "
    "level.rms_m_s2.\n"
)
NONE = {"clipped": 0, "dead": 0, "constant": 0, "not_finite": 0}


@pytest.fixture
def loud_recipe(tiny_recipe, tmp_path):
    text = tiny_recipe.read_text()
    path = tmp_path / "loud.yaml"
    path.write_text(text.replace("settle_s: 0.05}", "settle_s: 0.05, converter: {full_scale_m_s2: 0.001, kind: adc}}"))
    return path


def test_generate_keeps_a_corpus_that_cannot_be_used_but_says_so_and_exits_with_1(run, loud_recipe, tmp_path):
    result = run("generate", loud_recipe, "-o", tmp_path / "c", "--workers", 1)
    assert result.exit_code == FOUND_WANTING
    assert SENTENCE in result.stderr
    assert "48 records in 4 parts; 48 clipped cannot be used." in result.stdout
    assert validate_corpus(tmp_path / "c") == []
    again = run("generate", loud_recipe, "-o", tmp_path / "c", "--workers", 1)
    assert again.exit_code == FOUND_WANTING
    assert SENTENCE in again.stderr


def test_json_has_the_counts(told, loud_recipe, tiny_recipe, tmp_path):
    found = told("generate", loud_recipe, "-o", tmp_path / "loud", "--workers", 1, exit_code=FOUND_WANTING)
    assert found["signals"] == NONE | {"clipped": 48}
    assert told("info", tmp_path / "loud")["signals"] == found["signals"]
    assert told("generate", tiny_recipe, "-o", tmp_path / "c", "--workers", 1, exit_code=DONE)["signals"] == NONE


def test_info_shows_how_many_records_cannot_be_used(run, loud_recipe, tiny_corpus, tmp_path):
    run("generate", loud_recipe, "-o", tmp_path / "c", "--workers", 1)
    shown = " ".join(run("info", tmp_path / "c").stdout.split())
    assert "not usable 48 clipped" in shown
    assert "not usable none" in " ".join(run("info", tiny_corpus).stdout.split())
