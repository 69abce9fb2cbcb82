"""Labelled rows of a feature table: features, fault class, and the groups that a record belongs to.

A specimen is identified by its rig and its number, a recording by its specimen, its fault and its number. So a corpus
may restart either number on each rig, or number all of them consecutively.
"""

import hashlib
from collections.abc import Hashable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from features.signal.rows import FloatArray, IntArray
from features.table.recording_speeds import recording_numbers
from features.table.waveforms import Waveforms
from gen.corpus import FAULT_NAMES, FAULTS, UNKNOWN, UNKNOWN_CODE, numbered, specimen_numbers
from gen.corpus.fault_classes import HEALTHY
from gen.support.errors import CorpusError

if TYPE_CHECKING:
    from pandas import DataFrame

DEFAULT_GROUPS = ("lines", "shape")  # independent of gain and spectral colour
HEALTHY_CODE = FAULTS.index(HEALTHY)


class Records(NamedTuple):
    """Labelled rows; ``features`` is a data frame, because estimators identify its columns by name, or waveforms.

    ``fault`` is an index into ``gen.corpus.FAULTS``; ``rig``, ``specimen`` and ``recording`` are numbers from 0, unique
    in the table; ``width`` is that of the widest spall [m], 0 without a spall and NaN if unknown; ``shaft_rate`` is the
    labelled one [Hz], NaN if unknown; ``bearing`` is the number of the type from 0. All are of shape (record,),
    ``features`` of shape (record, feature) or (record, time).
    """

    title: str
    features: Any
    fault: IntArray
    rig: IntArray
    specimen: IntArray
    recording: IntArray
    width: FloatArray
    shaft_rate: FloatArray
    bearing: IntArray

    def at(self, rows: IntArray) -> "Records":
        """Some of the rows, in the order given."""
        return Records(self.title, self.features.take(rows), *(cast("Any", column)[rows] for column in self[2:]))


def labelled_records(table: xr.Dataset, features: Sequence[str]) -> Records:
    """Rows of a feature table whose class is known, with some of its features in the order given; the width is NaN if the table lacks it.

    Raises
    ------
    CorpusError
        If the table has no records, lacks a feature, the fault, or the number of rig, specimen or recording, or if all records are of
        class ``unknown``.
    """
    title, unknown = title_of(table), count_unknown(table)
    if unknown and unknown == table.sizes["record"]:
        raise CorpusError(f"{title}: all records are of class {UNKNOWN}; label some of them, or give another corpus.")
    if unknown:
        table = table.isel(record=table["fault"].values != UNKNOWN_CODE)
    rows = feature_rows(table, features)
    fault = np.asarray(table["fault"].values, dtype=np.intp)
    if not np.isin(fault, [*FAULT_NAMES]).all():
        allowed = ", ".join(f"{code} {name}" for code, name in FAULT_NAMES.items())
        raise CorpusError(f"{title}: fault has values other than {allowed}.")
    specimen = specimen_numbers(table)
    return Records(
        title=title,
        features=rows,
        fault=fault,
        rig=numbered(table["rig"].values),
        specimen=specimen,
        recording=recording_numbers(table),
        width=_column(table, "width"),
        shaft_rate=_column(table, "shaft_rate"),
        bearing=_bearing_type(table, specimen),
    )


def count_unknown(table: xr.Dataset) -> int:
    """Number of records of a feature table whose class is not known."""
    return int((table["fault"].values == UNKNOWN_CODE).sum()) if "fault" in table else 0


def records_of(data: xr.Dataset | Waveforms, groups: Sequence[str]) -> Records:
    """Rows of a feature table with the features of some groups, or waveforms with their labels.

    Raises
    ------
    CorpusError
        As `labelled_records`, or if the table has no feature of one of the groups.
    """
    if not isinstance(data, Waveforms):
        return labelled_records(data, features_of(data, groups))
    none = data.labels.assign(features=(("record", "feature"), np.empty((len(data), 0))))
    records = labelled_records(none.assign_coords(feature=[], record=np.arange(len(data))), ())
    return records._replace(features=data.take(records.features.index))


