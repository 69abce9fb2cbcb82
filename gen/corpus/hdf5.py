"""The HDF5 and netCDF libraries: one thread at a time, and only values that are in the file itself.

Both libraries keep state for the whole process and are not made for threads, so every call into them is made under :data:`LIBRARY_LOCK`.
An HDF5 file can also name other files as the place of its values: external links, external raw storage, virtual datasets. A file from
elsewhere could so read any file of this machine; :func:`own_dataset` refuses all of these, except where the format itself has one.
"""

import os
import threading
from typing import Any

import h5py

LIBRARY_LOCK = threading.RLock()
"""Held around every call into HDF5 or netCDF. A process that is forked meanwhile starts with the lock free and the libraries at rest."""

os.register_at_fork(
    before=LIBRARY_LOCK.acquire, after_in_parent=LIBRARY_LOCK.release, after_in_child=LIBRARY_LOCK.release
)


class ForeignStorageError(ValueError):
    """A dataset whose values are not in the file that was opened."""


def own_dataset(file: h5py.File, path: str, *, virtual: bool = False) -> h5py.Dataset:
    """Dataset of an HDF5 file with its values in this very file; the caller holds the lock.

    Parameters
    ----------
    file : h5py.File
        An open file.
    path : str
        Names of the groups and of the dataset, with slashes between.
    virtual : bool
        Whether a virtual dataset is expected, as in ``corpus.nc``; its sources are then the caller's to check.

    Raises
    ------
    KeyError
        If there is no such dataset.
    ForeignStorageError
        If it is reached through a link that is not a plain one, or its values are in another file.
    """
    node: Any = file
    for name in path.split("/"):
        if not isinstance(node, h5py.Group):
            raise KeyError(path)
        link = node.get(name, getlink=True)
        if link is None:
            raise KeyError(path)
        if not isinstance(link, h5py.HardLink):
            raise ForeignStorageError(f"{path} is a link to somewhere else")
        node = node[name]
    if not isinstance(node, h5py.Dataset):
        raise KeyError(path)
    if node.external:
        raise ForeignStorageError(f"the values of {path} are in another file")
    if node.is_virtual is not virtual:
        raise ForeignStorageError(f"{path} is {'no' if virtual else 'a'} virtual dataset")
    return node
