"""Lazy reading of the records of a corpus as an xarray Dataset.

Datasets hold paths instead of handles, so they can be pickled, sent to dask workers and shared with forked processes.
"""

import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import xarray as xr
from numpy.typing import NDArray
from xarray.backends import BackendArray, BackendEntrypoint
from xarray.core import indexing

from gen.corpus.blocks import inflate_all, stored_chunks
from gen.corpus.layout import (
    PACKING,
    Packing,
    attributes_of,
    is_bare_dimension,
    is_text,
    is_utf8,
    plain_attributes,
)
from gen.corpus.open_files import OpenFile, Source, close, open_source, source_of
from gen.corpus.schema import SIGNAL, SIGNAL_DIMS, with_own_codes
from gen.support.errors import CorpusError
from gen.support.limits import check_limit


class _Column(BackendArray):
    """Stored values of a per-record variable or of an axis."""

    def __init__(self, source: Source, name: str, shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
        self.source, self.name, self.shape, self.dtype = source, name, shape, dtype

    def __getitem__(self, key: indexing.ExplicitIndexer) -> NDArray[Any]:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.BASIC, self._read)

    def _read(self, key: tuple[int | slice, ...]) -> NDArray[Any]:
        counts = [
            len(range(*item.indices(size))) if isinstance(item, slice) else 1
            for item, size in zip(key, self.shape, strict=True)
        ]
        check_limit(
            "file_bytes", self.dtype.itemsize * math.prod(counts), f"{self.source.path}: {self.name} has", CorpusError
        )
        with open_source(self.source) as file:
            values = np.asarray(file.dataset(self.name)[key])
        if values.dtype == np.dtype("S1") and not is_utf8(values):
            raise CorpusError(
                f"{self.source.path}: {self.name} has text that is not UTF-8; make or copy the corpus again."
            )
        return values


class _Signal(BackendArray):
    """Decoded signal (record, channel, elapsed_time) of consecutive parts."""

    def __init__(self, parts: Sequence[Source], counts: Sequence[int], row: tuple[int, int], packing: Packing) -> None:
        self.parts, self.packing = tuple(parts), packing
        self.starts = np.concatenate([[0], np.cumsum(counts)])
        self.shape, self.dtype = (int(self.starts[-1]), *row), packing.decoded

    def __getitem__(self, key: indexing.ExplicitIndexer) -> NDArray[Any]:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER, self._read)

    def _read(self, key: tuple[int | slice | NDArray[np.integer[Any]], ...]) -> NDArray[Any]:
        """Read runs of consecutive records of a part in one call, in whole chunks of one record and channel."""
        chosen = [_numbers_of(item, size) for size, item in zip(self.shape, key, strict=True)]
        records, channels, samples = map(np.atleast_1d, chosen)
        parts = np.searchsorted(self.starts, records, side="right") - 1
        ends = np.flatnonzero((np.diff(records) != 1) | (np.diff(parts) != 0)) + 1
        whole = len(samples) == self.shape[2] and bool((np.diff(samples) == 1).all())
        wanted = range(channels[0], channels[0] + 1) if len(channels) == 1 else range(self.shape[1])
        values = np.empty((len(records), len(wanted), self.shape[2]), self.dtype)
        for start, stop in zip([0, *ends], [*ends, len(records)], strict=True):
            if start == stop:
                continue
            first = int(records[start] - self.starts[parts[start]])
            self._decode(int(parts[start]), range(first, first + stop - start), wanted, values[start:stop])
        values = values if len(channels) == 1 else values[:, channels]
        values = values if whole else values[:, :, samples]
        return values.reshape([len(item) for item in chosen if item.ndim])

    def _decode(self, part: int, records: range, channels: range, out: NDArray[Any]) -> None:
        """Decode consecutive records of a part into ``out``. Chunks are inflated without the lock, so that threads run in parallel."""
        with open_source(self.parts[part]) as file:
            stored, shape, packing, deflated = file.signal()
            if (shape, packing) != ((self.starts[part + 1] - self.starts[part], *self.shape[1:]), self.packing):
                raise CorpusError(
                    f"{self.parts[part].path}: its signal has another shape or type than the corpus; do not trust this corpus."
                )
            if not deflated:
                self.packing.decode(stored[records.start : records.stop, channels.start : channels.stop], out)
                return
            chunks = stored_chunks(stored, records, channels)
        inflating = inflate_all(chunks, self.shape[2], self.parts[part].path)
        for place, counts in zip(np.ndindex(out.shape[:2]), inflating, strict=True):
            self.packing.decode(counts, out[place])


