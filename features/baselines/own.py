"""Classifiers of the user: estimators of scikit-learn, or alike, that are not in the registry of baselines.

An own classifier is anything with ``fit(X, y)`` and ``predict(X)``. It is given the names of the classes as ``y``,
because names need no table of codes and scikit-learn takes them. `OwnClassifier` translates between names and codes.
"""

import inspect
import pkgutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol, Self

import numpy as np
import pandas as pd
from scipy.special import softmax
from sklearn.base import clone

from features.baselines.records import FloatArray, IntArray
from gen.corpus import FAULTS
from gen.support.errors import RacewayError

PROBABILITIES = ("predict_proba", "decision_function")


class EstimatorError(RacewayError):
    """An estimator of the user that cannot be found, made or used."""


class Classifier(Protocol):
    """What an own classifier must have; ``predict_proba`` or ``decision_function`` is used if it exists."""

    def fit(self, X: Any, y: Any) -> Any:
        """Learn from records, a data frame (record, feature) or waveforms (record, time), and their class names."""

    def predict(self, X: Any) -> Any:
        """Class name of each record, shape (record,)."""


Maker = Classifier | Callable[..., Classifier]
"""An unfitted classifier, which is copied before each fit, or a class or function that makes one.

A class or function is given the seed if it has one required argument, or an argument ``seed`` or ``random_state``.
"""


class OwnClassifier:
    """A classifier of the user as one of codes: indices into ``gen.corpus.FAULTS`` in place of class names.

    Without ``predict_proba``, the softmax of ``decision_function`` is taken; without either, the prediction has the
    probability 1.

    Attributes
    ----------
    classes_
        Codes that it predicts, ascending, shape (class,).
    """

    def __init__(self, maker: Maker, seed: int) -> None:
        self.name = maker_name(maker)
        self.classifier = new_classifier(maker, seed, self.name)

    def fit(self, X: Any, y: IntArray) -> Self:
        """Fit the classifier to records of the codes ``y``, shape (record,).

        Raises
        ------
        EstimatorError
            If it fails, or predicts classes that it was not given.
        """
        fitted = self._call("fit", X, np.array(FAULTS)[y])
        self.fitted: Any = self.classifier if fitted is None else fitted
        names = [str(name) for name in getattr(self.fitted, "classes_", [FAULTS[c] for c in np.unique(y)])]
        if not set(names) <= set(FAULTS):
            raise EstimatorError(
                f"{self.name}: its classes_ are {', '.join(names)}; leave y as it is, the names of the classes."
            )
        codes = np.array([FAULTS.index(name) for name in names])
        self.columns = np.argsort(codes)
        self.classes_ = codes[self.columns]
        return self

    def predict_proba(self, X: Any) -> FloatArray:
        """Probability of each of ``classes_``, shape (record, class).

        Raises
        ------
        EstimatorError
            If the classifier fails, or its result has another shape or is not finite.
        """
        method = next((name for name in PROBABILITIES if hasattr(self.fitted, name)), None)
        if method is None:
            return self._certain(np.asarray(self._call("predict", X)), len(X))
        probabilities = np.asarray(self._call(method, X), dtype=float)
        if method == "decision_function":
            probabilities = of_margins(probabilities)
        wanted = (len(X), len(self.classes_))
        if probabilities.shape != wanted or not np.isfinite(probabilities).all():
            what = (
                "numbers that are not finite"
                if probabilities.shape == wanted
                else f"an array of shape {probabilities.shape}"
            )
            raise EstimatorError(
                f"{self.name}: {method} gives {what}; give finite numbers of shape {wanted}, (record, class)."
            )
        return probabilities[:, self.columns]

    def _certain(self, predicted: Any, records: int) -> FloatArray:
        """Probability 1 of each predicted class name, shape (record, class)."""
        names = np.array(FAULTS)[self.classes_]
        wrong = predicted[~np.isin(predicted.astype(str), names)] if predicted.shape == (records,) else None
        if wrong is None or wrong.size:
            what = f"an array of shape {predicted.shape}" if wrong is None else repr(wrong[0].item())
            raise EstimatorError(
                f"{self.name}: predict gives {what}; give one of {', '.join(names)} for each of {records} records."
            )
        return (predicted.astype(str)[:, None] == names).astype(float)

    def predict(self, X: Any) -> IntArray:
        """Code of each record, shape (record,)."""
        return self.classes_[self.predict_proba(X).argmax(axis=1)]

    def _call(self, method: str, *arguments: Any) -> Any:
        try:
            return getattr(self.fitted if method != "fit" else self.classifier, method)(*arguments)
        except (Exception, SystemExit) as error:
            features = isinstance(arguments[0], pd.DataFrame)
            told = (
                "a table of features; features.open_waveforms, or --waveforms, gives signals" if features else "signals"
            )
            raise EstimatorError(
                f"{self.name}: {method} failed ({_brief(error)}; it got {told}); RACEWAY_TRACEBACK=1 shows where."
            ) from error


