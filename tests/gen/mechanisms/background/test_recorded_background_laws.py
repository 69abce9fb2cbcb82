"""Laws of a recording as background: what is mixed, which segments a specimen has, and files that do not fit."""

import json
import shutil
from copy import deepcopy
from pathlib import Path

import numpy as np
import pytest

import gen
from features.auditing import audit_splits
from gen.corpus import read_manifest, sha256
from gen.recipe import read_recipe
from gen.recipe.reading import recipe_hash
from gen.support.errors import RecipeError
from raceway import copy
from raceway.sharing import describe
from tests.same_corpora import assert_the_same_corpus

FS, SEGMENT = 12_000.0, 1200
LICENCE = "CC-BY-4.0"
CHANGES = {
    "corpus.rigs": 2,
    "recording.converter": {"kind": "float32"},
    "level": {"kind": "physical", "gain": 2, "background_m_s2": 3},
}


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    """A corpus of three healthy records of 0.55 s, five segments each."""
    signals = np.random.default_rng(1).standard_normal((3, 6600)) * np.array([[1.0], [2.0], [0.5]])
    labels = {"fault": ["healthy"] * 3, "specimen": [0] * 3}
    return gen.write_corpus(signals, tmp_path_factory.mktemp("recording") / "pump.nc", fs=FS, labels=labels)


@pytest.fixture
def keys(recording, write_recipe, tmp_path):
    """Keys of a recipe with the recording as background, and some changes."""

    def changed(changes=None, **of_recording):
        recorded = {"file": str(recording), "sha256": sha256(recording), "stretches": 12, "licence": LICENCE}
        background = {"background": {"recording": recorded | of_recording}}
        return write_recipe(tmp_path / "recorded.yaml", deepcopy(CHANGES | background | (changes or {})))

    return changed


