"""Zarr (version 2 of its format, which more programs read than version 3): the corpus with the same variables and attributes.

The signal is stored as in the corpus, counts with their scale, in chunks of several records.
"""

from pathlib import Path
from typing import Any

import xarray as xr

from gen.corpus.layout import PACKING
from gen.corpus.schema import SIGNAL
from raceway.sharing.columns import Export

_BLOCK_BYTES = 16_000_000  # of single precision
_CHUNK_BYTES = 4_000_000  # of single precision, half of that as counts
_COLUMN_CHUNK = 4096  # records


def write_zarr(export: Export, folder: Path) -> str:
    """Write the store ``corpus.zarr``; returns the page about it."""
    write_store(export, folder / "corpus.zarr")
    return export.page(_READING)


def write_store(export: Export, store: Path) -> None:
    """Write one store."""
    import zarr

    for number, block in enumerate(export.blocks(_BLOCK_BYTES)):
        records = block.dataset.assign_attrs(export.chosen.attributes)
        how: Any = {"append_dim": "record"} if number else {"mode": "w", "encoding": _storage(records, export)}
        for variable in records.variables.values():
            variable.encoding = {}
        records.to_zarr(store, zarr_format=2, consolidated=False, **how)
    zarr.consolidate_metadata(store, zarr_format=2)


def _storage(records: xr.Dataset, export: Export) -> dict[str, dict[str, Any]]:
    """Packing, chunks and compression of each variable."""
    from numcodecs import Blosc

    encodings: dict[str, dict[str, Any]] = {}
    for name, variable in records.variables.items():
        how: dict[str, Any] = {"compressors": Blosc("zstd", 5, Blosc.SHUFFLE)}
        if name == SIGNAL:
            how |= {key: variable.encoding[key] for key in ("dtype", *PACKING) if key in variable.encoding}
            how["chunks"] = (export.chosen.records_in(_CHUNK_BYTES), *variable.shape[1:])
        elif variable.dims == ("record",):
            how["chunks"] = (min(_COLUMN_CHUNK, export.chosen.count),)
        if name != SIGNAL and variable.dtype.kind == "f":
            how["_FillValue"] = None
        encodings[str(name)] = how
    return encodings


_READING = """\
The store `corpus.zarr` has the variables and attributes of the corpus; the signal is stored as in the corpus, and xarray
decodes it to m s-2, in double precision. It is a store of version 2, which more programs read than version 3.

    import xarray
    corpus = xarray.open_zarr("corpus.zarr")
    signal = corpus["acceleration"][0, 0].values
"""
