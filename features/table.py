"""Feature table: a corpus in, one row per record out, with features and all variables of the record.

``parts -> one task per part: read signal and operating variables -> indicators -> rows, in corpus order``

Features are computed from the signal and the ``operating`` variables only; labels, simulator truth and provenance are
copied unchanged. A task returns features and no signals, so that memory does not grow with the signals of a corpus. A
task is one part, so the features do not depend on the number of workers.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr
from distributed import Client

from features.indicators import GROUPS, Orders, feature_groups, feature_names, indicators
from features.signal.rows import FloatArray
from gen.cluster import client_of, local_client, run_tasks
from gen.corpus import DRAWS, open_corpus, part_paths, read_channel, read_manifest
from gen.errors import CorpusError

Progress = Callable[[int, int], None]

INLINE_RECORDS = 2000  # their features take about as long as a local cluster takes to start


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
        Some of ``features.indicators.GROUPS``; ``lines`` and ``shape`` transfer to other machines.
    channel
        Number of the channel, from 0.
    scheduler
        A dask client, the address of a dask scheduler, or ``"local"`` for a cluster with one process per core, which
        is not started for a small corpus; by default this process.
    progress
        Called after each part with the number of parts done and of all parts.

    Returns
    -------
    Dataset
        ``features (record, feature)``, coordinates ``feature`` (names) and ``group``, all variables of the records
        except ``draws``, which is larger than the rest of the table, and the attributes of the corpus with
        ``records_with_missing_features``, the number of rows with a NaN.

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
    values = np.empty((table.sizes["record"], len(names)))
    counts = [row.records for row in read_manifest(Path(corpus)).parts]
    starts = np.concatenate([[0], np.cumsum(counts)])
    compute = partial(part_features, groups=tuple(groups), channel=channel)
    runs = _run(compute, paths, None if scheduler == "local" and small else scheduler)
    for done, (number, block) in enumerate(runs, start=1):
        values[starts[number] : starts[number + 1]] = block
        if progress is not None:
            progress(done, len(paths))
    return _assemble(table, values, groups)


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
    """Yield number and features of each part as they are completed."""
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
