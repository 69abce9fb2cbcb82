"""Content of a model file as plain values: the JSON of a skops archive, read without creating any object that it names.

``schema.json`` of an archive is a tree of JSON objects that names the type of every object of a model. It is read into a
tree of `State`: text, numbers and arrays. Equal states of one tree are the same `State`.
"""

import json
from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from features.baselines.model_members import SCHEMA, read_array, refuse_member, without_padding
from gen.errors import CorpusError
from gen.limits import check_limit

KINDS = frozenset(
    {
        ("builtins", "dict", "DictNode"),
        ("builtins", "list", "ListNode"),
        ("builtins", "str", "JsonNode"),
        ("builtins", "str", "TypeNode"),
        ("builtins", "tuple", "TupleNode"),
        ("features.baselines.estimators", "EnvelopeRule", "ObjectNode"),
        ("numpy", "dtype", "DTypeNode"),
        ("numpy", "float64", "NdArrayNode"),
        ("numpy", "int64", "NdArrayNode"),
        ("numpy", "ndarray", "NdArrayNode"),
        ("numpy", "uint64", "NdArrayNode"),
        ("numpy.random._generator", "Generator", "RandomGeneratorNode"),
        ("sklearn._loss._loss", "CyHalfBinomialLoss", "LossNode"),
        ("sklearn._loss._loss", "CyHalfMultinomialLoss", "LossNode"),
        ("sklearn._loss.link", "Interval", "ObjectNode"),
        ("sklearn._loss.link", "LogitLink", "ObjectNode"),
        ("sklearn._loss.link", "MultinomialLogit", "ObjectNode"),
        ("sklearn._loss.loss", "HalfBinomialLoss", "ObjectNode"),
        ("sklearn._loss.loss", "HalfMultinomialLoss", "ObjectNode"),
        ("sklearn.dummy", "DummyClassifier", "ObjectNode"),
        ("sklearn.ensemble._forest", "ExtraTreesClassifier", "ObjectNode"),
        ("sklearn.ensemble._forest", "RandomForestClassifier", "ObjectNode"),
        ("sklearn.ensemble._hist_gradient_boosting.binning", "_BinMapper", "ObjectNode"),
        ("sklearn.ensemble._hist_gradient_boosting.gradient_boosting", "HistGradientBoostingClassifier", "ObjectNode"),
        ("sklearn.ensemble._hist_gradient_boosting.predictor", "TreePredictor", "ObjectNode"),
        ("sklearn.ensemble._voting", "VotingClassifier", "ObjectNode"),
        ("sklearn.impute._base", "SimpleImputer", "ObjectNode"),
        ("sklearn.linear_model._logistic", "LogisticRegression", "ObjectNode"),
        ("sklearn.pipeline", "Pipeline", "ObjectNode"),
        ("sklearn.preprocessing._data", "StandardScaler", "ObjectNode"),
        ("sklearn.preprocessing._label", "LabelEncoder", "ObjectNode"),
        ("sklearn.svm._classes", "SVC", "ObjectNode"),
        ("sklearn.tree._classes", "DecisionTreeClassifier", "ObjectNode"),
        ("sklearn.tree._classes", "ExtraTreeClassifier", "ObjectNode"),
        ("sklearn.tree._tree", "Tree", "TreeNode"),
        ("sklearn.utils._bunch", "Bunch", "DictNode"),
    }
)
"""Module, class and loader of every object in the model files of Raceway; files with others are refused."""
_KEYS = ("__module__", "__class__", "__loader__", "__id__")  # of every JSON object
PROTOCOL = ("protocol", "_skops_version")  # of the outermost
OBJECT_LOADERS = ("ObjectNode", "TreeNode", "LossNode")  # those that give attributes to an object


@dataclass(frozen=True, eq=False)
class State:
    """One object of an archive as plain values; equal states of one tree are the same object.

    Attributes
    ----------
    kind
        Its module and class, and the skops loader that creates it.
    parts
        The rest of its JSON object: text, numbers, mappings, lists and other states.
    size
        Number of states in it, itself included; a state that appears twice counts twice.
    array, content
        Values and bytes of its member of the archive, if it is an array.
    """

    kind: tuple[str, str, str]
    parts: Mapping[str, Any]
    size: int
    array: NDArray[Any] | None = None
    content: bytes = b""


