"""Hash of the source files that make records: two corpora with the same one were made by the same code."""

from gen.support.sources import hash_sources

_MAKES_RECORDS = (
    "gen/drawing",
    "gen/physics",
    "gen/mechanisms",
    "gen/recipe",
    "gen/scenarios",
    "gen/simulation",
    "gen/measurement",
    "gen/generation/step_checks.py",
    "gen/generation/undetected.py",
    "gen/generation/labels.py",
    "gen/support/units.py",
)
"""Folders and files by which a recipe becomes records."""


def sources_sha256() -> str:
    """SHA-256 over the sources of kernel, random draws, simulation, measurement and labels, in hexadecimal."""
    return hash_sources(*_MAKES_RECORDS)
