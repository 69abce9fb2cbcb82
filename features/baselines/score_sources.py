"""Hash of the source files that make features, models and scores: what is kept from an earlier run counts only with the same one."""

from gen.support.sources import hash_sources

_MAKES_SCORES = (
    "gen/corpus",
    "gen/support",
    "features/signal",
    "features/fault_classes.py",
    "features/table",
    "features/baselines",
)
"""Folders and files by which a corpus becomes scores; a test looks for others."""


def score_sources() -> str:
    """SHA-256 over the sources of features, models and scores, in hexadecimal."""
    return hash_sources(*_MAKES_SCORES)
