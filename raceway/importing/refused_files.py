"""Reason why a file cannot be used, and the one place where an error of a library becomes a sentence.

Every error becomes an :class:`UnusableError` with a reason and without the name of the file: the caller adds the name.
"""

import errno
import importlib
import os
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.support.errors import CorpusError
from gen.support.limits import check_limit

FloatArray = NDArray[np.float64]

_WITH_REASON = (ValueError, OSError, EOFError, Warning)  # of a library; the text of others is about its code


class UnusableError(Exception):
    """Reason why a file cannot be used; its text has no full stop, because a sentence about the file goes on after it.

    ``key`` names what the caller has to give, such as ``column``; the reason then goes on with "with column". ``axes`` are the signals
    of one sensor, as the key takes them, where none of several is chosen. ``contradicted`` is the rate, unit or sensitivity that is given,
    while the file states another.
    """

    def __init__(self, reason: str, key: str = "", *, axes: tuple[str, ...] = (), contradicted: str = "") -> None:
        super().__init__(reason, key)
        self.axes, self.contradicted = axes, contradicted

    def told(self, options: Mapping[str, str]) -> str:
        """Reason with the name of the option that gives the key."""
        reason, key = self.args
        reason = "".join(letter if letter.isprintable() else "?" for letter in reason)
        return f"{reason} with {options.get(key, key)}" if key else reason.removesuffix(".")

    def __str__(self) -> str:
        return self.told({})


@contextmanager
def guarded(path: Path, kind: str) -> Iterator[None]:
    """Check the size of a file before a library reads it, and turn each of the library's errors into an :class:`UnusableError`.

    Raises
    ------
    UnusableError
        If the file is empty or above the limit ``file_bytes``, or the library fails.
    OSError
        If the file is missing, not readable, or a folder, a pipe or a device.
    MemoryError
        If its values do not fit in memory.
    """
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "is a folder, a pipe or a device", str(path))
    with path.open("rb") as stream:
        size = os.fstat(stream.fileno()).st_size
    if size == 0:
        raise UnusableError("is empty (0 bytes); copy it again")
    # before the library takes memory for it
    check_limit("file_bytes", size, "is", UnusableError)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except (UnusableError, MemoryError):
        raise
    except BaseException as error:  # SciPy, h5py and NumPy raise a dozen unrelated types on damaged bytes
        # a panic of a library in Rust is no Exception either, and the class cannot be imported
        if not isinstance(error, Exception) and type(error).__name__ != "PanicException":
            raise
        reason = f" ({str(error).splitlines()[0][:120]})" if isinstance(error, _WITH_REASON) and str(error) else ""
        raise UnusableError(f"is truncated, damaged or not a {kind} file{reason}") from error


@contextmanager
def told_of(path: Path, options: Mapping[str, str]) -> Iterator[None]:
    """Turn what makes a file unusable into a sentence on it, which names the options of a caller.

    Raises
    ------
    CorpusError
        If the file cannot be used.
    """
    try:
        yield
    except UnusableError as reason:
        raise CorpusError(f"{path}: {reason.told(options)}.") from None
    except (OSError, MemoryError) as error:
        raise CorpusError(f"{path}: {reason_of(error)}.") from None


def reason_of(error: OSError | MemoryError) -> str:
    """Reason why a file could not be read, and advice."""
    if isinstance(error, MemoryError):
        return "holds more values than fit in memory; cut it into shorter files"
    return f"could not be read ({error.strerror or error}); check the path"


def optional(module: str) -> Any:
    """Module of a library that is an extra.

    Raises
    ------
    UnusableError
        If it is missing.
    """
    try:
        return importlib.import_module(module)
    except ImportError:
        name = module.partition(".")[0].replace("_", "-")
        raise UnusableError(f"is of a kind that needs {name}; pip install raceway[files]") from None
