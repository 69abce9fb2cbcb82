"""Least, median and largest value of each quantity of a corpus, for its data card.

The per-record variables are those of every corpus. A simulated corpus also has ``draws``, the scenario of a record as JSON; its
quantities are taken from some records, because all of them would take long to read. Their units are those of the recipe's keys in SI.
"""

import json
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.card.markdown import plain_text, table
from gen.corpus.schema import DRAWS, FAULT_NAMES, SIGNAL
from gen.support.units import unit_suffix

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.intp]

MOST_DRAWS = 256  # records whose draws are read, in runs: text is stored in blocks of 256 records, 1 ms each
_RUN = 4
MOST_QUANTITIES = 200  # rows of a table
FEWEST = 12  # specimens of a class whose values are compared with those of the others
_LARGEST = 1e300  # not infinite, and no whole number beyond the range of floats

SI_SYMBOLS: Mapping[str, str] = {
    "mm": "m", "um": "m", "nm": "m", "rpm": "Hz", "deg": "rad", "percent": "1", "mm_s": "m s-1", "mm2_s": "m2 s-1", "hz": "Hz", "s": "s",
    "kg": "kg", "n": "N", "m_s2": "m s-2", "n_m": "N m-1", "n_s_m": "N s m-1", "db": "1", "celsius": "degC", "k": "K",
    "kg_m3": "kg m-3", "per_gpa": "Pa-1",
}  # fmt: skip
"""Unit of a drawn value by the suffix of its key; levels in decibels are drawn as ratios of amplitudes."""

_UNITS = {
    "machine.unbalance": "kg m", "harmonics.frequency": "1", "knocks.frequency": "1", "modulation.once": "1", "modulation.twice": "1",
    "axis.jumps": "1",
}  # fmt: skip
"""Units by the end of the place, of values without a key of their own or with another unit than that of the key: orders of the shaft."""

_NOT_DRAWN = {"seed", "settings", "number", "entry", "bearing", "fault_try", "level_try", "ball"}
"""Numbers and copies of the catalogue among the draws."""


_MEANING = (
    "Finite values of the per-record variables, in the stored unit. A variable that describes the fault has one row for each class with "
    "such a fault; another has one row for each class if the median of a class lies outside the middle half of the other classes."
)


class Range(NamedTuple):
    """Finite values of a quantity; ``fault`` names one or more classes, or ``all``."""

    name: str
    unit: str
    fault: str
    least: float
    median: float
    largest: float


class Groups(NamedTuple):
    """Class and specimen of each value."""

    fault: NDArray[np.integer[Any]]
    specimen: NDArray[np.integer[Any]]


def ranges(corpus: xr.Dataset, recipe: str | None) -> list[str]:
    """Section with the ranges of the variables and of the drawn quantities; ``recipe`` is that of the corpus, as YAML."""
    rows, constant = variable_ranges(corpus)
    header = ("variable", "unit", "class", "least", "median", "largest")
    lines = [
        "",
        "## Ranges",
        "",
        _MEANING,
        *table(header, map(_cells, rows), right=3),
    ]
    if constant:
        lines += ["", f"The same in all records: {', '.join(constant)}."]
    drawn, read = drawn_ranges(corpus, recipe)
    if drawn:
        some = "all records" if read == corpus.sizes["record"] else f"{read} records drawn at random"
        lines += [
            "",
            f"Further drawn quantities that vary, by their place in `{DRAWS}`, in SI units, of {some}. The recipe has their distributions.",
            *table(("drawn quantity", *header[1:]), map(_cells, drawn[:MOST_QUANTITIES]), right=3),
        ]
    return lines


def _cells(row: Range) -> tuple[str, ...]:
    return f"`{plain_text(row.name)}`", plain_text(row.unit), row.fault, *(f"{value:.4g}" for value in row[3:])


def variable_ranges(corpus: xr.Dataset) -> tuple[list[Range], list[str]]:
    """Ranges of the variables that vary, and the others with their value; those that are 0 or unknown everywhere are left out."""
    groups = Groups(corpus["fault"].values, corpus["specimen"].values)
    rows: list[Range] = []
    constant: list[str] = []
    for name, variable in corpus.variables.items():
        role = variable.attrs.get("role")
        if name == SIGNAL or variable.dims != ("record",) or variable.dtype.kind not in "fiu" or role == "provenance":
            continue
        if "flag_values" in variable.attrs:
            continue
        # of a copy, because the corpus would keep the values in memory
        values, unit = variable[:].values.astype(float), _unit(variable)
        finite = values[np.isfinite(values)]
        if finite.size and finite.min() < finite.max():
            rows += quantity_ranges(str(name), unit, values, groups, describes_fault=role == "label")
        elif finite.size and finite[0] != 0:
            value = f"{finite[0]:.6g}" + (f" {plain_text(unit)}" if unit not in ("", "1") else "")
            constant.append(f"`{plain_text(name)}` {value}")
    return rows, constant


def _unit(variable: xr.Variable) -> str:
    """Unit in a table; that of a level in decibels is stored as 1, because CF has no unit for it."""
    return "dB" if "decibels" in str(variable.attrs.get("long_name")) else str(variable.attrs.get("units", ""))


