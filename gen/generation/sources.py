"""Hash of the source files that make records: two corpora with the same one were made by the same code."""

import functools
import hashlib
from pathlib import Path

_MAKES_RECORDS = (
    "physics",
    "recipe",
    "scenarios",
    "simulation",
    "measurement",
    "generation/step_checks.py",
    "generation/undetected.py",
    "generation/labels.py",
    "generation/scheduling.py",
    "support/units.py",
)
"""Folders and files of this package by which a recipe becomes records."""


@functools.cache
def sources_sha256() -> str:
    """SHA-256 over the sources of kernel, random draws, simulation, measurement and labels, in hexadecimal."""
    root, digest = Path(__file__).parents[1], hashlib.sha256()
    for name in _MAKES_RECORDS:
        place = root / name
        for path in sorted(place.rglob("*.py")) if place.is_dir() else [place]:
            digest.update(f"{path.relative_to(root)}\n".encode() + path.read_bytes())
    return digest.hexdigest()
