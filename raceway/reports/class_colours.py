"""Colours of the fault classes in all pictures, from the palette of Okabe and Ito [1]_; classes of plug-ins take further ones.

.. [1] M. Okabe, K. Ito, "Color Universal Design: how to make figures and presentations that are friendly to colorblind
       people", 2008.
"""

from collections.abc import Mapping
from itertools import cycle

from gen.corpus.fault_classes import FAULTS, HEALTHY, UNKNOWN

_OWN = {
    HEALTHY: "#009E73",
    "inner": "#D55E00",
    "outer": "#0072B2",
    "ball": "#CC79A7",
    "cage": "#E69F00",
    "compound": "#56B4E9",
    UNKNOWN: "#444444",
}
_FURTHER = ("#882255", "#999933", "#332288", "#F0E442")

FAULT_COLOURS: Mapping[str, str] = {
    **_OWN,
    **dict(zip((name for name in FAULTS if name not in _OWN), cycle(_FURTHER), strict=False)),
}
"""By the name of the class."""
