"""Features of records relative to healthy records of the same rig.

``feature table, healthy records -> mean of these -> features, and their change from that mean``

A machine has lines and a colour of its own, and a fault changes them. So a classifier is given the features of a record, how far they are
from those of healthy records of the rig, and how far the energies in bands of frequency are from theirs. The change that all bands have in
common is taken away, so that gain has no effect. In training, a healthy recording of a simulated rig is the reference of its other records.
"""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from features.baselines.colour_distance import COUNTED, ENERGIES, Colour, scatter_of
from features.baselines.records import (
    HEALTHY_CODE,
    FloatArray,
    IntArray,
    feature_rows,
    record_digests,
    title_of,
)
from features.signal.rows import group_means, mean_row
from features.table.band import band_of
from features.table.channels import channels_of
from features.table.recording_speeds import recording_numbers
from gen.corpus import UNKNOWN_CODE
from gen.support.errors import CorpusError

RELATIVE = "relative"  # group of the features of a relative table
SAME_SPEED = 0.02  # relative: speeds within it are one speed, as in the search for lines
NEAREST = 3  # recordings, nearest in speed, that a virtual reference is chosen from


def with_energies(groups: Sequence[str]) -> tuple[str, ...]:
    """Groups of features that records and references need for a model of some groups."""
    return tuple(dict.fromkeys((*groups, "bands")))


def relative_names(features: Sequence[str]) -> tuple[str, ...]:
    """Names of the features of a record relative to a reference.

    >>> relative_names(["raw_kurtosis"])[:3]
    ('raw_kurtosis', 'raw_kurtosis_change', 'energy_20-100_Hz_change')
    """
    return (*features, *(f"{name}_change" for name in _compared(features)))


def _compared(features: Sequence[str]) -> tuple[str, ...]:
    """Features whose changes are told: the energies come last and once, also if they are among the features."""
    return (*(name for name in features if name not in ENERGIES), *ENERGIES)


def relative_table(table: xr.Dataset, features: Sequence[str], references: FloatArray) -> xr.Dataset:
    """Feature table of some features, and of their changes and those of the energies, in the group ``RELATIVE``.

    Parameters
    ----------
    table
        Feature table with the groups of these features, and ``bands``.
    features
        Names of features.
    references
        Values of the reference of each record, shape (record, feature): of ``features`` that are no energies, then of ``ENERGIES``.

    Raises
    ------
    CorpusError
        If the table has no records, or lacks a feature.
    """
    values = feature_rows(table, features).to_numpy()
    differences = feature_rows(table, _compared(features)).to_numpy() - references
    changes, energies = np.split(differences, [-len(ENERGIES)], axis=1)
    if energies.size:
        energies = energies - np.median(energies, axis=1, keepdims=True)
    columns = np.concatenate([values, changes, energies], axis=1)
    names = np.array(relative_names(features), dtype=object)
    groups = np.full(len(names), RELATIVE, dtype=object)
    return (
        table.drop_dims("feature")
        .assign(features=(("record", "feature"), columns))
        .assign_coords(feature=("feature", names), group=("feature", groups))
    )


def relative_to(table: xr.Dataset, reference: xr.Dataset, features: Sequence[str]) -> xr.Dataset:
    """`relative_table` of records whose reference is the mean of the healthy records of a reference table that are nearest in speed.

    If the reference has healthy records of each rig of the table, a record is compared with those of its rig, else with all of them.

    Raises
    ------
    CorpusError
        If a table lacks a feature, the reference has no healthy record, or their sample rates cannot be compared.
    """
    healthy, number, members = _healthy_of(table, reference)
    number, members = _nearest_in_speed(table, healthy, number, members)
    values = feature_rows(healthy, _compared(features)).to_numpy()
    return relative_table(table, features, np.stack([mean_row(values[rows]) for rows in members])[number])


def colour_of(table: xr.Dataset, reference: xr.Dataset) -> Colour:
    """Change of the colour of records from the references of `relative_to`.

    Raises
    ------
    CorpusError
        As `relative_to`.
    """
    healthy, number, members = _healthy_of(table, reference)
    energies, recording = feature_rows(healthy, COUNTED).to_numpy(), recording_numbers(healthy)
    of_recordings = [group_means(energies[rows], recording[rows]) for rows in members]
    near, nearest = _nearest_in_speed(table, healthy, number, members)
    references = np.stack([mean_row(energies[rows]) for rows in nearest])
    changes = feature_rows(table, COUNTED).to_numpy() - references[near]
    return Colour(
        changes[None], np.array([scatter_of(energies_of_set) for energies_of_set in of_recordings])[None, number]
    )


def _healthy_of(table: xr.Dataset, reference: xr.Dataset) -> tuple[xr.Dataset, IntArray, list[NDArray[np.bool_]]]:
    """Healthy records of a reference, number of the set of them that each record is compared with, and the members of each set."""
    healthy = healthy_records(reference)
    check_rates(table, healthy)
    if not by_rig(table, healthy):
        return healthy, np.zeros(table.sizes["record"], np.intp), [np.ones(healthy.sizes["record"], np.bool_)]
    rigs, number = np.unique(table["rig"].values, return_inverse=True)
    return healthy, number, [healthy["rig"].values == rig for rig in rigs]


