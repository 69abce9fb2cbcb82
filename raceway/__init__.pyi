from .console.progress_bar import show_progress as show_progress
from .diagnosis import diagnose as diagnose
from .imitating import imitate as imitate
from .kept_models import reference_model as reference_model
from .lives.early_warning import warn_early as warn_early
from .lives.prognosis import score_lives as score_lives
from .reports.bearing_drawing import plot_bearing as plot_bearing
from .reports.maps import plot as plot
from .reports.views import plot_record as plot_record
from .sharing import copy as copy, describe as describe, publish as publish
from .visibility import limit as limit
