"""Feature tables on disk: netCDF with a digest of its whole content, or Parquet."""

import hashlib
import json
from collections.abc import Callable, Mapping
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import xarray as xr

from features.table.channels import channels_of
from gen.corpus import LIBRARY_LOCK, check_result, whole_or_not_at_all
from gen.corpus.schema import with_own_codes
from gen.support.errors import CorpusError
from gen.support.limits import check_limit

DIGEST = "sha256"
ROW_GROUP = 8192  # records that are copied to columns together


def write_table(table: xr.Dataset, path: Path | str) -> None:
    """Write a feature table as netCDF (``.nc``) or Parquet (``.parquet``), whole or not at all.

    The netCDF file contains the digest of its content. A Parquet file has one column per variable and per feature, whose
    name begins with the channel if there are several, and the attributes of a variable as metadata of its column.

    Raises
    ------
    CorpusError
        As `check_destination`, or if the disk refuses the file.
    """
    path = Path(path)
    check_destination(path)
    with whole_or_not_at_all(path) as temporary:
        WRITERS[path.suffix](table, temporary)


def check_destination(path: Path | str) -> None:
    """Refuse a path that no feature table can be written to; call it before the features are computed.

    Raises
    ------
    CorpusError
        If the suffix is neither ``.nc`` nor ``.parquet``, or is ``.parquet`` without pyarrow; if the path lies in a corpus, or is a file
        that is no feature table.
    """
    path = Path(path)
    if path.suffix not in WRITERS:
        message = f"{path}: {path.suffix or 'no suffix'} is no format of feature tables; use .nc or .parquet."
        raise CorpusError(message)
    if path.suffix == ".parquet" and find_spec("pyarrow") is None:
        message = f"{path}: Parquet needs pyarrow; pip install pyarrow, or write .nc instead."
        raise CorpusError(message)
    check_result(path, "feature table")


def read_table(path: Path | str) -> xr.Dataset:
    """Read a feature table written as netCDF.

    Raises
    ------
    CorpusError
        If the file is missing, unreadable, altered or not a feature table.
    """
    path = Path(path)
    try:
        check_limit("file_bytes", path.stat().st_size, f"{path}: holds", CorpusError)
        # the netCDF library is not thread-safe
        with LIBRARY_LOCK:
            table = xr.load_dataset(path, engine="netcdf4", decode_times=False).drop_encoding()
    except CorpusError:
        raise
    except Exception as error:  # netCDF4 and xarray raise a dozen unrelated types for damaged bytes
        reason = (str(error) or type(error).__name__).splitlines()[0]
        message = f"{path}: not a readable netCDF file ({reason}); write it with raceway features."
        raise CorpusError(message) from error
    if not {"features", "feature", "group"} <= set(table.variables):
        message = f"{path}: contains no features (record, feature); write a feature table with raceway features."
        raise CorpusError(message)
    # a table that another program changed may no longer be what its attributes say
    if table.attrs.pop(DIGEST, None) != _digest(table):
        message = f"{path}: altered, its content does not match its digest; write it again with raceway features."
        raise CorpusError(message)
    return with_own_codes(table, path)


def _digest(table: xr.Dataset) -> str:
    """SHA-256 of names, dimensions, types, values and attributes of a table."""
    whole = hashlib.sha256(_attributes_text(table.attrs))
    for name in sorted(map(str, table.variables)):
        variable = table[name].variable
        # texts come back from a file as another type, so their characters count
        texts = variable.dtype.kind in "OUT"
        whole.update(repr((name, variable.dims, variable.shape, "text" if texts else variable.dtype.str)).encode())
        whole.update(_attributes_text(variable.attrs))
        if texts:
            whole.update("\0".join(map(str, variable.values.flat)).encode())
        else:
            whole.update(np.ascontiguousarray(variable.values).data)
    return whole.hexdigest()


def _attributes_text(attributes: dict) -> bytes:
    """Attributes as text that does not change when a file is written and read."""
    plain = {str(key): np.atleast_1d(np.asarray(value)).tolist() for key, value in attributes.items()}
    return json.dumps(plain, sort_keys=True, default=str).encode()


def _write_netcdf(table: xr.Dataset, path: Path) -> None:
    encoding = {}
    for name, variable in table.variables.items():
        text = variable.dtype.kind in "OUT"
        # fixed-length characters: HDF5 2.2 can crash on variable-length strings once another file was closed
        kind = {"dtype": "S1", "char_dim_name": f"{name}_length"} if text else {"_FillValue": None}
        encoding[name] = {"zlib": True, **kind}
    with LIBRARY_LOCK:
        table.assign_attrs({DIGEST: _digest(table)}).to_netcdf(
            path, engine="netcdf4", format="NETCDF4", encoding=encoding
        )


def _write_parquet(table: xr.Dataset, path: Path) -> None:
    import pyarrow as pa
    from pyarrow import parquet

    names = [str(name) for name, known in table.variables.items() if known.dims == ("record",)]
    columns = {name: (table[name].values, table[name].attrs) for name in names}
    # unit and meaning of a feature become metadata of its column
    about = [str(name) for name, known in table.coords.items() if known.dims == ("feature",) and name != "feature"]
    for one in channels_of(table):
        prefix = f"{one['channel'].item()}_" if "channel" in one["features"].coords else ""
        for feature in one["features"].transpose("feature", "record"):
            known = {name: feature[name].item() for name in about}
            columns[f"{prefix}{feature['feature'].item()}"] = feature.values, known
    # types are those of a first value, so that no column is converted as a whole
    fields = [
        pa.field(name, pa.array(values[:1]).type, metadata={key: str(value) for key, value in attributes.items()})
        for name, (values, attributes) in columns.items()
    ]
    schema = pa.schema(fields, {key: str(value) for key, value in table.attrs.items()})
    # in groups of rows, so that memory does not grow with the table
    with parquet.ParquetWriter(path, schema) as file:
        for start in range(0, table.sizes["record"], ROW_GROUP):
            rows = slice(start, start + ROW_GROUP)
            file.write_table(pa.table([pa.array(values[rows]) for values, _ in columns.values()], schema=schema))


WRITERS: Mapping[str, Callable[[xr.Dataset, Path], None]] = {".nc": _write_netcdf, ".parquet": _write_parquet}
