"""Variables of the corpus that tell what mechanisms did to a record."""

from gen.mechanisms import faults
from gen.mechanisms.background import section
from gen.mechanisms.chain import measuring_chain

LABELS = faults.LABELS + section.LABELS + measuring_chain.LABELS
"""Of faults, of the background, then of the measuring chain: 0 in a record without the mechanism."""
