"""Laws of predictions: the same from tables in any order, and calibrated on groups outside the training."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from features.baselines import UNSURE, Model, predict
from features.baselines.calibration import UNCALIBRATED
from features.baselines.cross_calibration import calibration_splits, fit_and_calibrate
from features.baselines.records import features_of, labelled_records
from tests.model_files import make_table

pytestmark = pytest.mark.usefixtures("few_trees")


def windowed(records: int = 96, windows: int = 4, seed: int = 0, rigs: int = 6) -> xr.Dataset:
    """Table of recordings of several windows each; every recording has its own specimen."""
    table = make_table(3, records, seed)
    recording = np.arange(records) // windows
    known = {"fault": recording % 3, "specimen": recording, "recording": recording, "rig": recording // 3 % rigs}
    table = table.assign({name: ("record", values) for name, values in known.items()})
    shift = known["fault"] - np.arange(records) % 3
    return table.assign(features=table.features + xr.DataArray(shift, dims="record"))


def test_the_order_of_the_records_of_a_table_does_not_matter():
    model, table = Model().fit(windowed()), windowed(seed=1)
    order = np.random.default_rng(0).permutation(table.sizes["record"])
    straight, shuffled = predict(table, model), predict(table.isel(record=order), model)
    np.testing.assert_allclose(shuffled.probabilities, straight.probabilities[order])
    assert straight.by_recording is not None
    assert shuffled.by_recording is not None
    np.testing.assert_allclose(shuffled.by_recording.probabilities, straight.by_recording.probabilities)
    one, other = model.score(table), model.score(table.isel(record=order))
    assert (one.confusion, one.coverage, one.interval) == (other.confusion, other.coverage, other.interval)
    assert other.log_loss == pytest.approx(one.log_loss)


def test_labels_change_no_probability():
    model, table = Model().fit(windowed()), windowed(seed=1)
    other = table.assign(fault=("record", (table.fault.values + 1) % 3))
    np.testing.assert_array_equal(predict(other, model).probabilities, predict(table, model).probabilities)


def test_predictions_are_those_that_are_scored():
    model, table = Model("logistic_regression").fit(windowed()), windowed(seed=1)
    found, scores = predict(table, model), model.score(table)
    right = np.array(found.predicted) == np.array(model.classes)[table.fault.values]
    assert scores.accuracy == pytest.approx(right.mean())
    assert scores.coverage == np.mean([answer != UNSURE for answer in found.answers])
    assert scores.answered_accuracy == pytest.approx(right[found.answered].mean())
    assert scores.by_recording is not None
    assert scores.by_recording.records == len(np.unique(table.recording))


@pytest.mark.parametrize(("rigs", "by", "folds"), [(6, "rig", 3), (2, "rig", 2), (1, "specimen", 3)])
def test_rigs_are_kept_together_if_each_class_is_on_enough_of_them(rigs, by, folds):
    table = windowed(rigs=rigs)
    records = labelled_records(table, features_of(table, ("lines",)))
    found = calibration_splits(records, 0)
    assert found is not None
    assert (found[0], len(found[1])) == (by, folds)
    for trained, tested in found[1]:
        assert not set(getattr(records, by)[trained]) & set(getattr(records, by)[tested])
        assert set(records.fault[trained]) == set(records.fault)


class Witness:
    """A classifier that fails if it is asked for a record that it was trained on, or for one of its rig."""

    def fit(self, X, y):
        self.rigs = set(X["rig"])
        self.classes_ = np.unique(y)
        return self

    def predict_proba(self, X):
        if self.rigs & set(X["rig"]):
            raise AssertionError
        return np.full((len(X), len(self.classes_)), 1 / len(self.classes_))

    def predict(self, X):
        return self.classes_[self.predict_proba(X).argmax(axis=1)]


def test_no_record_that_calibrates_was_trained_on():
    table = windowed()
    records = labelled_records(table, features_of(table, ("lines",)))
    records = records._replace(features=records.features.assign(rig=records.rig))
    assert fit_and_calibrate(records, Witness, 0)[1].by == "rig"


def test_without_enough_specimens_and_without_training_nothing_is_calibrated():
    few = windowed(24).isel(record=slice(0, 24))
    assert Model("svm").fit(few.assign(specimen=few.specimen % 3, rig=few.rig * 0)).calibration == UNCALIBRATED
    for name in ("majority", "envelope_rule"):
        assert Model(name).fit(windowed()).calibration == UNCALIBRATED


def test_calibration_improves_the_log_loss_of_records_outside_the_training():
    model, other = Model("svm").fit(windowed(480, rigs=40)), windowed(480, seed=1)
    plain = replace(model, calibration=UNCALIBRATED).score(other)
    assert model.score(other).log_loss < plain.log_loss
    assert model.score(other).ece < plain.ece


def test_a_recording_is_predicted_from_the_mean_features_of_its_records():
    model, table = Model("logistic_regression").fit(windowed()), windowed(seed=1)
    found = predict(table, model)
    means = table["features"].values.reshape(-1, 4, table.sizes["feature"]).mean(axis=1)
    kept = table.isel(record=slice(None, None, 4)).assign(features=(("record", "feature"), means))
    assert found.by_recording is not None
    whole = found.by_recording.probabilities[found.recording[::4]]
    np.testing.assert_allclose(whole, predict(kept, model).probabilities)


def channels(*tables: xr.Dataset) -> xr.Dataset:
    """Table of several channels of the same records."""
    return tables[0].assign(features=xr.concat([table["features"] for table in tables], "channel"))


def test_the_same_channel_twice_tells_no_more_than_once():
    model, table = Model().fit(windowed()), windowed(seed=1)
    alone, twice = predict(table, model), predict(channels(table, table), model)
    np.testing.assert_allclose(twice.probabilities, alone.probabilities)
    one, other = model.score(table), model.score(channels(table, table))
    assert (other.confusion, other.records) == (one.confusion, one.records)
    assert model.score(channels(windowed(), windowed())).seen == 96
