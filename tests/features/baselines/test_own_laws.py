"""Laws of own classifiers: they learn names, are scored as the baselines are, and fail in one sentence."""

import sys

import numpy as np
import pytest
from sklearn.dummy import DummyClassifier
from sklearn.linear_model import LogisticRegression, RidgeClassifier
from sklearn.naive_bayes import GaussianNB
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import FunctionTransformer
from sklearn.svm import SVC

from features import feature_table, open_waveforms
from features.baselines import EstimatorError, Model, benchmark, cross_validate, load_maker
from features.baselines.estimators import class_probabilities, make_estimator
from gen.corpus import FAULTS
from gen.support.errors import CorpusError
from tests.features.baselines.test_baselines_laws import make_table
from tests.features.table.test_waveforms_laws import psd
from tests.tone_corpora import write_corpus

CODES = np.array([0, 1, 2, 4] * 3)
FOUR = ", ".join(FAULTS[:4])


class Nearest:
    """The class of the nearest mean, without anything of scikit-learn; ``seen`` holds the labels of the last fit."""

    def fit(self, X, y):
        self.seen = y
        self.names = np.unique(y)
        self.means = np.stack([np.asarray(X)[y == name].mean(axis=0) for name in self.names])

    def predict(self, X):
        distance = np.square(np.asarray(X)[:, None] - self.means).sum(axis=2)
        return self.names[distance.argmin(axis=1)]


ON_THE_PSD = make_pipeline(FunctionTransformer(psd), LogisticRegression(max_iter=5000))


@pytest.mark.parametrize("made", [LogisticRegression(), RidgeClassifier(), GaussianNB(), Nearest(), SVC()])
def test_a_classifier_of_names_becomes_one_of_codes(made):
    X = np.eye(4)[np.arange(12) % 4]
    fitted = make_estimator(made, 0).fit(X, CODES)
    np.testing.assert_array_equal(fitted.classes_, [0, 1, 2, 4])
    found = class_probabilities(fitted, X)
    np.testing.assert_allclose(found.sum(axis=1), 1)
    np.testing.assert_array_equal(fitted.predict(X), CODES)
    names = fitted.fitted.seen if isinstance(made, Nearest) else fitted.fitted.classes_
    assert set(names) == {FAULTS[code] for code in CODES}


@pytest.mark.parametrize("made", [RidgeClassifier(), LogisticRegression(), Nearest()])
def test_two_classes_are_told_apart_whichever_method_gives_the_probabilities(made):
    X, codes = np.array([[0.0], [0.1], [1.0], [1.1]]), np.array([1, 1, 0, 0])
    fitted = make_estimator(made, 0).fit(X, codes)
    assert class_probabilities(fitted, X).shape == (4, 2)
    np.testing.assert_array_equal(fitted.predict(X), codes)


def test_an_own_model_is_evaluated_and_not_saved(tmp_path):
    model = Model(Nearest).fit(make_table())
    assert model.score(make_table(seed=1)).balanced_accuracy > 0.95
    with pytest.raises(CorpusError, match="Nearest is no baseline; a model file holds only one of majority"):
        model.save(tmp_path / "model.skops")
    assert not list(tmp_path.iterdir())


def test_a_given_classifier_is_copied_before_each_fit():
    given, other = Nearest(), LogisticRegression()
    assert cross_validate(make_table(), given).balanced_accuracy > 0.95
    assert cross_validate(make_table(), other).balanced_accuracy > 0.95
    assert not hasattr(given, "means")
    assert not hasattr(other, "coef_")


def test_an_own_classifier_is_benchmarked_beside_the_untrained_baselines_and_on_another_corpus():
    chosen = {"worse": DummyClassifier(), "mine": Nearest, "alike": Nearest}
    results = benchmark(make_table(16, 3), make_table(8, 2, seed=1), estimators=chosen, folds=2)
    assert list(results.baselines) == ["majority", "envelope_rule", *chosen]
    assert results.leading == "mine"  # the best, and the first of equals
    assert results.baselines["mine"].grouped.balanced_accuracy > 0.95
    assert results.baselines["mine"].tests[0].balanced_accuracy > 0.95
    assert results.baselines["mine"].null.balanced_accuracy < 0.6


