"""Per-record variables of corpora that are merged: all of them, and the values of those that one corpus lacks."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from gen.corpus import SIGNAL, class_names
from gen.corpus.schema import listed_flags
from gen.errors import CorpusError

_SAME_UNIT = {"dB": "1"}  # levels of older corpora; their values are the same
_NOT_KNOWN = ("unjudged", "unknown")


class Described(NamedTuple):
    """Type of a per-record variable, its attributes, and the corpus that they were taken from."""

    dtype: np.dtype[Any]
    attributes: Mapping[str, Any]
    corpus: str


class Columns(NamedTuple):
    """All per-record variables of several corpora."""

    variables: Mapping[str, Described]
    filled: tuple[str, ...]
    """Names of those that one or more of the corpora lack."""
    differing: frozenset[str]
    """Attributes of the signal that are not the same in all corpora, such as whether it is simulated or measured."""
    axes: Mapping[str, xr.Variable]
    """Channels and times with the attributes of the first corpus; those of an older version have others."""


def columns_of_all(corpora: Sequence[tuple[str, xr.Dataset]]) -> Columns:
    """Variables of all corpora, in the order in which they first occur; the corpora are given with their names.

    Raises
    ------
    CorpusError
        If a variable has different types, units or class values in two of them.
    """
    found: dict[str, Described] = {}
    counts: dict[str, int] = {}
    for corpus, dataset in corpora:
        for key, variable in dataset.variables.items():
            name = str(key)
            if name == SIGNAL or variable.dims != ("record",):
                continue
            here = Described(variable.dtype.newbyteorder("="), variable.attrs, corpus)
            _check_same(name, found.setdefault(name, here), here)
            if found[name].attributes.get("units") in _SAME_UNIT:
                found[name] = here
            counts[name] = counts.get(name, 0) + 1
    signals = [dataset[SIGNAL].attrs for _, dataset in corpora]
    differing = {key for attrs in signals for key in attrs if any(of.get(key) != attrs[key] for of in signals)}
    filled = tuple(name for name in found if counts[name] < len(corpora))
    first = corpora[0][1]
    # h5py gives times with their byte order stated, of which netCDF4 warns
    axes_values = {"channel": first["channel"].values, "elapsed_time": first["elapsed_time"].values.astype(np.float64)}
    axes = {name: xr.Variable(name, of, first[name].attrs) for name, of in axes_values.items()}
    return Columns(found, filled, frozenset(differing), axes)


def _check_same(name: str, first: Described, other: Described) -> None:
    for what, one, two in (
        ("type", first.dtype, other.dtype),
        ("unit", *(_unit(of) for of in (first, other))),
        ("values", *(listed_flags(class_names(of.attributes)) for of in (first, other))),
    ):
        if one != two:
            raise CorpusError(
                f"{other.corpus}: the {what} of {name} is {two}, in {first.corpus} {one}; make both with one version of raceway."
            )


def _unit(variable: Described) -> str:
    unit = str(variable.attributes.get("units"))
    return _SAME_UNIT.get(unit, unit)


def with_all(records: xr.Dataset, columns: Columns) -> xr.Dataset:
    """Records with all variables, of which those that they lack are filled (:func:`not_known`)."""
    count = records.sizes["record"]
    signal = records[SIGNAL].variable
    kept = {key: value for key, value in signal.attrs.items() if key not in columns.differing}
    data: dict[str, Any] = {SIGNAL: (signal.dims, signal.values, kept)}
    coordinates: dict[str, Any] = dict(columns.axes)
    for name, described in columns.variables.items():
        values = records[name].values if name in records.variables else np.full(count, not_known(described))
        text = described.dtype.kind in "OSU"
        variable = (
            "record",
            np.asarray(values, object) if text else values.astype(described.dtype),
            described.attributes,
        )
        (coordinates if text else data)[name] = variable
    return xr.Dataset(data, coordinates, records.attrs)


def not_known(variable: Described) -> Any:
    """Value of a variable that is not known: empty text, NaN, the class value ``unjudged`` or ``unknown``, or else -1."""
    if variable.dtype.kind in "OSU":
        return ""
    if variable.dtype.kind == "f":
        return np.nan
    return next((code for code, name in class_names(variable.attributes).items() if name in _NOT_KNOWN), -1)
