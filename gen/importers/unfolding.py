"""Decompression within bounds: the size is checked before, and enforced during decompression."""

import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.importers.files import UnusableError
from gen.limits import check_limit

LARGEST_RATIO = 100  # decompressed over stored bytes; recordings of noise reach 2, those with few distinct counts 10
_ALWAYS = 64_000_000  # bytes that can be decompressed at any ratio
_SLICE, _PIECE = 65_536, 1_000_000  # compressed bytes taken, and bytes decompressed, at a time
_PADDING = 64  # bytes after the values


def check_size(size: int, stored: int) -> None:
    """Refuse values of ``size`` bytes that are above the limit, or far larger than their ``stored`` bytes.

    Raises
    ------
    UnusableError
        With both numbers.
    """
    check_limit("file_bytes", size, "holds", UnusableError)
    if size > _ALWAYS + LARGEST_RATIO * stored:
        message = f"is damaged: {stored} bytes that decompress to {size} are not a recording"
        raise UnusableError(message)


def unfold(compressed: Any, size: int) -> NDArray[np.uint8]:
    """First ``size`` bytes of a zlib stream that holds these and at most some padding, shape (byte,).

    Raises
    ------
    UnusableError
        If the stream holds fewer or more bytes; zlib.error if it is not a zlib stream.
    """
    check_size(size, len(compressed))
    found = np.empty(size, np.uint8)
    unpacker, done = zlib.decompressobj(), 0
    for start in range(0, len(compressed), _SLICE):
        left, room = compressed[start : start + _SLICE], 1
        while room > 0 and not unpacker.eof:
            room = min(_PIECE, size + _PADDING - done)
            piece = unpacker.decompress(left, room) if room > 0 else b""
            kept = max(min(len(piece), size - done), 0)
            found[done : done + kept] = np.frombuffer(piece, np.uint8, kept)
            done += len(piece)
            left = unpacker.unconsumed_tail
            if len(piece) < room and not left:
                break
    if done < size:
        message = f"is truncated or damaged: {size} bytes announced, {done} found"
        raise UnusableError(message)
    if not unpacker.eof:
        message = f"is truncated or damaged: the compressed data goes on after {size} bytes"
        raise UnusableError(message)
    return found


def first_bytes(compressed: Any, size: int) -> bytes:
    """At most ``size`` bytes from the start of a zlib stream."""
    return zlib.decompressobj().decompress(compressed, size)
