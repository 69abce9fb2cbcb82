"""Labelled rows of a feature table: features, fault class, and the groups that a record belongs to.

A specimen is identified by its rig and its number, a recording by its specimen, its fault and its number. So a corpus
may restart either number on each rig, or number all of them consecutively.
"""

from collections.abc import Hashable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import FAULTS
from gen.errors import CorpusError

if TYPE_CHECKING:
    from pandas import DataFrame

IntArray = NDArray[np.integer[Any]]
FloatArray = NDArray[np.floating[Any]]

DEFAULT_GROUPS = ("lines", "shape")  # independent of gain and spectral colour


class Records(NamedTuple):
    """Labelled rows; ``features`` is a data frame, because estimators identify its columns by name.

    ``fault`` is an index into ``gen.corpus.FAULTS``; ``rig``, ``specimen`` and ``recording`` are numbers from 0, unique
    in the table; ``width`` is that of the widest spall [m], 0 without a spall and NaN if unknown. All are of shape
    (record,), ``features`` of shape (record, feature).
    """

    title: str
    features: "DataFrame"
    fault: IntArray
    rig: IntArray
    specimen: IntArray
    recording: IntArray
    width: FloatArray


def labelled_records(table: xr.Dataset, features: Sequence[str]) -> Records:
    """Rows of a feature table with some of its features, in the order given; the width is NaN if the table lacks it.

    Raises
    ------
    CorpusError
        If the table has no records, or lacks a feature, the fault, or the number of rig, specimen or recording.
    """
    title = title_of(table)
    rows = feature_rows(table, features)
    fault = np.asarray(table["fault"].values, dtype=np.intp)
    if fault.min() < 0 or fault.max() >= len(FAULTS):
        message = f"{title}: fault has values outside 0..{len(FAULTS) - 1} ({', '.join(FAULTS)})."
        raise CorpusError(message)
    rig, specimen = (table[name].values for name in ("rig", "specimen"))
    return Records(
        title=title,
        features=rows,
        fault=fault,
        rig=_numbered(rig),
        specimen=_numbered(rig, specimen),
        recording=recording_numbers(table),
        width=np.asarray(table["width"].values, dtype=float) if "width" in table else np.full(len(fault), np.nan),
    )


def feature_rows(table: xr.Dataset, features: Sequence[str]) -> "DataFrame":
    """Rows of a feature table with some of its features, in the order given, whatever their labels.

    Raises
    ------
    CorpusError
        If the table has no records, or lacks a feature, the fault, or the number of rig, specimen or recording.
    """
    title = title_of(table)
    _require(title, ("features", "fault", "rig", "specimen", "recording"), table.variables)
    _require(title, features, table["feature"].values)
    if table.sizes["record"] == 0:
        message = f"{title}: the feature table holds no record; give a corpus with at least one."
        raise CorpusError(message)
    return cast("DataFrame", table["features"].sel(feature=list(features)).to_pandas())


def recording_numbers(table: xr.Dataset) -> IntArray:
    """Number of the recording of each record, from 0 and without a gap, shape (record,)."""
    return _numbered(*(table[name].values for name in ("rig", "specimen", "fault", "recording")))


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
        message = f"{records.title}: all records are {only}; give a corpus with two or more classes."
        raise CorpusError(message)
    return present


def features_of(table: xr.Dataset, groups: Sequence[str]) -> tuple[str, ...]:
    """Names of the features that a table has of some groups.

    Raises
    ------
    CorpusError
        If the table has no feature of one of the groups.
    """
    _require(title_of(table), ("feature", "group"), table.variables)
    held = table["group"].values
    _require(title_of(table), groups, held)
    return tuple(str(name) for name in table["feature"].values[np.isin(held, groups)])


def title_of(table: xr.Dataset) -> str:
    """Title of the corpus that a table was computed from."""
    return str(table.attrs.get("title", "untitled corpus"))


def _require(title: str, names: Iterable[str], held: Iterable[Hashable]) -> None:
    lacking = set(names) - set(held)
    if lacking:
        message = f"{title}: the feature table lacks {min(lacking)!r}; make it again with raceway features."
        raise CorpusError(message)


def _numbered(*keys: IntArray) -> IntArray:
    """Number from 0 of each distinct combination of keys, shape (record,)."""
    return np.unique(np.stack(keys), axis=1, return_inverse=True)[1].reshape(-1)
