"""Hash of the source files that make records: two corpora with the same one were made by the same code."""

from gen.support.sources import hash_sources

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


def sources_sha256() -> str:
    """SHA-256 over the sources of kernel, random draws, simulation, measurement and labels, in hexadecimal."""
    return hash_sources("gen", *_MAKES_RECORDS)
