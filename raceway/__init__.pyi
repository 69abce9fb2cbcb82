from .studies.reference_model import reference_model as reference_model
