"""A Dataset of records, as :mod:`gen.generation.memory` makes it, written as a corpus.

Each record is replayed from the scenario that it stores, so any records of one form can be written together: some of a recipe, changed by
hand, or of several recipes. All records of one recipe give the corpus that :func:`gen.generate` makes, with its recipe.
"""

import json
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import (
    DRAWS,
    IDENTITY,
    RECIPE_TEXT,
    SCHEMA,
    SIGNAL,
    SIMULATED,
    NewCorpus,
    Variable,
    check_new,
    make_dataset,
    new_corpus,
)
from gen.corpus.joining import new_numbers
from gen.generation.corpus import facts_of
from gen.generation.parts import part_attributes
from gen.measurement.measure import LARGEST_COUNT
from gen.recipe import Recipe, corpus_identity, read_recipe, recipe_text
from gen.scenarios import Settings, read_scenarios
from gen.support.errors import CorpusError

_PART_RECORDS = 256
_NOT_A_COUNT = 0.01  # largest distance of a decoded sample from a count; single precision comes within 0.004
_ONE_FORM = ("sample_rate", "samples", "channels", "full_scale")


def write_corpus(dataset: xr.Dataset, target: Path | str) -> Path:
    """Write records made in memory as a corpus.

    Parameters
    ----------
    dataset : Dataset
        Records with the scenarios that they were simulated from, in any order: from :func:`gen.record`, :func:`gen.records` or
        :func:`gen.simulate`, whole or chosen, or several such Datasets joined with :func:`xarray.concat`. Variables of shape
        (record,) can be added, with the attributes ``long_name`` and ``role``.
    target : path
        New corpus: a file if the name ends in ``.nc``, else a folder that is empty or does not exist.

    Returns
    -------
    Path
        The corpus. It is there as a whole or not at all.

    Raises
    ------
    CorpusError
        If the target exists or cannot be written; if the signal was changed or cut, a record occurs twice, or records have another
        sample rate, length, channels or converter than others.
    """
    target = Path(target).absolute()
    check_new(target)
    if not isinstance(dataset, xr.Dataset):
        raise CorpusError(f"{type(dataset).__name__} given in place of a Dataset; give one from gen.records.")
    rows = dataset if "record" in dataset.dims else _as_one_row(dataset)
    stored = _stored(rows, _form_of(rows))
    recipe = _whole_recipe(rows)
    if recipe is None:
        versions = json.loads(rows.attrs["versions"]) if "versions" in rows.attrs else {}
        made_by = {"title": stored.attrs["title"], "recipe": ", ".join(_recipes(rows)), "versions": versions}
        with new_corpus(target, **made_by) as corpus:
            _write_parts(stored, corpus, _PART_RECORDS)
        return target
    failures = tuple(json.loads(rows.attrs["failures"]))
    stored.attrs |= part_attributes(recipe, failures)
    facts = facts_of(recipe, {"seed": None, "records": None})
    facts |= {"publication": recipe.publication.dated(), "failures": failures}
    with new_corpus(target, codec=recipe.storage.codec, recipe_text=recipe_text(recipe), **facts) as corpus:
        _write_parts(stored, corpus, recipe.storage.records_per_part)
    return target


def _write_parts(stored: xr.Dataset, corpus: NewCorpus, size: int) -> None:
    for first in range(0, stored.sizes["record"], size):
        corpus.write(stored.isel(record=slice(first, first + size)))


def _recipes(rows: xr.Dataset) -> list[str]:
    """Names of the recipes of the records."""
    return list(dict.fromkeys(scenario.settings.recipe for scenario in read_scenarios(rows)))


def _as_one_row(record: xr.Dataset) -> xr.Dataset:
    """A single record with the axis of records."""
    axes = {"channel", "elapsed_time"}
    columns = {
        name: (("record", *found.dims), found.values[np.newaxis], found.attrs)
        for name, found in record.variables.items()
        if name not in axes
    }
    return xr.Dataset(columns, {name: record.variables[name] for name in axes}, record.attrs)


