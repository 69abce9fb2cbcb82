"""Records that are tested against a reference, without those that belong to it.

``table, reference -> healthy records, without double use -> Compared``
"""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from features.baselines.records import feature_rows, record_digests, recording_numbers, title_of
from features.baselines.references import by_rig, healthy_records
from gen.corpus import open_corpus
from gen.errors import CorpusError


class Compared(NamedTuple):
    """Records to test, the healthy records of their reference, and the number of records that are left out."""

    table: xr.Dataset
    reference: xr.Dataset
    left_out: int

    @property
    def sentence(self) -> str:
        """What is compared with what, for people."""
        count = self.reference.sizes["record"]
        whose = "the healthy records of their rig" if by_rig(self.table, self.reference) else "all healthy records"
        left = f"; {self.left_out:,} tested records that belong to it are left out" if self.left_out else ""
        return f"Records are compared with {whose} in the reference, which has {count:,}{left}."


def compared(table: xr.Dataset, reference: xr.Dataset, features: Sequence[str]) -> Compared:
    """Choose the records to test and their healthy records, so that no tested record is part of the reference.

    If both tables hold the same records, the first healthy recording of each rig is the reference, and rigs without one are not tested.

    Parameters
    ----------
    table, reference
        Feature tables; order of their records has no effect on the choice.
    features
        Names of the features that identify a record.

    Raises
    ------
    CorpusError
        If the reference has no healthy record, or no tested record is left.
    """
    healthy, tested = healthy_records(reference), np.ones(table.sizes["record"], dtype=bool)
    mine = record_digests(feature_rows(table, features).to_numpy())
    if np.array_equal(np.sort(mine), np.sort(record_digests(feature_rows(reference, features).to_numpy()))):
        healthy = _first_recordings(healthy)
        tested = np.isin(table["rig"].values, healthy["rig"].values)
    shared = np.isin(mine, record_digests(feature_rows(healthy, features).to_numpy()))
    tested &= ~shared
    if not tested.any():
        message = (
            f"{title_of(reference)}: every tested record belongs to the reference; give another recording as reference."
        )
        raise CorpusError(message)
    return Compared(table.isel(record=tested), healthy, int((~tested).sum()))


def _first_recordings(healthy: xr.Dataset) -> xr.Dataset:
    """The records of the recording with the lowest number of each rig."""
    rig, number = healthy["rig"].values, recording_numbers(healthy)
    first = [number[rig == each].min() for each in np.unique(rig)]
    return healthy.isel(record=np.isin(number, first))


def check_durations(corpus: Path | str, reference: Path | str) -> None:
    """Refuse a reference corpus with records of another duration: lines rise higher above the floor in longer records.

    Raises
    ------
    CorpusError
        If the durations differ by more than 1 %, or a corpus cannot be read.
    """
    tested, its = (_duration(folder) for folder in (corpus, reference))
    if abs(its - tested) > 0.01 * tested:
        message = (
            f"{reference}: the records of the reference last {its:g} s and those of {corpus} {tested:g} s; "
            "import the reference with records of the same duration."
        )
        raise CorpusError(message)


def _duration(corpus: Path | str) -> float:
    """Duration of the records of a corpus [s]."""
    with open_corpus(corpus) as opened:
        return opened.sizes["elapsed_time"] / float(opened["sample_rate"].max())
