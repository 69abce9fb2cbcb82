"""Names of baselines and tracks, which the command line needs before scikit-learn is loaded."""

from typing import Literal, get_args

BASELINES = (
    "majority",
    "envelope_rule",
    "logistic_regression",
    "svm",
    "random_forest",
    "extra_trees",
    "gradient_boosting",
    "ensemble",
)
"""Functions of `features.baselines.estimators` that make an estimator from a seed."""
UNTRAINED = ("majority", "envelope_rule")
DEFAULT_ESTIMATOR = "ensemble"

Track = Literal["specimen", "rig", "bearing", "speed"]
TRACKS: tuple[Track, ...] = get_args(Track)
