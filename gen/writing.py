"""A Dataset of records, as :mod:`gen.in_memory` makes it, written as a corpus.

The corpus is like one that :func:`gen.generate` made: with its recipe, so that every record can be made again. What cannot be made again
is refused: records that were changed, cut in time, or joined from several recipes.
"""

import json
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import (
    SCHEMA,
    SIGNAL,
    SIMULATED,
    Variable,
    check_name,
    finish_corpus,
    make_dataset,
    part_name,
    temporary_beside,
    write_part,
    write_text_durably,
)
from gen.errors import CorpusError, RecipeError
from gen.generation import facts_of
from gen.in_memory import GIVEN, SCENARIOS, checked_scenarios, recipe_of, scenarios_of
from gen.measurement.measure import LARGEST_COUNT
from gen.part_task import part_attributes
from gen.recipe import Recipe, recipe_text
from gen.scenarios import Scenario, draw_scenarios, with_level

_NOT_A_COUNT = 0.01  # largest distance of a decoded sample from a count; single precision comes within 0.004


def write_corpus(dataset: xr.Dataset, directory: Path | str) -> Path:
    """Write records made in memory as a corpus.

    Parameters
    ----------
    dataset : Dataset
        From :func:`gen.record`, :func:`gen.records` or :func:`gen.simulate_scenarios`: whole, some records of it in any order, or several
        Datasets of the same recipe joined with :func:`xarray.concat`. Variables of shape (record,) can be added, with the attributes
        ``long_name`` and ``role``.
    directory : path
        Folder of the corpus: new, or empty.

    Returns
    -------
    Path
        The folder. It is there as a whole or not at all.

    Raises
    ------
    CorpusError
        If the folder is not empty or cannot be written; if the signal was changed or cut, a record occurs twice, or records do not come
        from the recipe that the Dataset carries.
    """
    directory = Path(directory).absolute()
    check_name(directory)
    if directory.is_symlink() or (directory.exists() and not (directory.is_dir() and not any(directory.iterdir()))):
        raise CorpusError(f"{directory}: is there already; choose another folder, or remove it first.")
    recipe = recipe_of(dataset)
    given = dataset.attrs.get(SCENARIOS) == GIVEN
    rows = dataset if "record" in dataset.dims else _as_one_row(dataset)
    _check_scenarios(rows, recipe, given)
    failures = tuple(json.loads(rows.attrs.get("failures", "[]")))
    whole = not given and rows.sizes["record"] + len(failures) == recipe.n_records
    failures = failures if whole or given else ()  # those of a choice may belong to records that were not chosen
    stored = _stored(rows, recipe)
    stored.attrs |= part_attributes(recipe, failures)
    facts = {"failures": failures} | facts_of(recipe, {"seed": None, "records": None})
    facts["publication"] = recipe.publication.dated()
    if not whole:
        facts["scenarios"] = GIVEN if given else "chosen"
    _write(stored, recipe, directory, facts)
    return directory


