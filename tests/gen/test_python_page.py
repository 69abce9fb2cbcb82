"""The examples of ``docs/python.md`` run as they stand, with fewer and shorter records and one sensor."""

import re

import numpy as np
import pytest

import gen
from features.signal import band_envelope_spectrum
from gen.recipe import recipe_hash
from tests.page_examples import blocks, run_blocks
from tests.paths import ROOT

PAGE = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
# seconds instead of minutes
SMALLER = {
    r'^ +(- )?\{"?name"?: "?fan_end.*\n': "",
    "n=40": "n=5",
    "specimens_per_rig: 10": "specimens_per_rig: 5",
    "rigs=4": "rigs=1",
    "rigs: 4": "rigs: 1",
    "duration_s=1": "duration_s=0.1",
    "duration_s: 1": "duration_s: 0.1",
    "n=4,": "n=1,",
    '"6308"': '{"n_balls": 9, "pitch_diameter_mm": 60, "ball_diameter_mm": 9}',
    r"(fresh|loader), 20": r"\1, 2",
    "num_workers=2": "num_workers=1",  # PyTorch warns of more workers than cores
    r"gen\.record\(\n": "gen.record(\n    waviness_nm=20,",
}


def smaller(text):
    for whole, part in SMALLER.items():
        text = re.sub(whole, part, text, flags=re.MULTILINE)
    return text


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Folder in which all examples ran, one after the other, and their variables."""
    folder = tmp_path_factory.mktemp("page")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setenv("RACEWAY_CACHE", str(folder / "cache"))
        patch.setattr("features.baselines.estimators.TREES", 2)
        patch.setattr("gen.support.executor.cores", lambda: 1)  # other processes would train all trees
        names = run_blocks("python.md", folder, SMALLER)
        (recipe,) = blocks("python.md", "yaml")
        (folder / "ladder.yaml").write_text(smaller(recipe), encoding="utf-8")
        gen.generate("ladder.yaml", "of_yaml")
    return folder, names


def test_the_frequency_of_the_page_is_that_of_its_record(results):
    assert f"{results[1]['ball_pass_frequency']:.1f}" == "88.4"
    assert "in Hz: 88.4" in PAGE


def test_the_recipe_in_yaml_is_that_of_the_calls_and_gives_the_same_records(results):
    folder, names = results
    of_yaml = gen.read_recipe(folder / "ladder.yaml")
    assert recipe_hash(of_yaml) == recipe_hash(gen.read_recipe(names["ladder"]))
    of_calls, of_recipe = (gen.open_corpus(folder / name).drop_attrs() for name in ("ladder", "of_yaml"))
    assert of_calls.equals(of_recipe)


def test_the_page_has_two_hundred_records_at_five_severities_and_two_sensors(tmp_path):
    (text,) = blocks("python.md", "yaml")
    (tmp_path / "r.yaml").write_text(text, encoding="utf-8")
    recipe = gen.read_recipe(tmp_path / "r.yaml")
    widths = [scenario.spalls[0].width for scenario in gen.draw_scenarios(recipe)]
    assert len(widths) == 200
    assert sorted({(width, widths.count(width)) for width in widths}) == [
        (pytest.approx(width * 1e-3), 40) for width in (0.2, 0.4, 0.6, 0.8, 1.0)
    ]
    assert len(recipe.recording.channels) == 2


def test_the_corpora_of_the_page_are_valid_and_replay(results):
    folder, names = results
    for corpus in ("ladder", "growing", "large"):
        assert gen.validate_corpus(folder / corpus) == []
        assert gen.replay(folder / corpus, 0).identical
    assert names["again"].identical


def test_the_fault_of_the_far_bearing_of_the_page_has_its_line_beside_the_near_one(results):
    near, far, both = (results[1][name] for name in ("near", "far", "both"))
    assert near.true_shaft_rate == far.true_shaft_rate

    def line(record):
        frequencies, (spectrum,) = band_envelope_spectrum(record.acceleration.values, 25600.0, (2000, 4000))
        away = np.abs(frequencies - float(far.true_bpfo * far.true_shaft_rate))
        return spectrum[away <= 1].max() / np.median(spectrum[away <= 25])

    assert line(near) < 10
    assert line(both) > 30


def test_the_diagnosis_of_the_page_has_an_answer_and_levels(results):
    diagnosis = results[1]["diagnosis"]
    assert diagnosis.sentence
    assert diagnosis.levels[0].rms > 0
