"""MATLAB files altered as damage or a stranger may alter them: a variable is read, or the file refused in a sentence.

Level 5 is altered element by element, a compressed element after decompression; level 7.3 in its attributes, links and layout.
"""

import io
import struct
import zlib
from contextlib import suppress
from pathlib import Path

import h5py
import numpy as np
import scipy.io

from gen.importers.files import UnusableError, one_column
from gen.importers.matlab import read_matlab

VARIABLES = ("x", "bearing.gs", "text", "absent")
LENGTHS = (0, 1, 3, 4, 7, 8, 9, 255, 4096, 65_535, 2**24, 2**31 - 1, 2**31, 2**32 - 1)
HEADER, MATRIX, COMPRESSED = 128, 14, 15


def seeds(folder: Path) -> list[Path]:
    """Valid MATLAB files of both levels, written into a folder."""
    values = np.random.default_rng(1).normal(size=(40, 1))
    content = {
        "x": values,
        "bearing": {"gs": values, "sr": 48828.0, "load": "50"},
        "text": "lost",
        "n": np.arange(6, dtype=np.int16).reshape(2, 3),
    }
    for name, compressed in (("plain_5.mat", False), ("compressed_5.mat", True)):
        scipy.io.savemat(folder / name, content, do_compression=compressed)
    scipy.io.savemat(
        folder / "cells_5.mat", {"c": np.array([values, "a"], dtype=object), "z": values * 1j, "x": values}
    )
    for name, options in (
        ("plain_7_3.mat", {}),
        ("chunks_7_3.mat", {"chunks": (1, 16), "compression": "gzip", "shuffle": True}),
    ):
        with h5py.File(folder / name, "w", userblock_size=512) as file:
            file.create_dataset("x", data=values.T, **options)
            file.create_dataset("bearing/gs", data=values.T, **options)
            file.create_dataset("text", data=np.array([[108, 111]], np.uint16))
            file["x"].attrs["MATLAB_class"] = np.bytes_("double")
        with (folder / name).open("r+b") as stream:
            stream.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")
    names = ("plain_5.mat", "compressed_5.mat", "cells_5.mat", "plain_7_3.mat", "chunks_7_3.mat")
    return [folder / name for name in names]


def mutate(content: bytes, rng: np.random.Generator) -> bytes:
    """One or two changes of a MATLAB file."""
    for _ in range(int(rng.integers(1, 3))):
        if rng.random() < 0.15:
            content = _cut(content, rng) if rng.random() < 0.3 else _bytes(content, rng)
        elif b"\x89HDF" in content[:520]:
            content = _level_7_3(content, rng)
        else:
            content = _level_5(content, rng)
    return content


def check(path: Path) -> None:
    """Read some variables of a file; any exception except an UnusableError is a finding."""
    with path.open("rb") as stream:
        of_level_7_3 = b"\x89HDF" in stream.read(520)  # each variable is read in a separate process, which takes 10 ms
    for variable in VARIABLES[:1] if of_level_7_3 else VARIABLES:
        with suppress(UnusableError):
            one_column(read_matlab(path, variable), 0)


def _cut(content: bytes, rng: np.random.Generator) -> bytes:
    return content[: int(rng.integers(len(content) + 1))]


def _bytes(content: bytes, rng: np.random.Generator) -> bytes:
    changed = bytearray(content or b"\0")
    for _ in range(int(rng.integers(1, 6))):
        changed[int(rng.integers(len(changed)))] = int(rng.integers(256))
    return bytes(changed)


def _level_5(content: bytes, rng: np.random.Generator) -> bytes:
    """A change of the elements of a level 5 file, found as they stand."""
    if rng.random() < 0.05:
        place = int(rng.integers(116, HEADER))
        return content[:place] + bytes([int(rng.integers(256))]) + content[place + 1 :]
    elements = _elements(content[HEADER:])
    if not elements:
        return _bytes(content, rng)
    place = int(rng.integers(len(elements)))
    match int(rng.integers(6)):
        case 0:
            elements.insert(place, elements[int(rng.integers(len(elements)))])
        case 1:
            del elements[place]
        case _:
            elements[place] = _element(elements[place], rng)
    return content[:HEADER] + b"".join(elements)


def _elements(data: bytes) -> list[bytes]:
    """Elements one after the other, each with its tag and padding."""
    found = []
    while len(data) >= 8:
        kind, length = struct.unpack("<II", data[:8])
        size = 8 if kind >> 16 else 8 + length + (0 if kind == COMPRESSED else -length % 8)
        found.append(data[:size])
        data = data[size:]
    return found


