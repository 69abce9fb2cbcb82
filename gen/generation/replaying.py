"""Records of a corpus simulated again from the scenarios that it stores with them.

A stored scenario is complete, so it does not matter in which corpus its record lies.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import SIGNAL, open_corpus
from gen.corpus.numbering import NUMBERS
from gen.generation.make_part import decoded, labelled
from gen.generation.undetected import made_from
from gen.scenarios import Scenario, read_scenarios
from gen.support.errors import CorpusError


@dataclass(frozen=True)
class Replayed:
    """A record that was simulated again."""

    dataset: xr.Dataset
    """The new record, one row, with the channels and numbers of the corpus (undecoded)."""
    identical: bool
    """Whether its samples equal those of the stored record, bit for bit."""


def replay(path: Path | str, record: int) -> Replayed:
    """Simulate one record of a corpus again, and compare it with the stored record.

    ``record`` is the number of the record in the corpus, from 0. A channel that was renamed is known by its samples.

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
        names = [str(name) for name in corpus["channel"].values]
        numbers = {name: row[name].values for name in NUMBERS if name in corpus}
    # from the stored recipe alone, whatever corpus it lies in
    again = labelled(scenario.recipe, made_from([scenario]))
    (signal,) = decoded([again])[SIGNAL].values
    # a copy may have other channels, in another order and under other names
    places = [_place(channel, name, signal, scenario) for channel, name in zip(stored, names, strict=True)]
    dataset = again.isel(channel=places).assign_coords(channel=again["channel"][places].copy(data=names))
    # a copy has numbers of its own
    dataset = dataset.assign({name: again[name].copy(data=values) for name, values in numbers.items()})
    return Replayed(dataset, np.array_equal(signal[places], stored))


def _place(stored: NDArray[np.floating], name: str, again: NDArray[np.floating], scenario: Scenario) -> int:
    """Place of a stored channel among those simulated again: the one with its samples, or else with its name, or else the first."""
    names = [channel.name for channel in scenario.recipe.recording.channels]
    places = sorted(range(len(names)), key=lambda place: names[place] != name)
    return next((place for place in places if np.array_equal(again[place], stored)), places[0])