def feature_rows(table: xr.Dataset, features: Sequence[str]) -> "DataFrame":
    """Rows of a feature table with some of its features, in the order given, whatever their labels.

    A table of several channels has the features of each, one channel after the other.

    Raises
    ------
    CorpusError
        If the table has no records, or lacks a feature, the fault, or the number of rig, specimen or recording.
    """
    title = title_of(table)
    _require(title, ("features", "fault", "rig", "specimen", "recording"), table.variables)
    _require(title, features, table["feature"].values)
    if table.sizes["record"] == 0:
        raise CorpusError(f"{title}: the feature table holds no record; give a corpus with at least one.")
    held = table["features"]
    if list(table["feature"].values) != list(features):  # a selection is a copy
        held = held.sel(feature=list(features))
    if held.ndim > 2:
        held = held.stack(column=("channel", "feature"), create_index=False)
    return cast("DataFrame", held.to_pandas())


def _column(table: xr.Dataset, name: str) -> FloatArray:
    """Values of a variable, shape (record,); NaN if the table lacks it."""
    return np.asarray(table[name].values, dtype=float) if name in table else np.full(table.sizes["record"], np.nan)


def _bearing_type(table: xr.Dataset, specimen: IntArray) -> IntArray:
    """Number of the bearing type of the first record of each specimen, shape (record,): one designation and number of balls.

    The number of balls is the sum of the nominal orders BPFO and BPFI. Corpora of drawn geometries have one designation
    for all bearings.
    """
    balls = np.rint(_column(table, "bpfo") + _column(table, "bpfi"))
    named = table["bearing"].values.astype(str) if "bearing" in table else np.full(len(balls), "")
    first = np.unique(specimen, return_index=True)[1][specimen]
    return numbered(np.unique(named, return_inverse=True)[1], np.nan_to_num(balls))[first]


def record_digests(features: FloatArray | Waveforms) -> NDArray[np.uint64]:
    """Digest each row of features or waveforms to 64 bits, shape (record,)."""
    rows = (np.ascontiguousarray(row, dtype="<f8").tobytes() for row in features)
    digests = (int.from_bytes(hashlib.blake2b(row, digest_size=8).digest(), "little") for row in rows)
    return np.fromiter(digests, dtype=np.uint64, count=len(features))


def seen_records(features: FloatArray, digests: NDArray[np.uint64]) -> int:
    """Number of records whose digest is known; records without any feature are not counted."""
    with_features = np.isfinite(features).any(axis=1)
    return int(np.isin(record_digests(features[with_features]), digests).sum())


def check_classes(records: Records) -> IntArray:
    """Classes present, as indices into ``gen.corpus.FAULTS``, ascending.

    Raises
    ------
    CorpusError
        If there is only one.
    """
    present = np.unique(records.fault)
    if len(present) < 2:
        only = FAULTS[present[0]]
        raise CorpusError(
            f"{records.title}: all records are {only}; give a corpus with two or more classes (faults in its recipe, or "
            f"raceway copy)."
        )
    return present


def features_of(table: xr.Dataset, groups: Sequence[str]) -> tuple[str, ...]:
    """Names of the features that a table has of some groups.

    Raises
    ------
    CorpusError
        If the table has no feature of one of the groups.
    """
    check_table(table)
    held = table["group"].values
    _require(title_of(table), groups, held)
    return tuple(str(name) for name in table["feature"].values[np.isin(held, groups)])


def check_table(table: object) -> None:
    """Refuse anything but a feature table with a CorpusError."""
    if not isinstance(table, xr.Dataset) or not {"feature", "group"} <= set(table.variables):
        raise CorpusError(
            f"{type(table).__name__} given in place of a feature table; make one with features.feature_table."
        )


def title_of(table: xr.Dataset) -> str:
    """Title of the corpus that a table was computed from."""
    return str(table.attrs.get("title", "untitled corpus"))


def _require(title: str, names: Iterable[str], held: Iterable[Hashable]) -> None:
    lacking = set(names) - set(held)
    if lacking:
        raise CorpusError(f"{title}: the feature table lacks {min(lacking)!r}; make it again with raceway features.")
