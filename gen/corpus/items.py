"""Records of a corpus one by one or in batches, as the data loaders of training frameworks take them.

The object has ``__len__``, ``__getitem__`` and ``__getitems__``, the protocol of a map-style dataset of PyTorch; it needs no PyTorch.
It holds paths and no file handles: it can be pickled, and every process opens the parts for itself.
"""

import operator
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.choice import channel_names, chosen_channels, chosen_records, operating_variables, per_record
from gen.corpus.index import corpus_name, open_corpus
from gen.corpus.manifest import Check
from gen.corpus.schema import SIGNAL, class_names
from gen.corpus.where import nearest
from gen.support.display import Shown
from gen.support.errors import CorpusError

Transform = Callable[[NDArray[np.float32]], Any]
Item = tuple[Any, Any]
"""Signal, shape (channel, elapsed_time) [m s-2], or what the transform makes of it; and the label."""


@dataclass(frozen=True, eq=False, repr=False)
class LabelledRecords(Shown):
    """Records of a corpus, each with one label; made by :func:`torch_dataset`."""

    records: NDArray[np.intp]
    """Numbers of the records in the corpus, shape (item,)."""
    labels: NDArray[Any]
    """Label of each record, shape (item,): codes of a class, other integers, numbers in single precision, or texts."""
    operating: Mapping[str, NDArray[Any]]
    """What an analyst on site knows of the records: sample rate, shaft rate, nominal orders and more, each of shape (item,)."""
    names: Mapping[int, str]
    """Names of the codes of a class; empty for other labels."""
    channels: tuple[str, ...]
    """Names of the channels."""
    transform: Transform | None
    """Called with the signal of each record."""
    signal: xr.Variable
    """Signal of the whole corpus, unread."""
    channel_places: tuple[int, ...]
    """Places of the channels in the corpus."""

    def _heading(self) -> str:
        return f"{len(self):,} records of {self.signal.shape[-1]:,} samples, {', '.join(self.channels)}"

    def _facts(self) -> Mapping[str, object]:
        codes, counts = np.unique(self.labels, return_counts=True)
        classes = [f"{self.names[code]} {count:,}" for code, count in zip(codes, counts, strict=True) if self.names]
        return {
            "labels": ", ".join(classes) or f"{self.labels.dtype}, {codes[0]} to {codes[-1]}",
            "operating": ", ".join(self.operating),
            "next": "DataLoader(records, batch_size=64, shuffle=True), or records.batches(64, seed=0)",
        }

    def __len__(self) -> int:
        """Count the records."""
        return len(self.records)

    def __getitem__(self, item: int) -> Item:
        """Read one record: its signal in single precision, and its label."""
        place = operator.index(item)
        if not -len(self) <= place < len(self):
            raise IndexError(f"record {place} is not one of {len(self)}.")
        return self._item(self._read(int(self.records[place])), place)

    def __getitems__(self, items: Sequence[int] | NDArray[np.intp]) -> list[Item]:
        """Read several records at once, which takes half the time of one by one; PyTorch calls it for a batch."""
        rows, row_of_item = np.unique(self.records[np.asarray(items, np.intp)], return_inverse=True)
        signals = self._read(rows)
        return [self._item(signals[row], place) for row, place in zip(row_of_item, items, strict=True)]

    def batches(self, size: int, *, seed: int | None = None) -> Iterator[tuple[NDArray[Any], NDArray[Any]]]:
        """Every record once, in batches for a training loop without a data loader.

        Parameters
        ----------
        size : int
            Records of a batch; the last one may have fewer.
        seed : int, optional
            Shuffles the records; without it they come in the order of the corpus.

        Yields
        ------
        signals, labels : array
            Shapes (record, channel, elapsed_time) [m s-2] and (record,).
        """
        if size < 1:
            raise ValueError(f"size: {size} is no number of records; give 1 or more.")
        order = np.arange(len(self)) if seed is None else np.random.default_rng(seed).permutation(len(self))
        for start in range(0, len(order), size):
            places = order[start : start + size].astype(np.intp)
            yield np.stack([signal for signal, _ in self.__getitems__(places)]), self.labels[places]

    def _read(self, rows: int | NDArray[np.intp]) -> NDArray[np.float32]:
        """Signals of records of the corpus, shape ([record,] channel, elapsed_time) [m s-2]."""
        whole = len(self.channels) == self.signal.shape[1]
        chosen = self.signal[rows] if whole else self.signal[rows, list(self.channel_places)]
        return chosen.values.astype(np.float32, copy=False)

    def _item(self, signal: NDArray[np.float32], place: int) -> Item:
        """Item of a signal that was read."""
        label = self.labels[place]
        return (
            signal if self.transform is None else self.transform(signal),
            label if label.dtype == np.float32 else label.item(),
        )


def torch_dataset(
    corpus: Path | str | xr.Dataset,
    *,
    split: str | None = None,
    where: str | None = None,
    channels: Sequence[str] | None = None,
    label: str = "fault",
    transform: Transform | None = None,
    check: Check = "sha256",
) -> LabelledRecords:
    """Records of a corpus for the data loader of a training framework; nothing of the signals is read yet.

    ``DataLoader(gen.torch_dataset(corpus, split="train"), batch_size=64, shuffle=True, num_workers=4)`` works as it is. Each item is a
    pair: the signal in single precision, shape (channel, elapsed_time) [m s-2], and the label.

    Parameters
    ----------
    corpus : path or Dataset
        Folder of a corpus, a corpus in one file, or one that has been opened.
    split : {"train", "validation", "test"}, optional
        Name of a split.
    where : str, optional
        A condition, such as ``fault != 'unknown' and shaft_rpm > 1200``; :mod:`gen.corpus.where` has the rules.
    channels : sequence of str, optional
        Names of channels; all without.
    label : str
        Per-record variable that is the label. A class such as ``fault`` gives its code (``names`` has the names), another integer itself,
        a number a ``numpy.float32``, a text a ``str``.
    transform : callable, optional
        Called with the signal of each record, in the process that reads it. To be sent to spawned processes it must be a function of a
        module.
    check : {"sha256", "size"}
        Comparison of each file with the manifest, as for :func:`gen.open_corpus`.

    Raises
    ------
    CorpusError
        If the corpus cannot be opened, no record is chosen, or there is no such split, channel or label.
    """
    opened = open_corpus(corpus, check)
    names_of_channels = channel_names(opened)
    places = chosen_channels(names_of_channels, channels)
    numbers, names = _labels(opened, label, corpus_name(corpus))
    (records,) = chosen_records([opened], where, split)
    chosen = tuple(names_of_channels[place] for place in places)
    # labels are read now, signals when they are asked for
    operating = {name: values[records] for name, values in operating_variables(opened).items()}
    return LabelledRecords(
        records, numbers[records], operating, names, chosen, transform, opened[SIGNAL].variable, places
    )


def _labels(opened: xr.Dataset, label: str, corpus: str) -> tuple[NDArray[Any], Mapping[int, str]]:
    """Values of a per-record variable, and the names of its codes if it is a class."""
    variables = per_record(opened)
    if label not in variables:
        raise CorpusError(f"{corpus}: label: there is no variable {label}{nearest(label, variables)}")
    variable = opened[label]
    values = variable.values
    if values.dtype.kind not in "iuf":
        return values.astype(str), {}
    return (values.astype(np.float32), {}) if values.dtype.kind == "f" else (values, class_names(variable.attrs))
