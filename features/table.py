"""Feature table: a corpus in, one row of features per record out, beside everything known about the record.

``parts -> a task each: read the signal and what an analyst knows -> indicators -> rows, in corpus order``

Only the signal and ``operating`` variables reach the features; labels, simulator truth and provenance are
carried along untouched. A task returns numbers only, so that memory does not grow with the signals of a
corpus, and since a task is a part, the numbers are the same for every number of workers.
"""

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, nullcontext, suppress
from functools import partial
from pathlib import Path

import netCDF4
import numpy as np
import xarray as xr
from distributed import Client, LocalCluster, as_completed

from features.indicators import GROUPS, Orders, feature_groups, feature_names, indicators
from features.rows import FloatArray
from gen.corpus import SIGNAL, open_corpus, part_paths
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
        variables and the attributes of the corpus, and ``records_with_missing_features``, the number of rows
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
        table = opened.drop_dims(["channel", "elapsed_time"]).load().drop_encoding()
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
    x, (fs, shaft_rate, *nominal) = _read_part(path, channel)
    orders = Orders(*nominal)
    values = np.full((len(x), len(feature_names(groups))), np.nan)
    for rate in np.unique(fs[fs > 0]):
        rows = np.flatnonzero(fs == rate)
        chosen = Orders(*(order[rows] for order in orders))
        values[rows], _ = indicators(x[rows], float(rate), shaft_rate[rows], chosen, groups)
    return values


def _read_part(path: Path, channel: int) -> tuple[FloatArray, list[FloatArray]]:
    """Signals of one channel in single precision, then sample rate, shaft rate and `Orders` of the records.

    Not by xarray, which takes 1.6 times as long: it opens variables nobody reads and scales in double precision.
    """
    try:
        with netCDF4.Dataset(path) as part:
            part.set_auto_maskandscale(False)
            signal = part[SIGNAL]
            x, attributes = signal[:, channel], signal.__dict__
            known = [part[name][:] for name in ("sample_rate", "shaft_rate", *Orders._fields)]
    except (OSError, RuntimeError, IndexError) as error:  # no such file, damaged bytes, no such variable
        raise CorpusError(f"{path}: not a readable netCDF-4 part ({error}); generate or copy it again.") from error
    if "scale_factor" in attributes:
        missing = x == attributes.get("_FillValue")
        x = np.where(missing, np.float32(np.nan), x * np.float32(attributes["scale_factor"]))
    return x, known


def _run(
    compute: Callable[[Path], FloatArray], paths: list[Path], scheduler: Client | str | None
) -> Iterator[tuple[int, FloatArray]]:
    """Yield number and features of each part as they come."""
    if scheduler is None:
        yield from enumerate(map(compute, paths))
        return
    with ExitStack() as stack:
        client = stack.enter_context(_client(scheduler, stack))
        numbers = {future: number for number, future in enumerate(client.map(compute, paths, pure=False))}
        for future in as_completed(numbers):
            yield numbers[future], future.result()


def _client(scheduler: Client | str | None, stack: ExitStack) -> AbstractContextManager[Client]:
    if isinstance(scheduler, Client):
        return nullcontext(scheduler)
    if scheduler != "local":
        return Client(scheduler)
    cluster = LocalCluster(threads_per_worker=1, dashboard_address="127.0.0.1:0")
    return Client(stack.enter_context(cluster))


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
    temporary = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        writers[path.suffix](table, temporary)
        temporary.replace(path)
    except (OSError, RuntimeError) as error:
        message = f"{path}: could not be written ({error}); free some space or choose another folder."
        raise CorpusError(message) from error
    finally:
        with suppress(OSError):
            temporary.unlink()


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
