from .croissant import croissant_problems as croissant_problems
from .forms import FORMS as FORMS, Copied as Copied, copy as copy
from .publishing import describe as describe, publish as publish
