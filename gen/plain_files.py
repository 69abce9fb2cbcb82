"""Files from elsewhere: opened only if they are plain files, since a pipe never ends and a device may answer to being read."""

import errno
import os
import stat
from pathlib import Path
from typing import BinaryIO


def open_plain(path: Path) -> BinaryIO:
    """Open a plain file for reading; it is never waited for.

    Raises
    ------
    OSError
        If there is no such file, it may not be read, or it is a folder, a pipe, a socket or a device.
    """
    try:
        # a pipe without a writer would keep the opening waiting
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
    except ValueError as error:  # a NUL in the name
        raise OSError(errno.EINVAL, str(error), str(path)) from None
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise OSError(errno.EINVAL, "is a folder, a pipe or a device and no plain file", str(path))
    return os.fdopen(descriptor, "rb")
