"""Fits in processes: the same models and scores for any number of workers, and progress that ends."""

import time

import numpy as np
import pytest
import xarray as xr

from features.baselines import Model, benchmark, predict
from features.table.definitions import feature_coordinates


@pytest.fixture(scope="module", autouse=True)
def few_resamples():
    """Worker processes take as many as usual."""


@pytest.fixture(scope="module")
def table():
    """Six rigs with four specimens of three records, two of them healthy; the fault shifts all features."""
    rng, record, coordinates = np.random.default_rng(3), np.arange(72), feature_coordinates()
    rig, specimen, width = record // 12, record // 3, len(coordinates["feature"][1])
    fault = np.array([0, 0, 1, 2])[specimen % 4]
    values = rng.standard_normal((len(record), width)) + np.outer(fault, rng.standard_normal(width))
    columns = {"rig": rig, "specimen": specimen, "recording": record, "fault": fault, "shaft_rate": 20.0 + record % 7}
    return xr.Dataset(
        {"features": (("record", "feature"), values)} | {name: ("record", held) for name, held in columns.items()},
        coordinates,
        {"title": "Six rigs"},
    )


@pytest.mark.usefixtures("started_processes")
def test_predictions_do_not_depend_on_the_number_of_workers(table):
    models = [Model("svm").fit(table, workers=workers) for workers in (1, 2)]
    for reference in (None, table):
        first, *others = (predict(table, model, reference) for model in models)
        for other in others:
            np.testing.assert_array_equal(other.probabilities, first.probabilities)
            assert other.answers == first.answers


@pytest.mark.usefixtures("started_processes")
def test_scores_do_not_depend_on_the_number_of_workers(table):
    def scores(workers):
        other = table.assign(features=-table.features)
        return benchmark(table, other, estimators={"e": "logistic_regression"}, folds=2, workers=workers)

    assert scores(2) == scores(1)


def test_a_classifier_of_the_user_is_fitted_once_at_a_time(table):
    """Libraries of neural networks keep one random generator per process."""
    under_way, most = [], []

    class Alone:
        def fit(self, X, y):  # noqa: ARG002
            under_way.append(self)
            most.append(len(under_way))
            time.sleep(0.02)  # long enough for another fit to begin
            self.constant = np.unique(y)[0]
            under_way.remove(self)
            return self

        def predict(self, X):
            return np.repeat(self.constant, len(X))

    Model(Alone).fit(table, workers=4)
    assert set(most) == {1}
    assert len(most) > 1
