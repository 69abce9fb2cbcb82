from .results import (
    Baseline as Baseline,
    Results as Results,
    TrackResults as TrackResults,
    benchmark as benchmark,
    leaky_text as leaky_text,
)
from .calibration import Calibration as Calibration
from .estimators import ESTIMATORS as ESTIMATORS
from .names import BASELINES as BASELINES, DEFAULT_ESTIMATOR as DEFAULT_ESTIMATOR, TRACKS as TRACKS
from .classifying import predict as predict
from .models import Model as Model
from .own import EstimatorError as EstimatorError, load_maker as load_maker, unseeded as unseeded
from .predictions import UNSURE as UNSURE, Predictions as Predictions
from .records import DEFAULT_GROUPS as DEFAULT_GROUPS, count_unknown as count_unknown
from .scores import (
    Scores as Scores,
    behind_text as behind_text,
    interval_text as interval_text,
    no_width_text as no_width_text,
    percent_text as percent_text,
)
from .splits import controls as controls, cross_validate as cross_validate
from .submissions import check_submission as check_submission, write_submission as write_submission
