"""Feature table: a corpus in, one row per record out, with features and all variables of the record.

``records -> one task per block of them: read signal and operating variables -> indicators -> rows, in corpus order``

Features are computed from the signal and the ``operating`` variables only; labels, simulator truth and provenance are
copied unchanged. A task returns features and no signals, and its rows are copied into a table that is allocated once: a worker needs
memory for the signals of one block, and this process needs that of the table, which is 1.4 kB per record with all groups. A
task is one block of records, so the features do not depend on the number of workers. If shaft speeds are wanted, a pass over
all blocks before that of the features estimates them, since the records of a recording may lie in several blocks.
"""

import json
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import numpy as np
import xarray as xr

from features.signal.arguments import check_positive
from features.signal.rows import FloatArray, group_means
from features.table.band import DEFAULT_BAND, Band, band_attributes, band_of, checked_band
from features.table.channels import accelerations, channel_blocks, channel_number, joined_channels, orders_of
from features.table.definitions import GROUPS, feature_coordinates
from features.table.durations import DURATION, windows_of
from features.table.indicators import Orders, indicators
from features.table.recording_speeds import (
    Speed,
    block_sums,
    checked_speed,
    rates_to_use,
    recording_numbers,
    recording_speeds,
    with_speeds,
)
from gen.corpus import DRAWS, corpus_name, open_corpus
from gen.support.executor import Workers, connected, run
from gen.support.plugins import plugin_versions
from gen.support.progress import Progress, counter

if TYPE_CHECKING:
    from distributed import Client

Item = TypeVar("Item")
Result = TypeVar("Result")