def _form_of(rows: xr.Dataset) -> Settings:
    """Settings of the first record; of all others, those that fix the form of a file are the same."""
    if not rows.sizes["record"]:
        raise CorpusError("the Dataset has no record; give at least one.")
    first, *others = (scenario.settings for scenario in read_scenarios(rows))
    for place, settings in enumerate(others, start=1):
        changed = next((name for name in _ONE_FORM if getattr(settings, name) != getattr(first, name)), None)
        if changed is not None:
            raise CorpusError(
                f"record {place} of the Dataset has {changed} {getattr(settings, changed)}, and record 0 has {getattr(first, changed)}; "
                "write each kind as a corpus of its own."
            )
    return first


def _whole_recipe(rows: xr.Dataset) -> Recipe | None:
    """Recipe that a Dataset carries, if its records are all those of the recipe in their order; else None."""
    if RECIPE_TEXT not in rows.attrs:
        return None
    recipe = read_recipe(rows)
    corpora = {str(text).partition("/")[0] for text in rows[IDENTITY].values}
    ascending = bool((np.diff(rows["recording"].values) > 0).all())
    count = rows.sizes["record"] + len(json.loads(rows.attrs.get("failures", "[]")))
    whole = ascending and count == recipe.n_records and corpora == {corpus_identity(recipe)}
    return recipe if whole else None


def _stored(rows: xr.Dataset, settings: Settings) -> xr.Dataset:
    """The records in the layout of the corpus (undecoded)."""
    known = SCHEMA + SIMULATED
    missing = next((variable.name for variable in known if variable.name not in rows.variables), None)
    if missing is not None:
        raise CorpusError(f"the Dataset has no variable {missing}; keep all that gen.records gives.")
    names = {variable.name for variable in known}
    further = []
    for name in set(rows.variables) - names - {SIGNAL, "channel", "elapsed_time"}:
        found = rows[name]
        if found.dims != ("record",) or "long_name" not in found.attrs or "role" not in found.attrs:
            raise CorpusError(
                f"{name}: needs one value for each record and the attributes long_name and role; add them, or drop it."
            )
        kind = "str" if found.dtype.kind in "OU" else found.dtype.str[1:]
        further.append(
            Variable(str(name), kind, found.attrs.get("units", "1"), found.attrs["role"], found.attrs["long_name"])
        )
    twice = next((text for text, count in Counter(rows[DRAWS].values.tolist()).items() if count > 1), None)
    if twice is not None:
        first, second, *_ = np.flatnonzero(rows[DRAWS].values == twice)
        raise CorpusError(f"records {first} and {second} of the Dataset have the same scenario; give each record once.")
    signal, counts_per_unit = _counts(rows, settings)
    return make_dataset(
        signal,
        settings.sample_rate,
        settings.channels,
        {variable.name: rows[variable.name].values for variable in (*known, *further)}
        | new_numbers([str(text) for text in rows[IDENTITY].values]),
        extra=(*SIMULATED, *sorted(further)),
        counts_per_unit=counts_per_unit,
        attributes={"title": f"Records of recipe {settings.recipe}"}
        | {key: rows.attrs[key] for key in ("title", "history", "source") if key in rows.attrs},
    )


def _counts(rows: xr.Dataset, settings: Settings) -> tuple[NDArray[Any], float | None]:
    """Counts of the converter, or accelerations without one, shape (record, channel, elapsed_time); and the counts per m s-2."""
    channels = list(settings.channels)
    signal = rows[SIGNAL].transpose("record", "channel", "elapsed_time")
    if signal.shape[1:] != (len(channels), settings.samples) or list(rows["channel"].values) != channels:
        raise CorpusError(
            f"{SIGNAL} has channels {', '.join(map(str, rows['channel'].values))} and {signal.shape[2]} samples, the records "
            f"{', '.join(channels)} and {settings.samples}; write records with all of their channels and samples."
        )
    if settings.full_scale is None:
        return np.asarray(signal.values, np.float32), None
    counts_per_unit = LARGEST_COUNT / settings.full_scale
    counts = np.empty(signal.shape, np.int16)
    for place, values in enumerate(
        signal.values
    ):  # one record at a time: in double precision all would take four times their memory
        exact = values.astype(np.float64) * counts_per_unit
        rounded = np.rint(exact)
        if not np.abs(exact - rounded).max() <= _NOT_A_COUNT or np.abs(rounded).max() > LARGEST_COUNT:
            raise CorpusError(
                f"{SIGNAL} of record {place} is not as the converter gave it; write records before you filter, scale or correct them."
            )
        counts[place] = rounded
    return counts, counts_per_unit
