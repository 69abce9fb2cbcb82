"""Laws of early warning: the rate of false alarms that was asked for, delays that the feature allows, and bearings that are missed."""

import numpy as np
import pytest
import xarray as xr
from sklearn.dummy import DummyClassifier
from sklearn.neighbors import KNeighborsClassifier

from gen.corpus import FAULTS
from gen.corpus.schema import identity
from gen.support.errors import CorpusError
from raceway.lives.early_warning import warn_early

HOUR = 3600.0
BEGUN, SEEN, END = 400, 450, 600  # h, one snapshot each


def table(seed, rises_at=SEEN, bearings=30, rise=20.0):
    """Lives in which ``raw_kurtosis`` jumps at some hour, beside a feature that is noise; all spalls can be seen from the same hour on."""
    rng = np.random.default_rng(seed)
    age = np.tile(np.arange(END) * HOUR, bearings)
    hours, specimen = age / HOUR, np.repeat(np.arange(bearings), END)
    features = rng.standard_normal((len(age), 2))
    features[:, 0] += rise * (hours >= rises_at)
    columns = {
        "age": age, "rul": (END - hours) * HOUR, "event": np.ones(len(age), int), "rig": 0 * specimen, "specimen": specimen,
        "stage": (hours >= BEGUN).astype(int),
        "fault": np.where(hours >= BEGUN, FAULTS.index("outer"), FAULTS.index("healthy")),
        "first_detectable_time": np.full(len(age), SEEN * HOUR),
        "identity": np.array([identity(f"{seed}", 0, *some) for some in zip(specimen, hours.astype(int), strict=True)]),
    }  # fmt: skip
    return xr.Dataset(
        {"features": (("record", "feature"), features), "feature": ["raw_kurtosis", "noise"]}
        | {name: ("record", values) for name, values in columns.items()}
    ).isel(record=rng.permutation(len(age)))


@pytest.mark.parametrize("rate", [1.0, 20.0])
@pytest.mark.parametrize("estimator", ["logistic_regression", KNeighborsClassifier(100, weights="distance")])
def test_other_bearings_give_the_false_alarms_that_were_asked_for(rate, estimator):
    """The neighbours are sure of their own snapshots: a threshold on these would let nearly all others exceed it."""
    tables = (table(seed, bearings=60, rise=1.0) for seed in (0, 1))
    warned = warn_early(*tables, alarms_per_1000_h=rate, estimator=estimator)
    expected = rate * 60 * BEGUN / 1000
    for alarms in warned.alarms_per_1000_h:
        assert alarms * 60 * BEGUN / 1000 == pytest.approx(expected, abs=5 * np.sqrt(2 * expected))


@pytest.mark.parametrize("late", [0, 30])
def test_the_delay_is_that_of_the_feature_beyond_the_first_snapshot_that_shows_it(late):
    warned = warn_early(table(2, SEEN + late), alarms_per_1000_h=0, estimator="logistic_regression")
    assert warned.delay["raw_kurtosis"] == late * HOUR
    assert warned.time_left["raw_kurtosis"] == pytest.approx(1 - late / (END - 1 - SEEN))
    assert warned.missed["raw_kurtosis"] == 0
    assert warned.delay["logistic_regression"] <= late * HOUR


def test_a_feature_that_never_rises_misses_every_bearing():
    warned = warn_early(table(3, END), alarms_per_1000_h=0, estimator="majority")
    assert warned.missed.min() > 0.9


def by_hand(corpus, lives, seen_from):
    """Lives of an hour between snapshots, spalled from the fifth on, with the values of ``raw_kurtosis`` that are listed."""
    hours, number = np.tile(np.arange(10), len(lives)), np.repeat(np.arange(len(lives)), 10)
    columns = {
        "age": hours * HOUR, "rul": (10 - hours) * HOUR, "event": np.ones(len(hours), int), "rig": 0 * number, "specimen": number,
        "stage": (hours >= 5).astype(int), "fault": np.where(hours >= 5, FAULTS.index("ball"), FAULTS.index("healthy")),
        "first_detectable_time": np.repeat(seen_from, 10) * HOUR,
        "identity": np.array([identity(corpus, 0, *some) for some in zip(number, hours, strict=True)]),
    }  # fmt: skip
    return xr.Dataset(
        {"features": (("record", "feature"), np.concatenate(lives)[:, None].astype(float)), "feature": ["raw_kurtosis"]}
        | {name: ("record", values) for name, values in columns.items()}
    )