def _nearest_in_speed(
    table: xr.Dataset, healthy: xr.Dataset, number: IntArray, members: list[NDArray[np.bool_]]
) -> tuple[IntArray, list[NDArray[np.bool_]]]:
    """The sets of `_healthy_of` cut down to the records nearest in speed to each tested one, within `SAME_SPEED`."""
    if "shaft_rate" not in table or "shaft_rate" not in healthy:
        return number, members
    with np.errstate(
        divide="ignore", invalid="ignore"
    ):  # a speed that is not known is 0 or NaN, and as far from all others
        tested_speed, speed = (np.log(of_table["shaft_rate"].values) for of_table in (table, healthy))
    # records of one rig at one speed share their set
    pairs, number = np.unique(np.stack([number, tested_speed]), axis=1, return_inverse=True)
    nearest = list[NDArray[np.bool_]]()
    for rig, tested in pairs.T:
        # without a known speed all healthy records of the rig are as near
        apart = np.abs(speed - tested) if np.isfinite(tested) else np.zeros(len(speed))
        closest = np.nanmin(apart[members[int(rig)]], initial=np.inf)
        nearest.append(members[int(rig)] & ~(apart > closest + SAME_SPEED))
    return number.reshape(-1), nearest


def healthy_records(reference: xr.Dataset) -> xr.Dataset:
    """The records of a reference that are healthy, or all of them if the class of all is unknown.

    Raises
    ------
    CorpusError
        If there is none.
    """
    fault = reference["fault"].values
    rows = (fault == HEALTHY_CODE) | bool((fault == UNKNOWN_CODE).all())
    finite = [np.isfinite(of_channel["features"].values).any(axis=1) for of_channel in channels_of(reference)]
    rows &= np.logical_or.reduce(finite)  # too short or constant signals have no features
    if not rows.any():
        raise CorpusError(
            f"{title_of(reference)}: the reference holds no healthy record with features; give a healthy recording of "
            "the rig that is as long as the records."
        )
    return reference.isel(record=rows)


def by_rig(table: xr.Dataset, reference: xr.Dataset) -> bool:
    """Whether a reference has records of each rig of a table."""
    return bool(np.isin(table["rig"].values, reference["rig"].values).all())


def check_rates(table: xr.Dataset, reference: xr.Dataset) -> None:
    """Refuse a reference whose features differ from those of the table because of its sample rate.

    Raises
    ------
    CorpusError
        If the sample rates differ, and half of one of them is below the end of the band of the features.
    """
    if "sample_rate" not in table or "sample_rate" not in reference:
        return
    tested, its = np.unique(table["sample_rate"].values), np.unique(reference["sample_rate"].values)
    comparable = 2 * band_of(table.attrs).high  # from it on, all bands of the features lie below the Nyquist frequency
    if not np.array_equal(tested, its) and min(*tested, *its) < comparable:
        raise CorpusError(
            f"{title_of(reference)}: the sample rate of the reference is {its[0]:g} Hz and that of the records "
            f"{tested[0]:g} Hz; they may differ only if both are at least {comparable:g} Hz."
        )


def virtual_references(table: xr.Dataset, features: Sequence[str], seed: int) -> tuple[IntArray, IntArray]:
    """Choose another healthy recording of the same rig for each record of a corpus.

    It is one of the three nearest in speed, on another specimen or on the same one. The choice depends on the features of the records
    and on the seed, and not on the order of the records.

    Returns
    -------
    Numbers of the records with a reference, and of their references, each of shape (pair,).
    """
    rows = feature_rows(table, features).to_numpy()
    digests, recording = record_digests(rows), recording_numbers(table)
    speed = np.log(np.asarray(table["shaft_rate"].values, dtype=float))
    healthy = (table["fault"].values == HEALTHY_CODE) & np.isfinite(rows).any(axis=1)
    pairs: list[tuple[int, int]] = []
    for rig in np.unique(table["rig"].values):
        records = np.flatnonzero(table["rig"].values == rig)
        healthy_of_rig = records[healthy[records]]
        # ordered by content, so that the choice does not depend on the order of the table
        healthy_of_rig = healthy_of_rig[np.argsort(digests[healthy_of_rig])]
        for record in records:
            # windows of the same recording would be closer than any real reference
            others = healthy_of_rig[recording[healthy_of_rig] != recording[record]]
            nearest = others[np.argsort(np.abs(speed[others] - speed[record]), kind="stable")[:NEAREST]]
            if len(nearest):
                # the draw belongs to the record, whatever other records there are
                drawn = np.random.default_rng([seed, int(digests[record])]).integers(len(nearest))
                pairs.append((int(record), int(nearest[drawn])))
    chosen = np.array(pairs, dtype=np.intp).reshape(-1, 2)
    return chosen[:, 0], chosen[:, 1]


def paired_table(table: xr.Dataset, features: Sequence[str], seed: int) -> xr.Dataset | None:
    """`relative_table` of the records of a corpus with their virtual references.

    None if the table lacks energies or shaft rates, or if a class of the corpus has no record with a reference: then no rig has two
    healthy recordings and records of that class.
    """
    if not set(ENERGIES) <= set(table["feature"].values) or "shaft_rate" not in table:
        return None
    table = table.isel(record=table["fault"].values != UNKNOWN_CODE)
    records, references = virtual_references(table, features, seed)
    paired = table.isel(record=records)
    if len(np.unique(paired["fault"].values)) < len(np.unique(table["fault"].values)):
        return None
    values = feature_rows(table, _compared(features)).to_numpy()[references]
    return relative_table(paired, features, values)
