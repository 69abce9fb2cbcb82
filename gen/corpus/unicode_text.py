"""Global attributes with letters beyond ASCII, as fixed-length text in UTF-8.

netCDF4 writes such text with variable length, on which HDF5 2.2 can crash after another file was closed, and which no file of the format
has. So it is written by h5py, after netCDF4 has closed the file.
"""

from collections.abc import Mapping
from typing import Any

import h5py
import numpy as np


def beyond_ascii(attributes: Mapping[str, Any]) -> dict[str, str]:
    """Attributes whose text has letters beyond ASCII.

    >>> beyond_ascii({"title": "Kugellager", "institution": "Universität", "format": 2})
    {'institution': 'Universität'}
    """
    return {name: value for name, value in attributes.items() if isinstance(value, str) and not value.isascii()}


def write_unicode(file: h5py.File, attributes: Mapping[str, str]) -> None:
    """Write text attributes of a file that h5py has open."""
    for name, value in attributes.items():
        text = value.encode()
        file.attrs.create(name, np.array(text, h5py.string_dtype("utf-8", len(text))))
