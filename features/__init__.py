"""Features of vibration records: a corpus in, a feature table, scores and a report out.

It knows the format of a corpus and not the simulator, so that recordings of real machines are treated alike.

``corpus -> feature_table -> evaluate -> report``

============ =================================================================================
module       responsibility
============ =================================================================================
rows         what loops over records share: compilation, sums, windows [pure]
spectra      power spectra, Fourier coefficients, whitening [pure]
demodulation bands as analytic signals, envelope spectra and their floor [pure]
lines        levels of fault lines and combs at orders of the shaft [pure]
shape        impulsiveness, slow fluctuation, time statistics [pure]
indicators   the feature vector of records, in four groups [pure]
transformer  the same as a scikit-learn transformer
table        corpus -> feature table (record, feature), part by part
table_files  feature tables on disk
baselines    classifiers on a feature table, scored by specimen or rig beside their controls
pictures     records, corpora and scores as figures
envelopes    envelope spectra in pictures of many: faults side by side, run-ups
report       one page of all that, and the picture of a record
============ =================================================================================
"""

from features.baselines import evaluate
from features.table import feature_table

__all__ = ["evaluate", "feature_table"]
