"""Laws of the baselines: splits without leaks, reproducible scores, and model files that are refused if damaged."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from features.baselines import ESTIMATORS, Model, benchmark, cross_validate
from features.baselines.estimators import class_probabilities
from features.baselines.records import features_of, labelled_records
from features.baselines.splits import control_cases, grouped_case, permuted_labels, score_splits
from features.baselines.tracks import check_taught, grouped_splits
from features.table.class_features import COMBS, EVIDENCE, class_features
from gen.corpus import FAULTS
from gen.support.errors import CorpusError

NAMES = (*EVIDENCE, *(f"whitened_line_{n}" for n in range(3)), "raw_kurtosis", "raw_crest_factor")
GROUPS = ("lines",) * (len(NAMES) - 2) + ("shape",) * 2
TELLING = {name: class_features(name) for name in FAULTS} | {"compound": (COMBS["inner"], COMBS["outer"])}
pytestmark = pytest.mark.usefixtures("few_trees")
FOUR = FAULTS[:4]  # a recipe need not have all classes


def make_table(
    specimens: int = 20,
    records: int = 4,
    *,
    told: float = 2.0,
    signature: float = 0.0,
    windows: int = 1,
    classes: int = 4,
    rigs: int = 5,
    seed: int = 0,
) -> xr.Dataset:
    """A feature table whose lines depend on the fault by ``told`` and whose other features on the specimen by ``signature``.

    Each recording is cut into ``windows`` records.
    """
    rng = np.random.default_rng(seed)
    specimen = np.repeat(np.arange(specimens), records)
    fault = (specimen % classes).astype(np.int8)
    features = 0.5 + 0.3 * rng.standard_normal((len(specimen), len(NAMES)))
    for name, columns in TELLING.items():
        for column in columns:
            features[:, NAMES.index(column)] += told * (fault == FAULTS.index(name))
    features[:, 3:] += signature * rng.standard_normal((specimens, len(NAMES) - 3))[specimen]
    known = {
        "fault": fault,
        "rig": specimen // classes % rigs,
        "specimen": specimen,
        "recording": np.arange(len(specimen)) // windows,
    }
    return xr.Dataset(
        {"features": (("record", "feature"), features), **{key: ("record", value) for key, value in known.items()}},
        {"feature": np.array(NAMES, dtype=object), "group": ("feature", np.array(GROUPS, dtype=object))},
        {"title": "a made-up corpus"},
    )


def records_of(table: xr.Dataset):
    return labelled_records(table, features_of(table, ("lines", "shape")))


def test_equal_numbers_on_different_rigs_are_different_specimens():
    table = make_table(8, 3)
    again = table.assign(specimen=table.specimen % 4, recording=table.recording * 0)
    assert len(np.unique(records_of(again).specimen)) == 8
    assert len(np.unique(records_of(again).recording)) == 8


def test_a_recording_of_a_specimen_that_became_faulty_is_another_recording():
    table = make_table(8, 2).assign(specimen=("record", np.repeat(np.arange(4), 4)))
    records = records_of(table.assign(recording=table.recording * 0, rig=table.rig * 0))
    assert len(np.unique(records.specimen)) == 4
    assert len(np.unique(records.recording)) == 8


@given(seed=st.integers(0, 999))
def test_labels_are_permuted_among_whole_specimens(seed):
    found = records_of(make_table(12, 3))
    labels = permuted_labels(found, seed)
    assert sorted(labels) == sorted(found.fault)
    assert all(len(set(labels[found.specimen == number])) == 1 for number in range(12))


def test_each_control_is_stratified_by_the_labels_that_it_scores():
    records = records_of(make_table(24, 3))
    cases = {"grouped": grouped_case(records, "specimen", 3, 7), **control_cases(records, "specimen", 3, 7)}
    assert list(cases) == ["grouped", "leaky", "null"]
    for name, (labels, found) in cases.items():
        group = np.arange(len(labels)) if name == "leaky" else records.specimen
        for one, expected in zip(found, grouped_splits(labels, group, 3, 7), strict=True):
            np.testing.assert_array_equal(one[1], expected[1])
    np.testing.assert_array_equal(cases["null"][0], permuted_labels(records, 7))


def test_a_benchmark_has_every_baseline_with_its_controls_and_is_tested_on_a_corpus_with_fewer_classes():
    table = make_table(4 * len(FAULTS), 3, classes=len(FAULTS))
    results = benchmark(table, make_table(8, 4, windows=2, seed=1), folds=3, seed=5)
    assert list(results.baselines) == list(ESTIMATORS)
    assert results.corpus.classes == dict.fromkeys(FAULTS, 12)
    for name, found in results.baselines.items():
        low, high = (0.0, 1.01 / len(FAULTS)) if name == "majority" else (0.9, 1.0)
        assert low <= found.grouped.balanced_accuracy <= high
        assert len(found.grouped.folds) == 3
        assert found.null.balanced_accuracy < 0.6
        assert found.grouped.classes == found.grouped.model_classes == found.tests[0].model_classes == FAULTS
        assert found.tests[0].classes == FOUR
        assert np.shape(found.tests[0].confusion) == (4, len(FAULTS))
        assert (found.tests[0].by_recording.records, found.tests[0].seen) == (16, 0)


def test_classifiers_are_ranked_on_the_same_resampled_specimens():
    table = make_table(40, 3, told=0.5)
    estimators = dict.fromkeys(("one", "same"), "logistic_regression") | {"lines": "envelope_rule"}
    found = benchmark(table, estimators=estimators, folds=3).baselines
    assert found["one"].behind == found["same"].behind == (0, 0, 0)
    difference, low, high = found["lines"].behind
    assert difference == pytest.approx(
        found["one"].grouped.balanced_accuracy - found["lines"].grouped.balanced_accuracy
    )
    # errors on the same specimens cancel: the two intervals alone would leave more
    alone = [np.ptp(found[name].grouped.interval) for name in ("one", "lines")]
    assert 0 < high - low < sum(alone)
    assert low < difference < high


def test_permuted_labels_of_a_rare_class_are_scored_although_a_fold_trains_none_of_it():
    table = make_table(40, 5, classes=5, rigs=8)
    rare = np.where(np.isin(table.specimen, [0, 20]), FAULTS.index("compound"), table.fault)
    records = records_of(table.assign(fault=("record", rare)))
    untrained = 0
    for seed in range(40):
        labels = permuted_labels(records, seed)
        folds = grouped_splits(labels, records.rig, 5, seed)
        if any(FAULTS.index("compound") not in labels[known] for known, _ in folds):
            untrained += 1
            with pytest.raises(CorpusError, match="a fold has no compound record to train on"):
                check_taught(labels, folds)
            scores, _ = score_splits(records, labels, folds, "envelope_rule", seed)
            assert scores.classes == FAULTS[:6]
    assert untrained > 0


@pytest.mark.parametrize("name", list(ESTIMATORS))
def test_probabilities_sum_to_one_and_their_largest_is_the_prediction(name):
    for classes in (2, 4, 6):
        table = make_table(12, 4, told=0.3, classes=classes)
        model = Model(name).fit(table)
        frame = records_of(table).features
        found = class_probabilities(model.estimator, frame)
        np.testing.assert_allclose(found.sum(axis=1), 1.0)
        np.testing.assert_array_equal(model.estimator.classes_[found.argmax(axis=1)], model.estimator.predict(frame))


def test_records_seen_in_training_are_counted():
    table, other = make_table(), make_table(seed=1)
    model = Model("svm").fit(table)
    assert model.score(table).seen == 80
    assert model.score(other).seen == 0
    assert model.score(xr.concat([other, table.isel(record=[4, 5])], "record")).seen == 2
    for made in (table, other):
        made["features"][:3] = np.nan  # records without any feature are all alike
    assert Model("logistic_regression").fit(table).score(other).seen == 0


def test_records_of_a_class_that_was_not_trained_count_as_errors():
    found = Model("logistic_regression").fit(make_table(classes=2)).score(make_table(classes=4))
    assert found.classes == FOUR
    assert found.model_classes == ("healthy", "inner")
    assert found.balanced_accuracy <= 0.5
    assert np.shape(found.confusion) == (4, 2)


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        (make_table(8, 2, classes=1), "all records are healthy; give a corpus with two or more classes"),
        (make_table(4, 3), r"4 specimen\(s\) cannot fill 5 folds; test on another corpus"),
        (make_table(4, 3, classes=2), r"4 specimen\(s\) cannot fill 5 folds; use at most 4 folds"),
        (make_table(6, 5), "all outer records are of one specimen"),
        (make_table(8, 2), r"4 healthy record\(s\) for 5 folds; use fewer folds"),
        (make_table().drop_vars("specimen"), "lacks 'specimen'; make it again with raceway features"),
        (make_table().assign(fault=("record", np.full(80, 9))), "fault has values other than 0 healthy, 1 inner"),
    ],
)
def test_a_table_that_cannot_be_cross_validated_is_refused_in_one_sentence(table, sentence):
    with pytest.raises(CorpusError, match=sentence) as caught:
        cross_validate(table, "logistic_regression")
    assert str(caught.value).startswith("a made-up corpus")
