"""Parquet: one row per record, a column per label, and per channel a column of lists.

Units and meanings are metadata of the columns. A class is a column of names (dictionary-encoded), a missing sample is NaN.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from raceway.sharing.copying import Block
from raceway.sharing.form_columns import Column, Export

if TYPE_CHECKING:
    import pyarrow as pa

FILE_BYTES = 500_000_000
"""Largest size of the signals of a file in single precision."""
_ROW_GROUP_BYTES = 16_000_000
_SIGNAL = "acceleration_"


def write_parquet(export: Export, folder: Path) -> str:
    """Write ``data/records-00000-of-00002.parquet`` ...; returns the page about them."""
    write_shards(export, folder / "data", "records", np.arange(export.chosen.count), names=True)
    return export.page(_READING)


def write_parquet_file(export: Export, path: Path) -> None:
    """Write one Parquet file."""
    _write(export, path, None, names=True)


def write_shards(export: Export, folder: Path, prefix: str, places: NDArray[np.intp], *, names: bool) -> None:
    """Write some of the chosen records as Parquet files of up to ``FILE_BYTES``.

    ``names`` stores classes by their names, and otherwise by their places among `known_classes`, with null for one that is not known.
    """
    folder.mkdir(exist_ok=True)
    size = max(1, FILE_BYTES // (4 * len(export.channels) * export.chosen.samples))
    shards = -(-len(places) // size)
    for number in range(shards):
        path = folder / f"{prefix}-{number:05d}-of-{shards:05d}.parquet"
        _write(export, path, places[number * size : (number + 1) * size], names=names)


def _write(export: Export, path: Path, places: NDArray[np.intp] | None, *, names: bool) -> None:
    from pyarrow import parquet

    schema = _schema(export, names=names)
    with parquet.ParquetWriter(path, schema, **_storage(export)) as file:
        for block in export.blocks(_ROW_GROUP_BYTES, places):
            file.write_table(_table(export, block, schema, names=names))


def known_classes(column: Column) -> dict[int, str]:
    """Names of the classes in the chosen records by their codes, ascending, without "unknown"."""
    return {code: name for code, name in sorted(column.flags.items()) if name != "unknown"}


def _schema(export: Export, *, names: bool) -> "pa.Schema":
    import pyarrow as pa

    chosen = export.chosen
    number = {"long_name": "number of the record in the corpus", "role": "provenance"}
    fields = [pa.field("record", pa.int64(), metadata=number)]
    for column in export.columns:
        about = {"units": column.units, "role": column.role, "long_name": column.meaning}
        fields.append(pa.field(column.name, _type(column, names=names), metadata=about))
    for name, text in zip(export.channels, chosen.channels, strict=True):
        about = {"units": "m s-2", "role": "signal", "channel": text, "sample_rate_hz": repr(chosen.sample_rate)}
        fields.append(pa.field(f"{_SIGNAL}{name}", pa.list_(pa.float32(), chosen.samples), metadata=about))
    return pa.schema(fields, {str(key): str(value) for key, value in chosen.attributes.items()})


def _storage(export: Export) -> dict[str, Any]:
    """Compression and encodings of the columns.

    Counts have at most 65,536 different values, which fit the dictionary of a row group: half the size of any other encoding.
    """
    signals = [f"{_SIGNAL}{name}.list.element" for name in export.channels]
    labels = [column.name for column in export.columns]
    if export.chosen.scale is None:
        return {"compression": "zstd", "use_dictionary": labels, "use_byte_stream_split": signals}
    return {"compression": "zstd", "use_dictionary": [*labels, *signals]}


def _type(column: Column, *, names: bool) -> "pa.DataType":
    import pyarrow as pa

    if column.flags and names:
        return pa.dictionary(pa.int8(), pa.string())
    if column.flags:
        return pa.int64()
    return pa.string() if column.dtype is None else pa.from_numpy_dtype(column.dtype)


def _table(export: Export, block: Block, schema: "pa.Schema", *, names: bool) -> "pa.Table":
    import pyarrow as pa

    columns: list[Any] = [pa.array(block.numbers)]
    for column in export.columns:
        if column.flags and not names:
            # classes as the places that the features of datasets count
            known, codes = [*known_classes(column)], block.dataset[column.variable].values
            columns.append(pa.array(np.searchsorted(known, codes), pa.int64(), mask=~np.isin(codes, known)))
        elif column.flags and names:
            columns.append(_categories(column.of(block.dataset)))
        else:
            values = column.of(block.dataset)
            columns.append(pa.array(values.tolist(), pa.string()) if values.dtype.kind in "OUS" else pa.array(values))
    signal = block.accelerations()
    for place in range(signal.shape[1]):
        # the signal of each channel is a list of one length
        flat = np.ascontiguousarray(signal[:, place]).reshape(-1)
        columns.append(pa.FixedSizeListArray.from_arrays(pa.array(flat), signal.shape[2]))
    return pa.table(columns, schema=schema)


def _categories(names: NDArray[Any]) -> Any:
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
