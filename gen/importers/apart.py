"""Reading in a child process, so that a library that crashes or hangs on a damaged file does not end the import.

The HDF5 library can loop for ever on a damaged file, or end the process; Python code cannot prevent either. The child sends the values
through a pipe.
"""

import faulthandler
import json
import os
import resource
import signal
import struct
import warnings
from collections.abc import Callable
from io import BufferedReader
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.importers.files import UnusableError

CPU_SECONDS = 3  # processor time to open a file; waiting for a slow disk is not included
_CPU_SECONDS_PER_BYTE = 2e-7  # 30 times the time that inflating takes


def read_apart(read: Callable[[], NDArray[Any]], size: int) -> NDArray[Any]:
    """Result of ``read`` in a child process, for a file of ``size`` bytes.

    Raises
    ------
    UnusableError
        If ``read`` raises it, or if the process ended or ran for too long.
    ValueError
        If ``read`` raises any other error; with its text.
    """
    receiving, sending = os.pipe()
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore", DeprecationWarning
        )  # Python 3.12 warns of fork with threads: the child starts no thread and takes no lock
        child = os.fork()
    if child == 0:
        _serve(read, sending, CPU_SECONDS + int(size * _CPU_SECONDS_PER_BYTE))
    os.close(sending)
    try:
        with os.fdopen(receiving, "rb") as stream:
            return _received(stream)
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)


def _serve(read: Callable[[], NDArray[Any]], sending: int, seconds: int) -> None:
    """Read, send and exit without the exit handlers that the child has inherited from its parent."""
    try:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent receives the interrupt and ends this process
        faulthandler.disable()
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        with os.fdopen(sending, "wb") as stream:
            try:
                values = np.asarray(read(), order="C")
                head = {"dtype": values.dtype.str, "shape": values.shape}
            except UnusableError as reason:
                values, head = np.empty(0), {"unusable": str(reason)}
            except BaseException as error:  # noqa: BLE001 - the parent reports every error
                values, head = np.empty(0), {"error": str(error) or type(error).__name__}
            text = json.dumps(head).encode()
            stream.write(struct.pack("<Q", len(text)) + text)
            stream.write(values.reshape(-1).view(np.uint8).data)
    finally:
        os._exit(0)


def _received(stream: BufferedReader) -> NDArray[Any]:
    size = stream.read(8)
    if len(size) < 8:
        raise UnusableError("is damaged: the HDF5 library crashes on it or does not finish")
    head = json.loads(stream.read(struct.unpack("<Q", size)[0]))
    if "unusable" in head:
        raise UnusableError(head["unusable"])
    if "error" in head:
        raise ValueError(head["error"])
    values = np.empty(head["shape"], head["dtype"])
    if stream.readinto(values.reshape(-1).view(np.uint8).data) < values.nbytes:
        raise UnusableError("is damaged: the HDF5 library crashes on it or does not finish")
    return values
