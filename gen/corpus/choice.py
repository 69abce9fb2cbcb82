"""Choice of records and channels of corpora, as ``--where``, ``--split`` and ``--channels`` give it."""

import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.contents import extent
from gen.corpus.schema import SPLITS
from gen.corpus.where import label_columns, nearest, records_where
from gen.support.errors import CorpusError
from gen.support.units import range_text


def chosen_records(
    corpora: Sequence[xr.Dataset], where: str | None = None, split: str | None = None
) -> list[NDArray[np.intp]]:
    """Places of the records of each corpus that meet a condition and belong to a split, ascending; all records without either.

    Parameters
    ----------
    corpora : sequence of Dataset
        Opened corpora with the same variables.
    where : str, optional
        A condition, such as ``fault == 'inner' and width_mm > 0.5`` (:mod:`gen.corpus.where`).
    split : {"train", "validation", "test"}, optional
        Name of a split.

    Raises
    ------
    CorpusError
        If the condition cannot be read, names an unknown column or value, or no record meets it; if the split is unknown.
    """
    if split is not None and split not in SPLITS:
        raise CorpusError(f"split: there is no split {split!r}; allowed are {', '.join(SPLITS)}.")
    places: list[NDArray[np.intp]] = []
    for corpus in corpora:
        chosen = np.arange(corpus.sizes["record"])
        if split is not None:
            chosen = np.flatnonzero(corpus["split"].values == SPLITS.index(split))
        if where is not None:
            chosen = np.intersect1d(chosen, records_where(where, _variables(corpus)))
        places.append(chosen)
    # an empty copy helps nobody: say what the records have instead
    if not any(map(len, places)):
        words = [f"where {where!r}"] * (where is not None) + [f"split {split!r}"] * (split is not None)
        count = sum(corpus.sizes["record"] for corpus in corpora)
        raise CorpusError(
            f"{' and '.join(words)}: none of {count} records is chosen; choose others{_extents(corpora, where)}."
        )
    return places


def chosen_channels(names: Sequence[str], channels: Sequence[str] | None) -> tuple[int, ...]:
    """Places of the channels with the given names, in the order of the corpus; all channels without names.

    Raises
    ------
    CorpusError
        If the corpus has no such channel, or no name is given.
    """
    if channels is None:
        return tuple(range(len(names)))
    if isinstance(channels, str) or not channels:
        raise CorpusError(f"channels: {channels!r} is not a list of names; allowed are {', '.join(names)}.")
    for name in channels:
        if name not in names:
            raise CorpusError(f"channels: there is no channel {name!r}{nearest(name, names)}")
    return tuple(place for place, name in enumerate(names) if name in channels)


def channel_names(corpus: xr.Dataset) -> list[str]:
    """Names of the channels of an opened corpus."""
    return [str(name) for name in corpus["channel"].values]


def per_record(corpus: xr.Dataset) -> list[str]:
    """Names of the per-record variables that an opened corpus stores; names of classes have no role."""
    variables = corpus.variables.items()
    return [str(name) for name, variable in variables if variable.dims == ("record",) and "role" in variable.attrs]


def operating_variables(corpus: xr.Dataset) -> dict[str, NDArray[Any]]:
    """What an analyst on site knows of each record of an opened corpus: the variables of the role ``operating``, shape (record,)."""
    names = [name for name in per_record(corpus) if corpus[name].attrs["role"] == "operating"]
    return {name: corpus[name].values for name in names}


def _variables(corpus: xr.Dataset) -> dict[str, xr.DataArray]:
    return {name: corpus[name] for name in per_record(corpus)}


def _extents(corpora: Sequence[xr.Dataset], where: str | None) -> str:
    """Least and largest value of the measured quantities in a condition, in brackets: a unit is easily mistaken."""
    columns, extents = label_columns(_variables(corpora[0])), list[str]()
    named = re.findall(r"[A-Za-z_]\w*", where or "")
    for name in dict.fromkeys(columns[word][0] for word in named if word in columns):
        unit = str(corpora[0][name].attrs.get("units", "1"))
        ends = extent(np.concatenate([corpus[name].values for corpus in corpora])) if unit != "1" else None
        if ends is not None:
            extents.append(f"{name} is {range_text(name, ends[0], ends[-1], unit)}")
    return f" ({', '.join(extents)})" if extents else ""
