"""Records made in memory, as one xarray Dataset: from keys, or from scenarios made by hand.

The Dataset has the variables of a corpus and carries its recipe, so that :func:`gen.write_corpus` makes a corpus of it. Records are drawn,
simulated and measured as :func:`gen.generate` does it, so the same recipe gives the same records either way.
"""

import json
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from gen.corpus import DRAWS
from gen.errors import CorpusError, RecipeError, SimulationError
from gen.families import made_from
from gen.making import Crew, MadePart, made_parts
from gen.part_task import dataset_of, part_attributes
from gen.recipe import Recipe, plain, recipe_for
from gen.recipe.keywords import FaultLike
from gen.scenarios import Scenario, check_fits, read_scenario, scenario_texts

RECIPE, SCENARIOS = "recipe", "scenarios"  # attributes of a Dataset of records
GIVEN = "given"  # value of the attribute SCENARIOS for scenarios that were not drawn from the recipe


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
    recipe = recipe_for(fault, **{"name": "record", **keys})
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
        Number of threads.
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
    return _made(recipe_for(fault, n, **keys), workers)


def simulate_scenarios(scenarios: Sequence[Scenario], recipe: Recipe) -> xr.Dataset:
    """Records of scenarios made by hand, such as drawn ones changed with :func:`dataclasses.replace`.

    Parameters
    ----------
    scenarios : sequence of Scenario
        From :func:`gen.draw_scenarios`, :func:`gen.scenarios_of` or :func:`gen.stored_scenario`, changed or not. Random processes such as
        noise follow from the numbers of rig, specimen and record, so scenarios with the same numbers have the same noise.
    recipe : Recipe
        Gives sample rate, duration, channels, converter and kind of level; its distributions are not drawn from.

    Returns
    -------
    Dataset
        As from :func:`gen.records`; :func:`gen.write_corpus` and :func:`gen.replay` take each record from its own scenario.

    Raises
    ------
    RecipeError
        If scenarios do not fit the recipe or each other.
    SimulationError
        If no record can be simulated.
    """
    scenarios = checked_scenarios(scenarios, recipe)
    rungs: dict[int, int] = {}
    for place, one in enumerate(scenarios):
        if one.record.pair >= 0 and one.record.rung <= rungs.get(one.record.pair, -1):
            raise RecipeError(
                f"scenarios[{place}]: rung {one.record.rung} of pair {one.record.pair} does not rise; sort them, each once."
            )
        rungs[one.record.pair] = one.record.rung  # the last, with the largest severity, sets the level of the pair
    dataset, failures = dataset_of(made_from(scenarios, recipe), recipe)
    dataset.attrs["history"] = dataset.attrs["history"].replace(
        "from recipe", "from given scenarios, with the settings of recipe"
    )
    return _decoded([dataset], recipe, failures, {SCENARIOS: GIVEN})


def recipe_of(dataset: xr.Dataset) -> Recipe:
    """Recipe that a Dataset of records was made from.

    Raises
    ------
    CorpusError
        If the Dataset carries none.
    """
    if not isinstance(dataset, xr.Dataset):
        raise CorpusError(
            f"{type(dataset).__name__} given in place of a Dataset; give one from gen.record or gen.records."
        )
    if RECIPE not in dataset.attrs:
        raise CorpusError(
            f"the Dataset has no attribute {RECIPE}; give one from gen.record, gen.records or gen.simulate_scenarios, with its attributes."
        )
    try:
        return Recipe(**json.loads(dataset.attrs[RECIPE]))
    except (ValueError, TypeError):
        raise CorpusError(
            f"the attribute {RECIPE} of the Dataset is not the JSON text of a recipe; make the records again."
        ) from None


def scenarios_of(dataset: xr.Dataset) -> list[Scenario]:
    """Scenario of each record of a Dataset, with every drawn value.

    Raises
    ------
    CorpusError
        If the Dataset has no scenarios.
    """
    if not isinstance(dataset, xr.Dataset) or DRAWS not in dataset:
        raise CorpusError(
            f"the Dataset has no variable {DRAWS}, so it holds no scenarios; give one from gen.record or gen.records."
        )
    return [read_scenario(str(text)) for text in np.atleast_1d(dataset[DRAWS].values)]