def test_a_classifier_of_waveforms_is_scored_beside_the_others_and_on_the_same_corpora(tmp_path):
    kept = {}
    for seed in range(3):
        write_corpus(tmp_path / f"{seed}", specimens=24 if seed == 0 else 8, records=2, seed=seed)
        kept[seed] = open_waveforms(tmp_path / f"{seed}", normalise=True, per_turn=64, turns=4)
    tables = [feature_table(tmp_path / f"{seed}") for seed in kept]
    options = {"estimators": {"psd": ON_THE_PSD}, "waveforms": [*kept.values()], "folds": 3}
    results = benchmark(tables[0], tables[1:], **options)
    assert [test.records for test in results.tests] == [16, 16]
    for name, found in results.baselines.items():
        assert [test.records for test in found.tests] == [16, 16]
        assert (found.tests[0].balanced_accuracy > 0.8) == (name == "psd")
    model = Model(ON_THE_PSD).fit(kept[0])
    assert model.score(kept[1]) == results.baselines["psd"].tests[0]
    assert model.score(kept[0]).seen == 48
    assert model.predict(kept[2]).shape == (16,)
    with pytest.raises(CorpusError, match="was trained on waveforms; give waveforms"):
        model.score(tables[1])
    with pytest.raises(CorpusError, match="ensemble learns from features; give a feature table or a corpus"):
        Model().fit(kept[0])


class Broken(Nearest):
    def __init__(self, how):
        self.how = how

    def fit(self, X, y):
        if self.how == "fit":
            raise ZeroDivisionError("by zero\nand more")
        super().fit(X, y)
        if self.how == "codes":
            self.classes_ = np.arange(4)

    def predict_proba(self, X):
        return np.full((len(X), 4), np.nan) if self.how == "nan" else np.ones((len(X), 3))


class Predicting:
    def __init__(self, *predicted):
        self.predicted = predicted

    def fit(self, *_):
        if not self.predicted:
            raise SystemExit(3)

    def predict(self, X):
        return self.predicted if len(self.predicted) > 1 else self.predicted * len(X)


@pytest.mark.parametrize(
    ("made", "sentence"),
    [
        (Broken("fit"), r"^Broken: fit failed \(ZeroDivisionError: by zero; it got a table of features"),
        (Broken("codes"), "Broken: its classes_ are 0, 1, 2, 3; leave y as it is, the names of the classes"),
        (Broken("nan"), r"predict_proba gives numbers that are not finite; give finite numbers of shape \(16, 4\)"),
        (Broken("shape"), r"predict_proba gives an array of shape \(16, 3\); give finite numbers of shape \(16, 4\)"),
        (Predicting(), r"^Predicting: fit failed \(SystemExit: 3; it got a table"),
        (Predicting(1), f"Predicting: predict gives 1; give one of {FOUR} for each of 16 records"),
        (Predicting("cage"), f"predict gives 'cage'; give one of {FOUR}"),
        (Predicting("inner", "ball"), r"predict gives an array of shape \(2,\); give one of healthy"),
        (dict, "dict: dict has no fit and no predict; a classifier needs both"),
        (np.take, r"cannot be made \(TypeError: .*missing 2 required positional arguments"),
        (7, "int: is no classifier; it needs fit and predict, or must be a function that makes one"),
    ],
)
def test_a_classifier_that_cannot_be_used_is_refused_in_one_sentence(made, sentence):
    with pytest.raises(EstimatorError, match=sentence) as caught:
        cross_validate(make_table(), made)
    assert "\n" not in str(caught.value)


@pytest.fixture
def module(tmp_path, monkeypatch):
    """Write a module into the current folder: ``module("name", text)``."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    written = []

    def write(name, text):
        (tmp_path / f"{name}.py").write_text(text)
        written.append(name)

    yield write
    for name in written:
        sys.modules.pop(name, None)


def test_a_module_is_imported_from_the_current_folder_or_from_an_installed_package(module):
    module("own_one", "from sklearn.naive_bayes import GaussianNB\nmade = GaussianNB()\ndef make(seed): return made\n")
    for address in (
        "own_one:make",
        "own_one.py:make",
        "own_one:made",
        "own_one:GaussianNB",
        "sklearn.naive_bayes:GaussianNB",
    ):
        assert cross_validate(make_table(), load_maker(address)).balanced_accuracy > 0.9


@pytest.mark.parametrize(
    ("address", "text", "sentence"),
    [
        (
            "own_none:make",
            None,
            "own_none:make: cannot be imported \\(ModuleNotFoundError: No module named 'own_none'\\)",
        ),
        ("own_two:make", "raise SystemExit(3)", r"own_two:make: cannot be imported \(SystemExit: 3\)"),
        ("own_two:make", "def other(): pass", "module 'own_two' has no attribute 'make'"),
        ("own_two:make", "make = 3", "own_two:make: is no classifier; it needs fit and predict"),
        ("own_two:make", "def make(): return 1 / 0", r"own_two:make: cannot be made \(ZeroDivisionError: division"),
    ],
)
def test_an_address_that_gives_no_classifier_is_refused_in_one_sentence(module, address, text, sentence):
    if text is not None:
        module("own_two", text)
    with pytest.raises(EstimatorError, match=sentence) as caught:
        load_maker(address)
    assert "\n" not in str(caught.value)
