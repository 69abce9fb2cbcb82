"""Features of vibration records: a corpus in, a feature table and scores out.

It uses the format of a corpus and not the simulator, so that recordings of real machines are treated in the same way.

``corpus -> feature_table -> Model -> scores``

============= ===================================================================================
module        responsibility
============= ===================================================================================
signal        spectra, envelope spectra, levels of fault lines, statistics of the waveform [pure]
table         records -> feature table: bands, definitions, indicators, files
auditing      splits of real recordings that can leak
baselines     classifiers on a feature table, scored by specimen or rig beside their controls
ranking       features by what a classifier loses without them
============= ===================================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
