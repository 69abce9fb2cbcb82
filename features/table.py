"""Feature table: a corpus in, one row of features per record out, beside everything known about the record.

``parts -> a task each: read the signal and what an analyst knows -> indicators -> rows, in corpus order``

Only the signal and ``operating`` variables reach the features; labels, simulator truth and provenance are
carried along untouched. A task returns numbers only, so that memory does not grow with the signals of a
corpus, and since a task is a part, the numbers are the same for every number of workers.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr
from distributed import Client

from features.indicators import GROUPS, Orders, feature_groups, feature_names, indicators
from features.rows import FloatArray
from gen.cluster import client_of, local_client, run_tasks
from gen.corpus import DRAWS, open_corpus, part_paths, read_channel, whole_or_not_at_all
from gen.errors import CorpusError

Progress = Callable[[int, int], None]

INLINE_RECORDS = 2000  # a local cluster takes about as long to start as these take to compute


def feature_table(
    corpus: Path | str,
    groups: Sequence[str] = GROUPS,
    *,
    channel: int = 0,
    scheduler: Client | str | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Features of every record of a corpus.

    Parameters
    ----------
    corpus
        The folder of the corpus.
    groups
        Any of ``lines``, ``shape``, ``bands``, ``time``; the first two are the ones that carry over to other
        machines.
    channel
        Number of the channel to look at.
    scheduler
        A dask client, the address of a dask scheduler, or ``"local"`` for a cluster of one process per core
        unless the corpus is small; by default this process.
    progress
        Called after each part with the number of parts done and of all parts.

    Returns
    -------
    Dataset
        ``features (record, feature)``, coordinates ``feature`` (names) and ``group``, all per-record
        variables but ``draws``, which would be most of the table, the attributes of the corpus, and
        ``records_with_missing_features``, the number of rows
        that hold a NaN.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, altered or has no such channel.
    ValueError
        For a group that does not exist.
    """
    names = feature_names(groups)
    with open_corpus(corpus) as opened:
        if not 0 <= channel < opened.sizes["channel"]:
            last = opened.sizes["channel"] - 1
            message = f"{corpus}: no channel {channel}; give one of 0 to {last}."
            raise CorpusError(message)
        described = opened.drop_dims(["channel", "elapsed_time"]).drop_vars(DRAWS, errors="ignore")
        table = described.load().drop_encoding()
    paths = part_paths(corpus, check="size")
    small = len(paths) == 1 or table.sizes["record"] <= INLINE_RECORDS
    blocks: list[FloatArray] = [np.empty((0, len(names)))] * len(paths)
    compute = partial(part_features, groups=tuple(groups), channel=channel)
    runs = _run(compute, paths, None if scheduler == "local" and small else scheduler)
    for done, (number, block) in enumerate(runs, start=1):
        blocks[number] = block
        if progress is not None:
            progress(done, len(paths))
    return _assemble(table, np.concatenate(blocks), groups)


def part_features(path: Path, groups: Sequence[str] = GROUPS, channel: int = 0) -> FloatArray:
    """Features of the records of one part, shape (record, feature); NaN as in `features.indicators`."""
    x, (fs, shaft_rate, *nominal) = read_channel(path, channel, ("sample_rate", "shaft_rate", *Orders._fields))
    orders = Orders(*nominal)
    values = np.full((len(x), len(feature_names(groups))), np.nan)
    for rate in np.unique(fs[fs > 0]):
        rows = np.flatnonzero(fs == rate)
        chosen = Orders(*(order[rows] for order in orders))
        values[rows], _ = indicators(x[rows], float(rate), shaft_rate[rows], chosen, groups)
    return values


def _run(
    compute: Callable[[Path], FloatArray], paths: list[Path], scheduler: Client | str | None
) -> Iterator[tuple[int, FloatArray]]:
    """Yield number and features of each part as they come."""
    numbered = partial(_numbered, compute)
    if scheduler is None:
        yield from map(numbered, enumerate(paths))
        return
    with _client(scheduler) as client:
        yield from run_tasks(client, numbered, enumerate(path.absolute() for path in paths))