def feature_table(
    corpus: Path | str | xr.Dataset,
    groups: Sequence[str] = GROUPS,
    *,
    speed: Speed = "off",
    channel: int | str | Sequence[str] = 0,
    band: tuple[float, float] = DEFAULT_BAND,
    window: float | None = None,
    workers: int = 1,
    scheduler: "Client | str | None" = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Features of every record of a corpus.

    Parameters
    ----------
    corpus
        Folder or file of the corpus, or records in memory, of `gen.records` or chosen from `gen.open_corpus`.
    groups
        Some of ``features.table.definitions.GROUPS``; ``lines`` and ``shape`` transfer to other machines.
    speed
        ``off`` takes the labels; ``check`` also estimates the shaft speed of every recording (`features.shaft_speed`); ``correct`` does
        so too and computes the features at the estimated speed where it is clear. Simulated corpora are not checked.
    channel
        Name of the channel, or its number from 0; or the names of several, such as the axes of one housing.
    band
        Band that lines and shape are computed from [Hz], such as ``(300, 9000)``.
    window
        Longest signal that features are computed of [s]: longer records are cut into consecutive windows, and their features are the means
        over these.
    workers
        Number of processes that compute features; 1 is this one.
    scheduler
        A dask client, or the address of a dask scheduler whose workers see ``corpus`` under the same path; replaces ``workers``.
    progress
        Called after each block of records with the number of blocks done and of all; speeds count every block twice, and several
        channels are counted one after the other.

    Returns
    -------
    Dataset
        ``features (record, feature)``, or ``(channel, record, feature)`` of several channels, coordinates ``feature`` (names),
        ``group``, ``units`` and ``long_name`` (meanings), the ``duration`` of each record, or of its windows [s], all variables of the
        records except ``draws``, which is larger than the rest of the table, and the attributes of the corpus with the ``channel``, band
        and ``records_with_missing_features``, the number of rows with a NaN. With ``speed``, also ``shaft_rate_estimate`` and
        ``shaft_rate_uncertainty`` [Hz], ``shaft_rate_evidence`` (0: not clear) and, as an attribute, the number of
        ``recordings_with_other_speed``.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, altered or has no such channel.
    ValueError
        For a group or a treatment of speeds that does not exist, a band that is too narrow or out of range, or a window that is no
        positive number.
    """
    band = checked_band(*band)
    if window is not None:
        check_positive(window=window)
    # several channels are tables of one channel each, joined along a dimension
    if not isinstance(channel, int | str):
        if not channel:
            raise ValueError("channel: none is named; give the name of one, or of several.")
        each = partial(
            feature_table, corpus, groups, speed=speed, band=band, window=window, workers=workers, scheduler=scheduler
        )
        return joined_channels({name: each(channel=name, progress=progress) for name in channel})
    coordinates = feature_coordinates(groups, band)
    with open_corpus(corpus) as opened:
        number = channel_number(opened, channel, corpus_name(corpus))
        blocks = channel_blocks(opened, number)
        # facts that tell later readers how the features were made
        read = {"channel": str(opened["channel"].values[number]), **band_attributes(band)}
        # labels are read at once, signals block by block
        described = opened.drop_dims(["channel", "elapsed_time"]).drop_vars(DRAWS, errors="ignore")
        table = described.load().drop_encoding()
        lasts = {"long_name": "duration of the signal that features are computed of", "units": "s"}
        seconds = np.fmin(
            opened.sizes["elapsed_time"] / table["sample_rate"].values, np.inf if window is None else window
        )
        table[DURATION] = "record", seconds, lasts
    treatment = checked_speed(speed, table)
    starts = np.cumsum([0, *(block.sizes["record"] for block in blocks)])
    # with speeds every block is read twice: once to estimate them, once for the features
    report = counter(progress, len(blocks) * (1 if treatment == "off" else 2))
    values, missing = np.empty((table.sizes["record"], len(coordinates["feature"][1]))), 0
    with connected(min(workers, len(blocks)) if scheduler is None else scheduler, __name__) as place:
        # one speed for all windows of a recording, from whatever blocks they are in
        if treatment != "off":
            recording = recording_numbers(table)
            tasks = list(zip(blocks, np.split(recording, starts[1:-1]), strict=True))
            with closing(_counted(block_sums, tasks, place, report)) as sums:
                estimates = recording_speeds(recording, table["shaft_rate"].values, sums)
            table = with_speeds(table, recording, estimates, treatment)
        compute = partial(block_features, groups=tuple(groups), band=band, window=window)
        tasks = list(zip(blocks, np.split(rates_to_use(table), starts[1:-1]), strict=True))
        # blocks come back in order, so that rows are written where they belong
        with closing(_counted(compute, tasks, place, report)) as blocks_of_values:
            for first, rows in zip(starts, blocks_of_values, strict=False):
                values[first : first + len(rows)] = rows
                missing += int(np.isnan(rows).any(axis=1).sum())
    features = ("record", "feature"), values, {"long_name": "features of the signal"}
    read |= {"records_with_missing_features": missing}
    if added := plugin_versions("features", groups):
        read["versions"] = json.dumps(json.loads(table.attrs.get("versions", "{}")) | added)
    return table.assign(features=features).assign_coords(coordinates).assign_attrs(read)


def band_warnings(table: xr.Dataset) -> list[str]:
    """A sentence if the records are sampled too slowly for lines in the band of a feature table, or for the end of a band of its own."""
    band, rate = band_of(table.attrs), float(table["sample_rate"][0])
    needed, hz = f"need {band.lowest_rate:,.0f} Hz", f"{band.low:g}-{band.high:g} Hz"
    if rate >= max(band.lowest_rate, 0 if band == DEFAULT_BAND else 2 * band.high):
        return []
    if rate >= band.lowest_rate:
        return [f"the band {hz} ends above half the sample rate of {rate:,.0f} Hz, where energies are at their floor."]
    return [
        f"no record has lines and shape: in the band {hz} they {needed}, and the sample rate is {rate:,.0f} Hz; give a lower band."
    ]


def block_features(
    task: tuple[xr.Dataset, FloatArray], groups: Sequence[str], band: Band, window: float | None = None
) -> FloatArray:
    """Features of a block of records at their shaft rates [Hz], shape (record, feature); NaN as in `features.table.indicators`."""
    block, shaft_rate = task
    x, fs, orders = accelerations(block), float(block["sample_rate"][0]), orders_of(block)
    windows = x if window is None else windows_of(x, fs, [window])
    # the windows of a record are those of one machine
    record = np.repeat(np.arange(len(x)), len(windows) // len(x))
    nominal = Orders(*(order[record] for order in orders))
    values, _ = indicators(windows, fs, shaft_rate[record], nominal, groups, band)
    return values if len(windows) == len(x) else group_means(values, record)


def _counted(
    compute: Callable[[Item], Result], items: Sequence[Item], workers: Workers, report: Callable[[int], None]
) -> Generator[Result]:
    """Results of all items in their order; ``report`` is called with 1 for each."""
    with closing(run(compute, items, workers)) as results:
        for result in results:
            yield result
            report(1)
