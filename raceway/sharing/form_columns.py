"""Columns of the records in another form, with safe names.

Names and texts of a corpus can come from strangers. So names of columns and files are made here, from letters, digits and underscores.
"""

import re
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.choice import per_record
from gen.corpus.fault_classes import BUILT_IN
from gen.corpus.schema import DRAWS, SCHEMA, class_names
from raceway.sharing.copying import Chosen

_LONGEST_NAME = 60  # letters; PostgreSQL cuts names after 63
_RESERVED = ("record", "file")


class Column(NamedTuple):
    """One per-record variable: its column, its variable in the corpus, and its description."""

    name: str
    variable: str
    dtype: np.dtype[Any] | None
    """None for text."""
    units: str
    role: str
    meaning: str
    flags: Mapping[int, str]
    """Names of the values of a class variable by their codes, ascending; empty otherwise.

    Of the classes of bearings, those of plug-ins are here only if records have them, as in a file.
    """

    def of(self, records: xr.Dataset) -> NDArray[Any]:
        """Values in some records; the names of its classes if it is a class variable."""
        values = records[self.variable].values
        if not self.flags:
            return values
        return np.array([self.flags.get(int(code), str(code)) for code in values], object)


def columns_of(chosen: Chosen) -> list[Column]:
    """Columns of the per-record variables: those of every corpus first, the scenario last."""
    corpus = chosen.corpora[0]
    schema = [variable.name for variable in SCHEMA]
    further = [name for name in per_record(corpus) if name not in schema and name != DRAWS]
    ordered = [name for name in (*schema, *further, DRAWS) if name in corpus.variables]
    return [_column(chosen, *pair) for pair in zip(plain_names(ordered, _RESERVED), ordered, strict=True)]


def _column(chosen: Chosen, name: str, variable: str) -> Column:
    array = chosen.corpora[0][variable].variable
    names = class_names(array.attrs)
    # other class variables have no names of plug-ins
    codes = {*range(len(BUILT_IN)), *chosen.values(variable).tolist()} if variable == "fault" else names.keys()
    flags = {code: names[code] for code in sorted(names) if code in codes}
    is_text = bool(names) or array.dtype.kind not in "iuf"
    units, role, meaning = (str(array.attrs.get(key, "")) for key in ("units", "role", "long_name"))
    return Column(name, variable, None if is_text else array.dtype, units, role, meaning, flags)


def plain_names(names: Iterable[str], taken: Iterable[str] = ()) -> list[str]:
    """Names of letters, digits and underscores that begin with a letter, all different, also without regard to capital letters.

    >>> plain_names(["width", "../x y", "=1", "Width"], taken=["record"])
    ['width', 'x_y', 'x1', 'Width_2']
    """
    used, different = {name.lower() for name in taken}, []
    for name in names:
        plain = re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")[:_LONGEST_NAME]
        plain = plain if plain[:1].isalpha() else f"x{plain}"
        number, tried = 1, plain
        # two names may become the same, and some programs know no capital letters
        while tried.lower() in used:
            number += 1
            tried = f"{plain[: _LONGEST_NAME - 8]}_{number}"
        used.add(tried.lower())
        different.append(tried)
    return different