class Known(dict[Hashable, State]):
    """States read so far, by a key that equal states share."""


def plain(state: State) -> Any:
    """Value of a state of text, numbers, lists, tuples and mappings; None for an array or another object."""
    content: Any = state.parts.get("content")
    match state.kind[2]:
        case "JsonNode":
            return json.loads(content)
        case "ListNode":
            return [plain(item) for item in content]
        case "TupleNode":
            return tuple(plain(item) for item in content)
        case "DictNode":
            return {key: plain(item) for key, item in content.items()}
        case _:
            return None


class StateReader:
    """Reads the JSON of one archive into states."""

    def __init__(self, members: Mapping[str, bytes], known: Known, name: str) -> None:
        self.members, self.known, self.name = members, known, name
        self.numbered: dict[Any, State] = {}
        self.arrays: dict[str, tuple[NDArray[Any], bytes]] = {}

    def root(self) -> State:
        """State of the whole archive."""
        schema = json.loads(self.members[SCHEMA])
        found = self.state({key: value for key, value in schema.items() if key not in PROTOCOL})
        check_limit("model_objects", found.size, f"{self.name}: asks for", CorpusError)
        return found

    def state(self, value: Mapping[str, Any]) -> State:
        """State of a JSON object; an object with nothing but a number refers to the earlier object of that number."""
        number = value.get("__id__")
        if number is not None and len(value) == 1:
            if number not in self.numbered:
                refuse_member(self.name, f"there is no object {number!r} before it is referred to")
            return self.numbered[number]
        kind = (value["__module__"], value["__class__"], value["__loader__"])
        if kind not in KINDS:
            what = ".".join(str(part) for part in kind[:2])[:100]
            raise CorpusError(
                f"{self.name}: holds {what}, which no model of raceway contains; use only models you trust."
            )
        parts = {key: part for key, part in value.items() if key not in _KEYS}
        array, content = None, b""
        if kind[2] == "NdArrayNode" and parts.get("type") == "numpy":
            array, content = self.array(parts.pop("file"))
        taken = {key: self.part(part) for key, part in parts.items()}
        if not _is_well_formed(kind[2], taken):
            refuse_member(self.name, f"{'.'.join(kind[:2])} without the content it must have")
        key = (kind, _key(taken), content)
        if key not in self.known:
            size = 1 + sum(state.size for state in _states(taken))
            self.known[key] = State(kind, taken, size, array, content)
        found = self.known[key]
        if number is not None:
            self.numbered[number] = found
        return found

    def part(self, value: Any) -> Any:
        """Value of a JSON object, with the objects in it read as states."""
        match value:
            case dict() if "__loader__" in value or "__id__" in value:
                return self.state(value)
            case dict():
                return {key: self.part(part) for key, part in value.items()}
            case list():
                return tuple(self.part(part) for part in value)
            case _:
                return value

    def array(self, member: str) -> tuple[NDArray[Any], bytes]:
        """Array of a member, and the bytes of the array in a model file."""
        if member not in self.arrays:
            self.arrays[member] = without_padding(*read_array(self.members[member]))
        return self.arrays[member]


def _is_well_formed(loader: str, parts: Mapping[str, Any]) -> bool:
    """Whether the content has the form that the loader needs: JSON text, states, or attributes."""
    content = parts.get("content")
    match loader:
        case "JsonNode":
            return isinstance(content, str) and isinstance(json.loads(content), str | int | float | None)
        case "ListNode" | "TupleNode":
            return isinstance(content, tuple) and all(isinstance(item, State) for item in content)
        case "DictNode":
            return isinstance(content, dict) and all(isinstance(item, State) for item in content.values())
        case _ if loader in OBJECT_LOADERS and "content" in parts:
            return isinstance(content, State)
        case _:
            return True


def _key(value: Any) -> Hashable:
    """Key that equal values share, and no others."""
    match value:
        case dict():
            return tuple((key, _key(part)) for key, part in value.items())
        case tuple():
            return ("list", *(_key(part) for part in value))
        case State():
            return value
        case _:
            return (type(value), value)


def _states(value: Any) -> Iterator[State]:
    """States among the parts of a state."""
    match value:
        case State():
            yield value
        case dict():
            for part in value.values():
                yield from _states(part)
        case tuple():
            for part in value:
                yield from _states(part)
        case _:
            return