def of_margins(decision: FloatArray) -> FloatArray:
    """Probabilities of the margins of a classifier; with two classes there is one margin, that of the second."""
    return softmax(np.stack([-decision, decision], axis=1) if decision.ndim == 1 else decision, axis=1)


def maker_name(maker: Maker) -> str:
    """Name of a classifier or of its maker, for tables and errors."""
    return str(getattr(maker, "__name__", type(maker).__name__))


def new_classifier(maker: Maker, seed: int, name: str) -> Any:
    """Unfitted classifier: a copy of the given one, or a new one.

    Raises
    ------
    EstimatorError
        If it cannot be made, or has no ``fit`` or ``predict``.
    """
    classifier: Any = maker
    if isinstance(maker, type) or not hasattr(maker, "fit"):
        if not callable(maker):
            raise EstimatorError(
                f"{name}: is no classifier; it needs fit and predict, or must be a function that makes one."
            )
        try:
            classifier = maker(**_seed_argument(maker, seed))
        except (Exception, SystemExit) as error:
            raise EstimatorError(
                f"{name}: cannot be made ({_brief(error)}); RACEWAY_TRACEBACK=1 shows where."
            ) from error
    # a fitted object is copied, so that folds do not share what it learned
    else:
        classifier = clone(maker, safe=False)
    # told before the first fit, not by an AttributeError inside one
    lacking = [method for method in ("fit", "predict") if not callable(getattr(classifier, method, None))]
    if lacking:
        raise EstimatorError(
            f"{name}: {type(classifier).__name__} has no {' and no '.join(lacking)}; a classifier needs both."
        )
    return classifier


def unseeded(maker: Maker, seed: int) -> list[str]:
    """Parameters ``random_state`` of a classifier, or of parts of it, that are None: two fits may then differ.

    A function that takes a seed has set those that need one.
    """
    if callable(maker) and _seed_argument(maker, seed):
        return []
    classifier = new_classifier(maker, seed, maker_name(maker))
    parameters = classifier.get_params() if hasattr(classifier, "get_params") else {}
    return [name for name, value in parameters.items() if name.endswith("random_state") and value is None]


def _seed_argument(maker: Callable[..., Any], seed: int) -> dict[str, int]:
    try:
        parameters = inspect.signature(maker).parameters
    except ValueError:  # a function in C
        return {}
    required = [
        name
        for name, parameter in parameters.items()
        if parameter.default is parameter.empty and parameter.kind is parameter.POSITIONAL_OR_KEYWORD
    ]
    named = [name for name in ("seed", "random_state") if name in parameters]
    return dict.fromkeys(required if len(required) == 1 else named[:1], seed)


def load_maker(address: str) -> Maker:
    """Import a classifier, or a class or function that makes one, from ``module:name`` or ``module.py:name``.

    The module is searched in the current folder and among the installed packages. This runs its code.

    Raises
    ------
    EstimatorError
        If there is no such module or name, its code fails, or it makes no classifier.
    """
    here = str(Path.cwd())
    if here not in sys.path:
        sys.path.insert(0, here)
    try:
        maker: Maker = pkgutil.resolve_name(address.replace(".py:", ":"))
    except (Exception, SystemExit) as error:  # also of the code of the module
        raise EstimatorError(
            f"{address}: cannot be imported ({_brief(error)}); give MODULE:NAME of a module in this folder or an installed package. "
            "RACEWAY_TRACEBACK=1 shows where."
        ) from error
    new_classifier(maker, 0, address)
    return maker


def _brief(error: BaseException) -> str:
    """Type and first line of an error."""
    return ": ".join([type(error).__name__, *str(error).splitlines()[:1]])
