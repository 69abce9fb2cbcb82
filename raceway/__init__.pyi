from .kept_models import reference_model as reference_model
from .console.progress import show_progress as show_progress
