"""The rows of a feature table as a classifier sees them: features, fault, and the groups they belong to.

A specimen is known by its rig and its number, a recording by its specimen and its number, so that corpora may
count them within each rig or throughout.
"""

from collections.abc import Hashable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import FAULTS
from gen.errors import CorpusError

if TYPE_CHECKING:
    from pandas import DataFrame  # what xarray makes of a table

IntArray = NDArray[np.integer[Any]]
FloatArray = NDArray[np.floating[Any]]

DEFAULT_GROUPS = ("lines", "shape")  # free of gain and colour


class Records(NamedTuple):
    """Labelled rows; ``features`` is a data frame, so that estimators know their columns by name.

    ``fault`` indexes ``gen.corpus.FAULTS``; ``rig``, ``specimen`` and ``recording`` are numbers from 0, unique
    over the table. All are of shape (record,), ``features`` of shape (record, feature).
    """

    title: str
    features: "DataFrame"
    fault: IntArray
    rig: IntArray
    specimen: IntArray
    recording: IntArray


def labelled_records(table: xr.Dataset, features: Sequence[str]) -> Records:
    """Rows of a feature table with the chosen features in the order given.

    Raises
    ------
    CorpusError
        If the table has no records, or lacks a feature, the label or a group.
    """
    title = title_of(table)
    _require(title, ("features", "fault", "rig", "specimen", "recording"), table.variables)
    _require(title, features, table["feature"].values)
    if table.sizes["record"] == 0:
        message = f"{title}: the feature table holds no record; give a corpus with at least one."
        raise CorpusError(message)
    fault = np.asarray(table["fault"].values, dtype=np.intp)
    if fault.min() < 0 or fault.max() >= len(FAULTS):
        message = f"{title}: fault has values outside 0..{len(FAULTS) - 1} ({', '.join(FAULTS)})."
        raise CorpusError(message)
    rig, specimen, recording = (table[name].values for name in ("rig", "specimen", "recording"))
    return Records(
        title=title,
        features=cast("DataFrame", table["features"].sel(feature=list(features)).to_pandas()),
        fault=fault,
        rig=_numbered(rig),
        specimen=_numbered(rig, specimen),
        recording=_numbered(rig, specimen, fault, recording),
    )


def check_classes(records: Records) -> IntArray:
    """Classes present, as indices into ``gen.corpus.FAULTS``, ascending.

    Raises
    ------
    CorpusError
        If there is a single one.
    """
    present = np.unique(records.fault)
    if len(present) < 2:
        only = FAULTS[present[0]]
        message = f"{records.title}: all records are {only}; give a corpus with two or more classes."
        raise CorpusError(message)
    return present


def features_of(table: xr.Dataset, groups: Sequence[str]) -> tuple[str, ...]:
    """Names of the features of some groups in a table.

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
    """Title of the corpus a table was made from."""
    return str(table.attrs.get("title", "untitled corpus"))


def _require(title: str, names: Iterable[str], held: Iterable[Hashable]) -> None:
    lacking = set(names) - set(held)
    if lacking:
        message = f"{title}: the feature table lacks {min(lacking)!r}; make it again with raceway features."
        raise CorpusError(message)


def _numbered(*keys: IntArray) -> IntArray:
    """Numbers from 0, one for each distinct combination of keys."""
    return np.unique(np.stack(keys), axis=1, return_inverse=True)[1].reshape(-1)
