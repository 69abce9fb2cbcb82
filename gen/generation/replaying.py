"""Records of a corpus simulated again from the scenarios that it stores with them.

A stored scenario is complete, so it does not matter in which corpus its record lies.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from gen.corpus import SIGNAL, open_corpus
from gen.generation.make_part import decoded, labelled
from gen.generation.undetected import made_from
from gen.scenarios import read_scenarios
from gen.support.errors import CorpusError


@dataclass(frozen=True)
class Replayed:
    """A record that was simulated again."""

    dataset: xr.Dataset
    """The new record, one row, with the channels and numbers that its scenario has (undecoded)."""
    identical: bool
    """Whether every stored channel has the samples of one of its channels, bit for bit."""


def replay(path: Path | str, record: int) -> Replayed:
    """Simulate one record of a corpus again, and compare it with the stored record.

    ``record`` is the number of the record in the corpus, from 0. Of the result, ``identical`` tells whether all samples agree.

    Raises
    ------
    CorpusError
        If the corpus has no such record, or stores no scenario of it.
    """
    with open_corpus(path, check="size") as corpus:
        records = corpus.sizes["record"]
        if not 0 <= record < records:
            raise CorpusError(f"{path}: record {record} is not in it; it has records 0 to {records - 1}.")
        row = corpus.isel(record=[record])
        try:
            (scenario,) = read_scenarios(row)
        except CorpusError as error:
            raise CorpusError(f"{path}: record {record}{str(error).removeprefix('record 0')}") from None
        stored = row[SIGNAL].values[0]
    # from the stored recipe alone, whatever corpus it lies in
    again = labelled(scenario.recipe, made_from([scenario]))
    (signal,) = decoded([again])[SIGNAL].values
    # a copy may have fewer channels, in another order and under other names
    return Replayed(again, all(any(np.array_equal(channel, other) for other in signal) for channel in stored))
