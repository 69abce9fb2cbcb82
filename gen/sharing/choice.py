"""Choice of records and channels of a corpus, as ``--where``, ``--split`` and ``--channels`` give it."""

import re
from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import SPLITS, class_names
from gen.errors import CorpusError
from gen.sharing.where import Column, nearest, parse_where


def chosen_records(corpus: xr.Dataset, where: str | None = None, split: str | None = None) -> NDArray[np.intp]:
    """Places of the records that meet a condition and belong to a split, ascending; all records without either.

    Parameters
    ----------
    corpus : Dataset
        An opened corpus.
    where : str, optional
        A condition, such as ``fault == 'inner' and shaft_rate > 20``; :mod:`gen.sharing.where` has the grammar.
    split : {"train", "validation", "test"}, optional
        Name of a split.

    Raises
    ------
    CorpusError
        If the condition cannot be read, names an unknown variable or value, or no record meets it; if the split is unknown.
    """
    chosen = np.ones(corpus.sizes["record"], bool)
    if split is not None:
        if split not in SPLITS:
            raise CorpusError(f"split: there is no split {split!r}; allowed are {', '.join(SPLITS)}.")
        chosen &= corpus["split"].values == SPLITS.index(split)
    if where is not None:
        variables = [str(name) for name, variable in corpus.variables.items() if variable.dims == ("record",)]
        chosen &= parse_where(where).holds(variables, lambda name: _column(corpus, name))
    if not chosen.any():
        asked = [f"where {where!r}"] * (where is not None) + [f"split {split!r}"] * (split is not None)
        raise CorpusError(
            f"{' and '.join(asked)}: none of {len(chosen)} records is chosen; choose others{_extents(corpus, where)}."
        )
    return np.flatnonzero(chosen)


def chosen_channels(corpus: xr.Dataset, channels: Sequence[str] | None) -> tuple[int, ...]:
    """Places of the channels with the given names, in the order of the corpus; all channels without names.

    Raises
    ------
    CorpusError
        If the corpus has no such channel, or no name is given.
    """
    names = [str(name) for name in corpus["channel"].values]
    if channels is None:
        return tuple(range(len(names)))
    if isinstance(channels, str) or not channels:
        raise CorpusError(f"channels: {channels!r} is not a list of names; allowed are {', '.join(names)}.")
    for name in channels:
        if name not in names:
            raise CorpusError(f"channels: there is no channel {name!r}{nearest(name, names)}")
    return tuple(place for place, name in enumerate(names) if name in channels)


def _extents(corpus: xr.Dataset, where: str | None) -> str:
    """Least and largest value of the measured quantities in a condition, in brackets: a unit is easily mistaken."""
    found: list[str] = []
    for name in dict.fromkeys(re.findall(r"[A-Za-z_]\w*", where or "")):
        variable = corpus.get(name)
        unit = "1" if variable is None else str(variable.attrs.get("units", "1"))
        if variable is not None and unit != "1" and np.isfinite(variable.values).any():
            values = variable.values[np.isfinite(variable.values)]
            found.append(f"{name} is {values.min():.4g} to {values.max():.4g} {unit}")
    return f" ({', '.join(found)})" if found else ""


def _column(corpus: xr.Dataset, name: str) -> Column:
    """Values of a per-record variable with the names of its values, if it is a class variable."""
    variable = corpus[name]
    return Column(variable.values, class_names(variable.attrs))
