"""Check of the estimator in a model file, before any object is created from it.

A small estimator of the same name, seed, features and classes is trained on random records. The estimator of the file must be equal to it
in every type, setting, attribute and array, except for the attributes that `features.baselines.model_rules` has a rule for.
"""

from functools import lru_cache
from typing import Any

import numpy as np
from pandas import DataFrame, Index
from sklearn.ensemble import HistGradientBoostingClassifier

from features.baselines.estimators import Estimator, make_estimator
from features.baselines.model_file import pack, read_packed
from features.baselines.model_rules import LEARNED, LISTS, TOGETHER, attributes, brief, refuse
from features.baselines.model_states import OBJECT_LOADERS, Known, State
from gen.corpus import FAULTS

RECORDS_PER_CLASS = 10  # enough for every kind of estimator to learn something


def check_estimator(
    where: str, found: State, known: Known, *, name: str, seed: int, classes: tuple[str, ...], features: tuple[str, ...]
) -> None:
    """Refuse the estimator of a model file if this version could not have trained it.

    Parameters
    ----------
    where
        Path of the file, with which an error sentence begins.
    found, known
        State of the estimator in the file, and all states read from the file.
    name, seed, classes, features
        As in `features.baselines.models.Model`; ``name`` is in ``ESTIMATORS``.

    Raises
    ------
    CorpusError
        With the name of the first attribute that is wrong.
    """
    try:
        small = _small_estimator(name, seed, classes, features)
    except ValueError as error:  # the envelope rule needs certain features
        refuse(f"{where}: features", f"are not those of {name} ({str(error).splitlines()[0]})")
    expected = read_packed(small, known)
    _Comparison().parts(f"{where}: estimator", expected.parts["content"]["estimator"], found)


@lru_cache(maxsize=16)
def _small_estimator(name: str, seed: int, classes: tuple[str, ...], features: tuple[str, ...]) -> bytes:
    """Archive of an estimator with one tree or one round, trained on random records."""
    rng = np.random.default_rng(0)
    fault = np.repeat([FAULTS.index(name) for name in classes], RECORDS_PER_CLASS)
    values = rng.standard_normal((len(fault), len(features))) + fault[:, None]
    estimator = _shrunk(make_estimator(name, seed))
    return pack({"estimator": estimator.fit(DataFrame(values, columns=Index(features)), fault)})


def _shrunk(estimator: Estimator) -> Estimator:
    """The same estimator with one tree per forest, or one round of boosting."""
    for setting, value in estimator.get_params().items():
        if setting.endswith("n_estimators"):
            estimator.set_params(**{setting: 1})
        elif isinstance(value, HistGradientBoostingClassifier):
            value.set_params(max_iter=1)
    return estimator


class _Comparison:
    """Compares states part by part; a pair that was compared before is not compared again."""

    def __init__(self) -> None:
        self.seen: set[tuple[State, State]] = set()

    def parts(self, where: str, expected: Any, found: Any) -> None:
        """Compare two parts of states."""
        match expected, found:
            case State(), State():
                self.states(where, expected, found)
            case dict(), dict() if list(expected) == list(found):
                for key, value in expected.items():
                    self.parts(where if key == "content" else f"{where}.{key}", value, found[key])
            case tuple(), tuple() if len(expected) == len(found):
                for number, value in enumerate(expected):
                    self.parts(f"{where}[{number}]", value, found[number])
            case _ if type(expected) is not type(found) or expected != found:
                refuse(where, f"is {_text(found)} and must be {_text(expected)}")
            case _:
                return

    def states(self, where: str, expected: State, found: State) -> None:
        """Compare two states, which are the same object if they are equal."""
        if expected is found or (expected, found) in self.seen:
            return
        self.seen.add((expected, found))
        if expected.kind != found.kind:
            refuse(where, f"is {_text(found)} and must be {_text(expected)}")
        elif expected.array is not None or found.array is not None:
            refuse(where, "has other values than in a model of this version")
        elif _has_attributes(expected) and _has_attributes(found):
            self.objects(where, expected, found)
        else:
            self.parts(where, expected.parts, found.parts)

    def objects(self, where: str, expected: State, found: State) -> None:
        """Compare two objects attribute by attribute, and apply the rule for the attributes of the second together."""
        name = expected.kind[1]
        self.parts(where, _beside_content(expected), _beside_content(found))
        self.parts(where, _beside_content(expected.parts["content"]), _beside_content(found.parts["content"]))
        mine, theirs = attributes(expected), attributes(found)
        if list(mine) != list(theirs):
            refuse(
                where, f"has other attributes ({brief(min(mine.keys() ^ theirs.keys(), default='in another order'))})"
            )
        for attribute, value in mine.items():
            place, qualified = f"{where}.{attribute}", f"{name}.{attribute}"
            if value is theirs[attribute]:
                continue
            if qualified in LISTS:
                self.lists(place, value, theirs[attribute])
            elif qualified in LEARNED:
                LEARNED[qualified](place, value, theirs[attribute])
            else:
                self.states(place, value, theirs[attribute])
        if name in TOGETHER:
            TOGETHER[name](where, expected, found)

    def lists(self, where: str, expected: State, found: State) -> None:
        """Compare each item of a list with the only item of the list of the small estimator."""
        if found.kind != expected.kind or not found.parts["content"]:
            refuse(where, "must be a list that is not empty")
        for number, item in enumerate(found.parts["content"]):
            self.parts(f"{where}[{number}]", expected.parts["content"][0], item)


def _has_attributes(state: State) -> bool:
    """Whether a state is an object with attributes."""
    return state.kind[2] in OBJECT_LOADERS and "content" in state.parts and state.parts["content"].kind[2] == "DictNode"


def _beside_content(state: State) -> dict[str, Any]:
    """Parts of a state, with None for the content."""
    return {key: None if key == "content" else part for key, part in state.parts.items()}


def _text(value: Any) -> str:
    """Text of a value or state for an error sentence."""
    if not isinstance(value, State):
        return brief(value)
    return brief(value.parts.get("content")) if value.kind[2] == "JsonNode" else brief(f"a {value.kind[1]}")
