"""Global attributes with letters beyond ASCII, as fixed-length text in UTF-8.

netCDF4 writes such text with variable length, on which HDF5 2.2 can crash after another file was closed, and which no file of the format
has. So it is written by h5py, after netCDF4 has closed the file.
"""

from collections.abc import Mapping
from typing import Any

import h5py
import netCDF4
import numpy as np


def set_attributes(file: netCDF4.Dataset, attributes: Mapping[str, Any]) -> dict[str, str]:
    """Set global attributes; returns those with letters beyond ASCII, which :func:`write_unicode` must still write."""
    beyond = {name: value for name, value in attributes.items() if isinstance(value, str) and not value.isascii()}
    file.setncatts({name: value for name, value in attributes.items() if name not in beyond})
    return beyond


def write_unicode(file: h5py.File, attributes: Mapping[str, str]) -> None:
    """Write text attributes of a file that h5py has open."""
    for name, value in attributes.items():
        text = value.encode()
        file.attrs.create(name, np.array(text, h5py.string_dtype("utf-8", len(text))))
