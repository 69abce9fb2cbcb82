"""Access to the HDF5 and netCDF libraries: the lock, and the refusal of values that are stored in other files.

Both libraries keep state for the whole process and are not thread-safe, so every call to them holds :data:`LIBRARY_LOCK`.
An HDF5 file can refer to other files for its values: external links, external raw storage, virtual datasets. A file from a stranger
could use them to read any file of this machine. :func:`own_dataset` refuses them, except for the virtual dataset of the format.
"""

import os
import threading
from typing import Any

import h5py

LIBRARY_LOCK = threading.RLock()
"""Held during every call to HDF5 or netCDF. ``fork`` waits for it, so a child process starts with the lock free."""

os.register_at_fork(
    before=LIBRARY_LOCK.acquire, after_in_parent=LIBRARY_LOCK.release, after_in_child=LIBRARY_LOCK.release
)


class ForeignStorageError(ValueError):
    """A dataset with values outside the file that was opened."""


def own_dataset(file: h5py.File, path: str, *, virtual: bool = False) -> h5py.Dataset:
    """Dataset of an HDF5 file with its values in the same file; the caller holds the lock.

    Parameters
    ----------
    file : h5py.File
        An open file.
    path : str
        Names of the groups and of the dataset, separated by slashes.
    virtual : bool
        Whether a virtual dataset is expected, as in ``corpus.nc``; the caller then checks its sources.

    Raises
    ------
    KeyError
        If there is no such dataset.
    ForeignStorageError
        If a link on the path is not a hard link, or the values are in another file.
    """
    node: Any = file
    for name in path.split("/"):
        if not isinstance(node, h5py.Group):
            raise KeyError(path)
        link = node.get(name, getlink=True)
        if link is None:
            raise KeyError(path)
        if not isinstance(link, h5py.HardLink):
            raise ForeignStorageError(f"{path} is a soft or external link")
        node = node[name]
    if not isinstance(node, h5py.Dataset):
        raise KeyError(path)
    if node.external:
        raise ForeignStorageError(f"the values of {path} are in another file")
    if node.is_virtual is not virtual:
        raise ForeignStorageError(f"{path} is {'not ' if virtual else ''}a virtual dataset")
    return node
