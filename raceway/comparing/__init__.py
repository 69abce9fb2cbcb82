"""How much synthetic records look like real ones: the same measures on both, class by class.

``corpora -> windows of one length, band and rate -> measures -> weighted AUC, quantiles, yardstick``

=============== ==========================================================================
module          responsibility
=============== ==========================================================================
measures        the measured features, each with unit and definition, from arrays [pure]
windows         windows of a corpus: choice, reading in blocks, common band and rate
comparison      a synthetic corpus against real ones, and each real one against the others
comparison_page page of a comparison
compare_command the command compare
=============== ==========================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
