from .forms import FORMS as FORMS, Copied as Copied, copy as copy
from .items import LabelledRecords as LabelledRecords, torch_dataset as torch_dataset
