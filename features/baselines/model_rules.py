"""Allowed values of the attributes that training sets in the estimator of a model file.

scikit-learn follows the nodes of a tree, and libsvm the counts of support vectors, without checking that an index lies within its array. So
every index that compiled code follows has a rule here. In a tree, each child must come after its parent, as scikit-learn writes them; then
every path from the root ends at a leaf.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from features.baselines.model_states import State, plain
from gen.errors import CorpusError
from gen.limits import check_limit

Rule = Callable[[str, State, State], None]  # location, state of the small estimator, state of the file
Array = NDArray[Any]
LARGEST_INTEGER = 2**31 - 1


def attributes(state: State) -> Mapping[str, State]:
    """Attributes of an object, by name."""
    return state.parts["content"].parts["content"]


def refuse(where: str, reason: str) -> NoReturn:
    """Raise the error of a model file that is not as this version writes it."""
    raise CorpusError(f"{where} {reason}; train the model again with raceway train.")


def brief(value: Any) -> str:
    """Text of a value for an error sentence, shortened if it is long."""
    text = str(value)
    return text if len(text) <= 40 else f"{text[:40]}..."


def integer(where: str, expected: State, found: State) -> None:  # noqa: ARG001
    """Accept a count or a seed."""
    value = _number(where, found)
    if type(value) is not int or not 0 <= value <= LARGEST_INTEGER:
        refuse(where, f"is {brief(value)} and must be an integer in 0..{LARGEST_INTEGER}")


def positive(where: str, expected: State, found: State) -> None:
    """Accept a number above zero, of Python or of NumPy."""
    if found.array is None:
        value = _number(where, found)
    else:
        numbers(where, expected, found)
        value = found.array.item() if found.array.ndim == 0 else None
    if type(value) is not float or not 0 < value < math.inf:
        refuse(where, f"is {brief(value)} and must be a number above 0")


def numbers(where: str, expected: State, found: State) -> None:
    """Accept finite numbers of the same type and number of axes; a rule of `TOGETHER` may compare the lengths of axes."""
    mine, theirs = _array(where, expected), _array(where, found)
    if found.kind != expected.kind or theirs.dtype != mine.dtype or theirs.ndim != mine.ndim:
        refuse(
            where, f"has {brief(theirs.dtype)} of {theirs.ndim} axes and must have {brief(mine.dtype)} of {mine.ndim}"
        )
    if not (theirs.flags.c_contiguous if mine.flags.c_contiguous else theirs.flags.f_contiguous):
        refuse(where, "has its axes in the wrong order")
    for values in (theirs,) if theirs.dtype.names is None else (theirs[name] for name in theirs.dtype.names):
        if not np.isfinite(values).all():
            refuse(where, "has a number that is not finite")


def same_shape(where: str, expected: State, found: State) -> None:
    """Accept finite numbers of the same type and shape."""
    numbers(where, expected, found)
    _require_shape(where, _array(where, found), _array(where, expected).shape)


def above_zero(where: str, expected: State, found: State) -> None:
    """Accept numbers above zero of the same type and shape."""
    same_shape(where, expected, found)
    if not (_array(where, found) > 0).all():
        refuse(where, "has a number that is not above 0")


def thresholds(where: str, expected: State, found: State) -> None:
    """Accept a list of the same number of arrays, each of any length."""
    mine = expected.parts["content"]
    if found.kind != expected.kind or len(found.parts["content"]) != len(mine):
        refuse(where, f"must be a list of {len(mine)} arrays")
    for number, item in enumerate(found.parts["content"]):
        numbers(f"{where}[{number}]", mine[0], item)


def fitted_shape(where: str, expected: State, found: State) -> None:
    """Accept the number of records and the number of features, as a pair."""
    mine = expected.parts["content"]
    if found.kind != expected.kind or len(found.parts["content"]) != 2 or found.parts["content"][1] is not mine[1]:
        refuse(where, "must be the numbers of records and features")
    integer(f"{where}[0]", mine[0], found.parts["content"][0])


def forest(where: str, expected: State, found: State) -> None:  # noqa: ARG001
    """Require ``n_estimators`` trees in a forest; a forest that is not fitted has none."""
    its = attributes(found)
    if "estimators_" in its:
        members = its["estimators_"].parts["content"]
        _require_count(f"{where}.n_estimators", its["n_estimators"], len(members))
        trees = [attributes(member)["tree_"] for member in members]
        _check_nodes(where, (_array(where, attributes(one)["nodes"]) for one in trees))


def tree(where: str, expected: State, found: State) -> None:
    """Require that every path from the root of a tree ends at a leaf, and that each node splits an existing feature."""
    its = attributes(found)
    nodes, values = _array(where, its["nodes"]), _array(where, its["values"])
    _require_count(f"{where}.node_count", its["node_count"], len(nodes))
    _require_shape(f"{where}.values", values, (len(nodes), *_array(where, attributes(expected)["values"]).shape[1:]))
    inner = nodes["left_child"] != -1
    if not (nodes["right_child"][~inner] == -1).all():
        refuse(f"{where}.nodes", "has a leaf with a child")
    _require_descent(f"{where}.nodes", inner, nodes["left_child"], nodes["right_child"])
    features = expected.parts["__reduce__"]["args"].parts["content"][0]
    _require_below(f"{where}.nodes", nodes["feature"][inner], _number(where, features))


def boosting(where: str, expected: State, found: State) -> None:
    """Require the same of the trees of gradient boosting, and ``max_iter`` rounds."""
    its, features = attributes(found), attributes(expected)["n_features_in_"]
    rounds = its["_predictors"].parts["content"]
    _require_count(f"{where}.max_iter", its["max_iter"], len(rounds))
    predictors = [item for round_ in rounds for item in round_.parts["content"]]
    _check_nodes(where, (_array(where, attributes(item)["nodes"]) for item in predictors))
    for number, round_ in enumerate(rounds):
        for item in round_.parts["content"]:
            place = f"{where}._predictors[{number}].nodes"
            nodes = _array(place, attributes(item)["nodes"])
            _require_descent(place, nodes["is_leaf"] == 0, nodes["left"], nodes["right"])
            _require_below(place, nodes["feature_idx"], _number(where, features))
            if nodes["is_categorical"].any():
                refuse(place, "has a categorical split, and all features are numbers")


def support_vectors(where: str, expected: State, found: State) -> None:
    """Require the array sizes that libsvm derives from the number of support vectors."""
    its = attributes(found)
    counts = _array(where, its["_n_support"])
    total = sum(counts.tolist())
    if total < 1 or counts.min() < 0:
        refuse(f"{where}._n_support", "must be the number of support vectors of each class")
    width = _array(where, attributes(expected)["support_vectors_"]).shape[1]
    shapes = {"dual_coef_": (len(counts) - 1, total), "_dual_coef_": (len(counts) - 1, total)}
    for name, shape in {**shapes, "support_vectors_": (total, width), "support_": (total,)}.items():
        _require_shape(f"{where}.{name}", _array(where, its[name]), shape)
    records = its["shape_fit_"].parts["content"][0]
    _require_below(f"{where}.support_", _array(where, its["support_"]), _number(where, records))


def _check_nodes(where: str, trees: Iterable[Array]) -> None:
    """Refuse more nodes than the limit: a file may refer to one tree many times, and prediction evaluates each of them."""
    check_limit("model_nodes", sum(len(nodes) for nodes in trees), f"{where} has", CorpusError)


def _require_descent(where: str, inner: Array, left: Array, right: Array) -> None:
    """Refuse nodes without a root, and a child that does not come after its only parent."""
    count = len(inner)
    if count < 1:
        refuse(where, "has no node")
    number = np.flatnonzero(inner)
    children = np.stack([left[inner], right[inner]]).astype(np.int64)
    if (children <= number).any() or (children >= count).any():
        refuse(where, f"has a node with a child that is not between the node and the last of {count} nodes")
    if (np.bincount(children.reshape(-1), minlength=1) > 1).any():
        refuse(where, "has a node with two parents")


def _require_below(where: str, values: Array, end: int) -> None:
    if not ((values >= 0) & (values < end)).all():
        refuse(where, f"has an index outside 0..{end - 1}")


def _require_shape(where: str, array: Array, shape: tuple[int, ...]) -> None:
    if array.shape != shape:
        refuse(where, f"has the shape {brief(array.shape)} and must have {shape}")


def _require_count(where: str, state: State, count: int) -> None:
    value = _number(where, state)
    if value != count:
        refuse(where, f"is {brief(value)}, but the file has {count}")


def _array(where: str, state: State) -> Array:
    if state.array is None:
        refuse(where, "must be an array")
    return state.array


def _number(where: str, state: State) -> Any:
    if state.kind[2] != "JsonNode":
        refuse(where, "must be a number")
    return plain(state)


LEARNED: Mapping[str, Rule] = {
    "DummyClassifier.class_prior_": same_shape,
    "SimpleImputer.statistics_": same_shape,
    "StandardScaler.mean_": same_shape,
    "StandardScaler.n_samples_seen_": above_zero,
    "StandardScaler.scale_": above_zero,
    "StandardScaler.var_": same_shape,
    "LogisticRegression.coef_": same_shape,
    "LogisticRegression.intercept_": same_shape,
    "LogisticRegression.n_iter_": same_shape,
    "SVC._dual_coef_": numbers,
    "SVC._gamma": positive,
    "SVC._intercept_": same_shape,
    "SVC._n_support": same_shape,
    "SVC._num_iter": same_shape,
    "SVC.class_weight_": same_shape,
    "SVC.dual_coef_": numbers,
    "SVC.intercept_": same_shape,
    "SVC.n_iter_": same_shape,
    "SVC.shape_fit_": fitted_shape,
    "SVC.support_": numbers,
    "SVC.support_vectors_": numbers,
    "RandomForestClassifier._n_samples": integer,
    "RandomForestClassifier._n_samples_bootstrap": integer,
    "RandomForestClassifier._sample_weight": numbers,
    "RandomForestClassifier.n_estimators": integer,
    "ExtraTreesClassifier._n_samples": integer,
    "ExtraTreesClassifier._sample_weight": numbers,
    "ExtraTreesClassifier.n_estimators": integer,
    "DecisionTreeClassifier.random_state": integer,
    "ExtraTreeClassifier.random_state": integer,
    "Tree.max_depth": integer,
    "Tree.node_count": integer,
    "Tree.nodes": numbers,
    "Tree.values": numbers,
    "HistGradientBoostingClassifier._baseline_prediction": same_shape,
    "HistGradientBoostingClassifier.max_iter": integer,
    "_BinMapper.bin_thresholds_": thresholds,
    "_BinMapper.n_bins_non_missing_": same_shape,
    "TreePredictor.nodes": numbers,
}
"""Rule for each attribute that training sets, by class; the other attributes are equal in all models of the same kind."""

LISTS = (
    "RandomForestClassifier.estimators_",
    "ExtraTreesClassifier.estimators_",
    "HistGradientBoostingClassifier._predictors",
)
"""Lists of items of one kind, whose length training sets."""

TOGETHER: Mapping[str, Rule] = {
    "RandomForestClassifier": forest,
    "ExtraTreesClassifier": forest,
    "Tree": tree,
    "HistGradientBoostingClassifier": boosting,
    "SVC": support_vectors,
}
"""Rule for the attributes of an object together, applied after the rule for each."""
