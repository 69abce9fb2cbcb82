"""Records on their way into another form: their columns, with safe names, and the page about them.

Names and texts of a corpus can come from strangers. So names of columns and files are made here, from letters, digits and underscores.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.choice import per_record
from gen.corpus.schema import DRAWS, SCHEMA, class_names
from raceway.sharing.card.markdown import plain_text
from raceway.sharing.copying import Block, Chosen

_LONGEST_NAME = 60  # letters; PostgreSQL cuts names after 63
_RESERVED = ("record", "file")
_TERMS = {"license": "Licence", "creator_name": "Creators", "references": "References", "metadata_link": "Published at"}
"""Global attributes that the page repeats, with their headings."""


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
    """Names of the values that a class variable has in the chosen records, by their codes; empty otherwise."""

    def of(self, records: xr.Dataset) -> NDArray[Any]:
        """Values in some records; the names of its classes if it is a class variable."""
        values = records[self.variable].values
        if not self.flags:
            return values
        return np.array([self.flags.get(int(code), str(code)) for code in values], object)


@dataclass(frozen=True)
class Export:
    """Chosen records, and what a form needs to know about all of them."""

    chosen: Chosen
    report: Callable[[int], None]
    """Called with the number of records of each block that is done."""

    def blocks(self, most_bytes: int, places: NDArray[np.intp] | None = None) -> Iterator[Block]:
        """Blocks of records (:meth:`raceway.sharing.copying.Chosen.blocks`), each reported when the next one is asked for."""
        for block in self.chosen.blocks(most_bytes, places):
            yield block
            self.report(len(block.numbers))

    @cached_property
    def channels(self) -> list[str]:
        """Names of the channels for columns."""
        return plain_names(self.chosen.channels)

    @cached_property
    def columns(self) -> list[Column]:
        """Columns of the per-record variables: those of every corpus first, the scenario last."""
        corpus = self.chosen.corpora[0]
        schema = [variable.name for variable in SCHEMA]
        further = [name for name in per_record(corpus) if name not in schema and name != DRAWS]
        ordered = [name for name in (*schema, *further, DRAWS) if name in corpus.variables]
        return [_column(self.chosen, *pair) for pair in zip(plain_names(ordered, _RESERVED), ordered, strict=True)]

    @cached_property
    def title(self) -> str:
        """Title as one harmless line."""
        return plain_text(self.chosen.title) or "Vibration records of rolling bearings"

    def page(self, reading: str) -> str:
        """README.md of a folder: the origin of the records, their size, and how to read them."""
        chosen = self.chosen
        signal = f"{chosen.samples / chosen.sample_rate:g} s at {chosen.sample_rate:g} Hz"
        channels = ", ".join(map(plain_text, chosen.channels))
        count = f"{chosen.count} of {chosen.of} records of {'a corpus' if len(chosen.paths) == 1 else f'{len(chosen.paths)} corpora'}"
        about = f"{count}, {signal}, channels {channels}, in m s-2, copied by Raceway. `record` is the number of the record in the source."
        lines = [f"# {self.title}", "", about]
        for name, heading in _TERMS.items():
            text = plain_text(chosen.attributes.get(name, ""))
            lines += ["", f"{heading}: {text}"] if text else []
        return "\n".join([*lines, "", reading])


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


def _column(chosen: Chosen, name: str, variable: str) -> Column:
    array = chosen.corpora[0][variable].variable
    flags = class_names(array.attrs)
    found = set(chosen.values(variable).tolist()) if flags else set()
    units, role, meaning = (str(array.attrs.get(key, "")) for key in ("units", "role", "long_name"))
    return Column(
        name,
        variable,
        array.dtype if array.dtype.kind in "iuf" else None,
        units,
        role,
        meaning,
        {code: name for code, name in flags.items() if code in found},
    )
