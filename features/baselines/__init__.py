"""Baseline classifiers on a feature table, scored without leakage and together with controls.

``feature table -> labelled_records -> splits by specimen or rig -> Predictions -> Scores``

================= ========================================================================================
module            responsibility
================= ========================================================================================
names             names of baselines and tracks
records           labelled rows of a feature table, and the groups that they belong to
own               classifiers of the user, taught by class names
estimators        the registry of baselines, from majority class to ensemble
calibration       calibrated probabilities, and thresholds of answers
references        features relative to healthy records of the same rig
reference_choice  records tested against a reference, without those that belong to it
colour_distance   distance of the colour of a record from healthy recordings of its rig
predictions       predicted classes of records and of whole recordings
scores            figures of merit by record and by recording, with confidence intervals
detection         detection of faults by their width, and against false alarms
tracks            splits by specimen, rig, bearing type and speed, and their checks
fitting           fits of one classifier to several selections of records
splits            cross-validation on a track, with its two controls
inspection        permutation importance of features
cross_calibration calibration on rigs or specimens outside the training
model_file        the only module that reads and writes archives of skops
model_parts       models within a model, read when they are used
classifying       predictions of a fitted model for feature tables and waveforms
models            training, evaluation, saving, loading
results           scores of every baseline with controls, and on other corpora
submissions       predictions of a cross-validation in a file, and their scores
================= ========================================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
