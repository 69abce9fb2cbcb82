"""Scenarios integrated: accelerations of the bodies, and what is true of each record."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gen.physics.inputs import KernelInput
from gen.physics.kernel.batch import lay_out
from gen.physics.kernel.layout import Batch
from gen.recipe import Recipe
from gen.scenarios import Scenario
from gen.simulation.batches import Group, batches, group_of, integrate_all
from gen.simulation.inputs import kernel_inputs, without_fault
from gen.simulation.steps import checked_places, failure, step_phase, steps_per_sample
from gen.simulation.timeline import timeline
from gen.simulation.truth import Truth, lines_of_faults, truth_of, with_loaded_hits

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Twins:
    """The same records without their faults."""

    acceleration: NDArray[np.float32]
    """Shape (record, channel, time); of a record without a fault its own [m s-2]."""
    orders: list[tuple[float, ...]]
    """Orders at which the faults of each record repeat [1]."""


@dataclass(frozen=True)
class Response:
    """Motion of the bodies that the channels measure, from the lead ahead of the record to its end, and its truth."""

    acceleration: NDArray[np.float32]
    """Shape (record, channel, time), NaN where a record or its twin diverged [m s-2]."""
    oversampling: NDArray[np.int64]
    """Steps per sample, shape (record,)."""
    step_phase: FloatArray
    """Fastest angular frequency at the largest contact stiffness of a record, times the step, shape (record,) [rad]."""
    failures: dict[int, str]
    """A sentence for each record that is not possible or diverged, by its place among the scenarios."""
    inputs: list[KernelInput | None]
    """Kernel input of each record, None for a record that is not possible."""
    truth: list[Truth]
    twins: Twins | None
    """None with ``corpus.truth: none``."""


def simulate(
    scenarios: list[Scenario],
    recipe: Recipe,
    *,
    report: Callable[[int], None] = lambda _: None,
    known_twins: Mapping[int, NDArray[np.float32]] | None = None,
) -> Response:
    """Integrate scenarios.

    Parameters
    ----------
    scenarios : list of Scenario
        Records to simulate.
    recipe : Recipe
        Gives sample rate, duration and settling time.
    report : callable, optional
        Called after each batch with the number of records integrated so far.
    known_twins : mapping, optional
        Accelerations of records without their faults that are known already, by place, each of shape (channel, time) [m s-2].

    Returns
    -------
    Response
        One row per scenario.

    Raises
    ------
    SimulationError
        Before anything runs, if a step would be too coarse for the stiffest mode of a scenario, or for its shaft.
    """
    axis = timeline(recipe)
    inputs, failures = kernel_inputs(scenarios, axis)
    given = {place: some for place, some in enumerate(inputs) if some is not None}
    steps = {place: steps_per_sample(some, scenarios[place].record.number, recipe) for place, some in given.items()}
    known_twins = known_twins or {}
    healthy = _healthy_inputs(
        scenarios, {place: some for place, some in given.items() if place not in known_twins}, recipe
    )
    twin_rows = {place: row for row, place in enumerate(healthy, len(given))}
    every, of_steps = [*given.values(), *healthy.values()], [*steps.values(), *(steps[place] for place in healthy)]
    made = integrate_all(every, of_steps, axis, lambda done: report(done * len(given) // len(every)))
    acceleration = np.full((len(scenarios), len(recipe.recording.channels), axis.returned), np.nan, np.float32)
    oversampling, phases = np.zeros(len(scenarios), np.int64), np.full(len(scenarios), np.nan)
    for row, (place, some) in enumerate(given.items()):
        oversampling[place] = steps[place]
        phases[place] = step_phase(some, made.steepest[row], steps[place], axis.fs)
        # with its twin: if that diverged, what the fault adds is not known
        diverged = made.diverged[[row, twin_rows.get(place, row)]].max() / axis.fs
        sentence = failure(scenarios[place].record.number, steps[place], diverged, phases[place])
        if sentence is None:
            acceleration[place] = made.response[row]
        else:
            failures[place] = sentence
    truth = [truth_of(scenario, axis, some) for scenario, some in zip(scenarios, inputs, strict=True)]
    twins = None
    if recipe.corpus.truth == "full":
        truth = with_loaded_hits(truth, inputs, axis)
        orders = [lines_of_faults(scenario, known.orders) for scenario, known in zip(scenarios, truth, strict=True)]
        twins = Twins(acceleration.copy(), orders)
        for place, row in twin_rows.items():
            if place not in failures:
                twins.acceleration[place] = made.response[row]
        for place, alone in known_twins.items():
            if place not in failures:
                twins.acceleration[place] = alone
    return Response(acceleration, oversampling, phases, failures, inputs, truth, twins)


def integrations(scenarios: Iterable[Scenario], recipe: Recipe) -> int:
    """Number of integrations that records need: one, or two for a record that is also simulated without its fault."""
    twice = recipe.corpus.truth == "full"
    return sum(2 if twice and scenario.specimen.fault != "healthy" else 1 for scenario in scenarios)


def _healthy_inputs(
    scenarios: list[Scenario], given: Mapping[int, KernelInput], recipe: Recipe
) -> dict[int, KernelInput]:
    """Kernel inputs of the records with a fault, as they were without it, by place; none with ``corpus.truth: none``.

    They take the steps of the records with the fault, so the difference of the two is due to the fault alone.
    """
    if recipe.corpus.truth == "none":
        return {}
    healthy = {}
    for place, some in given.items():
        specimen = scenarios[place].specimen
        if specimen.wear is not None or specimen.cage or specimen.axis.get("jumps"):
            healthy[place] = without_fault(some, scenarios[place], timeline(recipe))
        elif specimen.fault != "healthy":  # spalls are the only difference
            healthy[place] = some._replace(spalls=())
    return healthy


def step_errors(scenarios: list[Scenario], recipe: Recipe, response: Response) -> FloatArray:
    """Relative rms change of some records of a part when their step is halved, NaN for the others, shape (record,)."""
    errors, axis = np.full(len(scenarios), np.nan), timeline(recipe)
    usable = {place: some for place, some in enumerate(response.inputs) if some and place not in response.failures}
    groups = {place: group_of(some, int(response.oversampling[place])) for place, some in usable.items()}
    tried = checked_places(scenarios, recipe, groups)
    if not tried:
        return errors
    finer = integrate_all([usable[place] for place in tried], [2 * groups[place].steps for place in tried], axis)
    coarse, halved = response.acceleration[tried][..., axis.kept], finer.response[..., axis.kept]
    change, whole = (np.sum(some**2, axis=(1, 2), dtype=np.float64) for some in (coarse - halved, halved))
    errors[tried] = np.sqrt(change / whole)
    return errors


def laid_out(scenarios: list[Scenario], recipe: Recipe) -> list[tuple[Group, Batch]]:
    """Scenarios in lanes, batch by batch, as :func:`simulate` integrates them; all must be possible."""
    axis = timeline(recipe)
    given = {place: some for place, some in enumerate(kernel_inputs(scenarios, axis)[0]) if some is not None}
    steps = {place: steps_per_sample(some, scenarios[place].record.number, recipe) for place, some in given.items()}
    healthy = _healthy_inputs(scenarios, given, recipe)
    inputs = [*given.values(), *healthy.values()]
    places = [*given, *healthy]
    groups = {row: group_of(some, steps[place]) for row, (some, place) in enumerate(zip(inputs, places, strict=True))}
    return [
        (group, lay_out([inputs[row] for row in rows], group.shape, 1 / axis.fs)) for group, rows in batches(groups)
    ]
