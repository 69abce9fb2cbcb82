"""What a feature table teaches: baseline classifiers, scored without leakage and beside their controls.

``feature table -> labelled_records -> splits by specimen or rig -> probabilities -> Scores``

============= ==================================================================================
module        responsibility
============= ==================================================================================
records       the rows of a feature table as a classifier sees them, and their groups
estimators    the registry of baselines, from majority class to ensemble
scores        figures over the classes present, by record and by recording, with intervals
splits        grouped cross-validation and its guards
model_members the zip of a model file and its arrays, checked before they are read
model_file    what a model file holds as plain values; the one place that reads and writes skops
model_rules   what training may put into the attributes of an estimator
model_check   the estimator of a model file against one trained here
models        training, saving, loading, evaluation
benchmark     every baseline, its controls, and another corpus
============= ==================================================================================
"""

from features.baselines.benchmark import Baseline, Results, benchmark
from features.baselines.estimators import DEFAULT_ESTIMATOR, ESTIMATORS
from features.baselines.models import Model, evaluate, load_model, save_model, train
from features.baselines.records import DEFAULT_GROUPS
from features.baselines.scores import Scores
from features.baselines.splits import cross_validate

__all__ = [
    "DEFAULT_ESTIMATOR",
    "DEFAULT_GROUPS",
    "ESTIMATORS",
    "Baseline",
    "Model",
    "Results",
    "Scores",
    "benchmark",
    "cross_validate",
    "evaluate",
    "load_model",
    "save_model",
    "train",
]