def quantity_ranges(
    name: str, unit: str, values: FloatArray, groups: Groups, *, describes_fault: bool = False
) -> list[Range]:
    """Range of a quantity over all records, or those of the classes if they differ or it describes the fault.

    Values that are not finite are left out, and of a quantity that describes the fault also the classes in which all values are 0.
    Classes with the same range share a row.
    """
    known = np.isfinite(values)
    values, groups = values[known], Groups(*(numbers[known] for numbers in groups))
    by_class = {code: values[groups.fault == code] for code in FAULT_NAMES if (groups.fault == code).any()}
    if describes_fault:
        by_class = {code: of_class for code, of_class in by_class.items() if of_class.any()}
    elif not _differ(by_class, values, groups):
        by_class = {}
    classes_of: dict[tuple[float, ...], list[str]] = {}
    for code, of_class in by_class.items():
        classes_of.setdefault(_extent(of_class), []).append(FAULT_NAMES[code])
    if len(classes_of) < 2 and not describes_fault:
        classes_of = {_extent(values): ["all"]}
    return [Range(name, unit, ", ".join(classes), *extent) for extent, classes in classes_of.items()]


def _differ(by_class: Mapping[int, FloatArray], values: FloatArray, groups: Groups) -> bool:
    """Whether the median of a class lies outside the middle half of the values of all other classes.

    Records of a specimen have much in common, so classes with few specimens differ by chance and are not compared.
    """
    for code, of_class in by_class.items():
        here = groups.fault == code
        if min(np.unique(groups.specimen[side]).size for side in (here, ~here)) >= FEWEST:
            low, high = np.quantile(values[~here], (0.25, 0.75))
            if not low <= np.median(of_class) <= high:
                return True
    return False


def _extent(values: FloatArray) -> tuple[float, float, float]:
    return float(values.min()), float(np.median(values)), float(values.max())


def drawn_ranges(corpus: xr.Dataset, recipe: str | None) -> tuple[list[Range], int]:
    """Ranges of the drawn quantities that vary, and the number of records they are taken from."""
    if DRAWS not in corpus:
        return [], 0
    chosen = some_records(corpus.sizes["record"])
    values_of: defaultdict[str, list[float]] = defaultdict(list)
    places: defaultdict[str, list[int]] = defaultdict(list)
    last: dict[str, Any] = {}
    leaves: dict[str, list[tuple[str, float]]] = {}
    for start, stop in _runs(chosen):
        for record, text in enumerate(corpus[DRAWS][start:stop].values, start):
            for section, drawn in _sections(str(text)).items():
                if section not in last or last[section] != drawn:  # neighbours share their rig and specimen
                    last[section], leaves[section] = drawn, [*_leaves(drawn, section)]
                for path, value in leaves[section]:
                    values_of[path].append(value)
                    places[path].append(record)
    units = _units(recipe or "")
    groups = Groups(corpus["fault"].values, corpus["specimen"].values)
    rows: list[Range] = []
    for path, numbers in values_of.items():
        values, name = np.array(numbers), path.rpartition(".")[2]
        if values.min() < values.max() and name not in corpus:
            of_path = Groups(*(group[places[path]] for group in groups))
            unit = next((unit for end, unit in _UNITS.items() if path.endswith(end)), units.get(name, ""))
            rows += quantity_ranges(path, unit, values, of_path)
    order = ("rig", "specimen", "record")
    rows.sort(key=lambda row: [row.name.startswith(f"{section}.") for section in order], reverse=True)
    return rows, len(chosen)


def some_records(n_records: int) -> IntArray:
    """Numbers of at most ``MOST_DRAWS`` records: all, or runs of consecutive ones whose starts are drawn at random."""
    if n_records <= MOST_DRAWS:
        return np.arange(n_records)
    starts = np.random.default_rng(0).choice(n_records // _RUN, MOST_DRAWS // _RUN, replace=False)
    return (np.sort(starts)[:, None] * _RUN + np.arange(_RUN)).ravel()


def _runs(numbers: IntArray) -> Iterator[tuple[int, int]]:
    """First number, and one past the last, of each run of consecutive numbers."""
    for run in np.split(numbers, np.flatnonzero(np.diff(numbers) != 1) + 1):
        yield int(run[0]), int(run[-1]) + 1


def _sections(text: str) -> dict[str, Any]:
    """Sections of the draws of a record: rig, specimen and record; none in a text that is no JSON."""
    try:
        sections = json.loads(text)
    except (ValueError, RecursionError):  # a corpus from elsewhere
        return {}
    return (
        {name: drawn for name, drawn in sections.items() if name not in _NOT_DRAWN}
        if isinstance(sections, dict)
        else {}
    )


def _leaves(value: Any, path: str) -> Iterator[tuple[str, float]]:
    """Finite numbers with their places; entries of a list of sections share a place, plain lists are left out."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key not in _NOT_DRAWN:
                yield from _leaves(inner, f"{path}.{key}")
    elif isinstance(value, list):
        for inner in value:
            if isinstance(inner, dict):
                yield from _leaves(inner, path)
    elif isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _LARGEST:
        yield path, float(value)


def _units(recipe: str) -> dict[str, str]:
    """Units of drawn values by name, from the keys of a recipe: ``shaft_mass_kg`` tells that ``shaft_mass`` is in kg."""
    units: dict[str, str] = {}
    for key in re.findall(r"(\w+)\s*:", recipe):
        suffix = unit_suffix(key)
        units.setdefault(key.removesuffix(f"_{suffix}"), SI_SYMBOLS[suffix] if suffix else "1")
    return units
