"""Messages of the commands about records that cannot be used."""

import numpy as np

from gen.corpus import FAULT_NAMES, open_corpus, validate_corpus
from gen.generation.corpus import generate
from raceway.console.ending import FOUND_WANTING
from raceway.sharing.card.card_page import data_card

SENTENCE = (
    "48 of 48 records cannot be used (48 clipped): raise recording.converter.full_scale_m_s2, or lower operation.load_n, level.gain or "
    "level.rms_m_s2.\n"
)


def with_full_scale(recipe, folder, full_scale):
    """File of a recipe whose converter is full at an acceleration [m s-2]."""
    text = recipe.read_text()
    path = folder / "loud.yaml"
    converter = f"converter: {{full_scale_m_s2: {full_scale}, kind: adc}}"
    path.write_text(text.replace("settle_s: 0.05}", f"settle_s: 0.05, {converter}}}"))
    return path


def test_generate_keeps_a_corpus_that_cannot_be_used_but_says_so_and_exits_with_1(
    run, told, tiny_recipe, tiny_corpus, tmp_path
):
    line = ("generate", with_full_scale(tiny_recipe, tmp_path, 0.001), "-o", tmp_path / "c", "--workers", 1)
    made = run(*line)
    assert made.exit_code == FOUND_WANTING
    assert SENTENCE in made.stderr
    assert "48 records in 4 parts; 48 clipped cannot be used." in made.stdout
    assert validate_corpus(tmp_path / "c") == []
    counts = told(*line, exit_code=FOUND_WANTING)["signals"]
    assert counts == told("info", tmp_path / "c")["signals"] == {"clipped": 48}
    assert told("info", tiny_corpus)["signals"] == {}
    for corpus, words in ((tmp_path / "c", "not usable 48 clipped"), (tiny_corpus, "not usable none")):
        assert words in " ".join(run("info", corpus).stdout.split())


def test_generate_info_and_card_count_the_records_of_each_class_with_a_clipped_sample(run, told, tiny_recipe, tmp_path):
    """At 150 m/s2 some impacts of the faults are clipped, which leaves their records usable; --quiet leaves the warning."""
    recipe = with_full_scale(tiny_recipe, tmp_path, 150)
    made = run("--quiet", "generate", recipe, "-o", tmp_path / "c", "--workers", 1)
    with open_corpus(tmp_path / "c") as corpus:
        clipped = (np.abs(corpus.acceleration) == np.abs(corpus.acceleration).max()).any(("channel", "elapsed_time"))
        classes = [str(name) for name in corpus.fault_name.values[clipped]]
    counts = {name: classes.count(name) for name in FAULT_NAMES.values() if name in classes}
    assert 0 < sum(counts.values()) < 48
    found = told("info", tmp_path / "c")
    assert (found["clipped"], found["signals"]) == (counts, {})
    sentence = f"{len(classes)} of 48 records are clipped at least once; raise recording.converter.full_scale_m_s2."
    assert found["warnings"] == [sentence]
    assert made.exit_code == 0
    assert made.stderr == f"warning: {sentence}\n"
    assert sentence in str(generate(recipe, tmp_path / "c"))
    words = ", ".join(f"{name} {number}" for name, number in counts.items())
    assert f"clipped at least once: {words} " in " ".join(run("info", tmp_path / "c").stdout.split())
    assert f"Records with a clipped sample: {words}." in data_card(tmp_path / "c")
