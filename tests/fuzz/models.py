"""Model files with random damage: reading one gives a usable model or an error of one sentence.

``seeds`` writes small valid files, ``mutate`` damages one, and ``check`` reads it with `load_model`. The checksums of a damaged zip are
computed again, so that its reader has to find the damage itself.
"""

import io
import json
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.random import Generator

from features.baselines import evaluate, load_model
from gen.errors import CorpusError
from tests.model_files import make_table, write_models

INTEGERS = (0, 1, -1, 2, 3, 7, 100, 255, 2**31 - 1, 2**31, 2**32 - 1, 2**40, 2**62, -(2**31), -(2**63))
REALS = (0.0, -0.0, 1.0, -1.0, 1e-320, 1e300, -1e300, np.nan, np.inf, -np.inf)
TYPES = ("<f8", "<f4", "<i8", "<i4", "<u8", "|u1", ">f8", "|O", "<U9", "|S4", "|V8", "<M8[s]", "<c16", "|b1")
TEXTS = (
    "",
    "null",
    "true",
    "-1",
    "3",
    "1e999",
    "NaN",
    "[1, 2]",
    "{}",
    '"x"',
    '"majority"',
    '"svm"',
    "1" * 5000,
    "[" * 5000,
    '"\\ud800"',
)
VALUES = (None, True, -1, 0, 2**70, 1.5, float("nan"), "", "x", [], {}, [[]], {"__id__": 1}, {"__id__": 9999})
WORDS = (
    "os", "system", "builtins", "eval", "list", "tuple", "dict", "set", "str", "int", "numpy", "ndarray", "float64", "int64", "dtype",
    "ListNode", "TupleNode", "DictNode", "JsonNode", "TypeNode", "NdArrayNode", "ObjectNode", "TreeNode", "CachedNode", "FunctionNode",
    "MethodNode", "PartialNode", "DTypeNode", "sklearn.svm._classes", "SVC", "sklearn.tree._tree", "Tree", "sklearn.pipeline", "Pipeline",
    "sklearn.dummy", "DummyClassifier", "collections", "OrderedDict", "json", "0.npy", "1.npy", "2.npy", "schema.json",
)  # fmt: skip


def seeds(folder: Path) -> list[Path]:
    """Write a small model file of every estimator, over few and over many classes, and return their paths."""
    return [path for classes in (2, 4) for path in write_models(folder, classes).values()]


def check(path: Path) -> None:
    """Read a model file and let the model classify some records; only a `CorpusError` of one sentence may come of it."""
    try:
        model = load_model(path)
        table = make_table(3, 9, 2, model.features)
        table["features"][1, 0] = np.nan
        table["features"][2] *= 1e20
        evaluate(table, model)
    except CorpusError as error:
        if "\n" in str(error):
            raise AssertionError("an error is one sentence") from error


def mutate(content: bytes, rng: Generator) -> bytes:
    """Damage a model file in one to three ways."""
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        content = _pick(
            rng, (_flip, _cut, _damage_member, _damage_members, *[_damage_array] * 8, *[_damage_schema] * 10)
        )(content, rng)
    return content


def _flip(content: bytes, rng: Generator) -> bytes:
    changed = bytearray(content)
    for place in rng.integers(max(len(changed), 1), size=rng.integers(1, 9)) if changed else ():
        changed[place] ^= int(rng.integers(1, 256))
    return bytes(changed)


def _cut(content: bytes, rng: Generator) -> bytes:
    return content[: rng.integers(len(content) + 1)]


def _damage_member(content: bytes, rng: Generator) -> bytes:
    """Flip bytes in one member, or cut it; the checksum is that of the damaged member."""

    def change(members: list[tuple[str, bytes]]) -> None:
        place = int(rng.integers(len(members)))
        name, held = members[place]
        members[place] = (name, _pick(rng, (_flip, _flip, _cut))(held, rng))

    return _zipped_again(content, change)


