"""Laws of the scenario stored in a corpus: it is the drawn one, and a corpus without one gets a sentence."""

import json
import shutil

import h5py
import numpy as np
import pytest

from gen import draw_scenarios, generate, open_corpus, replay, shaft_angles, stored_scenario
from gen.corpus import sha256
from gen.errors import CorpusError
from gen.replaying import corpus_recipe
from gen.simulation.motion import start_of
from tests import corpora


def test_records_of_faults_and_levels_that_were_drawn_again_are_replayed_bit_for_bit(write_recipe, tmp_path):
    """Also where records before them were left out, so that their places in the corpus are not their numbers."""
    level = {
        "kind": "snr",
        "faulty_db": {"kind": "uniform", "low": -25, "high": 10},
        "healthy_db": {"kind": "uniform", "low": -15, "high": 10},
    }
    outer = {"kind": "outer", "width_mm": 0.5, "angle_deg": {"kind": "uniform", "low": -180, "high": 180}}
    hidden = {"kind": "ball", "width_mm": 0.1, "level": {"faulty_db": -60}}
    changes = {"level": level, "faults": [outer, hidden], "recording.duration_s": 0.25, "corpus.undetected": "redraw"}
    generated = generate(write_recipe(tmp_path / "r.yaml", changes), tmp_path / "corpus")
    assert generated.failures
    with open_corpus(tmp_path / "corpus") as corpus:
        numbers, faults, levels = (corpus[name].values for name in ("recording", "fault_tries", "level_tries"))
    moved = numbers != np.arange(len(numbers))
    for wanted in (moved & (faults > 0), moved & (levels > 0)):
        assert replay(tmp_path / "corpus", int(np.flatnonzero(wanted)[0])).identical


def test_an_older_corpus_that_decodes_to_double_precision_is_replayed_bit_for_bit(tiny_corpus, tmp_path):
    older = shutil.copytree(tiny_corpus, tmp_path / "corpus")
    manifest = json.loads((older / "manifest.json").read_text())
    files = [older / "corpus.nc", *sorted((older / "parts").iterdir())]
    for path, listed in zip(files, [manifest["index"], *manifest["parts"]], strict=True):
        with h5py.File(path, "r+") as file:
            attributes = file["acceleration"].attrs
            scale = 500 / 32767
            assert attributes["scale_factor"] == pytest.approx(scale)
            for name, value in {"scale_factor": scale, "add_offset": 0.0}.items():
                attributes.create(name, np.float64(value))
        listed |= {"bytes": path.stat().st_size, "sha256": sha256(path)}
    (older / "manifest.json").write_text(json.dumps(manifest))
    with open_corpus(older) as corpus:
        assert corpus["acceleration"].dtype == np.float64
    assert replay(older, 5).identical


def test_the_stored_scenario_of_every_record_is_the_drawn_one(tiny_corpus):
    with open_corpus(tiny_corpus) as corpus:
        numbers = corpus["recording"].values
    drawn = draw_scenarios(corpus_recipe(tiny_corpus))
    assert [stored_scenario(tiny_corpus, record) for record in range(len(numbers))] == [drawn[n] for n in numbers]


def test_a_corpus_without_its_recipe_still_gives_its_scenarios(tiny_corpus, tmp_path):
    copied = shutil.copytree(tiny_corpus, tmp_path / "corpus")
    (copied / "recipe.yaml").unlink()
    assert stored_scenario(copied, 7) == stored_scenario(tiny_corpus, 7)


@pytest.mark.parametrize("record", [-1, 48])
def test_a_record_that_is_not_there_has_no_scenario(tiny_corpus, record):
    with pytest.raises(CorpusError, match=f"record {record} is not in it; it has records 0 to 47"):
        stored_scenario(tiny_corpus, record)


def test_a_stored_text_that_is_no_scenario_is_refused_with_corpus_and_record(tmp_path):
    corpora.write_corpus(tmp_path / "corpus")
    with pytest.raises(CorpusError, match=r"corpus: record 4: stored scenario: the whole text: Invalid JSON"):
        stored_scenario(tmp_path / "corpus", 4)


def test_a_corpus_that_stores_no_scenarios_is_refused(tmp_path, monkeypatch):
    with_draws = corpora.columns
    monkeypatch.setattr(corpora, "EXTRA", ())
    monkeypatch.setattr(corpora, "columns", lambda *part: {k: v for k, v in with_draws(*part).items() if k != "draws"})
    corpora.write_corpus(tmp_path / "corpus")
    with pytest.raises(CorpusError, match="has no variable draws, so it was not generated and stores no scenarios"):
        stored_scenario(tmp_path / "corpus", 0)


def test_the_angle_of_the_shaft_turns_at_the_true_rate_of_the_record(tiny_corpus):
    with open_corpus(tiny_corpus) as corpus:
        rates, time = corpus["true_shaft_rate"].values, corpus["elapsed_time"].values
    for record in (0, 17):
        angles = shaft_angles(tiny_corpus, record)
        assert angles.shape == time.shape
        assert np.polyfit(time, angles / (2 * np.pi), 1)[0] == pytest.approx(rates[record], rel=2e-3)


def test_the_angle_of_the_shaft_begins_with_the_record_after_its_settling(tiny_corpus):
    recipe = corpus_recipe(tiny_corpus)
    for record in (0, 17):
        scenario = stored_scenario(tiny_corpus, record)
        turned = shaft_angles(tiny_corpus, record)[0] - start_of(scenario).shaft
        settling = 2 * np.pi * scenario.record.conditions["shaft"] * recipe.recording.settle_s
        assert turned == pytest.approx(settling, rel=0.02)


def test_a_corpus_that_was_not_generated_has_no_angle_of_the_shaft(tmp_path):
    corpora.write_corpus(tmp_path / "corpus")
    with pytest.raises(CorpusError, match="was not generated"):
        shaft_angles(tmp_path / "corpus", 0)
