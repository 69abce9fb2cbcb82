"""Form of a part: its attributes and the description of its variables, from which the same file can be written again.

A form is plain JSON. It holds no values of records, so parts that one command made share one form.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.codecs import CODECS
from gen.corpus.hdf5 import LIBRARY_LOCK
from gen.corpus.schema import SIGNAL, SIGNAL_DIMS


def form_of(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Global attributes of a part, and its form: codec, and of each variable name, type, whether it is a label, and attributes."""
    with LIBRARY_LOCK, netCDF4.Dataset(path) as part:
        filters = part[SIGNAL].filters()
        variables = [_variable(name, variable) for name, variable in part.variables.items()]
        attributes = {name: _written(part.getncattr(name)) for name in part.ncattrs()}
    codec = next((codec for codec in CODECS if filters.get(codec)), "none")
    return attributes, {"codec": codec, "variables": variables}


def _variable(name: str, variable: netCDF4.Variable) -> dict[str, Any]:
    found = {key: _written(variable.getncattr(key)) for key in variable.ncattrs()}
    label = found.pop("coordinates", None) is None
    text = found.pop("_Encoding", None) is not None
    return {"name": name, "type": "text" if text else variable.dtype.str, "label": label, "attributes": found}


def _written(value: Any) -> Any:
    """Attribute as JSON: text as it is, numbers with their type."""
    return value if isinstance(value, str) else {"type": value.dtype.str, "value": value.tolist()}


def read_attributes(written: Mapping[str, Any]) -> dict[str, Any]:
    """Attributes from their JSON.

    >>> read_attributes({"units": "m", "flag_values": {"type": "|i1", "value": [0, 1]}, "scale_factor": {"type": "<f8", "value": 0.5}})
    {'units': 'm', 'flag_values': array([0, 1], dtype=int8), 'scale_factor': np.float64(0.5)}
    """
    return {
        name: value if isinstance(value, str) else np.array(value["value"], value["type"])[()]
        for name, value in written.items()
    }


def dataset_of(
    form: Mapping[str, Any], attributes: Mapping[str, Any], values: Mapping[str, NDArray[Any]]
) -> xr.Dataset:
    """Records of a part as they were given to :func:`gen.corpus.write_part`.

    ``values`` are those of every variable by name: stored counts or accelerations, and text without the characters that fill it up.
    """
    variables: dict[str, xr.Variable] = {}
    for item in form["variables"]:
        name = item["name"]
        dimensions = SIGNAL_DIMS if values[name].ndim == 3 else (name if name in SIGNAL_DIMS else "record",)
        found = np.asarray(values[name], object if item["type"] == "text" else item["type"])
        variables[name] = xr.Variable(dimensions, found, read_attributes(item["attributes"]))
    labels = [item["name"] for item in form["variables"] if item["label"]]
    return xr.Dataset(variables, attrs=read_attributes(attributes)).set_coords(labels)  # in the order of the file
