"""Allowed shapes, types and attributes of the signal and of the other variables in a file of a corpus.

Files can come from strangers: anything that is not part of the format is refused here, before xarray interprets it.
"""

from typing import TYPE_CHECKING, Any, NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

from gen.corpus.schema import MISSING_COUNT, SIGNAL
from gen.support.errors import CorpusError
from gen.support.limits import check_limit

if TYPE_CHECKING:
    import xarray as xr

PACKING = ("scale_factor", "add_offset", "_FillValue")
"""Attributes by which readers decode a signal; only the signal may have them."""

_HDF5_OWN = {
    "CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST", "_Netcdf4Dimid", "_Netcdf4Coordinates", "_NCProperties", "_nc3_strict",
}  # fmt: skip
_ACTED_ON = (*PACKING, "missing_value", "_Unsigned", "dtype", "calendar", "bounds", "grid_mapping")


class Packing(NamedTuple):
    """Storage of a signal: its type, the factor from counts to m s-2, and the count that stands for a missing sample."""

    dtype: np.dtype[Any]
    scale: np.floating[Any] | None
    fill: int | None

    @property
    def decoded(self) -> np.dtype[Any]:
        """Type of the decoded signal: that of the scale factor."""
        return self.dtype if self.scale is None else self.scale.dtype

    def decode(self, stored: NDArray[Any], out: NDArray[Any]) -> None:
        """Write the signal in m s-2 into ``out``; a missing sample is NaN."""
        if self.scale is None:
            out[...] = stored
            return
        np.multiply(stored, self.scale, out=out, casting="same_kind")
        missing = stored == self.fill
        if missing.any():
            out[missing] = np.nan


def packing_of(stored: h5py.Dataset) -> Packing:
    """Storage of a signal; ValueError if it is packed in a way that the format does not have."""
    attributes = {name: _plain(stored.attrs[name], name) for name in PACKING if name in stored.attrs}
    if stored.dtype == np.dtype(np.float32):
        if attributes.keys() & {"scale_factor", "add_offset"}:
            raise ValueError(f"{SIGNAL} is floating point and has a scale_factor or an add_offset")
        return Packing(stored.dtype, None, None)
    scale, offset, fill = (attributes[name] for name in PACKING)
    if not (_is_scale(scale) and offset == 0 and getattr(fill, "dtype", None) == np.int16):
        raise ValueError(f"{SIGNAL} has scale_factor {scale!r}, add_offset {offset!r}, _FillValue {fill!r}")
    return Packing(stored.dtype, scale, int(fill))


def _is_scale(scale: Any) -> bool:
    """Whether a scale factor is a positive number with which every count is a normal number of its type."""
    if getattr(scale, "dtype", None) not in (np.float32, np.float64):
        return False
    limits = np.finfo(scale.dtype)
    return bool(limits.smallest_normal <= scale <= limits.max / -MISSING_COUNT)


def checked_shape(stored: h5py.Dataset) -> tuple[int, int, int]:
    """Shape of a signal after a check of its dimensions, type and size."""
    if stored.ndim != 3 or stored.dtype not in (np.dtype(np.int16), np.dtype(np.float32)):
        raise ValueError(f"{SIGNAL} is of type {stored.dtype} and shape {stored.shape}")
    records, channels, samples = stored.shape
    check_limit("records", records, f"{stored.file.filename}: holds", CorpusError)
    check_limit("record_samples", channels * samples, f"{stored.file.filename}: a record has", CorpusError)
    # every record costs a chunk: a file with fewer chunks could claim any number of records
    if stored.chunks != (1, 1, samples) or stored.id.get_num_chunks() != records * channels:
        raise ValueError(f"{SIGNAL} is not stored as one chunk for each record and channel")
    return records, channels, samples


def is_deflated(stored: h5py.Dataset) -> bool:
    """Whether the chunks of a signal are shuffled and deflated counts, as from :func:`gen.corpus.part.deflated`."""
    plain = stored.scaleoffset is None and not stored.fletcher32
    return stored.dtype == np.dtype(np.int16) and stored.compression == "gzip" and stored.shuffle and plain


def is_bare_dimension(stored: h5py.Dataset) -> bool:
    """Whether a dataset only stores the size of a netCDF dimension."""
    if not stored.is_scale:  # asked first: reading an attribute takes ten times as long
        return False
    return bytes(stored.attrs.get("NAME", b"")).startswith(b"This is a netCDF dimension but not a netCDF variable")


def is_text(stored: h5py.Dataset, name: str, dimension: str, size: int) -> bool:
    """Whether a variable is text, with one character per column; ValueError if it is neither text nor numbers."""
    text = stored.dtype == np.dtype("S1") and stored.ndim == 2
    if stored.shape[:1] != (size,) or stored.ndim != 1 + text or (not text and stored.dtype.kind not in "iuf"):
        raise ValueError(
            f"{name} is of type {stored.dtype} and shape {stored.shape}, not one value for each {dimension}"
        )
    return text


def is_utf8(rows: NDArray[Any]) -> bool:
    """Whether each row of characters, shape (record, character), is text in UTF-8."""
    try:
        for row in np.ascontiguousarray(rows).view(f"S{rows.shape[-1]}").ravel() if rows.size else ():
            row.decode()
    except UnicodeDecodeError:
        return False
    return True


def plain_attributes(stored: h5py.Dataset, name: str) -> dict[str, Any]:
    """Attributes of a variable that is not packed; ValueError if it has one that readers would act on."""
    attributes = attributes_of(stored)
    attributes.pop("coordinates", None)
    wrong = next((key for key in _ACTED_ON if key in attributes), None)
    encoding = attributes.get("_Encoding")
    if wrong is not None or encoding not in (None, "utf-8") or (encoding is not None and stored.ndim == 1):
        raise ValueError(f"{name} has the attribute {wrong or '_Encoding'}, which it must not have")
    return attributes


def attributes_of(node: h5py.Dataset | h5py.File) -> dict[str, Any]:
    """Attributes of a netCDF variable or file, without those that link dimensions to variables in HDF5."""
    return {name: _plain(node.attrs[name], name) for name in node.attrs if name not in _HDF5_OWN}


def _plain(value: Any, name: str) -> Any:
    """Text, a number, or a row of numbers; ValueError for anything else."""
    if isinstance(value, h5py.Empty):
        return ""
    if isinstance(value, bytes):
        return value.decode()
    if isinstance(value, np.ndarray) and value.ndim == 1 and value.dtype.kind in "iuf":
        return value[0] if value.shape == (1,) else value
    if isinstance(value, str | np.integer | np.floating):
        return value
    raise ValueError(f"the attribute {name} is neither text nor numbers")


def stored_signal(signal: "xr.Variable") -> tuple[NDArray[Any], float | None]:
    """Counts of a decoded signal and their scale, or accelerations and None."""
    if np.dtype(signal.encoding.get("dtype", signal.dtype)).kind != "i":
        return signal.values, None
    scale = float(signal.encoding["scale_factor"])
    counts = np.rint(np.asarray(signal.values, np.float64) / scale)
    lost = np.isnan(counts)
    if lost.any():
        counts[lost] = float(signal.encoding["_FillValue"])
    return counts.astype(np.int16), scale
