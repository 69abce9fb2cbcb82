"""Fixtures of other folders, for tests that take long, kill processes or measure memory: ``make thorough`` runs them."""

from tests.benchmarks.conftest import brief_full, brief_seed, few_short
from tests.conftest import recipe_with, write_recipe
from tests.raceway.conftest import run, start, told

__all__ = ["brief_full", "brief_seed", "few_short", "recipe_with", "run", "start", "told", "write_recipe"]
