from .forms import FORMS as FORMS
from .forms import Copied as Copied
from .forms import copy as copy
from .items import LabelledRecords as LabelledRecords
from .items import torch_dataset as torch_dataset
