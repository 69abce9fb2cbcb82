"""Messages of the commands about records that cannot be used."""

import numpy as np
import pytest

from gen.corpus import FAULT_NAMES, open_corpus, validate_corpus
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


def test_info_and_card_count_the_records_of_each_class_with_a_clipped_sample(run, told, tiny_recipe, tmp_path):
    """At 100 m/s2 some impacts of the faults are clipped, which leaves their records usable."""
    text = tiny_recipe.read_text()
    loud = tmp_path / "loud.yaml"
    loud.write_text(text.replace("settle_s: 0.05}", "settle_s: 0.05, converter: {full_scale_m_s2: 100, kind: adc}}"))
    run("generate", loud, "-o", tmp_path / "c", "--workers", 1)
    with open_corpus(tmp_path / "c") as corpus:
        clipped = (np.abs(corpus.acceleration) == np.abs(corpus.acceleration).max()).any(("channel", "elapsed_time"))
        classes = [str(name) for name in corpus.fault_name.values[clipped]]
    counts = {name: classes.count(name) for name in FAULT_NAMES.values() if name in classes}
    assert 0 < sum(counts.values()) < 48
    found = told("info", tmp_path / "c")
    assert (found["clipped"], found["signals"]) == (counts, NONE)
    words = ", ".join(f"{name} {number}" for name, number in counts.items())
    assert f"clipped at least once: {words} " in " ".join(run("info", tmp_path / "c").stdout.split())
    assert f"Records with a clipped sample: {words}." in (tmp_path / "c" / "README.md").read_text()


def test_a_corpus_without_a_clipped_sample_says_so(run, told, tiny_corpus):
    assert told("info", tiny_corpus)["clipped"] == {}
    assert "clipped none" in " ".join(run("info", tiny_corpus).stdout.split())
    assert "Records with a clipped sample: none." in (tiny_corpus / "README.md").read_text()
