"""Zarr (version 2 of its format, which more programs read than version 3): the corpus with the same variables and attributes.

The signal is stored as in the corpus, counts with their scale, in chunks of several records.
"""

from pathlib import Path
from typing import Any

import xarray as xr

from gen.corpus.layout import PACKING
from gen.corpus.schema import SIGNAL_DIMS
from gen.sharing.exporting.choosing import Chosen
from gen.sharing.exporting.report import Report, page

STORE = "corpus.zarr"
_BLOCK_BYTES = 16_000_000  # of single precision
_CHUNK_BYTES = 4_000_000  # of single precision, half of that as counts
_COLUMN_CHUNK = 4096  # records


def write_zarr(chosen: Chosen, folder: Path, report: Report) -> str:
    """Write the store ``corpus.zarr``; returns the page about it."""
    import zarr

    store = folder / STORE
    rows = chosen.records_in(_CHUNK_BYTES)
    for block in chosen.blocks(_BLOCK_BYTES, multiple_of=rows):
        dataset = block.dataset
        stored = {str(name): _storage(variable, chosen, rows) for name, variable in dataset.variables.items()}
        for variable in dataset.variables.values():
            variable.encoding = {}
        how: Any = {"append_dim": "record"} if block.first else {"mode": "w", "encoding": stored}
        dataset.to_zarr(store, zarr_format=2, consolidated=False, **how)
        report(block)
    zarr.consolidate_metadata(store, zarr_format=2)
    return page(chosen, _READING)


def _storage(variable: xr.Variable, chosen: Chosen, rows: int) -> dict[str, Any]:
    """Type, packing, chunks and compression of a variable; ``rows`` are the records of a chunk of the signal."""
    from numcodecs import Blosc

    if variable.dims == SIGNAL_DIMS:
        packing = {name: variable.encoding[name] for name in ("dtype", *PACKING) if name in variable.encoding}
        chunks = (rows, len(chosen.channels), chosen.samples)
        return {**packing, "chunks": chunks, "compressors": Blosc("zstd", 5, Blosc.SHUFFLE)}
    chunks = {"chunks": (min(_COLUMN_CHUNK, len(chosen.records)),)} if variable.dims == ("record",) else {}
    return {
        "compressors": Blosc("zstd", 5, Blosc.SHUFFLE),
        **chunks,
        **({"_FillValue": None} if variable.dtype.kind == "f" else {}),
    }


_READING = """\
The store `corpus.zarr` has the variables and attributes of the corpus; the signal is stored as in the corpus, and xarray
decodes it to m s-2, in double precision. It is a store of version 2, which more programs read than version 3.

    import xarray
    corpus = xarray.open_zarr("corpus.zarr")
    signal = corpus["acceleration"][0, 0].values
"""
