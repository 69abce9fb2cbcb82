"""Names of the fault classes, and their codes.

Plug-ins add names by entry points of the group ``raceway.classes``, so the code of a class is that of one process. A file has codes of its
own with their names, and whoever reads it turns them into those of the process. `features.fault_classes` says what a class looks like.
"""

import json
import re
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.support.errors import CorpusError, RacewayError
from gen.support.plugins import missing_distributions, plugins

HEALTHY = "healthy"
UNKNOWN, UNKNOWN_CODE = "unknown", 127  # recording whose class is not known: a value of ``fault``, not a class

BUILT_IN = (HEALTHY, "inner", "outer", "ball", "cage", "compound")

FAULTS = (*BUILT_IN, *plugins("classes"))
"""Names of the classes; the code of a class is its place."""

FAULT_NAMES: Mapping[int, str] = {**dict(enumerate(FAULTS)), UNKNOWN_CODE: UNKNOWN}

for _name in plugins("classes"):
    if not re.fullmatch("[a-z][a-z0-9_]*", _name) or _name in (*BUILT_IN, UNKNOWN):
        raise RacewayError(f"raceway.classes: {_name!r} is no name for a further class; uninstall its plug-in.")


def own_codes(
    codes: NDArray[Any], names: Mapping[int, str], place: object, attributes: Mapping[Any, Any]
) -> NDArray[np.int8]:
    """Codes of ``fault`` in this process, of those of a file with their ``names`` there; -1 for a code without a name.

    Raises
    ------
    CorpusError
        If a record is of a class that this process does not have; ``attributes`` of the file have the ``versions`` that made it.
    """
    own, unique, place_of = {name: code for code, name in FAULT_NAMES.items()}, *np.unique(codes, return_inverse=True)
    held = [names.get(int(code), "") for code in unique]
    if (foreign := next((name for name in held if name and name not in own), None)) is not None:
        missing = missing_distributions(json.loads(attributes.get("versions", "{}")))
        raise CorpusError(
            f"{place}: has records of the class {foreign}, which comes from a plug-in; pip install {' '.join(missing) or 'it'}."
        )
    return np.array([own.get(name, -1) for name in held], np.int8)[place_of]