def _write(stored: xr.Dataset, recipe: Recipe, directory: Path, facts: dict[str, Any]) -> None:
    """Write all files of the corpus into a temporary folder, which then gets its name."""
    size = recipe.corpus.records_per_part
    try:
        directory.parent.mkdir(parents=True, exist_ok=True)
        with temporary_beside(directory) as folder:
            (folder / "parts").mkdir(parents=True)
            write_text_durably(recipe_text(recipe), folder / "recipe.yaml")
            rows = [
                write_part(
                    stored.isel(record=slice(first, first + size)),
                    folder / "parts" / part_name(first // size),
                    recipe.corpus.codec,
                )
                for first in range(0, stored.sizes["record"], size)
            ]
            finish_corpus(folder, rows, **facts)
            folder.replace(directory)
    except OSError as error:
        raise CorpusError(
            f"{directory}: cannot be written ({error.strerror or error}); choose another folder."
        ) from None


def _as_one_row(record: xr.Dataset) -> xr.Dataset:
    """A single record with the axis of records."""
    axes = {"channel", "elapsed_time"}
    columns = {
        name: (("record", *found.dims), found.values[np.newaxis], found.attrs)
        for name, found in record.variables.items()
        if name not in axes
    }
    return xr.Dataset(columns, {name: record.variables[name] for name in axes}, record.attrs)


def _check_scenarios(rows: xr.Dataset, recipe: Recipe, given: bool) -> None:
    """Refuse records that cannot be made again from the recipe, or from their own scenarios if these were given."""
    if not rows.sizes["record"]:
        raise CorpusError("the Dataset has no record; give at least one.")
    scenarios = scenarios_of(rows)
    if given:
        try:
            checked_scenarios(scenarios, recipe)
        except RecipeError as error:
            raise CorpusError(f"{error} Write records of one call of gen.simulate_scenarios.") from None
        highest = {one.record.pair: one.record.rung for one in sorted(scenarios, key=lambda one: one.record.rung)}
        cut = next((pair for pair, rung in highest.items() if pair >= 0 and rung != recipe.corpus.n_rungs - 1), None)
        if cut is not None:
            raise CorpusError(f"the record with the largest severity of pair {cut} is missing; write pairs whole.")
        return
    numbers = [scenario.record.number for scenario in scenarios]
    tries = {one.specimen.number: one.specimen.fault_try for one in scenarios}
    drawn = {number: one for numbers in _runs(numbers, recipe) for number, one in _drawn(recipe, numbers, tries)}
    levelled = [
        with_level(drawn[n], recipe, one.record.level_try)
        for n, one in zip(numbers, scenarios, strict=True)
        if n in drawn
    ]
    if levelled != scenarios:
        raise CorpusError(
            "the Dataset has records that were not drawn from its recipe; write the records of each recipe on their own and join the "
            "corpora with gen.merge."
        )
    twice = next((number for number, count in Counter(numbers).items() if count > 1), None)
    if twice is not None:
        raise CorpusError(f"record {twice} is in the Dataset twice; give it once.")


def _drawn(recipe: Recipe, numbers: range, tries: dict[int, int]) -> list[tuple[int, Scenario]]:
    return list(zip(numbers, draw_scenarios(recipe, numbers.start, numbers.stop, fault_tries=tries), strict=True))


def _runs(numbers: list[int], recipe: Recipe) -> list[range]:
    """Ranges of consecutive records of a recipe.

    >>> from gen import read_recipe
    >>> _runs([5, 2, 3], read_recipe("quickstart"))
    [range(2, 4), range(5, 6)]
    """
    runs: list[range] = []
    for number in sorted({number for number in numbers if 0 <= number < recipe.n_records}):
        first = runs.pop().start if runs and runs[-1].stop == number else number
        runs.append(range(first, number + 1))
    return runs


def _stored(rows: xr.Dataset, recipe: Recipe) -> xr.Dataset:
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
    signal, counts_per_unit = _counts(rows, recipe)
    return make_dataset(
        signal,
        recipe.recording.sample_rate_hz,
        tuple(channel.name for channel in recipe.recording.channels),
        {variable.name: rows[variable.name].values for variable in (*known, *further)},
        extra=(*SIMULATED, *sorted(further)),
        counts_per_unit=counts_per_unit,
        attributes={key: rows.attrs[key] for key in ("title", "history", "source") if key in rows.attrs},
    )


def _counts(rows: xr.Dataset, recipe: Recipe) -> tuple[NDArray[Any], float | None]:
    """Counts of the converter, or accelerations without one, shape (record, channel, elapsed_time); and the counts per m s-2."""
    channels = [channel.name for channel in recipe.recording.channels]
    signal = rows[SIGNAL].transpose("record", "channel", "elapsed_time")
    if signal.shape[1:] != (len(channels), recipe.n_samples) or list(rows["channel"].values) != channels:
        raise CorpusError(
            f"{SIGNAL} has channels {', '.join(map(str, rows['channel'].values))} and {signal.shape[2]} samples, the recipe "
            f"{', '.join(channels)} and {recipe.n_samples}; write records with all of their channels and samples."
        )
    converter = recipe.recording.converter
    if converter.kind == "float32":
        return np.asarray(signal.values, np.float32), None
    counts_per_unit = LARGEST_COUNT / converter.full_scale_m_s2
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
