"""Corpora whose files are changed by someone who knows the format: the manifest names the changed files, so that their hashes agree."""

import hashlib
import io
import json
import shutil
import tempfile
import zipfile
from contextlib import suppress
from pathlib import Path

import h5py
import numpy as np

from features.table import part_features
from gen.corpus import SIGNAL, open_corpus, validate_corpus
from gen.errors import RacewayError
from tests.corpora import write_corpus

INDEX, MANIFEST = "corpus.nc", "manifest.json"
ODD = (
    None,
    True,
    -1,
    0,
    1e308,
    10**40,
    "",
    "x" * 70,
    "../x",
    "part-00001.nc",
    [],
    {},
    [[]],
    {"a": []},
    "9" * 64,
    float("nan"),
)


def seeds(folder):
    """Archives of two small corpora."""
    paths = []
    for kind in ("counts", "float32"):
        write_corpus(folder / kind, (2, 2), kind=kind)
        paths.append(Path(shutil.make_archive(str(folder / f"{kind}-corpus"), "zip", folder / kind)))
    return paths


def mutate(content, rng):
    """Change one or two files of an archived corpus; most of the time the manifest then names them as they are."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        files = {name: archive.read(name) for name in archive.namelist() if not name.endswith("/")}
    for _ in range(rng.integers(1, 3)):
        name = str(rng.choice(sorted(files)))
        if name == MANIFEST:
            files[name] = _other_manifest(files[name], rng)
        else:
            files[name] = rng.choice([_flipped, _cut, _edited, _edited, _edited])(files[name], rng)
    if rng.random() < 0.9:
        files[MANIFEST] = _sealed(files)
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return out.getvalue()


def check(path):
    """Open, validate and read the corpus, and compute features of its parts."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "c"
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        validate_corpus(folder)
        with suppress(RacewayError):
            with open_corpus(folder) as corpus:
                corpus.load()
            for part in sorted((folder / "parts").iterdir()):
                part_features(part, ("time",))


def _flipped(data, rng):
    altered = bytearray(data)
    for place in rng.integers(0, len(data), rng.integers(1, 9)):
        altered[place] ^= int(rng.integers(1, 256))
    return bytes(altered)


def _cut(data, rng):
    return data[: rng.integers(0, len(data))]


def _edited(data, rng):
    """An HDF5 file with one thing changed by the library itself."""
    stream = io.BytesIO(data)
    try:
        with h5py.File(stream, "r+") as file:
            names = sorted(file)
            name, other = (str(item) for item in rng.choice(names, 2))
            edits = (_attribute, _attribute, _replaced, _replaced, _link, _values)
            edits[rng.integers(len(edits))](file, name, other, rng)
    except (OSError, ValueError, TypeError, KeyError, RuntimeError, OverflowError):
        return data  # too damaged to edit, or the library refuses the edit
    return stream.getvalue()


def _attribute(file, name, _other, rng):
    node = file if rng.random() < 0.2 else file[name]
    keys = [*node.attrs, "scale_factor", "coordinates", "_FillValue", "units", "calendar", "add_offset"]
    key = str(rng.choice(keys))
    values = (
        np.float64(np.nan),
        np.int64(-1),
        np.zeros((2, 2)),
        "days since 1-1-1",
        "",
        b"\xff\xfe",
        "x" * 1000,
        h5py.Empty("f"),
        1e308,
    )
    if key in node.attrs and rng.random() < 0.3:
        del node.attrs[key]
    else:
        node.attrs[key] = values[rng.integers(len(values))]


def _replaced(file, name, _other, rng):
    shape = file[name].shape
    attributes = {
        key: file[name].attrs[key] for key in file[name].attrs if key not in ("DIMENSION_LIST", "REFERENCE_LIST")
    }
    del file[name]
    dtypes = (
        "f8",
        "i2",
        "f4",
        "S1",
        "S40",
        h5py.string_dtype(),
        "c16",
        [("a", "i4")],
        h5py.ref_dtype,
        "?",
        "u8",
        ">i2",
    )
    shapes = (shape, shape[::-1], (), (0,), (4,), (2**40,), (2, 2**36, 2), (4, 2), (*shape, 1))
    dtype, size = dtypes[rng.integers(len(dtypes))], shapes[rng.integers(len(shapes))]
    chunks = True if int(np.prod(size, dtype=float) > 1e6) else None
    file.create_dataset(name, size, dtype, chunks=chunks).attrs.update(attributes)


def _link(file, name, other, rng):
    links = (
        h5py.SoftLink(f"/{other}"),
        h5py.ExternalLink("/etc/passwd", "/x"),
        h5py.SoftLink(f"/{name}"),
        file["/"],
        file[other],
    )
    del file[name]
    file[name] = links[rng.integers(len(links))]


def _values(file, name, _other, rng):
    if name != SIGNAL and file[name].shape and file[name].dtype.kind in "iuf":
        file[name][rng.integers(len(file[name]))] = (np.nan, 127, -1, 0, 1e30)[rng.integers(5)]


def _other_manifest(data, rng):
    try:
        manifest = json.loads(data)
        assert manifest.keys() >= {"parts", "index"}
        assert all(isinstance(row, dict) and row for row in manifest["parts"])
    except (ValueError, RecursionError, AssertionError, AttributeError, TypeError):
        return data  # changed already
    node = (
        manifest["parts"][rng.integers(len(manifest["parts"]))]
        if manifest["parts"] and rng.random() < 0.4
        else manifest
    )
    key = str(rng.choice(sorted(node)))
    if rng.random() < 0.2 and len(node) > 1:
        del node[key]
    else:
        node[key] = ODD[rng.integers(len(ODD))]
    text = json.dumps(manifest)
    kinds = (text, text, text, text[: rng.integers(len(text))], "[" * 100_000, text.replace(":", ",", 1))
    return kinds[rng.integers(len(kinds))].encode()


def _sealed(files):
    """The manifest with sizes and hashes of the files as they are, as far as it can be read."""
    try:
        manifest = json.loads(files[MANIFEST])
        for row, name in [(manifest["index"], INDEX), *((row, f"parts/{row['name']}") for row in manifest["parts"])]:
            row |= {"bytes": len(files[name]), "sha256": hashlib.sha256(files[name]).hexdigest()}
        return json.dumps(manifest).encode()
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return files[MANIFEST]
