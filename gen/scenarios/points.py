"""Quasi-random points, of which rigs, specimens and records take their first values."""

import warnings

import numpy as np
from numpy.typing import NDArray

from gen.drawing import Level, stream
from gen.recipe import Recipe

_DIMENSIONS = 64  # quasi-random values of an item; its further values are pseudo-random
# Each level has its own dimensions: with common ones the first values of a specimen and of its only record were correlated (r up to 1).
_FIRST_DIMENSION = {"record": 0, "specimen": _DIMENSIONS, "rig": 2 * _DIMENSIONS}


def points_of(recipe: Recipe, level: Level, first: int, stop: int) -> dict[int, NDArray[np.float64]]:
    """Quasi-random points of the items ``first`` to ``stop`` of a level, by number; empty points if sampling is random."""
    if recipe.corpus.sampling == "random":
        return {number: np.empty(0) for number in range(first, stop)}
    from scipy.stats import qmc  # the import takes half a second, and few recipes need it

    engine_type = {"sobol": qmc.Sobol, "halton": qmc.Halton}[recipe.corpus.sampling]
    rng = stream(recipe.seed, "corpus", 0, "corpus.sampling")
    engine = engine_type(_FIRST_DIMENSION[level] + _DIMENSIONS, scramble=True, rng=rng)
    if isinstance(engine, qmc.Halton):
        engine.num_generated = first  # Halton.fast_forward computes all points before it
    elif first > 0:  # Sobol.fast_forward(0) overflows in scipy
        engine.fast_forward(first)
    with warnings.catch_warnings():
        # a range of the sequence is not balanced, the whole sequence is
        warnings.filterwarnings("ignore", "The balance properties", UserWarning)
        points = engine.random(stop - first)[:, _FIRST_DIMENSION[level] :]
    return dict(zip(range(first, stop), points, strict=True))
