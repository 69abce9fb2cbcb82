"""Open files from strangers only if they are plain files: a pipe can block for ever, and reading a device can have effects."""

import errno
import os
import stat
from pathlib import Path
from typing import BinaryIO


def open_plain(path: Path) -> BinaryIO:
    """Open a plain file for reading, without blocking.

    Raises
    ------
    OSError
        If the file is missing or not readable, or is a folder, a pipe, a socket or a device.
    """
    try:
        # without O_NONBLOCK, opening a pipe that has no writer blocks
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
    except ValueError as error:  # a NUL in the name
        raise OSError(errno.EINVAL, str(error), str(path)) from None
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise OSError(errno.EINVAL, "is a folder, a pipe or a device, not a plain file", str(path))
    return os.fdopen(descriptor, "rb")
