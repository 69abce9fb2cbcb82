"""Parquet: one row per record, a column per label, and per channel a column of lists.

Units and meanings are metadata of the columns. A class is a column of names (dictionary-encoded), a missing sample is NaN.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gen.sharing.exporting.choosing import Block, Chosen, Column
from gen.sharing.exporting.report import Report, page

if TYPE_CHECKING:
    import pyarrow as pa

FILE_BYTES = 500_000_000
"""Largest size of the signals of a file in single precision."""
_ROW_GROUP_BYTES = 16_000_000
_SIGNAL = "acceleration_"


def write_parquet(chosen: Chosen, folder: Path, report: Report) -> str:
    """Write ``data/records-00000-of-00002.parquet`` ...; returns the page about them."""
    write_shards(chosen, folder / "data", "records", chosen.records, report, names=True)
    return page(chosen, _READING)


def write_shards(
    chosen: Chosen, folder: Path, prefix: str, records: NDArray[np.intp], report: Report, *, names: bool
) -> None:
    """Write some of the chosen records as Parquet files of up to ``FILE_BYTES``.

    ``names`` stores classes by their names, and otherwise by their codes, with null for a class that is not known.
    """
    from pyarrow import parquet

    folder.mkdir(exist_ok=True)
    schema = _schema(chosen, names=names)
    size = max(1, FILE_BYTES // (4 * len(chosen.channels) * chosen.samples))
    shards = -(-len(records) // size)
    paths = [folder / f"{prefix}-{number:05d}-of-{shards:05d}.parquet" for number in range(shards)]
    storage = _storage(chosen)
    for number, path in enumerate(paths):
        with parquet.ParquetWriter(path, schema, **storage) as file:
            for block in chosen.blocks(_ROW_GROUP_BYTES, records[number * size : (number + 1) * size]):
                file.write_table(_table(chosen, block, schema, names=names))
                report(block)


def class_names(column: Column) -> list[str]:
    """Names of the classes of a variable in the order of their codes from 0, without "unknown"; none if it is no such variable."""
    known = {code: name for code, name in column.flags.items() if name != "unknown"}
    return [known[code] for code in range(len(known))] if sorted(known) == list(range(len(known))) else []


def _schema(chosen: Chosen, *, names: bool) -> "pa.Schema":
    import pyarrow as pa

    number = {"long_name": "number of the record in the corpus", "role": "provenance"}
    fields = [pa.field("record", pa.int64(), metadata=number)]
    for column in chosen.columns:
        about = {"units": column.units, "role": column.role, "long_name": column.meaning}
        fields.append(pa.field(column.name, _type(column, names=names), metadata=about))
    for name, text in zip(chosen.channel_names, chosen.channel_texts, strict=True):
        about = {"units": "m s-2", "role": "signal", "channel": text, "sample_rate_hz": repr(chosen.sample_rate)}
        fields.append(pa.field(f"{_SIGNAL}{name}", pa.list_(pa.float32(), chosen.samples), metadata=about))
    return pa.schema(fields, {str(key): str(value) for key, value in chosen.corpus.attrs.items()})


def _storage(chosen: Chosen) -> dict[str, Any]:
    """Compression and encodings of the columns.

    Counts have at most 65,536 different values, which fit the dictionary of a row group: half the size of any other encoding.
    """
    signals = [f"{_SIGNAL}{name}.list.element" for name in chosen.channel_names]
    labels = [column.name for column in chosen.columns]
    if chosen.scale is None:
        return {"compression": "zstd", "use_dictionary": labels, "use_byte_stream_split": signals}
    return {"compression": "zstd", "use_dictionary": [*labels, *signals]}


def _type(column: Column, *, names: bool) -> "pa.DataType":
    import pyarrow as pa

    if column.flags and names:
        return pa.dictionary(pa.int8(), pa.string())
    if class_names(column):
        return pa.int64()
    return pa.string() if column.dtype is None or column.flags else pa.from_numpy_dtype(column.dtype)


def _table(chosen: Chosen, block: Block, schema: "pa.Schema", *, names: bool) -> "pa.Table":
    import pyarrow as pa

    columns: list[Any] = [pa.array(block.numbers)]
    for column in chosen.columns:
        if class_names(column) and not names:
            codes = block.dataset[column.variable].values
            columns.append(pa.array(codes.astype(np.int64), mask=codes >= len(class_names(column))))
        elif column.flags and names:
            columns.append(_categories(block.values(column)))
        else:
            values = block.values(column)
            columns.append(pa.array(values.tolist(), pa.string()) if values.dtype.kind in "OUS" else pa.array(values))
    signal = block.accelerations()
    for place in range(signal.shape[1]):
        flat = np.ascontiguousarray(signal[:, place]).reshape(-1)
        columns.append(pa.FixedSizeListArray.from_arrays(pa.array(flat), chosen.samples))
    return pa.table(columns, schema=schema)


def _categories(names: Sequence[str] | NDArray[Any]) -> Any:
    import pyarrow as pa

    return pa.array(list(names)).dictionary_encode().cast(pa.dictionary(pa.int8(), pa.string()))


_READING = """\
The files in `data/` have one row for each record: labels, and a list of samples [m s-2] for each channel. Units and meanings
are metadata of the columns (`pyarrow.parquet.read_schema(file)`).

    import numpy, pandas
    records = pandas.read_parquet("data")
    column = next(name for name in records if name.startswith("acceleration_"))
    signal = numpy.stack(records[column])
"""