def segments_of(recording):
    """All segments over the rms of the recording, shape (segment, time)."""
    with gen.open_corpus(recording) as corpus:
        signals = corpus.acceleration.values[:, 0].astype(float)
    whole = signals / np.sqrt(np.mean(signals**2))
    return whole[:, : whole.shape[1] // SEGMENT * SEGMENT].reshape(-1, SEGMENT)


def records_of(recipe):
    read = read_recipe(recipe)
    return gen.simulate(gen.draw_scenarios(read))


def test_a_healthy_record_is_a_segment_and_a_faulty_one_a_segment_and_what_the_fault_adds(keys, recording):
    faults = [{"kind": "healthy", "weight": 2}, {"kind": "inner", "width_mm": 0.5}, {"kind": "ball", "width_mm": 0.5}]
    pairs = {"corpus.rungs": [0, 1], "corpus.specimens_per_rig": 6, "faults": faults}
    records, segments = records_of(keys(pairs)), segments_of(recording)
    silent = records_of(keys(pairs | {"background": {}, "level.background_m_s2": 0}))
    signal = records.acceleration.values[:, 0].astype(float)
    alone = silent.acceleration.values[:, 0].astype(float)
    for place in np.flatnonzero(records.rung.values == 1):
        twin, added = signal[place - 1], signal[place] - signal[place - 1]
        nearest = np.abs(segments - twin / (2 * 3)).max(axis=1).argmin()
        np.testing.assert_allclose(twin, 2 * 3 * segments[nearest], atol=1e-5)
        np.testing.assert_allclose(added, alone[place] - alone[place - 1], atol=1e-4 * np.abs(added).max())
        over = 20 * np.log10(np.sqrt(np.mean(added**2) / np.mean(twin**2)))
        assert float(records.fault_snr[place]) == pytest.approx(over, abs=1e-2)
    healthy = records.isel(record=records.fault.values == 0)
    assert np.isnan(healthy.fault_snr).all()
    assert not healthy.detectable.any()


@pytest.mark.parametrize("ratio", [-40.0, 20.0])
def test_a_drawn_ratio_is_that_of_the_fault_over_the_segment(keys, ratio):
    level = {"kind": "snr", "faulty_db": ratio, "healthy_db": 0, "rms_m_s2": 5}
    records = records_of(keys({"level": level}))
    faulty = records.isel(record=records.fault.values > 0)
    np.testing.assert_allclose(faulty.fault_snr, ratio, atol=1e-3)
    assert (faulty.detectable.values == (ratio > 0)).all()
    np.testing.assert_allclose(np.sqrt((records.acceleration**2).mean(("channel", "elapsed_time"))), 5, rtol=1e-4)


def test_no_segment_is_in_records_of_two_specimens(keys, recording):
    healthy = {"faults": [{"kind": "healthy"}], "corpus.rigs": 3, "corpus.records_per_specimen": 30}
    records, segments = records_of(keys(healthy)), segments_of(recording)
    signal = records.acceleration.values[:, 0].astype(float) / (2 * 3)
    number = np.abs(signal[:, None] - segments).max(axis=2).argmin(axis=1)
    owners = [{*records.specimen.values[number == segment].tolist()} for segment in range(len(segments))]
    assert all(len(specimens) == 1 for specimens in owners)  # and no segment is left out
    assert not [sentence for sentence in audit_splits(records) if "same samples" in sentence]


@pytest.mark.usefixtures("started_processes")
def test_workers_parts_growth_and_replay_give_the_same_records(keys, tmp_path):
    recipe = keys()
    whole = gen.generate(recipe, tmp_path / "whole", records=24)  # rigs beyond those of the recipe
    assert gen.generate(recipe, tmp_path / "two", workers=2, records=24).records == 24
    assert_the_same_corpus(tmp_path / "two", whole)
    gen.generate(recipe, tmp_path / "grown", parts=range(1, 2))
    gen.generate(recipe, tmp_path / "grown")
    gen.generate(recipe, tmp_path / "grown", records=24)
    assert_the_same_corpus(tmp_path / "grown", whole)
    assert all(gen.replay(tmp_path / "whole", record).identical for record in (0, 7, 23))


def test_another_place_of_the_recording_is_no_other_corpus_and_another_recording_is(keys, recording, tmp_path):
    moved = shutil.copyfile(recording, tmp_path / "moved.nc")
    hashes = [recipe_hash(read_recipe(keys(**changes))) for changes in ({}, {"file": str(moved)}, {"sha256": "0" * 64})]
    assert hashes[0] == hashes[1] != hashes[2]


def test_manifest_card_and_copies_name_the_recording(keys, recording, tmp_path):
    sentence = f"Background: cut from the recording pump.nc, SHA-256 {sha256(recording)}, licence {LICENCE}."
    made = gen.generate(keys(), tmp_path / "made").path
    describe(made)
    assert sentence in (made / "README.md").read_text()
    written = gen.write_corpus(records_of(keys()), tmp_path / "written.nc")
    with gen.open_corpus(made) as corpus:
        changed = corpus.assign(acceleration=corpus.acceleration * np.float32(1.5))
        scaled = gen.write_corpus(changed, tmp_path / "scaled")
    copy([made], tmp_path / "copied", where="fault == 'healthy'")
    for corpus in (made, written, scaled, tmp_path / "copied"):
        assert sentence in read_manifest(corpus).basis


@pytest.mark.parametrize(
    ("changes", "of_recording", "sentence"),
    [
        (
            {},
            {"file": "no.nc"},
            f"file: no.nc: there is no {Path.cwd() / 'no.nc'}; run the command in the folder from which its path leads",
        ),
        ({}, {"sha256": "0" * 64}, "is another file than that of sha256; give the right one, or its own sha256"),
        ({"recording.sample_rate_hz": 10_000}, {}, "is sampled at 12000 Hz, and recording.sample_rate_hz is 10000"),
        ({"recording.duration_s": 0.3}, {}, "has 3 segments of 0.3 s, and stretches asks for 12; lower it with"),
        (
            {"recording.channels": [{"name": "a"}, {"name": "b"}]},
            {},
            "has 1 channels, and recording.channels 2; give as many",
        ),
    ],
)
def test_a_recording_that_does_not_fit_is_refused_before_anything_is_written(
    keys, tmp_path, changes, of_recording, sentence
):
    recipe = keys(changes, **of_recording)
    for refuse in (lambda: gen.generate(recipe, tmp_path / "c"), lambda: records_of(recipe)):
        with pytest.raises(RecipeError) as caught:
            refuse()
        assert sentence in str(caught.value)
        assert str(caught.value).startswith("background.recording")
    assert not (tmp_path / "c").exists()


@pytest.mark.parametrize("flaw", ["fault", "silence"])
def test_a_recording_that_is_not_healthy_or_silent_is_refused(keys, tmp_path, flaw):
    signals = np.zeros((2, 12_000)) if flaw == "silence" else np.random.default_rng(0).standard_normal((2, 12_000))
    labels = {"fault": ["healthy", "inner" if flaw == "fault" else "healthy"], "specimen": [0, 1]}
    file = gen.write_corpus(signals, tmp_path / "flawed.nc", fs=FS, labels=labels)
    with pytest.raises(RecipeError, match="has a record that is not healthy, or samples that are no vibration"):
        records_of(keys(file=str(file), sha256=sha256(file)))


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"background.slope": 1}, "background.slope: has no effect with a recording in place of the noise; leave one"),
        ({"truth": {"twins": False}}, "truth.twins: without them it is not known what a fault adds to background"),
        ({"corpus.rigs": 4}, "background.recording.stretches: 12 are too few for 16 specimens, each of which has one"),
        ({"records": 26}, "background.recording.stretches: 12 are too few for 13 specimens, each of which has one"),
    ],
)
def test_keys_that_contradict_a_recording_are_refused(keys, changes, sentence):
    with pytest.raises(RecipeError) as caught:
        read_recipe(keys(changes))
    assert sentence in str(caught.value)


def test_a_scenario_tells_the_recording_and_no_more_of_the_disk(keys, recording):
    (scenario, *_) = gen.draw_scenarios(read_recipe(keys()))
    stored = json.loads(gen.simulate([scenario]).draws.item())["background"]["recording"]
    assert stored["file"] == str(recording)
    assert stored["sha256"] == sha256(recording)
