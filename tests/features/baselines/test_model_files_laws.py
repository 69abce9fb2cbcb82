"""Laws of model files: a loaded model predicts the same, and other files are refused in one sentence; durations."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import skops.io
from hypothesis import given
from hypothesis import strategies as st

from features.baselines import ESTIMATORS, Model, estimators, predict
from features.baselines.classifying import SAME_DURATION, suited, suited_to
from features.baselines.model_file import TRUSTED, read_model_file
from features.baselines.models import FORMAT
from features.table.durations import durations_of
from gen.support.errors import CorpusError
from tests.model_files import Archive, make_table, write_models
from tests.tone_corpora import write_corpus


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> dict[str, Path]:
    """A model file of every estimator."""
    return write_models(tmp_path_factory.mktemp("models"), 3)


def refusal(path: Path) -> str:
    """The sentence that a model file is refused with."""
    with pytest.raises(CorpusError) as caught:
        Model.load(path)
    sentence = str(caught.value)
    assert sentence.startswith(f"{path}: ")
    assert "\n" not in sentence
    return sentence


@pytest.mark.usefixtures("few_trees")
@pytest.mark.parametrize("name", list(ESTIMATORS))
def test_a_model_trained_again_and_a_loaded_one_predict_the_same_also_without_some_features(
    tmp_path, name, monkeypatch
):
    monkeypatch.setattr(estimators, "ROUNDS", 3)
    whole = make_table(3, 60, seed=2).assign(recording=("record", np.arange(60) // 4))
    holed = whole.copy(deep=True)
    holed["features"][::5] = np.nan
    holed["features"][:, 2] = np.nan
    for table in (whole, holed):
        model = Model(name, seed=2).fit(table)
        model.save(tmp_path / "m")
        loaded, again, known = Model.load(tmp_path / "m"), Model(name, seed=2).fit(table), predict(holed, model)
        for found in (predict(holed, loaded), predict(holed, again)):
            np.testing.assert_array_equal(found.probabilities, known.probabilities)
            assert (found.answers, found.by_recording.answers) == (known.answers, known.by_recording.answers)
        for field in ("name", "classes", "features", "groups", "corpus", "records", "seed", "calibration"):
            assert getattr(loaded, field) == getattr(model, field)
    assert [path.name for path in tmp_path.iterdir()] == ["m"]


@given(data=st.data())
def test_a_damaged_model_is_refused_in_one_sentence_or_unchanged(files, data):
    path, table = files["logistic_regression"], make_table()
    content, place = bytearray(path.read_bytes()), data.draw(st.integers(0, path.stat().st_size - 1))
    damaged, cut = path.with_name("damaged.skops"), data.draw(st.booleans())
    if cut:
        del content[place:]
    else:
        content[place] ^= data.draw(st.integers(1, 255))
    damaged.write_bytes(content)
    try:
        found = Model.load(damaged)
    except CorpusError as error:
        found, sentence = None, str(error)
    if found is None:
        assert re.fullmatch(rf"{damaged}: .*", sentence)
    else:
        assert not cut
        np.testing.assert_array_equal(found.predict_proba(table), Model.load(path).predict_proba(table))


def test_the_trusted_types_are_those_of_models(files):
    held = set()
    for path in files.values():
        found = [part for part in Archive(path).values() if isinstance(part, dict) and "__class__" in part]
        held |= {f"{part['__module__']}.{part['__class__']}" for part in found}
    assert set(TRUSTED) <= held


def test_a_type_that_is_renamed_in_the_file_is_refused_by_name(files, tmp_path):
    archive = Archive(files["svm"])
    archive.field("estimator").update({"__module__": "os", "__class__": "system"})
    assert "holds os.system, which no model of raceway contains" in refusal(archive.write(tmp_path / "m"))


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "not a readable model"),
        (b"\x80\x04K*.", "not a readable model"),
        (skops.io.dumps({"raceway_model": 99}), "not a model of this version"),
        (skops.io.dumps([1, 2]), "not a model of this version"),
        (skops.io.dumps({"raceway_model": FORMAT, "estimator": 3}), "not a complete model"),
    ],
)
def test_a_file_that_is_no_model_is_refused(content, sentence, tmp_path):
    (tmp_path / "m").write_bytes(content)
    assert sentence in refusal(tmp_path / "m")


@pytest.mark.parametrize("part", ["relative", "shorter"])
@pytest.mark.parametrize("value", [3, "text", [1, 2], {"name": "svm"}])
def test_a_part_that_is_no_model_is_refused(files, tmp_path, part, value):
    content = read_model_file(files["svm"]) | {part: value}
    (tmp_path / "m").write_bytes(skops.io.dumps(content))
    assert "not a complete model" in refusal(tmp_path / "m")


def test_a_classifier_that_is_no_baseline_is_refused_before_the_fit_and_in_a_file(files, tmp_path):
    with pytest.raises(ValueError, match="estimator: 'rf' is no baseline; choose from majority, "):
        Model("rf")
    for name in ("rf", ["svm"]):
        (tmp_path / "m").write_bytes(skops.io.dumps(read_model_file(files["svm"]) | {"name": name}))
        assert "not a complete model" in refusal(tmp_path / "m")


@pytest.mark.parametrize(
    ("packed", "sentence"),
    [
        (b"PK", "not a readable model"),
        (skops.io.dumps({"name": "svm"}), "not a complete model"),
        (skops.io.dumps({"name": Path()}), "holds pathlib.PosixPath, which no model of raceway contains"),
    ],
)
def test_a_damaged_part_is_refused_when_it_is_used(files, tmp_path, packed, sentence):
    content = read_model_file(files["svm"]) | {"wide": packed}
    (tmp_path / "m").write_bytes(skops.io.dumps(content))
    model = Model.load(tmp_path / "m")
    assert model.shorter is None
    with pytest.raises(CorpusError, match=f"m: {sentence}"):
        _ = model.wide


def test_a_model_of_another_version_of_scikit_learn_is_refused(files, tmp_path):
    archive = Archive(files["svm"])
    for place in archive.places("_sklearn_version"):
        place["content"] = json.dumps("0.1")
    assert "was trained with scikit-learn 0.1, and " in refusal(archive.write(tmp_path / "m"))


def test_a_model_larger_than_the_limit_is_refused(files, monkeypatch):
    monkeypatch.setenv("RACEWAY_LIMITS", "file_bytes=5000")
    assert "raceway --limit file_bytes=NUMBER" in refusal(files["extra_trees"])


@pytest.mark.parametrize("part", ["shorter", "wide"])
def test_models_for_other_records_are_in_the_same_file(part, tmp_path):
    model, other = (Model("logistic_regression", seed=seed).fit(make_table(seed=seed)) for seed in (0, 1))
    replace(model, **{part: other}).save(tmp_path / "m")
    loaded, table = getattr(Model.load(tmp_path / "m"), part), make_table(seed=2)
    assert (loaded.shorter, loaded.wide) == (None, None)
    np.testing.assert_array_equal(loaded.predict_proba(table), other.predict_proba(table))


def test_a_model_file_holds_no_pickle(files):
    members = Archive(files["ensemble"]).members
    assert all(name.endswith(".npy") for name in members)


@given(st.lists(st.floats(0.01, 100), max_size=4), st.floats(0, 50_000))
def test_shorter_records_and_those_of_a_wider_band_have_models_of_their_own(durations, highest):
    short, wide = Model(durations=(0.5, 0.5)), Model(durations=(2.0, 2.0), band=(300.0, 9000.0))
    model = Model(durations=(2.0, 2.0), shorter=short, wide=wide)
    below = bool(durations) and min(durations) < 2 / SAME_DURATION
    assert suited(model, durations, highest) is (short if below else wide if highest >= 9000 else model)
    assert suited(short, durations, highest) is short
    assert suited(replace(model, wide=None), durations, highest).band == (300.0, 5000.0)


@pytest.mark.parametrize(("rate", "band"), [(12_000.0, (300.0, 5000.0)), (20_000.0, (300.0, 9000.0))])
def test_features_of_a_corpus_are_computed_in_the_widest_band_that_its_rate_allows(rate, band, tmp_path):
    write_corpus(tmp_path / "c", sample_rate=np.full(48, rate))
    model = Model(durations=(0.1, 0.1), wide=Model(durations=(0.1, 0.1), band=(300.0, 9000.0)))
    assert suited_to(model, tmp_path / "c").band == band


def test_a_table_tells_its_shortest_and_longest_duration_or_none():
    table = make_table()
    told = table.assign(duration=("record", [0.5, 2.0, 1.0] * 8))
    assert (durations_of(table), durations_of(told), durations_of(told.isel(record=[]))) == ((), (0.5, 2.0), ())
