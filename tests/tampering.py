"""Corpora that are changed by someone who knows the format: checksums, manifest and index agree with the changed files."""

import hashlib
import json
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import h5py
import numpy as np

from gen.corpus.disk import append_checksum, remove_checksum
from gen.corpus.manifest import facts_as_attributes, write_manifest
from gen.support.errors import CorpusError


@contextmanager
def edited(path: Path) -> Iterator[h5py.File]:
    """Open a netCDF file of a corpus for changes; in the end it has the checksum of its bytes."""
    remove_checksum(path)
    with h5py.File(path, "r+") as file:
        yield file
    append_checksum(path)


def edit_manifest(folder, parts=(), **changes):
    """Change facts of ``manifest.json``, and those of some parts by their number."""
    content = manifest_content(folder) | changes
    for number, change in dict(parts).items():
        content["parts"][number] |= change
    write_manifest(folder, content)


def manifest_content(folder):
    """Contents of ``manifest.json`` without its hash."""
    content = json.loads((folder / "manifest.json").read_text())
    del content["sha256"]
    return content


def seal(folder):
    """Let manifest and index of a folder name the parts as they are now."""
    content = manifest_content(folder)
    for row in content["parts"]:
        data = (folder / "parts" / row["name"]).read_bytes()
        row |= {"bytes": len(data), "sha256": hashlib.sha256(data).hexdigest()}
    content["parts_sha256"] = hashlib.sha256("\n".join(row["sha256"] for row in content["parts"]).encode()).hexdigest()
    write_manifest(folder, content)
    with suppress(CorpusError), edited(folder / "index.nc") as index:
        attributes = facts_as_attributes(content)
        index.attrs.update({name: np.bytes_(text.encode()) for name, text in attributes.items()})
