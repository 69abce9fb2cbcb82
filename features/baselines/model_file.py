"""Model files: the only module that reads and writes skops archives.

``bytes of a file -> members -> State, checked by the caller -> skops -> Python objects``

A skops archive is a zip of arrays (``.npy``) and of ``schema.json``, which names the type of every object. The origin of
a file is unknown, so it is first read into plain values: see `features.baselines.model_states`. skops creates objects
only after the caller has compared these values with a model that was trained in this process.

`pack` numbers objects by their first appearance. So equal models give equal bytes in every process, and a file contains
each array once.
"""

import io
import json
import warnings
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import IO, Any

import skops.io

from features.baselines.model_members import SCHEMA, read_members, write_members
from features.baselines.model_states import KINDS, OBJECT_LOADERS, PROTOCOL, Known, State, StateReader
from gen.errors import CorpusError
from gen.limits import check_limit


def pack(content: Mapping[str, Any]) -> bytes:
    """Bytes of a model file with some objects; equal objects give equal bytes in any process."""
    return _archive(read_packed(skops.io.dumps(dict(content)), Known()))


def unpack(state: State) -> Any:
    """Create the objects of a state, which `features.baselines.model_check` must have accepted."""
    return skops.io.loads(_archive(state), trusted=[f"{module}.{name}" for module, name, _ in KINDS])


def read_state(path: Path, known: Known) -> State:
    """Read a model file as plain values.

    Raises
    ------
    CorpusError
        If it is missing, damaged, larger than the limits, or names a type that no model of Raceway contains.
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
        # the readers of zip, JSON and NumPy raise many unrelated types for a damaged file
        reason = (str(error) or type(error).__name__).splitlines()[0]
        raise CorpusError(f"{path}: not a readable model ({reason}); train it again.") from error


def read_packed(content: bytes, known: Known) -> State:
    """Read the bytes of an archive made in this process as plain values."""
    return _read(io.BytesIO(content), known, "model")


def _read(source: Path | IO[bytes], known: Known, name: str) -> State:
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # NumPy warns of headers in a form that it does not write itself
        return StateReader(read_members(source, name), known, name).root()


def _archive(root: State) -> bytes:
    """Zip archive of a state, with objects and arrays numbered by first appearance, and one date for all members."""
    done: dict[State, dict[str, Any]] = {}
    arrays: dict[bytes, str] = {}

    def written(value: Any) -> Any:
        match value:
            case State() if value in done:
                # skops resolves the number of an object only after it has read the object; other states are short
                return {"__id__": done[value]["__id__"]} if value.kind[2] in OBJECT_LOADERS else done[value]
            case State():
                found = done[value] = _opening(value, len(done) + 1)
                if value.array is not None:
                    found["file"] = arrays.setdefault(value.content, f"{len(arrays)}.npy")
                found |= {key: written(part) for key, part in value.parts.items()}
                if value.kind[2] in OBJECT_LOADERS and "content" in found:
                    # scikit-learn removes the version from the attributes of an object, so objects may not share them
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
    """First keys of the JSON object of a state."""
    module, name, loader = state.kind
    return {"__class__": name, "__module__": module, "__loader__": loader, "__id__": number}


@cache
def _protocol() -> dict[str, Any]:
    """Protocol and version that the installed skops writes into its archives."""
    schema = json.loads(read_members(io.BytesIO(skops.io.dumps(None)), "skops")[SCHEMA])
    return {key: schema[key] for key in PROTOCOL}
