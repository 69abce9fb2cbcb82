"""Colours of the fault classes in all pictures by their places in the palette of Okabe and Ito [1]_, with further ones behind it.

.. [1] M. Okabe, K. Ito, "Color Universal Design: how to make figures and presentations that are friendly to colorblind
       people", 2008.
"""

from collections.abc import Mapping
from itertools import cycle

from gen.corpus.fault_classes import FAULTS, UNKNOWN

_PALETTE = (
    "#009E73", "#D55E00", "#0072B2", "#CC79A7", "#E69F00", "#56B4E9", "#882255", "#999933", "#332288", "#F0E442",
)  # fmt: skip

FAULT_COLOURS: Mapping[str, str] = {**dict(zip(FAULTS, cycle(_PALETTE), strict=False)), UNKNOWN: "#444444"}
"""By the name of the class."""