def _numbers_of(key: int | slice | NDArray[np.integer[Any]], size: int) -> NDArray[np.integer[Any]]:
    """Numbers of the items that a key selects from ``size`` items."""
    if isinstance(key, slice):
        return np.arange(*key.indices(size))
    return np.asarray(key) + size * (np.asarray(key) < 0)


class _Records(BackendEntrypoint):
    """Backend with which xarray opens a file of records, or an index with its parts."""

    open_dataset_parameters = ("filename_or_obj", "drop_variables", "parts", "counts")

    def open_dataset(  # type: ignore[override]
        self,
        filename_or_obj: Any,
        *,
        drop_variables: Any = None,
        parts: Sequence[Path],
        counts: Sequence[int] | None,
    ) -> xr.Dataset:
        """Variables of one file with the signal of ``parts``; ``counts`` are their numbers of records."""
        source, sources = source_of(filename_or_obj), [source_of(path) for path in parts]
        with open_source(sources[0]) as file:
            stored, (count, channels, samples), packing, _ = file.signal()
            attributes = attributes_of(stored)
        counts = [count] if counts is None else counts
        signal = _Signal(sources, counts, (channels, samples), packing)
        encoding = {name: attributes.pop(name) for name in PACKING if name in attributes}
        attributes.pop("coordinates", None)
        with open_source(source) as file:
            variables = _variables(file, source, dict(zip(SIGNAL_DIMS, signal.shape, strict=True)))
            facts = attributes_of(file.handle)
        texts = [name for name, variable in variables.items() if variable.ndim == 2]
        described = xr.decode_cf(xr.Dataset(variables, attrs=facts), decode_times=False).set_coords(texts)
        lazy = indexing.LazilyIndexedArray(signal)
        records = with_own_codes(described, source.path).assign(
            {SIGNAL: xr.Variable(SIGNAL_DIMS, lazy, attributes, {"dtype": packing.dtype, **encoding})}
        )
        records.set_close(partial(close, (source, *sources)))
        return records


def open_records(path: Path, parts: Sequence[Path], counts: Sequence[int] | None = None) -> xr.Dataset:
    """Open the per-record variables of ``path`` with the signal of ``parts``, lazily.

    ``counts`` are the numbers of records of the parts if ``path`` is their index; without them ``path`` is the only part.

    Raises
    ------
    CorpusError
        If a file is missing or unreadable, or has links, values in other files or unknown dimensions.
    """
    records: Any = xr.open_dataset(path, engine=_Records, parts=parts, counts=counts)
    return records


def open_part(path: Path) -> xr.Dataset:
    """Records of one file, decoded to m s-2 and read lazily.

    Raises
    ------
    CorpusError
        If the file is missing or is not a file of records.
    """
    return open_records(path, [path])


def _variables(file: OpenFile, source: Source, sizes: dict[str, int]) -> dict[str, xr.Variable]:
    """All variables of a file except the signal."""
    variables: dict[str, xr.Variable] = {}
    for name in map(str, file.handle):
        if name != SIGNAL and not is_bare_dimension(file.dataset(name)):
            variables[name] = _variable(source, file.dataset(name), name, sizes)
    return variables


def _variable(source: Source, stored: h5py.Dataset, name: str, sizes: dict[str, int]) -> xr.Variable:
    """Variable of one value per record, or an axis of the signal."""
    dimension = name if name in SIGNAL_DIMS else "record"
    text = is_text(stored, name, dimension, sizes[dimension])
    check_limit("file_bytes", stored.shape[-1] if text else 0, f"{source.path}: a text in {name} has", CorpusError)
    attributes = plain_attributes(stored, name)
    array = indexing.LazilyIndexedArray(_Column(source, name, stored.shape, stored.dtype))
    return xr.Variable((dimension, f"{name}_length") if text else (dimension,), array, attributes)
