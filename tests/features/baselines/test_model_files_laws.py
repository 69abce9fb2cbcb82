"""Laws of model files: a loaded model predicts the same, and other files are refused in one sentence."""

import json
from pathlib import Path

import numpy as np
import pytest
import skops.io
from sklearn.base import BaseEstimator

from features.baselines import ESTIMATORS, Model, estimators, predict
from features.baselines.model_file import TRUSTED, read_model_file
from features.baselines.models import FORMAT
from gen.support.errors import CorpusError
from tests.model_files import Archive, make_table, write_models


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


@pytest.mark.parametrize("name", list(ESTIMATORS))
def test_a_model_trained_again_and_a_loaded_one_predict_the_same(tmp_path, name, monkeypatch):
    monkeypatch.setattr(estimators, "TREES", 3)
    table = make_table(6, 61, seed=2).isel(record=np.arange(61) != 5)
    model = Model(name, seed=2).fit(table)
    model.save(tmp_path / "m")
    loaded, again = Model.load(tmp_path / "m"), Model(name, seed=2).fit(table)
    for other in (loaded, again):
        np.testing.assert_array_equal(predict(table, other).probabilities, predict(table, model).probabilities)
    assert (loaded.seed, loaded.features, loaded.calibration) == (2, model.features, model.calibration)


def test_the_trusted_types_are_those_of_models(files):
    held = set()
    for path in files.values():
        found = [part for part in Archive(path).values() if isinstance(part, dict) and "__class__" in part]
        held |= {f"{part['__module__']}.{part['__class__']}" for part in found}
    assert set(TRUSTED) <= held


class Foreign(BaseEstimator):
    """An estimator of another project."""


def test_a_model_with_a_foreign_type_is_refused_by_name(tmp_path):
    (tmp_path / "m").write_bytes(skops.io.dumps({"raceway_model": 4, "estimator": Foreign()}))
    assert "test_model_files_laws.Foreign, which no model of raceway contains" in refusal(tmp_path / "m")


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


@pytest.mark.parametrize("share", [0.1, 0.5, 0.99])
def test_a_truncated_model_is_refused(files, tmp_path, share):
    content = files["ensemble"].read_bytes()
    (tmp_path / "m").write_bytes(content[: int(share * len(content))])
    assert "not a readable model" in refusal(tmp_path / "m")


def test_a_missing_file_and_a_folder_are_no_models(tmp_path):
    assert "no such file; give a model made with raceway train" in refusal(tmp_path / "none.skops")
    assert "not a file" in refusal(tmp_path)


def test_a_model_of_another_version_of_scikit_learn_is_refused(files, tmp_path):
    archive = Archive(files["svm"])
    for place in archive.places("_sklearn_version"):
        place["content"] = json.dumps("0.1")
    assert "was trained with scikit-learn 0.1, and " in refusal(archive.write(tmp_path / "m"))


def test_a_model_larger_than_the_limit_is_refused(files, monkeypatch):
    monkeypatch.setenv("RACEWAY_LIMITS", "file_bytes=5000")
    assert "raceway --limit file_bytes=NUMBER" in refusal(files["extra_trees"])


def test_the_model_for_shorter_records_is_in_the_same_file(tmp_path):
    model = Model("logistic_regression").fit(make_table())
    model.shorter = Model("logistic_regression", seed=1).fit(make_table(seed=1))
    model.save(tmp_path / "m")
    loaded, table = Model.load(tmp_path / "m").shorter, make_table(seed=2)
    assert loaded.shorter is None
    np.testing.assert_array_equal(loaded.predict_proba(table), model.shorter.predict_proba(table))


def test_a_model_file_holds_no_pickle(files):
    members = Archive(files["ensemble"]).members
    assert all(name.endswith(".npy") for name in members)