TRAINED = by_hand("a", [[1, 2, 3, 4, 9, 0, 0, 0, 0, 0], [1, 2, np.nan, 4, 8, 0, 0, 0, 0, 0]], [5.0, 5.0])
"""Eight hours without a spall, in which an alarm in eight hours is allowed: the threshold is 8."""
TRIED = by_hand(
    "b",
    [
        [0, 9, 9, 0, 0, 0, 9, 0, 0, 0],  # seen at 5 h, alarm at 6 h: three of four hours are left
        [
            0,
            0,
            0,
            0,
            0,
            9,
            0,
            0,
            9,
            0,
        ],  # seen at 6 h, alarm at 8 h, one of three hours is left: the alarm before is by chance
        [0, 0, 0, 0, 0, 8, 8, 8, 8, 8],  # no alarm
        [0, 0, 0, 0, 0, 9, 9, 9, 9, 9],  # never seen
    ],
    [5.0, 6.0, 5.0, np.nan],
)


def test_alarms_and_delays_are_those_that_one_counts_by_hand():
    (row,) = warn_early(TRAINED, TRIED, alarms_per_1000_h=125, estimator="majority").iloc[:1].itertuples()
    assert row.alarms_per_1000_h == pytest.approx(1000 * 2 / 16)  # two in sixteen hours
    assert row.missed == pytest.approx(1 / 3)
    assert (row.delay, row.delay_90) == pytest.approx((1.5 * HOUR, 1.9 * HOUR))
    assert row.time_left == pytest.approx((3 / 4 + 1 / 3) / 2)
    assert row.allowed == pytest.approx(1)


def test_a_snapshot_of_unknown_stage_is_neither_healthy_nor_faulty():
    """Loud ones of unknown stage would raise the threshold."""
    louder = table(5).copy(deep=True)
    unknown = louder["age"].values < 50 * HOUR
    louder["features"].values[unknown, 0] = 40.0
    louder["stage"].values[unknown] = 3
    options = {"alarms_per_1000_h": 0, "estimator": "logistic_regression"}
    warned, without = (warn_early(of, table(6), **options) for of in (louder, louder.isel(record=~unknown)))
    assert warned.drop(columns="allowed").equals(without.drop(columns="allowed"))
    assert (warned.missed == 0).all()


def test_no_classifier_learns_from_snapshots_of_unknown_stage():
    fitted_to = []

    class Recorder(DummyClassifier):
        def fit(self, X, y):
            fitted_to.append(X["raw_kurtosis"])
            return super().fit(X, y)

    first = TRAINED["features"].values[:, 0] == 1  # of each bearing
    for stage, learnt in (
        (TRAINED["stage"], [1, 1, 2]),
        (TRAINED["stage"].where(xr.DataArray(~first, dims="record"), 3), [0, 0, 0]),
    ):
        fitted_to.clear()
        warn_early(TRAINED.assign(stage=stage), TRIED, estimator=Recorder)
        # a fit for each bearing that is held out for the threshold, and one to both
        assert [int((values == 1).sum()) for values in fitted_to] == learnt


@pytest.mark.parametrize(
    ("trained", "tested", "options", "sentence"),
    [
        (table(4).drop_vars("first_detectable_time"), None, {}, r"early warning needs simulated lives with truth\.twins: true"),
        (TRAINED, TRIED.assign(first_detectable_time=np.nan * TRIED["age"]), {}, "the table of the tested bearings: knows of no spall"),
        (TRAINED.drop_vars("stage"), None, {}, "the feature table: has no lives"),
        (TRAINED, TRIED.drop_vars("stage"), {}, "the table of the tested bearings: has no lives"),
        (TRAINED, None, {"folds": 2}, "^a training has one bearing; use more bearings"),
        (TRAINED.isel(record=slice(10)), TRIED, {}, "^a training has one bearing; use more bearings"),
        (TRAINED.assign(stage=TRAINED["stage"] + 1), TRIED, {}, "has no snapshot before spalls begin"),
        (TRAINED.assign(fault=0 * TRAINED["fault"]), TRIED, {}, "has no two classes to tell apart"),
        (TRAINED, TRIED.isel(record=TRIED["age"].values < 5 * HOUR), {}, "no tested bearing has a spall that can be seen"),
        (TRAINED, TRIED.assign(feature=["rms"]), {}, "have other features than those of the training"),
        (TRAINED.isel(record=slice(0, None, 2)), TRAINED.isel(record=slice(1, None, 2)), {}, r"among those of the training \(a/0/0\)"),
        *((TRIED, None, {"folds": folds}, "folds: .* is not a whole number from 2 to 4") for folds in (1, 2.5, 5)),
        *((TRAINED, TRIED, {"alarms_per_1000_h": rate}, "is not a finite number from 0") for rate in (-1, np.nan, np.inf, "1", None)),
    ],
)  # fmt: skip
def test_what_gives_no_early_warning_is_refused_in_a_sentence(trained, tested, options, sentence):
    with pytest.raises(CorpusError, match=sentence):
        warn_early(trained, tested, estimator="majority", **options)