def _damage_members(content: bytes, rng: Generator) -> bytes:
    """Drop, double, rename, exchange or compress members."""
    kind, compressed = rng.integers(6), False

    def change(members: list[tuple[str, bytes]]) -> None:
        one, other = (int(place) for place in rng.integers(len(members), size=2))
        match kind:
            case 0:
                del members[one]
            case 1:
                members.append(members[one])
            case 2:
                members[one] = (_pick(rng, (*WORDS, "../x.npy", "x" * 300)), members[one][1])
            case 3:
                members[one], members[other] = (
                    (members[one][0], members[other][1]),
                    (members[other][0], members[one][1]),
                )
            case 4:
                members[one] = (members[one][0], b"\0" * int(rng.integers(100_000)))
            case _:
                members.append((f"{rng.integers(1000)}.npy", members[other][1]))

    compressed = bool(kind == 4 and rng.random() < 0.5)
    return _zipped_again(content, change, zipfile.ZIP_DEFLATED if compressed else zipfile.ZIP_STORED)


def _damage_array(content: bytes, rng: Generator) -> bytes:
    """Change values of an array, or what its header says of them."""

    def change(members: list[tuple[str, bytes]]) -> None:
        places = [place for place, (name, _) in enumerate(members) if name.endswith(".npy")]
        if not places:
            return
        place = int(_pick(rng, places))
        name, held = members[place]
        try:
            array = np.load(io.BytesIO(held), allow_pickle=False)
        except Exception:  # noqa: BLE001 - it may be damaged in any way already
            return
        members[place] = (
            name,
            _with_other_header(array, rng) if rng.random() < 0.3 else _with_other_values(array, rng),
        )

    return _zipped_again(content, change)


def _with_other_values(array: np.ndarray, rng: Generator) -> bytes:
    array = np.array(array)
    if array.dtype.names is None and rng.random() < 0.3:
        array = _reshaped(array, rng)
    elif array.dtype.names is not None and rng.random() < 0.15:
        array = np.array(array[: rng.integers(len(array) + 1)]) if array.ndim else array
    values: Any = array[_pick(rng, array.dtype.names)] if array.dtype.names else array
    if values.size and values.dtype.kind in "iuf":
        for place in rng.integers(values.size, size=rng.integers(1, 4)):
            near = (*INTEGERS, int(place), int(place) + 1, values.size, values.size - 1)
            with np.errstate(all="ignore"):
                new = _pick(rng, REALS) if values.dtype.kind == "f" else _wrapped(_pick(rng, near), values.dtype)
                values[np.unravel_index(place, values.shape)] = new
    file = io.BytesIO()
    np.lib.format.write_array(file, array, (1, 0), allow_pickle=False)
    return file.getvalue()


def _wrapped(value: int, dtype: np.dtype) -> Any:
    bits = 8 * dtype.itemsize
    value %= 2**bits
    return value - 2**bits if dtype.kind == "i" and value >= 2 ** (bits - 1) else value


def _reshaped(array: np.ndarray, rng: Generator) -> np.ndarray:
    match rng.integers(6):
        case 0:
            return np.asfortranarray(array)
        case 1:
            return np.array(array.T)
        case 2:
            return np.repeat(array.reshape(-1), 2)[: rng.integers(2 * array.size + 1)]
        case 3:
            return array.reshape(-1)
        case 4:
            return (
                array.astype(str(_pick(rng, ("<f4", ">f8", "<i4", "<i8", "<u4"))))
                if array.dtype.kind in "iu"
                else array
            )
        case _:
            return array[None]


def _with_other_header(array: np.ndarray, rng: Generator) -> bytes:
    shape, descr = [int(length) for length in array.shape], np.lib.format.dtype_to_descr(array.dtype)
    match rng.integers(4):
        case 0:
            shape.insert(int(rng.integers(len(shape) + 1)), int(_pick(rng, INTEGERS)))
        case 1 if shape:
            shape[int(rng.integers(len(shape)))] = int(_pick(rng, INTEGERS))
        case 2 if shape:
            shape[int(rng.integers(len(shape)))] += int(rng.integers(-2, 3))
        case _:
            descr = str(_pick(rng, TYPES))
    header = repr({"descr": descr, "fortran_order": bool(rng.random() < 0.2), "shape": tuple(shape)}).encode()
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header) + 1) + header + b"\n" + array.tobytes()


