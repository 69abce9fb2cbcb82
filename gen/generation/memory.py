"""Records made in memory, as one xarray Dataset: from keys, or from scenarios made by hand.

The Dataset has the variables of a corpus, so that :func:`gen.write_corpus` makes a corpus of it. Records are drawn, simulated and measured
as :func:`gen.generate` does it, so the same recipe gives the same records either way.
"""

import json
import warnings
from collections.abc import Sequence
from functools import partial
from typing import Any

import xarray as xr

from gen.corpus import RECIPE_TEXT
from gen.generation.identity import failures_of, library_versions, part_attributes
from gen.generation.make_part import decoded, labelled, make_part
from gen.generation.undetected import made_from
from gen.recipe import Recipe, make_recipe, recipe_text
from gen.recipe.keywords import FaultLike
from gen.scenarios import Scenario
from gen.support.errors import RecipeError, SimulationError
from gen.support.executor import run


def record(fault: FaultLike | None = None, **keys: Any) -> xr.Dataset:
    """One record of a bearing, simulated in memory.

    Parameters
    ----------
    fault : section, dict or str
        From :func:`gen.healthy`, :func:`gen.inner`, :func:`gen.outer`, :func:`gen.ball`, :func:`gen.cage`, :func:`gen.distributed` or
        :func:`gen.compound`; or an entry of ``faults`` of a recipe.
    **keys
        Keys of a recipe by their own names, such as ``bearing="6205"``, ``shaft_rpm=1480``, ``load_n=500``, ``sample_rate_hz=25600``,
        ``duration_s=1``, ``seed=1``; or whole sections, such as ``machine={...}`` and ``channels=[...]``. Numbers can be distributions
        (:func:`gen.uniform`). Keys that are left out have the defaults of a recipe; bearing, speed, sample rate and duration then are
        6205, 1500 rpm, 25.6 kHz and 1 s.

    Returns
    -------
    Dataset
        ``acceleration (channel, elapsed_time)`` [m s-2], and one value of each variable of a corpus.

    Raises
    ------
    RecipeError
        If a key is unknown or a value is not allowed; one sentence for each of them.
    SimulationError
        If the record cannot be simulated.

    Examples
    --------
    >>> found = record(outer(width_mm=0.8), bearing="6205", shaft_rpm=1480)  # doctest: +SKIP
    >>> found.acceleration.plot()  # doctest: +SKIP
    """
    recipe = make_recipe(fault, **{"name": "record", **keys})
    if recipe.n_records != 1:
        raise RecipeError(
            f"the keys ask for {recipe.n_records} records; gen.record makes one, gen.records makes several."
        )
    return _made(recipe, 1).isel(record=0)


def records(
    fault: FaultLike | Sequence[FaultLike] | None = None, n: int | None = None, *, workers: int = 1, **keys: Any
) -> xr.Dataset:
    """Records of one or several faults, simulated in memory.

    Parameters
    ----------
    fault : section, dict, str or list of them
        One fault or several, as for :func:`gen.record`.
    n : int
        Number of records of each fault. Each record has a bearing (``specimen``) of its own in one machine (``rig``), unless ``keys``
        give ``rigs``, ``specimens_per_rig``, ``records_per_specimen`` or ``rungs``. The faults take turns.
    workers : int
        Number of processes that make parts; 1 is this one.
    **keys
        Keys of a recipe, as for :func:`gen.record`.

    Returns
    -------
    Dataset
        ``acceleration (record, channel, elapsed_time)`` [m s-2], and the variables of a corpus, shape (record,). A record that cannot be
        simulated is left out with a warning.

    Raises
    ------
    RecipeError
        If a key is unknown or a value is not allowed; one sentence for each of them.
    SimulationError
        If no record can be simulated.
    """
    if type(workers) is not int or workers < 1:
        raise RecipeError(f"workers: {workers!r} is not allowed; use 1 or more.")
    return _made(make_recipe(fault, n, **keys), workers)


def simulate(scenarios: Sequence[Scenario]) -> xr.Dataset:
    """Simulate records of scenarios, such as drawn ones changed by their methods.

    Parameters
    ----------
    scenarios : sequence of Scenario
        From :func:`gen.draw_scenarios` or :func:`gen.read_scenarios`, changed or not: ``without_fault()``, ``at_severity(0.5)``,
        ``with_(operation={"shaft_rpm": 1200})``. Random processes such as noise follow from the numbers of their ``origin``, so scenarios
        with the same numbers have the same noise. In a pair or ladder with a drawn ratio, the one of the largest severity sets the
        level; a stored scenario has that level already.

    Returns
    -------
    Dataset
        As from :func:`gen.records`, without a recipe; each record has its scenario.

    Raises
    ------
    RecipeError
        If these are no scenarios.
    SimulationError
        If scenarios have different recordings, or no record can be simulated.
    """
    wrong = (
        [scenarios] if not isinstance(scenarios, Sequence) else [of for of in scenarios if not isinstance(of, Scenario)]
    )
    if wrong:
        raise RecipeError(f"scenarios: {type(wrong[0]).__name__} given; give a list of scenarios.")
    outcomes = made_from([*scenarios])
    part = labelled(scenarios[0].recipe, outcomes)
    return _joined(
        [part],
        failures_of(part),
        {"versions": json.dumps(library_versions(*(scenario.recipe for scenario in scenarios)))},
    )


def _made(recipe: Recipe, workers: int) -> xr.Dataset:
    """Records of a recipe, made in parts as those of a corpus."""
    numbers = list(map(recipe.records_of_part, range(recipe.n_parts)))
    parts = list(run(partial(make_part, recipe), numbers, min(workers, len(numbers))))
    failures = [sentence for part in parts for sentence in failures_of(part)]
    count = sum(part.sizes["record"] for part in parts)
    attributes = part_attributes(recipe, failures) | {RECIPE_TEXT: recipe_text(recipe), "records": str(count)}
    return _joined(parts, failures, attributes)


def _joined(parts: list[xr.Dataset], failures: Sequence[str], attributes: dict[str, str]) -> xr.Dataset:
    """Records of all parts in m s-2; SimulationError if there is none."""
    records = decoded(parts)
    if not records.sizes["record"]:
        raise SimulationError(failures[0])
    if failures:
        left_out = f"{len(failures)} of {len(failures) + records.sizes['record']} records are left out"
        warnings.warn(f"{left_out}; the first: {failures[0]}", stacklevel=4)
    return records.assign_attrs(attributes)
