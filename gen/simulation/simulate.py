"""Scenarios integrated: accelerations of the bodies, and what is true of each record."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.errors import SimulationError
from gen.physics.inputs import KernelInput
from gen.physics.kernel.batch import lay_out
from gen.physics.kernel.decimate import decimation
from gen.physics.kernel.integrate import integrate
from gen.physics.kernel.layout import Batch
from gen.recipe import Recipe
from gen.scenarios import Scenario
from gen.simulation.batches import Group, Integration, batches, group_of, integrate_all
from gen.simulation.inputs import kernel_input
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


class Run(NamedTuple):
    """A scenario with the integrations that it needs."""

    scenario: Scenario
    given: KernelInput | None
    """None if no such machine is possible."""
    impossible: str
    """Why it is not possible, else empty."""
    own: Integration | None
    """None if no such machine is possible."""
    twin: Integration | None
    """Without the fault; None for a record without a fault, and with ``corpus.truth: none``."""


def simulate(scenarios: list[Scenario], recipe: Recipe, *, report: Callable[[int], None] = lambda _: None) -> Response:
    """Integrate scenarios.

    Parameters
    ----------
    scenarios : list of Scenario
        Records to simulate.
    recipe : Recipe
        Gives sample rate, duration and settling time.
    report : callable, optional
        Called after each batch with the number of records integrated so far.

    Returns
    -------
    Response
        One row per scenario.

    Raises
    ------
    SimulationError
        Before anything runs, if a step would be too coarse for the stiffest mode of a scenario, or for its shaft.
    """
    runs = runs_of(scenarios, recipe)
    wanted = [one for run in runs for one in (run.own, run.twin) if one is not None]
    integrate_all(wanted, timeline(recipe), lambda done: report(done * len(scenarios) // len(wanted)))
    return response_of(runs, recipe)


def runs_of(
    scenarios: list[Scenario], recipe: Recipe, known_twins: Mapping[int, Integration] | None = None
) -> list[Run]:
    """Integrations that scenarios need; ``known_twins`` are records without their faults that were integrated before, by number.

    Raises
    ------
    SimulationError
        If a step would be too coarse for the stiffest mode of a scenario, or for its shaft.
    """
    known_twins, runs = known_twins or {}, []
    inputs, failures = possible_inputs(scenarios, recipe)
    for place, (scenario, given) in enumerate(zip(scenarios, inputs, strict=True)):
        number = scenario.record.number
        if given is None:
            runs.append(Run(scenario, None, failures[place], None, None))
            continue
        steps = steps_per_sample(given, number, recipe)
        twin = known_twins.get(number)
        if twin is None:
            healthy = _healthy_input(scenario, given, recipe)
            # it takes the step of the record with the fault, so the difference of the two is due to the fault alone
            twin = None if healthy is None else Integration(number, healthy, group_of(healthy, steps))
        runs.append(Run(scenario, given, "", Integration(number, given, group_of(given, steps)), twin))
    return runs


def response_of(runs: Sequence[Run], recipe: Recipe) -> Response:
    """Response and truth of scenarios that have been integrated."""
    axis, full = timeline(recipe), recipe.corpus.truth == "full"
    acceleration = np.empty((len(runs), len(recipe.recording.channels), axis.returned), np.float32)
    healthy = np.empty_like(acceleration) if full else acceleration
    oversampling, phases, failures = np.zeros(len(runs), np.int64), np.full(len(runs), np.nan), {}
    for place, run in enumerate(runs):
        sentence = run.impossible
        if run.own is not None and run.given is not None:
            steps = oversampling[place] = run.own.group.steps
            phases[place] = step_phase(run.given, run.own.steepest, steps, axis.fs)
            # with its twin: if that diverged, what the fault adds is not known
            diverged = max(one.diverged for one in (run.own, run.twin) if one is not None) / axis.fs
            sentence = failure(run.scenario.record.number, steps, diverged, phases[place])
        if sentence:
            failures[place] = sentence
        acceleration[place] = np.nan if sentence else _motion(run.own)
        if full:
            healthy[place] = acceleration[place] if sentence or run.twin is None else _motion(run.twin)
    truth, inputs = [truth_of(run.scenario, axis, run.given) for run in runs], [run.given for run in runs]
    twins = None
    if full:
        truth = with_loaded_hits(truth, inputs, axis)
        twins = Twins(
            healthy, [lines_of_faults(run.scenario, one.orders) for run, one in zip(runs, truth, strict=True)]
        )
    return Response(acceleration, oversampling, phases, failures, inputs, truth, twins)


def _motion(of: Integration | None) -> NDArray[np.float32]:
    """Response of a record that has been integrated, shape (channel, time) [m s-2]."""
    assert of is not None and of.response is not None  # noqa: S101, PT018
    return of.response


def integrations(scenarios: Iterable[Scenario], recipe: Recipe) -> int:
    """Number of integrations that records need: one, or two for a record that is also simulated without its fault."""
    twice = recipe.corpus.truth == "full"
    return sum(2 if twice and scenario.specimen.fault != "healthy" else 1 for scenario in scenarios)


def _healthy_input(scenario: Scenario, given: KernelInput, recipe: Recipe) -> KernelInput | None:
    """Kernel input of a record as it was without its fault; None if it has none, and with ``corpus.truth: none``."""
    specimen = scenario.specimen
    if recipe.corpus.truth == "none" or specimen.fault == "healthy":
        return None
    if specimen.wear is not None or specimen.cage or specimen.axis.get("jumps"):
        return kernel_input(scenario.without_fault(), timeline(recipe))
    return given._replace(spalls=())  # spalls are the only difference


def possible_inputs(scenarios: list[Scenario], recipe: Recipe) -> tuple[list[KernelInput | None], dict[int, str]]:
    """Kernel input of each scenario, None where no such machine is possible; and a sentence for each of these, by place."""
    axis, inputs, failures = timeline(recipe), [], {}
    for place, scenario in enumerate(scenarios):
        try:
            inputs.append(kernel_input(scenario, axis))
        except SimulationError as error:
            inputs.append(None)
            failures[place] = str(error)
    return inputs, failures


def step_errors(scenarios: list[Scenario], recipe: Recipe, response: Response) -> FloatArray:
    """Relative rms change of some records of a part when their step is halved, NaN for the others, shape (record,)."""
    finer = step_checks(scenarios, recipe, response)
    integrate_all(finer.values(), timeline(recipe))
    return step_changes(finer, response, recipe)


def step_checks(scenarios: list[Scenario], recipe: Recipe, response: Response) -> dict[int, Integration]:
    """Integrations of some records of a part at half their step, by place."""
    usable = {place: some for place, some in enumerate(response.inputs) if some and place not in response.failures}
    groups = {place: group_of(some, int(response.oversampling[place])) for place, some in usable.items()}
    return {
        place: Integration(
            scenarios[place].record.number, usable[place], groups[place]._replace(steps=2 * groups[place].steps)
        )
        for place in checked_places(scenarios, recipe, groups)
    }


def step_changes(finer: Mapping[int, Integration], response: Response, recipe: Recipe) -> FloatArray:
    """Relative rms change between records and the same at half the step, NaN for the other records, shape (record,)."""
    errors, kept = np.full(len(response.oversampling), np.nan), timeline(recipe).kept
    tried = list(finer)
    if tried:
        coarse, halved = response.acceleration[tried], np.stack([_motion(one) for one in finer.values()])
        pair = coarse[..., kept] - halved[..., kept], halved[..., kept]
        change, whole = (np.sum(some**2, axis=(1, 2), dtype=np.float64) for some in pair)
        errors[tried] = np.sqrt(change / whole)
    return errors


def laid_out(scenarios: list[Scenario], recipe: Recipe) -> list[tuple[Group, Batch]]:
    """Scenarios in lanes, batch by batch, as :func:`simulate` integrates them; all must be possible."""
    runs = runs_of(scenarios, recipe)
    every = [one for run in runs for one in (run.own, run.twin) if one is not None]
    return [
        (group, lay_out([every[place].given for place in places], group.shape, 1 / recipe.recording.sample_rate_hz))
        for group, places in batches({place: one.group for place, one in enumerate(every)})
    ]


def compile_kernel(given: KernelInput) -> None:
    """Compile the kernel that a record needs, or fetch it from numba's cache on disk."""
    shape = group_of(given, 1).shape
    integrate(shape, lay_out([given], shape, 1e-4), 1e-5, 1, decimation(1), 0, 1)