def _element(element: bytes, rng: np.random.Generator) -> bytes:
    """A change within an element: of its parts if it is an array, of its decompressed content if it is compressed."""
    kind, length = struct.unpack("<II", element[:8])
    if kind == COMPRESSED:
        with suppress(zlib.error):
            inside = zlib.decompress(element[8 : 8 + length])
            inside = _element(inside, rng) if rng.random() < 0.8 else inside * int(rng.integers(2, 2000))
            packed = zlib.compress(inside, int(rng.integers(10)))
            if rng.random() < 0.2:
                packed = [_cut, _bytes][int(rng.integers(2))](packed, rng)
            return struct.pack("<II", COMPRESSED, len(packed)) + packed
    if kind == MATRIX and rng.random() < 0.8:
        parts = _elements(element[8:])
        if parts:
            place = int(rng.integers(len(parts)))
            match int(rng.integers(6)):
                case 0:
                    del parts[place]
                case 1:
                    parts.insert(place, parts[int(rng.integers(len(parts)))])
                case _:
                    parts[place] = _part(parts[place], rng)
        inside = b"".join(parts)
        return struct.pack("<II", MATRIX, len(inside)) + inside
    return _part(element, rng)


def _part(part: bytes, rng: np.random.Generator) -> bytes:
    """Another type, another length, or other values, such as other sides of an array."""
    kind, length = struct.unpack("<II", part[:8])
    match int(rng.integers(5)):
        case 0:
            return struct.pack("<II", int(rng.integers(20)), length) + part[8:]
        case 1:
            return struct.pack("<II", kind, LENGTHS[int(rng.integers(len(LENGTHS)))]) + part[8:]
        case 2:
            size = int(rng.integers(1 << 17))
            return struct.pack("<II", size << 16 & 0xFFFF0000 | kind & 0xFFFF, length) + part[8:]
        case 3 if len(part) >= 12:
            place = 8 + 4 * int(rng.integers((len(part) - 8) // 4))
            number = [0, 1, -1, -40, 20, 40, 2**31 - 1, int(rng.integers(2**31))][int(rng.integers(8))]
            return part[:place] + struct.pack("<i", number) + part[place + 4 :]
        case _:
            return part[:8] + _bytes(part[8:], rng)[: len(part) - 8]


def _level_7_3(content: bytes, rng: np.random.Generator) -> bytes:
    """A change through the library, or of the bytes that describe the layout, which come before the values."""
    if rng.random() < 0.6:
        changed = bytearray(content)
        for _ in range(int(rng.integers(1, 4))):
            place = int(rng.integers(512, len(changed)))
            if rng.random() < 0.5:
                changed[place] = [0, 1, 2, 255, 128, int(rng.integers(256))][int(rng.integers(6))]
            else:
                number = LENGTHS[int(rng.integers(len(LENGTHS)))]
                changed[place : place + 4] = struct.pack("<I", number)[: len(changed) - place]
        return bytes(changed)
    stream = io.BytesIO(content)
    with suppress(Exception), h5py.File(stream, "r+") as file:
        _rewritten(file, rng)
    return stream.getvalue()


def _rewritten(file: h5py.File, rng: np.random.Generator) -> None:
    """Put something else in the place of a variable."""
    name = ["x", "bearing/gs", "text"][int(rng.integers(3))]
    size = int(10 ** rng.uniform(0, 12))
    match int(rng.integers(11)):
        case 0:
            del file[name]
            file[name] = h5py.SoftLink(["/x", "/text", "/nowhere", "/", name][int(rng.integers(5))])
        case 1:
            del file[name]
            file[name] = h5py.ExternalLink("/etc/passwd", "/x")
        case 2:
            del file[name]
            file.create_dataset(name, (100,), "u1", external=[("/etc/passwd", 0, 100)])
        case 3:
            del file[name]
            layout = h5py.VirtualLayout((40,), "f8")
            layout[:] = h5py.VirtualSource("." if rng.random() < 0.5 else "other.mat", "text", (40,), "f8")
            file.create_virtual_dataset(name, layout)
        case 4:
            del file[name]
            file.create_dataset(name, (size,), "f8", chunks=(min(size, 1000),))
        case 5:
            del file[name]
            file.create_dataset(
                name, (min(size, 1000),), "f8", maxshape=(None,), chunks=(int(10 ** rng.uniform(0, 6)),)
            )[0] = 1
        case 6:
            del file[name]
            found = file.create_dataset(
                name, (1000,), "f8", chunks=(1000,), compression="gzip", fletcher32=rng.random() < 0.5
            )
            found.id.write_direct_chunk((0,), zlib.compress(bytes(min(size, 10**7))), int(rng.integers(4)))
        case 7:
            del file[name]
            odd = [
                ["a", "bc"],
                np.array([1j]),
                np.array([(1, 2)], "i4,f8"),
                h5py.Empty("f8"),
                3.5,
                np.zeros((2, 3, 4)),
                [True],
            ]
            file[name] = odd[int(rng.integers(len(odd)))]
        case 8:
            del file[name]
            file.create_group(name)
        case 9:
            file["x"].attrs["MATLAB_class"] = ["char", "struct", "", "x" * 1000][int(rng.integers(4))]
        case _:
            file.move(name, ["bearing/x", "y", "absent"][int(rng.integers(3))])
