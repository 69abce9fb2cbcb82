"""Access to the HDF5 and netCDF libraries: the lock, and the refusal of files that refer to other files.

Both libraries keep state for the whole process and are not thread-safe, so every call to them holds :data:`LIBRARY_LOCK`.
An HDF5 file can refer to other files for its values: external links, external raw storage, virtual datasets. A file from a stranger
could use them to read any file of this machine. :func:`own_dataset` refuses them.
"""

import os
import threading
from typing import Any

import h5py

_HDF5: Any = h5py  # its low-level interface has no types
LIBRARY_LOCK = threading.RLock()
"""Held during every call to HDF5 or netCDF. ``fork`` waits for it, so a child process starts with the lock free."""

if hasattr(os, "register_at_fork"):  # Windows has no fork
    os.register_at_fork(
        before=LIBRARY_LOCK.acquire, after_in_parent=LIBRARY_LOCK.release, after_in_child=LIBRARY_LOCK.release
    )


class ForeignStorageError(ValueError):
    """A dataset with values outside the file that was opened."""


def own_dataset(file: h5py.File, path: str) -> h5py.Dataset:
    """Dataset of an HDF5 file with its values in the same file; the caller holds the lock.

    ``path`` holds the names of the groups and of the dataset, separated by slashes.

    Raises
    ------
    KeyError
        If there is no such dataset.
    ForeignStorageError
        If a link on the path is not a hard link, or the values are in another file.
    """
    node: Any = file.id  # through the objects of h5py it takes three times as long
    for name in path.encode().split(b"/"):
        if not isinstance(node, _HDF5.h5g.GroupID) or not node.links.exists(name):
            raise KeyError(path)
        if node.links.get_info(name).type != _HDF5.h5l.TYPE_HARD:
            raise ForeignStorageError(f"{path} is a soft or external link")
        node = _HDF5.h5o.open(node, name)
    if not isinstance(node, _HDF5.h5d.DatasetID):
        raise KeyError(path)
    storage: Any = node.get_create_plist()
    if storage.get_external_count():
        raise ForeignStorageError(f"the values of {path} are in another file")
    if storage.get_layout() == _HDF5.h5d.VIRTUAL:
        raise ForeignStorageError(f"{path} is a virtual dataset")
    return h5py.Dataset(node)
