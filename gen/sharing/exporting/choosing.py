"""The records of a corpus that are exported, read in blocks, with the names of their columns.

Names and texts of a corpus can come from strangers. So names of columns and files are made here, from letters, digits and underscores.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import DRAWS, SCHEMA, SIGNAL, class_names
from gen.corpus.index import OF_ONE_FILE
from gen.corpus.record_hashes import stored_signal
from gen.sharing.choice import chosen_channels, chosen_records

_LONGEST_NAME = 60  # letters; MATLAB allows 63
_MOST_IN_BLOCK = 1024  # records; drawn values are text of some kilobytes a record
_OF_THE_WHOLE = ("summary", "id", "naming_authority")  # global attributes that a choice of records does not have
_RESERVED = ("record", "file", "place", "units", "channels")


class Column(NamedTuple):
    """One exported per-record variable: its column, its variable in the corpus, and its description."""

    name: str
    variable: str
    dtype: np.dtype[Any] | None
    """None for text."""
    units: str
    role: str
    meaning: str
    flags: Mapping[int, str]
    """Names of the values of a class variable by their codes; empty otherwise."""


class Block(NamedTuple):
    """Some exported records in memory."""

    first: int
    """Place of the first one among the exported records."""
    numbers: NDArray[np.intp]
    """Numbers of the records in the corpus."""
    dataset: xr.Dataset

    def accelerations(self) -> NDArray[np.float32]:
        """Signal, shape (record, channel, elapsed_time) [m s-2]; a missing sample is NaN."""
        return np.asarray(self.dataset[SIGNAL].values, np.float32)

    def counts(self) -> NDArray[Any]:
        """Stored counts, shape (record, channel, elapsed_time), or accelerations [m s-2] if the corpus holds floating point."""
        return stored_signal(self.dataset[SIGNAL].variable)[0]

    def values(self, column: Column) -> NDArray[Any]:
        """Values of a column; the names of its classes if it is a class variable."""
        values = self.dataset[column.variable].values
        if not column.flags:
            return values
        return np.array([column.flags.get(int(code), str(code)) for code in values], object)


@dataclass(frozen=True)
class Chosen:
    """Records and channels of an opened corpus."""

    corpus: xr.Dataset
    records: NDArray[np.intp]
    channels: tuple[int, ...]

    @property
    def samples(self) -> int:
        """Samples of a record and channel."""
        return self.corpus.sizes["elapsed_time"]

    @cached_property
    def sample_rate(self) -> float:
        """Sample rate [Hz]."""
        return float(self.corpus["sample_rate"].variable[:1].values[0])

    @property
    def scale(self) -> float | None:
        """Factor from stored counts to m s-2; None if the corpus holds floating point."""
        encoding = self.corpus[SIGNAL].encoding
        return float(encoding["scale_factor"]) if np.dtype(encoding["dtype"]).kind == "i" else None

    @cached_property
    def channel_texts(self) -> list[str]:
        """Names of the channels as the corpus has them."""
        return [str(self.corpus["channel"].values[place]) for place in self.channels]

    @cached_property
    def channel_names(self) -> list[str]:
        """Names of the channels for columns."""
        return plain_names(self.channel_texts)

    @cached_property
    def columns(self) -> list[Column]:
        """Columns of the per-record variables: those of every corpus first, drawn values last."""
        schema = [variable.name for variable in SCHEMA]
        found = [str(name) for name, variable in self.corpus.variables.items() if variable.dims == ("record",)]
        further = [name for name in found if name not in schema and name != DRAWS]
        ordered = [*schema, *further, *(name for name in found if name == DRAWS)]
        names = plain_names(ordered, _RESERVED)
        return [_column(self.corpus, *pair) for pair in zip(names, ordered, strict=True)]

    def blocks(
        self, most_bytes: int, records: NDArray[np.intp] | None = None, *, multiple_of: int = 1
    ) -> Iterator[Block]:
        """Blocks of consecutive chosen records, each with at most so many bytes of single precision, but one record at least.

        ``records`` are some of the chosen records instead of all; the size of a block is a multiple of ``multiple_of``.
        """
        records = self.records if records is None else records
        size = max(1, self.records_in(most_bytes) // multiple_of) * multiple_of
        for first in range(0, len(records), size):
            numbers = records[first : first + size]
            yield Block(first, numbers, self._loaded(numbers))

    def records_in(self, most_bytes: int) -> int:
        """Records whose signals fill so many bytes in single precision; at least 1, and not more than a block may have."""
        each = 4 * len(self.channels) * self.samples
        return int(np.clip(most_bytes // each, 1, _MOST_IN_BLOCK))

    def _loaded(self, numbers: NDArray[np.intp]) -> xr.Dataset:
        run = numbers[-1] - numbers[0] + 1 == len(numbers)
        wanted: Any = slice(int(numbers[0]), int(numbers[-1]) + 1) if run else numbers
        chosen = self.corpus.isel(record=wanted)
        if len(self.channels) < self.corpus.sizes["channel"]:
            chosen = chosen.isel(channel=list(self.channels))
        return chosen.load()


def choose(
    corpus: xr.Dataset, where: str | None = None, split: str | None = None, channels: Sequence[str] | None = None
) -> Chosen:
    """Records and channels of an opened corpus; CorpusError if there are none such."""
    found = Chosen(corpus, chosen_records(corpus, where, split), chosen_channels(corpus, channels))
    whole = len(found.records) == corpus.sizes["record"] and len(found.channels) == corpus.sizes["channel"]
    left_out = OF_ONE_FILE if whole else (*OF_ONE_FILE, *_OF_THE_WHOLE)
    own = {name: value for name, value in corpus.attrs.items() if name not in left_out}
    return replace(found, corpus=corpus.drop_attrs(deep=False).assign_attrs(own))


def plain_names(names: Iterable[str], taken: Iterable[str] = ()) -> list[str]:
    """Names of letters, digits and underscores that begin with a letter, all different, also without regard to capital letters.

    >>> plain_names(["width", "../x y", "=1", "Width"], taken=["record"])
    ['width', 'x_y', 'x1', 'Width_2']
    """
    used, found = {name.lower() for name in taken}, []
    for name in names:
        plain = re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")[:_LONGEST_NAME]
        plain = plain if plain[:1].isalpha() else f"x{plain}"
        number, tried = 1, plain
        while tried.lower() in used:
            number += 1
            tried = f"{plain[: _LONGEST_NAME - 8]}_{number}"
        used.add(tried.lower())
        found.append(tried)
    return found


def _column(corpus: xr.Dataset, name: str, variable: str) -> Column:
    found = corpus[variable].variable
    units, role, meaning = (str(found.attrs.get(key, "")) for key in ("units", "role", "long_name"))
    dtype = None if found.dtype.kind in "OUS" or found.dtype.kind == "T" else found.dtype
    return Column(name, variable, dtype, units, role, meaning, class_names(found.attrs))
