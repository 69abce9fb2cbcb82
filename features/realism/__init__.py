"""How much synthetic records look like real ones: the same measures on both, class by class.

``corpora -> windows of one length, band and rate -> measures -> weighted AUC, quantiles, yardstick``

========== =========================================================================
module     responsibility
========== =========================================================================
measures   the measured features, each with unit and definition, from arrays [pure]
contrast   weighted AUC and quantiles of two samples [pure]
windows    windows of a corpus: choice, reading in blocks, common band and rate
comparison a synthetic corpus against real ones, and each real one against the others
========== =========================================================================
"""

from typing import TYPE_CHECKING

from gen.lazy import lazy_names

if TYPE_CHECKING:
    from features.realism.comparison import Comparison, compare

__all__ = ["Comparison", "compare"]

__getattr__, __dir__ = lazy_names(__name__, {"features.realism.comparison": ("Comparison", "compare")})
