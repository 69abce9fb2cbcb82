"""Variables of the corpus that tell what mechanisms did to a record."""

from gen.corpus.schema import Variable
from gen.drawing import Drawn
from gen.mechanisms.background.section import LOCKED, labels_of
from gen.mechanisms.chain.measuring_chain import CHAIN
from gen.mechanisms.faults import KINDS
from gen.mechanisms.faults.bearing_fault import Damage

LABELS: tuple[Variable, ...] = tuple(
    {label.name: label for mechanism in (*KINDS, *LOCKED, *CHAIN) for label in mechanism.labels}.values()
)
"""Of faults, of the background, then of the measuring chain."""


def label_values(damage: Damage, background: Drawn, chain: dict[str, float]) -> dict[str, float]:
    """Values of all ``LABELS`` of one record, 0 for those of mechanisms that are not in it.

    Labels of faults have the names of drawn values, and ``chain`` has the values of the labels of the measuring chain.
    """
    sizes = {name: value for drawn in damage.values() for name, value in drawn.items()}
    known = sizes | labels_of(background) | chain
    return {label.name: known.get(label.name, 0) for label in LABELS}
