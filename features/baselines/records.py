"""The rows of a feature table as a classifier sees them: features, fault, and the groups that must not be torn apart.

A specimen is known by its rig and its number, a recording by its specimen and its number, so that corpora may
count them within each rig or throughout.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import FAULTS
from gen.errors import CorpusError

IntArray = NDArray[np.integer[Any]]
FloatArray = NDArray[np.floating[Any]]

DEFAULT_GROUPS = ("lines", "shape")  # free of gain and colour


class Records(NamedTuple):
    """Labelled rows; ``features`` is a data frame, so that estimators know their columns by name.

    ``fault`` indexes ``gen.corpus.FAULTS``; ``rig``, ``specimen`` and ``recording`` are numbers from 0 that are
    unique over the table. All are of shape (record,), ``features`` of shape (record, feature).
    """

    features: Any
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
    lacking = [name for name in ("features", "fault", "rig", "specimen", "recording") if name not in table]
    lacking += sorted(set(features) - set(table["feature"].values)) if "feature" in table.coords else []
    if lacking:
        message = f"{title}: the feature table lacks {lacking[0]!r}; make it again with raceway features."
        raise CorpusError(message)
    if table.sizes["record"] == 0:
        message = f"{title}: the feature table holds no record; give a corpus with at least one."
        raise CorpusError(message)
    fault = np.asarray(table["fault"].values, dtype=np.intp)
    if fault.min() < 0 or fault.max() >= len(FAULTS):
        message = f"{title}: fault has values outside 0..{len(FAULTS) - 1} ({', '.join(FAULTS)})."
        raise CorpusError(message)
    rig, specimen, recording = (table[name].values for name in ("rig", "specimen", "recording"))
    return Records(
        features=table["features"].sel(feature=list(features)).to_pandas(),
        fault=fault,
        rig=_numbered(rig),
        specimen=_numbered(rig, specimen),
        recording=_numbered(rig, specimen, fault, recording),
    )


def features_of(table: xr.Dataset, groups: Sequence[str]) -> tuple[str, ...]:
    """Names of the features of some groups in a table.

    Raises
    ------
    CorpusError
        If the table has no feature of one of the groups.
    """
    held = table["group"].values
    for group in groups:
        if group not in held:
            message = (
                f"{title_of(table)}: the feature table holds no {group!r}, only {', '.join(sorted(set(held)))}; "
                f"make it again with raceway features."
            )
            raise CorpusError(message)
    return tuple(str(name) for name in table["feature"].values[np.isin(held, groups)])


def title_of(table: xr.Dataset) -> str:
    """Title of the corpus a table was made from."""
    return str(table.attrs.get("title", "untitled corpus"))


def _numbered(*keys: IntArray) -> IntArray:
    """Number from 0 of each distinct combination of keys."""
    return np.unique(np.stack(keys), axis=1, return_inverse=True)[1].reshape(-1)
