"""Features of vibration records: a corpus in, a feature table, scores and a report out.

It uses the format of a corpus and not the simulator, so that recordings of real machines are treated in the same way.

``corpus -> feature_table -> Model -> report``, and ``one recording -> diagnose -> report``

================ =================================================================================
module           responsibility
================ =================================================================================
band             band of frequencies that features are computed from [pure]
channels         channel of a corpus by name or number
durations        durations of records, and the model that suits them [pure]
faults           the fault classes: colour, lines and telling features of each, in one table
signal           spectra, envelope spectra, levels of fault lines, statistics of the waveform [pure]
definitions      name, unit, meaning, formula and range of every feature [pure]
indicators       the feature vector of records, in four groups [pure]
speed            shaft speed of a recording, from its windows [pure]
line_bands       bands of the fault lines of a bearing, and what a spectrum has in them
accessor         the functions of `signal` on xarray
transformer      the feature vector as a scikit-learn transformer
recording_table  feature table of one recording that lies in no corpus
recording_speeds shaft speed of every recording of a corpus, and warnings of wrong labels
table            corpus -> feature table (record, feature), part by part
table_files      feature tables on disk
auditing         splits of real recordings that can leak
waveforms        signals of a corpus as an array that is read when it is indexed
network_input    envelope levels at multiples of the fault orders, for networks [pure]
baselines        classifiers on a feature table, scored by specimen or rig beside their controls
ranking          features by how well they tell the classes, or follow a series to its end
realism          synthetic records against real ones: AUC of measures, class by class
diagnosis        class of one recording, and the lines that speak for it
report           figures of records, corpora and scores, and one page with all of them
================ =================================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