def _damage_schema(content: bytes, rng: Generator) -> bytes:
    """Change one value somewhere in the description of the objects."""

    def change(members: list[tuple[str, bytes]]) -> None:
        places = [place for place, (name, _) in enumerate(members) if name == "schema.json"]
        try:
            schema = json.loads(members[places[0]][1])
            slots = list(_slots(schema))
        except (ValueError, IndexError, RecursionError):
            return
        if not slots:
            return
        _change_slot(slots, rng)
        members[places[0]] = ("schema.json", json.dumps(schema).encode())

    return _zipped_again(content, change)


def _slots(value: Any) -> Any:
    """Each place in JSON that holds a value: its container and its key."""
    left = [value]
    while left:
        container = left.pop()
        keys = list(container) if isinstance(container, dict) else range(len(container))
        for key in keys:
            yield container, key
            if isinstance(container[key], dict | list):
                left.append(container[key])


def _change_slot(slots: list[tuple[Any, Any]], rng: Generator) -> None:
    container, key = slots[rng.integers(len(slots))]
    other, other_key = slots[rng.integers(len(slots))]
    match rng.integers(9):
        case 0:
            container[key] = json.loads(json.dumps(_pick(rng, VALUES)))
        case 1:
            container[key] = _pick(rng, WORDS)
        case 2 | 3:
            texts = [slot for slot in slots if slot[1] == "content" and isinstance(slot[0]["content"], str)]
            if texts:
                container, key = texts[rng.integers(len(texts))]
                container[key] = str(_pick(rng, (*TEXTS, *map(str, INTEGERS), *map(str, REALS))))
        case 4:
            del container[key]
        case 5:
            container[key] = json.loads(json.dumps(other[other_key]))
        case 6:
            container[key], other[other_key] = other[other_key], container[key]
            if _is_circular(container[key]) or _is_circular(other[other_key]):
                container[key], other[other_key] = other[other_key], container[key]
        case 7:
            lists = [slot[0][slot[1]] for slot in slots if isinstance(slot[0][slot[1]], list) and slot[0][slot[1]]]
            if lists:
                chosen = lists[rng.integers(len(lists))]
                chosen += chosen[:1] * int(rng.integers(1, 50))
        case _:
            numbers = [slot for slot in slots if slot[1] == "__id__" and isinstance(slot[0], dict)]
            if numbers:
                container, key = numbers[rng.integers(len(numbers))]
                container[key] = int(rng.integers(len(numbers) + 2))


def _is_circular(value: Any) -> bool:
    try:
        json.dumps(value)
    except ValueError:
        return True
    return False


def _zipped_again(
    content: bytes, change: Callable[[list[tuple[str, bytes]]], None], compression: int = zipfile.ZIP_STORED
) -> bytes:
    """Zip with its members changed, or the same bytes if it is no longer a zip."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = [(entry.filename, archive.read(entry)) for entry in archive.infolist()]
    except Exception:  # noqa: BLE001 - the zip may be damaged in any way
        return content
    if not members:
        return content
    change(members)
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", compression) as archive:
        for name, held in members:
            _append(archive, name, held)
    return file.getvalue()


def _append(archive: zipfile.ZipFile, name: str, held: bytes) -> None:
    entry = zipfile.ZipInfo(name)
    entry.compress_type = archive.compression
    archive.NameToInfo.pop(name, None)  # two members of a name are wanted here, without a warning
    archive.writestr(entry, held)


def _pick(rng: Generator, options: Any) -> Any:
    return options[int(rng.integers(len(options)))]
