"""What a recipe is made of, and how a value is drawn from it.

============= ========================================================
module        responsibility
============= ========================================================
expressions   distributions as text: loguniform(0.1, 2)
distributions distributions of drawn values
section       base of all sections: bounds, unknown keys, meanings, draw
draws         numbers that a section is drawn from, shares of others
streams       random numbers and streams by name
============= ========================================================
"""

from gen.drawing.distributions import (
    DISTRIBUTIONS,
    KINDS,
    Choice,
    Distribution,
    Grid,
    Listed,
    LogUniform,
    Normal,
    Number,
    Support,
    Uniform,
    interval,
    is_within,
    weighted_index,
    within,
)
from gen.drawing.draws import Combination, Draws, Wholes
from gen.drawing.section import (
    Count,
    Name,
    Probability,
    Section,
    Weight,
    bounds_of,
    composed,
    plain,
    quantities,
    sections_with_places,
)
from gen.drawing.streams import Level, number, stream

__all__ = [
    "DISTRIBUTIONS", "KINDS", "Choice", "Combination", "Count", "Distribution", "Draws", "Grid", "Level", "Listed", "LogUniform",
    "Name", "Normal", "Number", "Probability", "Section", "Support", "Uniform", "Weight", "Wholes", "bounds_of", "composed", "interval",
    "is_within", "number", "plain", "quantities", "sections_with_places", "stream", "weighted_index", "within",
]  # fmt: skip
