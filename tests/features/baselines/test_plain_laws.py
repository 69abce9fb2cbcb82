"""Laws of models as arrays: they predict the bits of scikit-learn, and are read from their file or made again."""

import io
import subprocess
import sys

import numpy as np
import pytest

from features.baselines import Model, estimators
from features.baselines.classifying import estimator_probabilities
from features.baselines.plain import PlainModel
from features.baselines.records import feature_rows
from tests.model_files import make_table


@pytest.fixture
def model(monkeypatch):
    monkeypatch.setattr(estimators, "TREES", 7)
    return Model("ensemble").fit(make_table(6, 400, seed=2))


def test_the_arrays_predict_the_bits_of_scikit_learn(model, tmp_path):
    rows = feature_rows(make_table(6, 300, seed=3), model.features).copy()
    rows.iloc[::7, 2] = np.nan
    model.shorter = Model("ensemble").fit(make_table(6, 200, seed=4).assign(duration=("record", np.full(200, 0.5))))
    PlainModel.of(model).save(tmp_path / "plain.npz")
    plain = PlainModel.read(tmp_path / "plain.npz")
    for arrays, its in ((plain, model), (plain.shorter, model.shorter)):
        np.testing.assert_array_equal(arrays.probabilities(rows.to_numpy()), estimator_probabilities(its, rows, ""))
        for name in ("name", "classes", "features", "groups", "band", "durations", "calibration"):
            assert getattr(arrays, name) == getattr(its, name)


def test_a_file_that_is_missing_or_damaged_is_no_model(model, tmp_path):
    path = tmp_path / "plain.npz"
    assert PlainModel.read(path) is None
    PlainModel.of(model).save(path)
    whole = path.read_bytes()
    for damaged in (b"", b"x" * 100, whole[: len(whole) // 2], whole[:-30]):
        path.write_bytes(damaged)
        assert PlainModel.read(path) is None
    with np.load(io.BytesIO(whole)) as file:
        held = dict(file)
    for other in ({"a": np.zeros(3)}, held | {"more": np.zeros(3)}, {name: held[name] for name in list(held)[1:]}):
        np.savez(path, **other)
        assert PlainModel.read(path) is None


def test_a_diagnosis_with_arrays_imports_neither_scikit_learn_nor_xarray():
    code = (
        "import sys, features.diagnosis.answer; print(*({'sklearn', 'skops', 'xarray', 'pandas'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip() == ""
