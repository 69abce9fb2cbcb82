"""Parquet: one row per record, a column per label, and per channel a column of lists.

Units and meanings are metadata of the columns. A class is a column of names, a missing sample is NaN.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from raceway.sharing.copying import Block, Chosen
from raceway.sharing.form_columns import Column, columns_of, plain_names

if TYPE_CHECKING:
    import pyarrow as pa

_ROW_GROUP_BYTES = 16_000_000
SIGNAL_PREFIX = "acceleration_"


def write_parquet(chosen: Chosen, path: Path, places: NDArray[np.intp] | None = None) -> None:
    """Write chosen records, or some of them, as one Parquet file."""
    from pyarrow import parquet

    columns = columns_of(chosen)
    schema = _schema(chosen, columns)
    with parquet.ParquetWriter(path, schema, compression="zstd") as file:
        for block in chosen.blocks(_ROW_GROUP_BYTES, places):
            file.write_table(_table(block, columns, schema))


def _schema(chosen: Chosen, columns: Sequence[Column]) -> "pa.Schema":
    import pyarrow as pa

    number = {"long_name": "number of the record in the corpus", "role": "provenance"}
    fields = [pa.field("record", pa.int64(), metadata=number)]
    for column in columns:
        about = {"units": column.units, "role": column.role, "long_name": column.meaning}
        stored = pa.string() if column.dtype is None else pa.from_numpy_dtype(column.dtype)
        fields.append(pa.field(column.name, stored, metadata=about))
    for name, text in zip(plain_names(chosen.channels), chosen.channels, strict=True):
        about = {"units": "m s-2", "role": "signal", "channel": text, "sample_rate_hz": repr(chosen.sample_rate)}
        fields.append(pa.field(f"{SIGNAL_PREFIX}{name}", pa.list_(pa.float32(), chosen.samples), metadata=about))
    return pa.schema(fields, {str(key): str(value) for key, value in chosen.attributes.items()})


def _table(block: Block, columns: Sequence[Column], schema: "pa.Schema") -> "pa.Table":
    import pyarrow as pa

    arrays: list[Any] = [pa.array(block.numbers)]
    for column in columns:
        values = column.of(block.dataset)
        arrays.append(pa.array(values.tolist(), pa.string()) if column.dtype is None else pa.array(values))
    signal = block.accelerations()
    for place in range(signal.shape[1]):
        # the signal of each channel is a list of one length
        flat = np.ascontiguousarray(signal[:, place]).reshape(-1)
        arrays.append(pa.FixedSizeListArray.from_arrays(pa.array(flat), signal.shape[2]))
    return pa.table(arrays, schema=schema)