def checked_scenarios(scenarios: Sequence[Scenario], recipe: Recipe) -> list[Scenario]:
    """Scenarios as they are stored; RecipeError if one does not fit the recipe or another scenario."""
    if not isinstance(recipe, Recipe):
        raise RecipeError(f"recipe: {type(recipe).__name__} given; give a gen.Recipe, such as gen.read_recipe makes.")
    if not isinstance(scenarios, Sequence) or isinstance(scenarios, str | bytes):
        raise RecipeError(f"scenarios: {type(scenarios).__name__} given; give a list of scenarios.")
    rigs: dict[int, tuple[int, Any]] = {}
    found = []
    for place, scenario in enumerate(scenarios):
        try:
            found.append(read_scenario(scenario_texts([scenario])[0]))
        except (CorpusError, TypeError, AttributeError) as error:
            reason = str(error).removeprefix("stored scenario: ").partition("; ")[0]
            raise RecipeError(
                f"scenarios[{place}]: is no scenario ({reason}); change drawn ones with dataclasses.replace, in finite numbers and text."
            ) from None
        problem = _problem(found[-1], recipe)
        for spall in found[-1].specimen.spalls:
            check_fits(spall, found[-1].specimen.bearing, found[-1].specimen.number)
        first, rig = rigs.setdefault(scenario.rig.number, (place, found[-1].rig))
        if not problem and rig != found[-1].rig:
            problem = f"rig {rig.number} is not that of scenarios[{first}]; give another machine another number"
        if problem:
            raise RecipeError(f"scenarios[{place}]: {problem}.")
    if not found:
        raise RecipeError("scenarios: there are none; give at least one.")
    return found


def _problem(scenario: Scenario, recipe: Recipe) -> str | None:
    """Reason why a scenario does not fit the recipe, and what to do; None if it does."""
    channels, levelled = len(recipe.recording.channels), recipe.level.kind == "snr"
    if scenario.seed != recipe.seed:
        return f"seed {scenario.seed} is not that of the recipe, {recipe.seed}; give them the same seed"
    if len(scenario.rig.channels) != channels or len(scenario.rig.own_paths) != channels:
        return f"rig.channels and rig.own_paths need one entry for each of {channels} recording.channels of the recipe"
    if (scenario.record.snr is not None) != levelled or (scenario.record.rms is not None) != levelled:
        return (
            f"record.snr and record.rms must be {'given' if levelled else 'None'} with level.kind: {recipe.level.kind}"
        )
    if scenario.record.pair >= 0 and not 0 <= scenario.record.rung < recipe.corpus.n_rungs > 1:
        return "record.pair needs corpus.rungs in the recipe, and record.rung a place in it; or set both to -1"
    specimen = scenario.specimen
    if not 0 <= specimen.entry < len(recipe.faults):
        return f"specimen.entry {specimen.entry} is no place in faults of the recipe, which has {len(recipe.faults)}"
    parts = specimen.damaged_parts
    label = "compound" if len(parts) > 1 else (parts or ["healthy"])[0]
    if specimen.fault != label:
        return f"specimen.fault is {specimen.fault}, and the damage of the specimen is {label}; change one of the two"
    if any(spall.width <= 0 or spall.depth <= 0 for spall in specimen.spalls):
        return "specimen.spalls: width and depth of a spall must be above 0; leave out a spall that is not there"
    return None


def _made(recipe: Recipe, workers: int) -> xr.Dataset:
    """Records of a recipe, made in parts as those of a corpus."""

    def finished(made: MadePart) -> tuple[int, xr.Dataset, tuple[str, ...]]:
        return made.place, *dataset_of(made.records, recipe, made.step_error)

    size, stop = recipe.corpus.records_per_part, recipe.n_records
    numbers = [range(first, min(first + size, stop)) for first in range(0, stop, size)]
    parts = sorted(made_parts(recipe, numbers, finished, crew=Crew(workers)), key=lambda part: part[0])
    return _decoded([part for _, part, _ in parts], recipe, [text for *_, texts in parts for text in texts], {})


def _decoded(
    parts: list[xr.Dataset], recipe: Recipe, failures: Sequence[str], attributes: dict[str, str]
) -> xr.Dataset:
    """Records of all parts in m s-2, with their recipe."""
    dataset = parts[0] if len(parts) == 1 else xr.concat(parts, "record", data_vars="minimal", coords="minimal")
    if not dataset.sizes["record"]:
        raise SimulationError(failures[0])
    decoded = xr.decode_cf(dataset, decode_times=False).load()
    decoded.attrs |= {**part_attributes(recipe, failures), RECIPE: json.dumps(plain(recipe)), **attributes}
    if failures:
        left_out = f"{len(failures)} of {len(failures) + dataset.sizes['record']} records are left out"
        warnings.warn(f"{left_out}; the first: {failures[0]}", stacklevel=4)
    return decoded
