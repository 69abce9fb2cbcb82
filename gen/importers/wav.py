"""WAV files: PCM of 8 to 32 bits and floating point; damaged files are refused with a reason.

Such a file is a sequence of chunks, each with a name, a length and its bytes [1]_; ``fmt`` describes the samples that ``data`` holds. Every
length is compared with the file before anything is read.

.. [1] IBM Corporation and Microsoft Corporation, *Multimedia Programming Interface and Data Specifications 1.0*, 1991.
"""

import os
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.importers.files import UnusableError
from gen.limits import check_limit
from gen.plain_files import open_plain

_PCM, _FLOAT, _EXTENSIBLE = 1, 3, 0xFFFE
_MOST_CHUNKS, _MOST_CHANNELS = 10_000, 1024
_SUBFORMAT = 24  # place of the true format in the description of an extensible file


class Sound(NamedTuple):
    """Samples of a WAV file as stored, shape (time, channel), the value of full scale (1 for floating point), and the sample rate [Hz]."""

    samples: NDArray[Any]
    full_scale: float
    rate: float


class _Format(NamedTuple):
    """Format of the samples: number of the encoding, channels, sample rate [Hz], and bytes of one sample of one channel."""

    encoding: int
    channels: int
    rate: int
    width: int


def read_wav(path: Path) -> Sound:
    """Samples of a WAV file.

    Raises
    ------
    UnusableError
        If the file is truncated or damaged, is not a WAV file, or is compressed.
    """
    with open_plain(path) as stream:
        check_limit("file_bytes", os.fstat(stream.fileno()).st_size, "is", UnusableError)
        described: _Format | None = None
        for name, length in _chunks(stream):
            if name == b"fmt ":
                described = _format(stream.read(min(length, 64)))
            elif name == b"data":
                if described is None:
                    raise UnusableError("is damaged: its samples come before their description")
                return _sound(stream.read(length), described)
    raise UnusableError("is truncated or damaged: it has no samples")


def _chunks(stream: BinaryIO) -> Iterator[tuple[bytes, int]]:
    """Name and length of each chunk, with the stream at its first byte."""
    end = os.fstat(stream.fileno()).st_size
    head = stream.read(12)
    if head[:4] != b"RIFF" or head[8:] != b"WAVE":
        raise UnusableError("is not a WAV file")
    position = 12
    for _ in range(_MOST_CHUNKS):
        stream.seek(position)
        tag = stream.read(8)
        if len(tag) < 8:
            return
        name, length = struct.unpack("<4sI", tag)
        if length > end - position - 8:
            message = f"is truncated or damaged: {length} bytes announced where {end - position - 8} are left"
            raise UnusableError(message)
        yield name, length
        position += 8 + length + length % 2
    message = f"is damaged: more than {_MOST_CHUNKS} chunks"
    raise UnusableError(message)


def _format(described: bytes) -> _Format:
    if len(described) < 16:
        raise UnusableError("is damaged: the description of its samples is too short")
    encoding, channels, rate, _, block, _ = struct.unpack("<HHIIHH", described[:16])
    if encoding == _EXTENSIBLE and len(described) >= _SUBFORMAT + 2:
        (encoding,) = struct.unpack("<H", described[_SUBFORMAT : _SUBFORMAT + 2])
    if encoding not in (_PCM, _FLOAT):
        message = f"holds samples of encoding {encoding}; save it as PCM or floating point"
        raise UnusableError(message)
    if not 1 <= channels <= _MOST_CHANNELS or rate == 0 or block % channels:
        message = f"is damaged: {channels} channels, {rate} Hz, {block} bytes for a sample of all channels"
        raise UnusableError(message)
    width = block // channels
    if width not in ((1, 2, 3, 4) if encoding == _PCM else (4, 8)):
        message = f"holds samples of {8 * width} bits; PCM of 8, 16, 24 or 32 and floating point of 32 or 64 are read"
        raise UnusableError(message)
    return _Format(encoding, channels, rate, width)


def _sound(data: bytes, described: _Format) -> Sound:
    encoding, channels, rate, width = described
    count = len(data) // (channels * width)
    values = np.frombuffer(data, np.uint8, count * channels * width)
    if encoding == _FLOAT:
        return Sound(values.view(f"<f{width}").reshape(count, channels), 1.0, float(rate))
    if width == 1:  # unsigned, with silence at 128
        samples = values.astype(np.int16) - 128
    elif width == 3:
        padded = np.zeros((count * channels, 4), np.uint8)
        padded[:, 1:] = values.reshape(-1, 3)
        samples = padded.view("<i4") >> 8
    else:
        samples = values.view(f"<i{width}")
    return Sound(samples.reshape(count, channels), 2.0 ** (8 * width - 1), float(rate))
