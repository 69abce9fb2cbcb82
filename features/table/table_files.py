"""Feature tables on disk: netCDF with a checksum of each variable, or Parquet."""

from collections.abc import Callable, Mapping
from contextlib import closing
from importlib.util import find_spec
from pathlib import Path

import xarray as xr
from xarray.backends import NetCDF4DataStore

from features.table.channels import channels_of
from gen.corpus import LIBRARY_LOCK, check_result, whole_or_not_at_all
from gen.corpus.fault_classes import further_classes
from gen.corpus.schema import with_file_codes, with_own_codes
from gen.support.errors import CorpusError
from gen.support.limits import check_limit

ROW_GROUP = 8192  # records that a reader decodes together


def write_table(table: xr.Dataset, path: Path | str) -> None:
    """Write a feature table as netCDF (``.nc``) or Parquet (``.parquet``), whole or not at all.

    A Parquet file has one column per variable and per feature, whose
    name begins with the channel if there are several, and the attributes of a variable as metadata of its column.

    Raises
    ------
    CorpusError
        As `check_destination`, or if the disk refuses the file.
    """
    path = Path(path)
    check_destination(path)
    if "fault" in table:
        table = with_file_codes(table, further_classes(table["fault"].values))
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
        raise CorpusError(f"{path}: {path.suffix or 'no suffix'} is no format of feature tables; use .nc or .parquet.")
    if path.suffix == ".parquet" and find_spec("pyarrow") is None:
        raise CorpusError(f"{path}: Parquet needs pyarrow; pip install pyarrow, or write .nc instead.")
    check_result(path, "feature table")


def read_table(path: Path | str) -> xr.Dataset:
    """Read a feature table written as netCDF.

    Raises
    ------
    CorpusError
        If the file is missing, unreadable or not a feature table.
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
        raise CorpusError(f"{path}: not a readable netCDF file ({reason}); write it with raceway features.") from error
    if not {"features", "feature", "group"} <= set(table.variables):
        raise CorpusError(
            f"{path}: contains no features (record, feature); write a feature table with raceway features."
        )
    return with_own_codes(table, path)


def _write_netcdf(table: xr.Dataset, path: Path) -> None:
    encoding = {}
    for name, variable in table.variables.items():
        text = variable.dtype.kind in "OUT"
        # fixed-length characters: HDF5 2.2 can crash on variable-length strings once another file was closed
        kind = {"dtype": "S1", "char_dim_name": f"{name}_length"} if text else {"_FillValue": None}
        # the checksum is compared by the library whenever the values are read
        encoding[name] = {"zlib": True, "fletcher32": True, **kind}
    # to_netcdf would load dask to choose a lock, which takes half a second
    with LIBRARY_LOCK, closing(NetCDF4DataStore.open(path, "w", lock=False)) as store:
        table.dump_to_store(store, encoding=encoding)


def _write_parquet(table: xr.Dataset, path: Path) -> None:
    import pyarrow as pa
    from pyarrow import parquet

    names = [str(name) for name, variable in table.variables.items() if variable.dims == ("record",)]
    columns = {name: (table[name].values, table[name].attrs) for name in names}
    # unit and meaning of a feature become metadata of its column
    about = [
        str(name) for name, coordinate in table.coords.items() if coordinate.dims == ("feature",) and name != "feature"
    ]
    for of_channel in channels_of(table):
        prefix = f"{of_channel['channel'].item()}_" if "channel" in of_channel["features"].coords else ""
        for feature in of_channel["features"].transpose("feature", "record"):
            metadata = {name: feature[name].item() for name in about}
            columns[f"{prefix}{feature['feature'].item()}"] = feature.values, metadata
    arrays = {name: pa.array(values) for name, (values, _) in columns.items()}
    fields = [pa.field(name, array.type, metadata=_texts(columns[name][1])) for name, array in arrays.items()]
    parquet.write_table(pa.table(arrays, pa.schema(fields, _texts(table.attrs))), path, row_group_size=ROW_GROUP)


def _texts(attributes: Mapping[str, object]) -> dict[str, str]:
    return {str(name): str(value) for name, value in attributes.items()}


WRITERS: Mapping[str, Callable[[xr.Dataset, Path], None]] = {".nc": _write_netcdf, ".parquet": _write_parquet}
