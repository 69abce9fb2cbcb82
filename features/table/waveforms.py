"""Waveforms of a corpus as an array that is read when it is indexed, for classifiers that learn from signals.

``corpus -> open_waveforms -> X of shape (record, time) -> cross_validate(X, estimator)``

`Waveforms` behaves like a NumPy array of single precision where scikit-learn needs one, and reads only the records that
are indexed. So an estimator that takes slices needs no more memory for a larger corpus.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import DTypeLike, NDArray

from features.signal.orders import resample_to_orders
from features.table.channels import channel_number
from gen.corpus import DRAWS, SIGNAL, corpus_name, open_corpus, operating_variables
from gen.support.errors import CorpusError

BLOCK = 256  # records that are decoded at a time


@dataclass(frozen=True, eq=False)
class Waveforms:
    """Signals of one channel, shape (record, time), in single precision; every indexing reads them anew.

    ``X[start:stop]``, ``X[numbers]`` and ``X[mask]`` are arrays (record, time), ``X[number]`` is one record, shape
    (time,). ``np.asarray(X)`` reads all. ``X.take(numbers)`` chooses records and reads nothing.

    Attributes
    ----------
    labels
        All per-record variables of the corpus, for the records of ``rows``, with the shaft rates that are used.
    signal
        The stored signal, shape (record, time), unread.
    rows
        Numbers of the chosen records in the corpus, shape (record,).
    normalise
        Whether the mean of each record is subtracted, and the result divided by its rms.
    per_turn, samples
        Samples per turn of the shaft, or None for samples at equal times; and number of samples of each record.
    """

    labels: xr.Dataset
    signal: xr.DataArray
    rows: NDArray[np.intp]
    normalise: bool
    per_turn: int | None
    samples: int

    ndim = 2
    dtype = np.dtype(np.float32)

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of records and of samples."""
        return len(self.rows), self.samples

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[NDArray[np.float32]]:
        for start in range(0, len(self), BLOCK):
            yield from self[start : start + BLOCK]

    @property
    def operating(self) -> dict[str, NDArray[Any]]:
        """What an analyst on site knows of the records: sample rate, shaft rate, nominal orders and more, each of shape (record,)."""
        return operating_variables(self.labels)

    def take(self, rows: Any) -> Waveforms:
        """Choose some of these records by number; nothing is read."""
        rows = np.asarray(rows)
        return replace(self, rows=self.rows[rows], labels=self.labels.isel(record=rows))

    def __getitem__(self, key: Any) -> NDArray[np.float32]:
        chosen = self.rows[key]
        if chosen.ndim == 0:
            return self._read(chosen[None])[0]
        values = np.empty((len(chosen), self.samples), np.float32)
        for start in range(0, len(chosen), BLOCK):
            values[start : start + BLOCK] = self._read(chosen[start : start + BLOCK])
        return values

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        return self[:].astype(dtype or np.float32, copy=False)

    def _read(self, rows: NDArray[np.intp]) -> NDArray[np.float32]:
        """Signals of some records of the corpus; samples that are not finite become 0."""
        stored = self.signal[rows]
        # classifiers refuse NaN, and a gap of zeros is as if nothing vibrated
        x = np.nan_to_num(stored.values.astype(np.float32, copy=False), nan=0.0, posinf=0.0, neginf=0.0)
        if self.per_turn is not None:
            fs, shaft_rate = stored["sample_rate"].values, stored["shaft_rate"].values
            x = resample_to_orders(x, fs, shaft_rate, self.per_turn, self.samples)
        if self.normalise:
            x -= x.mean(axis=1, keepdims=True)
            rms = np.sqrt(np.mean(np.square(x), axis=1, keepdims=True))
            x /= np.where(rms > 0, rms, 1)
        return x


def open_waveforms(
    corpus: Path | str | xr.Dataset,
    *,
    channel: int | str = 0,
    normalise: bool = False,
    shaft_rate: NDArray[np.floating] | None = None,
    per_turn: int | None = None,
    turns: int | None = None,
) -> Waveforms:
    """Waveforms of every record of a corpus, unread.

    Parameters
    ----------
    corpus
        Folder or file of the corpus, or records in memory.
    channel
        Name of the channel, or its number from 0.
    normalise
        Subtract the mean of each record and divide the result by its rms, so that the gain of the sensor has no effect.
    shaft_rate
        Shaft rates that replace the labelled ones, shape (record,) [Hz].
    per_turn
        Resample to so many samples per turn of the shaft. See `features.signal.orders`.
    turns
        Number of turns of a resampled record; a shorter record ends in zeros. By default as many whole turns as the
        slowest record has.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, altered or has no such channel, or the shaft rate of a record is not known.
    """
    opened = open_corpus(corpus)
    where = corpus_name(corpus)
    number = channel_number(opened, channel, where)
    # signals stay in the corpus until they are indexed
    labels = opened.drop_dims(["channel", "elapsed_time"]).drop_vars(DRAWS, errors="ignore").load()
    # speeds known better than the labels, such as estimated ones
    if shaft_rate is not None:
        labels = labels.assign(shaft_rate=labels["shaft_rate"].copy(data=shaft_rate))
    signal = opened[SIGNAL].isel(channel=number).drop_vars(["elapsed_time"])
    signal = signal.assign_coords({name: labels[name].variable for name in ("sample_rate", "shaft_rate")})
    samples = opened.sizes["elapsed_time"]
    if per_turn is not None:
        samples = _samples_in_turns(where, labels, samples, per_turn, turns)
    return Waveforms(labels, signal, np.arange(opened.sizes["record"]), normalise, per_turn, samples)


def _samples_in_turns(where: str, labels: xr.Dataset, samples: int, per_turn: int, turns: int | None) -> int:
    """Number of samples of a resampled record; the stored ones have ``samples``."""
    shaft_rate, fs = labels["shaft_rate"].values, labels["sample_rate"].values
    unknown = np.flatnonzero(~(shaft_rate > 0))
    if len(unknown):
        raise CorpusError(f"{where}: record {unknown[0]} has no shaft rate; leave out per_turn.")
    turns = int((shaft_rate * samples / fs).min() + 1e-9) if turns is None else turns  # rates are rounded
    if per_turn < 1 or turns < 1:
        raise CorpusError(
            f"{where}: {turns} turns of {per_turn} samples are no signal; give turns and per_turn above 0."
        )
    return turns * per_turn
