"""SHA-256 of single records: of the stored counts and of every variable that belongs to the record itself.

The hash of a record does not change when the record goes to another part, file or corpus, or is compressed in another way. Numbers that
only tell records of one corpus apart (:data:`RENUMBERED`) are left out, because joined corpora are numbered anew.
"""

import hashlib
import json
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.schema import SIGNAL

RENUMBERED = ("rig", "specimen", "recording", "pair")
"""Variables that get new numbers when corpora are joined."""


def record_hashes(part: xr.Dataset) -> list[str]:
    """SHA-256 of each record, in hexadecimal.

    It covers the channels' counts (or accelerations in floating point) with their scale, and name, type and value of all per-record
    variables except :data:`RENUMBERED`. Text counts without the characters that fill it up to a fixed length.

    Parameters
    ----------
    part : Dataset
        Records as :func:`gen.corpus.open_part` and :func:`gen.corpus.open_corpus` give them, or as
        :func:`gen.corpus.make_dataset` makes them. The whole signal is read into memory.
    """
    signal, packing = stored_signal(part[SIGNAL].variable)
    return hashes_of(signal, packing, {str(name): part.variables[name] for name in part.variables})


def hashes_of(signal: NDArray[Any], scale: float | None, variables: dict[str, xr.Variable]) -> list[str]:
    """SHA-256 of records with the stored ``signal``, shape (record, channel, elapsed_time), and ``variables``.

    ``scale`` is the factor from counts to m s-2, None for a signal in floating point. Variables that have not one value for each record
    are left out.
    """
    own = sorted(name for name, found in variables.items() if found.dims == ("record",) and name not in RENUMBERED)
    texts = {name: variables[name].values for name in own if variables[name].dtype.kind in "OUS"}
    numbers = {name: _little_endian(variables[name].values) for name in own if name not in texts}
    types = [f"{name} {numbers[name].dtype.str if name in numbers else 'text'}" for name in own]
    form = f"{signal.dtype.newbyteorder('<').str} {signal.shape[1:]} {None if scale is None else float(scale)!r}"
    common = hashlib.sha256("\n".join([form, *types, ""]).encode())
    rows = [np.ascontiguousarray(values).view(np.uint8).reshape(len(signal), -1) for values in numbers.values()]
    row_bytes = np.concatenate(rows, axis=1) if rows else np.zeros((len(signal), 0), np.uint8)
    stored, found = _little_endian(signal), []
    for record in range(len(signal)):
        record_hash = common.copy()
        record_hash.update(row_bytes[record].tobytes())
        for values in texts.values():
            text = _encoded(values[record])
            record_hash.update(len(text).to_bytes(8, "little") + text)
        record_hash.update(np.ascontiguousarray(stored[record]).data)
        found.append(record_hash.hexdigest())
    return found


def axes_sha256(records: xr.Dataset) -> str:
    """SHA-256 of the names of the channels and of the times of the samples, which all records share, in hexadecimal."""
    names = json.dumps([str(name) for name in records["channel"].values])
    return hashlib.sha256(names.encode() + _little_endian(records["elapsed_time"].values).tobytes()).hexdigest()


def stored_signal(signal: xr.Variable) -> tuple[NDArray[Any], float | None]:
    """Counts of a signal and their scale, or accelerations and None; a decoded signal is turned back into its counts."""
    scale = packing_scale(signal)
    if scale is None or "scale_factor" in signal.attrs:
        return signal.values, scale
    counts = np.rint(np.asarray(signal.values, np.float64) / scale)
    lost = np.isnan(counts)
    if lost.any():
        counts[lost] = float(signal.encoding["_FillValue"])
    return counts.astype(np.int16), scale


def packing_scale(signal: xr.Variable) -> float | None:
    """Factor from counts to m s-2 of a signal, decoded or not; None if it is stored in floating point."""
    if "scale_factor" in signal.attrs:
        return float(signal.attrs["scale_factor"])
    counts = np.dtype(signal.encoding.get("dtype", signal.dtype)).kind == "i"
    return float(signal.encoding["scale_factor"]) if counts else None


def _little_endian(values: NDArray[Any]) -> NDArray[Any]:
    return np.asarray(values, values.dtype.newbyteorder("<"))


def _encoded(text: Any) -> bytes:
    return bytes(text).rstrip(b"\0") if isinstance(text, bytes) else str(text).encode()
