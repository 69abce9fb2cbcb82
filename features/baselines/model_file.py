"""Model files: the one place that reads and writes skops archives.

``bytes of a file -> members -> State, checked by the caller -> skops -> Python objects``

A skops archive is a zip of arrays (``.npy``) and of ``schema.json``, a tree of JSON objects that names the type of every object. A file
may come from anyone, so it is read into a tree of `State` first: text, numbers and arrays, and no object of the types it names. skops makes
objects of a tree only after the caller has compared it with one it trusts.

Equal states of one tree are the same `State`, and `pack` numbers them by their first appearance. So equal models give equal bytes,
whatever the process, and the file holds each array once.
"""

import io
import json
import warnings
from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import IO, Any

import skops.io
from numpy.typing import NDArray

from features.baselines.model_members import (
    SCHEMA,
    read_array,
    read_members,
    refuse_member,
    without_padding,
    write_members,
)
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
"""Module, class and loader of every object in the model files of Raceway; a file with any other is refused."""
_KEYS = ("__module__", "__class__", "__loader__", "__id__")  # of every JSON object
_PROTOCOL = ("protocol", "_skops_version")  # of the outermost
OBJECT_LOADERS = ("ObjectNode", "TreeNode", "LossNode")  # those that give attributes to an object


@dataclass(frozen=True, eq=False)
class State:
    """One object of an archive as plain values; equal states of one tree are the same object.

    Attributes
    ----------
    kind
        Module, class and loader that skops makes it with.
    parts
        What else ``schema.json`` says of it: text, numbers, mappings, lists and other states.
    size
        Number of states in it, itself included; one that appears twice counts twice.
    array, content
        If it is an array in a member of its own: its values, and the bytes of the member.
    """

    kind: tuple[str, str, str]
    parts: Mapping[str, Any]
    size: int
    array: NDArray[Any] | None = None
    content: bytes = b""


class Known(dict[Hashable, State]):
    """States met so far, by what distinguishes them: equal states are found again."""


def pack(content: Mapping[str, Any]) -> bytes:
    """Bytes of a model file that holds some objects; equal objects give equal bytes in any process."""
    return _archive(read_packed(skops.io.dumps(dict(content)), Known()))


def unpack(state: State) -> Any:
    """Make the objects of a state. Only for a state that is known to be harmless: see `features.baselines.model_check`."""
    return skops.io.loads(_archive(state), trusted=[f"{module}.{name}" for module, name, _ in KINDS])


def plain(state: State) -> Any:
    """Value of a state that holds text, numbers, lists, tuples and mappings; None for an array or another object."""
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


def read_state(path: Path, known: Known) -> State:
    """Read a model file as plain values.

    Raises
    ------
    CorpusError
        If it is missing, damaged, larger than the limits, or names a type that no model of Raceway holds.
    """
    if not path.exists():
        raise CorpusError(f"{path}: no such file; give a model made with raceway train.")
    if not path.is_file():
        raise CorpusError(f"{path}: not a file; give a model made with raceway train.")
    check_limit("file_bytes", path.stat().st_size, f"{path}: has", CorpusError)
    try:
        return _read(path, known, str(path))
    except CorpusError:
        raise
    except Exception as error:
        # a foreign file can trip the readers of zip, JSON and NumPy in any way
        reason = (str(error) or type(error).__name__).splitlines()[0]
        raise CorpusError(f"{path}: not a readable model ({reason}); train it again.") from error


def read_packed(content: bytes, known: Known) -> State:
    """Read the bytes of an archive made in this process as plain values."""
    return _read(io.BytesIO(content), known, "model")


def _read(source: Path | IO[bytes], known: Known, name: str) -> State:
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # NumPy warns of headers that it does not write itself
        return _Reader(read_members(source, name), known, name).root()


class _Reader:
    """Turns the JSON of one archive into states."""

    def __init__(self, members: Mapping[str, bytes], known: Known, name: str) -> None:
        self.members, self.known, self.name = members, known, name
        self.numbered: dict[Any, State] = {}
        self.arrays: dict[str, tuple[NDArray[Any], bytes]] = {}

    def root(self) -> State:
        """State of the whole archive."""
        schema = json.loads(self.members[SCHEMA])
        found = self.state({key: value for key, value in schema.items() if key not in _PROTOCOL})
        check_limit("model_objects", found.size, f"{self.name}: asks for", CorpusError)
        return found

    def state(self, value: Mapping[str, Any]) -> State:
        """State of a JSON object; one that has only a number is the earlier object of that number."""
        number = value.get("__id__")
        if number is not None and len(value) == 1:
            if number not in self.numbered:
                refuse_member(self.name, f"there is no object {number!r} before it is referred to")
            return self.numbered[number]
        kind = (value["__module__"], value["__class__"], value["__loader__"])
        if kind not in KINDS:
            what = ".".join(str(part) for part in kind[:2])[:100]
            raise CorpusError(f"{self.name}: holds {what}, which no model of raceway holds; use only models you trust.")
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
        """A value of a JSON object, the objects within it as states."""
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
        """Array of a member, and the bytes that a model file holds it in."""
        if member not in self.arrays:
            self.arrays[member] = without_padding(*read_array(self.members[member]))
        return self.arrays[member]


def _is_well_formed(loader: str, parts: Mapping[str, Any]) -> bool:
    """Whether a value has its text, a container its states, and an object its attributes."""
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


def _archive(root: State) -> bytes:
    """Zip of a state: objects and arrays numbered by their first appearance, all members of one date."""
    done: dict[State, dict[str, Any]] = {}
    arrays: dict[bytes, str] = {}

    def written(value: Any) -> Any:
        match value:
            case State() if value in done:
                # skops takes an object it knows by its number; other states are short, and it may come to either of two first
                return {"__id__": done[value]["__id__"]} if value.kind[2] in OBJECT_LOADERS else done[value]
            case State():
                found = done[value] = _opening(value, len(done) + 1)
                if value.array is not None:
                    found["file"] = arrays.setdefault(value.content, f"{len(arrays)}.npy")
                found |= {key: written(part) for key, part in value.parts.items()}
                if value.kind[2] in OBJECT_LOADERS and "content" in found:
                    # scikit-learn takes the version out of the attributes of an object, so no two objects may share them
                    found["content"] = {key: part for key, part in found["content"].items() if key != "__id__"}
                return found
            case dict():
                return {key: written(part) for key, part in value.items()}
            case tuple():
                return [written(part) for part in value]
            case _:
                return value

    schema = json.dumps(written(root) | _protocol(), separators=(",", ":"))
    return write_members({name: content for content, name in arrays.items()} | {SCHEMA: schema.encode()})


def _opening(state: State, number: int) -> dict[str, Any]:
    """How the JSON of a state begins."""
    module, name, loader = state.kind
    return {"__class__": name, "__module__": module, "__loader__": loader, "__id__": number}


def _key(value: Any) -> Hashable:
    """What equal values have in common, and no others."""
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


@cache
def _protocol() -> dict[str, Any]:
    """How the installed skops marks its archives."""
    schema = json.loads(read_members(io.BytesIO(skops.io.dumps(None)), "skops")[SCHEMA])
    return {key: schema[key] for key in _PROTOCOL}