def _numbered(compute: Callable[[Path], FloatArray], task: tuple[int, Path]) -> tuple[int, FloatArray]:
    number, path = task
    return number, compute(path)


def _client(scheduler: Client | str) -> AbstractContextManager[Client]:
    if isinstance(scheduler, Client):
        return nullcontext(scheduler)
    return local_client() if scheduler == "local" else client_of(scheduler)


def _assemble(table: xr.Dataset, values: FloatArray, groups: Sequence[str]) -> xr.Dataset:
    names = np.array(feature_names(groups), dtype=object)
    group = np.array(feature_groups(groups), dtype=object)
    described = table.assign(
        features=(("record", "feature"), values, {"long_name": "features of the signal", "units": "1"})
    ).assign_coords(
        feature=("feature", names, {"long_name": "name of the feature"}),
        group=("feature", group, {"long_name": "group of the feature"}),
    )
    return described.assign_attrs(records_with_missing_features=int(np.isnan(values).any(axis=1).sum()))


def write_table(table: xr.Dataset, path: Path | str) -> None:
    """Write a feature table as netCDF (``.nc``) or Parquet (``.parquet``), whole or not at all.

    Parquet gets a column per feature and per variable, with the attributes as metadata of the column.

    Raises
    ------
    CorpusError
        For another suffix, for Parquet without pyarrow, or if the disk refuses the file.
    """
    path = Path(path)
    writers = {".nc": _write_netcdf, ".parquet": _write_parquet}
    if path.suffix not in writers:
        message = f"{path}: {path.suffix or 'no suffix'} is no format of feature tables; use .nc or .parquet."
        raise CorpusError(message)
    with whole_or_not_at_all(path) as temporary:
        writers[path.suffix](table, temporary)


def _write_netcdf(table: xr.Dataset, path: Path) -> None:
    encoding = {}
    for name, variable in table.variables.items():
        text = variable.dtype.kind in "OUT"
        # fixed-length characters: HDF5 2.2 can crash on variable-length strings once another file was closed
        encoding[name] = {"dtype": "S1", "char_dim_name": f"{name}_length"} if text else {"_FillValue": None}
    table.to_netcdf(path, engine="netcdf4", format="NETCDF4", encoding=encoding)


def _write_parquet(table: xr.Dataset, path: Path) -> None:
    try:
        import pyarrow as pa
        from pyarrow import parquet
    except ImportError as error:
        message = f"{path}: Parquet needs pyarrow; install raceway[parquet], or write .nc instead."
        raise CorpusError(message) from error
    columns = {str(name): table[name] for name, known in table.variables.items() if known.dims == ("record",)}
    columns |= {str(name): table["features"].sel(feature=name) for name in table["feature"].values}
    arrays = {name: pa.array(column.values) for name, column in columns.items()}
    fields = [
        pa.field(name, arrays[name].type, metadata={key: str(value) for key, value in column.attrs.items()})
        for name, column in columns.items()
    ]
    metadata = {key: str(value) for key, value in table.attrs.items()}
    parquet.write_table(pa.table(list(arrays.values()), schema=pa.schema(fields, metadata)), path)


def read_table(path: Path | str) -> xr.Dataset:
    """Read a feature table written as netCDF.

    Raises
    ------
    CorpusError
        If the file is missing, unreadable or no feature table.
    """
    try:
        table = xr.load_dataset(path, engine="netcdf4", decode_times=False).drop_encoding()
    except (OSError, ValueError) as error:
        message = f"{path}: not a readable netCDF file ({error}); write it with raceway features."
        raise CorpusError(message) from error
    if not {"features", "feature", "group"} <= set(table.variables):
        message = f"{path}: holds no features (record, feature); write a feature table with raceway features."
        raise CorpusError(message)
    return table
