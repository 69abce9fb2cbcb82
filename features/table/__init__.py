"""Feature tables: what each record of a corpus, of one recording or of an array shows, with one row for each record.

``signals -> indicators, shaft speed -> table (record, feature) -> files``

================== =================================================================================
module             responsibility
================== =================================================================================
band               band of frequencies that features are computed from [pure]
channels           channel of a corpus by name or number
durations          durations of records, and the windows that a model takes of longer ones [pure]
record_batch       records computed together, whitened bands and envelopes that groups share [pure]
feature_group      the form of a feature group, built-in or of a plug-in [pure]
envelope_groups    groups of fault lines and of shape, in envelopes of whitened bands [pure]
waveform_groups    groups of band energies and of time statistics [pure]
definitions        all groups; name, unit, meaning, formula and range of every feature [pure]
class_features     features that tell a fault class, by its lines [pure]
indicators         the feature vector of records, in chosen groups [pure]
speed_search       shaft speed of a recording, from its windows [pure]
recording_speeds   shaft speed of every recording of a corpus, and warnings of wrong labels
corpus_features    corpus -> feature table, part by part
recording_features feature table of one recording that lies in no corpus
table_files        feature tables on disk
waveforms          signals of a corpus as an array that is read when it is indexed
network_input      envelope levels at multiples of the fault orders, for networks [pure]
================== =================================================================================
"""
