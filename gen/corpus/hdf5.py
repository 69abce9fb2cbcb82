"""Access to the HDF5 and netCDF libraries: the lock, and the refusal of files that are dangerous to open.

Both libraries keep state for the whole process and are not thread-safe, so every call to them holds :data:`LIBRARY_LOCK`.
An HDF5 file can refer to other files for its values: external links, external raw storage, virtual datasets. A file from a stranger
could use them to read any file of this machine. :func:`own_dataset` refuses them, except for the virtual dataset of the format.
A damaged mapping of that virtual dataset ends the process (H5S__hyper_deserialize writes beyond the stack), so
:func:`survives_opening` tries it in a child process first.
"""

import faulthandler
import functools
import os
import resource
import threading
import warnings
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


CRASHES = "is damaged: the HDF5 library crashes on it; make or copy the corpus again"
CPU_SECONDS = 3  # processor time to open a dataset; it takes milliseconds


@functools.lru_cache(maxsize=256)
def survives_opening(path: str, sha256: str, name: str) -> bool:  # noqa: ARG001 - the hash is part of the key
    """Whether a child process can open dataset ``name`` of a file without a crash or an endless loop.

    An error is no crash: the caller meets it again. ``sha256`` is that of the file: the same bytes are tried once.
    """
    with LIBRARY_LOCK, warnings.catch_warnings():
        # Python 3.12 warns of fork with threads; the child starts no thread and takes no lock
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
        if child == 0:
            _open_and_exit(path, name)
        _, status = os.waitpid(child, 0)
    return os.WIFEXITED(status)


def _open_and_exit(path: str, name: str) -> None:
    """Open a dataset and end the process without the exit handlers of its parent."""
    try:
        faulthandler.disable()
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        with h5py.File(path, "r", locking=False) as file:
            _ = file[name]
    finally:
        os._exit(0)
