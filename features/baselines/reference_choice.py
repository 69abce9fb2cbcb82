"""Reference of a test: the healthy records that tested records are compared with, and none of which is tested.

``table, reference -> healthy records, without double use -> records to test, healthy records, a sentence``
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from features.baselines.records import feature_rows, record_digests, title_of
from features.baselines.references import SAME_SPEED, by_rig, healthy_records
from features.table.recording_speeds import recording_numbers
from gen.corpus import corpus_name, open_corpus
from gen.support.errors import CorpusError

SAME_BEARING = 0.02  # relative: orders within it are those of one bearing
OTHER_BEARING = "No bearing of the reference has the fault orders of a tested one: check that it is of the same rig."


def choose_reference(
    table: xr.Dataset, reference: xr.Dataset, features: Sequence[str]
) -> tuple[xr.Dataset, xr.Dataset, str]:
    """Choose the records to test and their healthy records, so that no tested record is part of the reference.

    If both tables hold the same records, the first healthy recording of each rig is the reference, and rigs without one are not tested.

    Parameters
    ----------
    table, reference
        Feature tables; order of their records has no effect on the choice.
    features
        Names of the features that identify a record.

    Returns
    -------
    Records to test, their healthy records, and a sentence for people: which records are compared with which.

    Raises
    ------
    CorpusError
        If the reference has no healthy record, or no tested record is left.
    """
    healthy, tested = healthy_records(reference), np.ones(table.sizes["record"], dtype=bool)
    mine = record_digests(feature_rows(table, features).to_numpy())
    # the same records are tested and reference: one recording of each rig has to be the reference
    if np.array_equal(np.sort(mine), np.sort(record_digests(feature_rows(reference, features).to_numpy()))):
        healthy = _first_recordings(healthy)
        tested = np.isin(table["rig"].values, healthy["rig"].values)
    # a record is never compared with itself
    tested &= ~np.isin(mine, record_digests(feature_rows(healthy, features).to_numpy()))
    if not tested.any():
        raise CorpusError(
            f"{title_of(reference)}: every tested record belongs to the reference; give another recording as reference."
        )
    chosen = table.isel(record=tested)
    return chosen, healthy, _sentence(chosen, healthy, int((~tested).sum()))


def _sentence(table: xr.Dataset, reference: xr.Dataset, left_out: int) -> str:
    count = reference.sizes["record"]
    whose = "the healthy records of their rig" if by_rig(table, reference) else "all healthy records"
    left = f"; {left_out:,} tested records that belong to it are left out" if left_out else ""
    apart = _apart_in_speed(table, reference)
    speed = f", those nearest in speed, which are up to {100 * apart:.0f} % away" if apart > SAME_SPEED else ""
    other = "" if _share_a_bearing(table, reference) else f" {OTHER_BEARING}"
    return f"Records are compared with {whose} in the reference, which has {count:,}{speed}{left}.{other}"


def _apart_in_speed(table: xr.Dataset, reference: xr.Dataset) -> float:
    """Largest relative distance of a tested speed from the nearest one of the reference; 0 if a table has no known speeds."""
    if "shaft_rate" not in table or "shaft_rate" not in reference:
        return 0.0
    tested, its = (
        np.unique(speeds_of["shaft_rate"].values[speeds_of["shaft_rate"].values > 0])
        for speeds_of in (table, reference)
    )
    return float(np.abs(its / tested[:, None] - 1).min(axis=1).max()) if tested.size and its.size else 0.0


def _share_a_bearing(table: xr.Dataset, reference: xr.Dataset) -> bool:
    """Whether some bearing of the reference has the outer race order of a tested one; true if a table has no orders."""
    if "bpfo" not in table or "bpfo" not in reference:
        return True
    tested, its = np.unique(table["bpfo"].values), np.unique(reference["bpfo"].values)
    return bool(np.isclose(tested[:, None], its, rtol=SAME_BEARING).any())


def _first_recordings(healthy: xr.Dataset) -> xr.Dataset:
    """The records of the recording with the lowest number of each rig."""
    rig, number = healthy["rig"].values, recording_numbers(healthy)
    first = [number[rig == each].min() for each in np.unique(rig)]
    return healthy.isel(record=np.isin(number, first))


def check_durations(corpus: Path | str | xr.Dataset, reference: Path | str | xr.Dataset) -> None:
    """Refuse a reference corpus with records of another duration: lines rise higher above the floor in longer records.

    Raises
    ------
    CorpusError
        If the durations differ by more than 1 %, or a corpus cannot be read.
    """
    with open_corpus(corpus) as opened, open_corpus(reference) as other:
        tested, its = _duration(opened), _duration(other)
    if abs(its - tested) > 0.01 * tested:
        raise CorpusError(
            f"{corpus_name(reference)}: the records of the reference last {its:g} s and those of {corpus_name(corpus)} {tested:g} s; "
            "import the reference with records of the same duration."
        )


def _duration(opened: xr.Dataset) -> float:
    """Duration of the records of an open corpus [s]."""
    return opened.sizes["elapsed_time"] / float(opened["sample_rate"].max())
