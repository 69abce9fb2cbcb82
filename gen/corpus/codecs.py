"""Codecs of stored signals: their netCDF options and how much they save."""

from typing import Any, Literal, NamedTuple

Codec = Literal["zlib", "zstd", "none"]


class Storage(NamedTuple):
    """How signals are stored with a codec."""

    options: dict[str, Any]
    """Arguments of ``netCDF4.Dataset.createVariable``."""
    share: float
    """Compressed over plain size of vibration that uses a part of the range of the converter [1]."""


CODECS: dict[Codec, Storage] = {
    "zlib": Storage({"zlib": True, "complevel": 1, "shuffle": True}, 0.67),
    "zstd": Storage({"compression": "zstd", "complevel": 1, "shuffle": True}, 0.75),
    "none": Storage({}, 1.0),
}
