"""The channel or channels of a corpus that features are computed from, by name or number."""

import difflib
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from features.signal.lines import Orders
from gen.corpus import SIGNAL, blocks_of
from gen.support.errors import CorpusError


def channel_number(corpus: xr.Dataset, channel: int | str, where: Path | str) -> int:
    """Number of a channel that is given by its name or its number; ``where`` is the corpus in the error.

    Raises
    ------
    CorpusError
        If the corpus has no such channel.
    """
    names = [str(name) for name in corpus["channel"].values]
    if channel in names:
        return names.index(str(channel))
    if isinstance(channel, int) and 0 <= channel < len(names):
        return channel
    near = difflib.get_close_matches(str(channel), names, n=1)
    by_number = "" if isinstance(channel, str) else ", or its number from 0"
    meant = f"; did you mean {near[0]}?" if near else "."
    raise CorpusError(f"{where}: no channel {channel!r}; give one of {', '.join(names)}{by_number}{meant}")


def channel_blocks(corpus: xr.Dataset, channel: int) -> list[xr.Dataset]:
    """Records in blocks that fit the memory of a task: the signal of one channel, rates and nominal orders, all unread."""
    names = ("sample_rate", "shaft_rate", *Orders._fields)
    columns = {SIGNAL: corpus[SIGNAL].variable[:, channel]} | {name: corpus[name].variable for name in names}
    chosen = xr.Dataset(columns)
    return [chosen.isel(record=block) for block in blocks_of(chosen)]


def accelerations(block: xr.Dataset) -> NDArray[np.float32]:
    """Signal of a block in single precision, shape (record, elapsed_time) [m s-2]; a missing sample is NaN."""
    return block[SIGNAL].values.astype(np.float32, copy=False)


def orders_of(block: xr.Dataset) -> Orders:
    """Nominal fault orders of the records of a block."""
    return Orders(*(block[name].values for name in Orders._fields))


def channels_of(table: xr.Dataset) -> list[xr.Dataset]:
    """Feature tables of the single channels of a feature table."""
    if "channel" not in table["features"].dims:
        return [table]
    return [table.isel(channel=number) for number in range(table.sizes["channel"])]


def joined_channels(tables: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """Feature table of several channels of the same records, by name; all but the features are those of the first."""
    first = next(iter(tables.values()))
    features = xr.concat([table["features"] for table in tables.values()], xr.Variable("channel", [*tables]))
    missing = int(features.isnull().any(["channel", "feature"]).sum())
    return first.assign(features=features).assign_attrs(
        channel=", ".join(tables), records_with_missing_features=missing
    )
