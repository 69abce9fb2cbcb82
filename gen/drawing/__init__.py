"""What a recipe is made of, and how a value is drawn from it.

============= ========================================================
module        responsibility
============= ========================================================
expressions   distributions as text: loguniform(0.1, 2)
distributions distributions of drawn values
section       base of all sections: bounds, unknown keys, meanings
draws         draw values from the distributions of a section
streams       random streams by number and purpose
============= ========================================================
"""

from gen.drawing.distributions import (
    DISTRIBUTIONS,
    KINDS,
    Choice,
    Distribution,
    Grid,
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
from gen.drawing.draws import Combination, Drawn, Draws, Known, in_si, known_of
from gen.drawing.section import Count, Name, Probability, Section, Weight, composed, plain, quantities
from gen.drawing.streams import Purpose, stream

__all__ = [
    "DISTRIBUTIONS", "KINDS", "Choice", "Combination", "Count", "Distribution", "Drawn", "Draws", "Grid", "Known", "LogUniform", "Name",
    "Normal", "Number", "Probability", "Purpose", "Section", "Support", "Uniform", "Weight", "composed", "in_si", "interval", "is_within",
    "known_of", "plain", "quantities", "stream", "weighted_index", "within",
]  # fmt: skip
