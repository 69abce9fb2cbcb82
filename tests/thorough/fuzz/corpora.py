"""Corpora whose files are changed by someone who knows the format: a folder, and a single file.

Most of the time the changed netCDF files end with their checksum, and manifest and index name the parts as they are now.
"""

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

from features.table.corpus_features import feature_table
from gen.corpus import SIGNAL, open_corpus, validate_corpus
from gen.corpus.manifest import manifest_text
from gen.support.errors import RacewayError
from raceway.console.summary import corpus_facts
from raceway.sharing.card.card_page import data_card
from tests.corpora import write_corpus

INDEX, MANIFEST, SINGLE = "index.nc", "manifest.json", "c.nc"
LINE_BYTES = 73  # of the checksum
ODD = (
    None, True, -1, 0, 1e308, 10**40, "", "x" * 70, "../x", "part-00001.nc", [], {}, [[]], {"a": []}, "9" * 64, float("nan"),
)  # fmt: skip


def seeds(folder):
    """Archives of small corpora of both forms."""
    paths = []
    for kind in ("counts", "float32"):
        for name in ("c", SINGLE):
            place = folder / f"{kind}-{name}"
            write_corpus(place / name, (2, 2), kind=kind)
            root = place / name if name == "c" else place
            paths.append(Path(shutil.make_archive(str(folder / f"{kind}-{name}-corpus"), "zip", root)))
    return paths


def mutate(content, rng):
    """Change one or two files of an archived corpus; most of the time their checksums are then right."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        files = {name: archive.read(name) for name in archive.namelist() if not name.endswith("/")}
    sealed = rng.random() < 0.9
    for _ in range(rng.integers(1, 3)):
        name = str(rng.choice(sorted(set(files) - {"README.md"})))
        if name == MANIFEST:
            files[name] = _other_manifest(files[name], rng)
        elif not name.endswith(".nc"):
            files[name] = rng.choice([_flipped, _cut])(files[name], rng)
        else:
            changed = rng.choice([_flipped, _cut, _edited, _edited, _edited])(files[name][:-LINE_BYTES], rng)
            files[name] = _with_line(changed) if sealed else changed + files[name][-LINE_BYTES:]
    if sealed and MANIFEST in files:
        _seal(files)
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return out.getvalue()


def check(path):
    """Validate, open and read the corpus, describe it, write its data card and compute its features: each works or says one sentence."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "c"
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        corpus = folder / SINGLE if (folder / SINGLE).exists() else folder
        problems = validate_corpus(corpus)
        assert not any("\n" in problem for problem in problems), problems
        for use in (_load, corpus_facts, data_card, lambda corpus: feature_table(corpus, ("time",))):
            with suppress(RacewayError):
                use(corpus)


def _load(corpus):
    with open_corpus(corpus) as opened:
        opened.load()


def _with_line(data):
    return data + f"\nsha256:{hashlib.sha256(data).hexdigest()}\n".encode()


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
    texts = "days since 1-1-1", "", b"\xff\xfe", "x" * 1000
    values = (np.float64(np.nan), np.int64(-1), np.zeros((2, 2)), h5py.Empty("f"), 1e308, *texts)
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
    plain = "f8", "i2", "f4", "S1", "S40", "c16", "?", "u8", ">i2"
    dtypes = (*plain, h5py.string_dtype(), [("a", "i4")], h5py.ref_dtype)
    shapes = (shape, shape[::-1], (), (0,), (4,), (2**40,), (2, 2**36, 2), (4, 2), (*shape, 1))
    dtype, size = dtypes[rng.integers(len(dtypes))], shapes[rng.integers(len(shapes))]
    chunks = True if int(np.prod(size, dtype=float) > 1e6) else None
    file.create_dataset(name, size, dtype, chunks=chunks).attrs.update(attributes)


def _link(file, name, other, rng):
    soft = [h5py.SoftLink(f"/{target}") for target in (name, other)]
    links = (*soft, h5py.ExternalLink("/etc/passwd", "/x"), file["/"], file[other])
    del file[name]
    file[name] = links[rng.integers(len(links))]


def _values(file, name, _other, rng):
    if name != SIGNAL and file[name].shape and file[name].dtype.kind in "iuf":
        file[name][rng.integers(len(file[name]))] = (np.nan, 127, -1, 0, 1e30)[rng.integers(5)]


def _other_manifest(data, rng):
    try:
        manifest = json.loads(data)
        assert "parts" in manifest
        assert all(isinstance(row, dict) and row for row in manifest["parts"])
    except (ValueError, RecursionError, AssertionError, AttributeError, TypeError):
        return data  # changed already
    rows = manifest["parts"] if rng.random() < 0.4 else []
    node = rows[rng.integers(len(rows))] if rows else manifest
    key = str(rng.choice(sorted(node)))
    if rng.random() < 0.2 and len(node) > 1:
        del node[key]
    else:
        node[key] = ODD[rng.integers(len(ODD))]
    text = json.dumps(manifest)
    kinds = (text, text, text, text[: rng.integers(len(text))], "[" * 100_000, text.replace(":", ",", 1))
    return kinds[rng.integers(len(kinds))].encode()


def _seal(files):
    """Let manifest and index name the parts as they are, as far as they can be read."""
    with suppress(ValueError, KeyError, TypeError, AttributeError, RecursionError, OSError, RuntimeError):
        manifest = json.loads(files[MANIFEST])
        for row in manifest["parts"]:
            data = files[f"parts/{row['name']}"]
            row |= {"bytes": len(data), "sha256": hashlib.sha256(data).hexdigest()}
        hashes = "\n".join(row["sha256"] for row in manifest["parts"])
        manifest["parts_sha256"] = hashlib.sha256(hashes.encode()).hexdigest()
        manifest.pop("sha256", None)
        files[MANIFEST] = manifest_text(manifest).encode()
        stream = io.BytesIO(files[INDEX][:-LINE_BYTES])
        with h5py.File(stream, "r+") as index:
            index.attrs["parts_sha256"] = manifest["parts_sha256"]
        files[INDEX] = _with_line(stream.getvalue())
