"""Scenarios integrated: accelerations of the bodies, and what is true of each record."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.physics.inputs import KernelInput
from gen.physics.kernel.batch import lay_out
from gen.physics.kernel.layout import Batch
from gen.scenarios import Scenario, common_settings
from gen.simulation.batches import Group, Integration, batches, group_of, integrate_all
from gen.simulation.inputs import kernel_inputs, without_fault
from gen.simulation.steps import failure, step_phase, steps_per_sample
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
    """None with ``truth.twins: false``."""


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
    """Without the fault; None for a record without a fault, and with ``truth.twins: false``."""

    @property
    def healthy(self) -> Integration | None:
        """The record without a fault, if it is integrated."""
        return self.twin or (self.own if self.scenario.specimen.fault == "healthy" else None)


def simulate(scenarios: list[Scenario]) -> Response:
    """Integrate scenarios.

    Parameters
    ----------
    scenarios : list of Scenario
        Records to simulate; they share their settings.

    Returns
    -------
    Response
        One row per scenario.

    Raises
    ------
    SimulationError
        Before anything runs, if a step would be too coarse for the stiffest mode of a scenario, or for its shaft, or if settings differ.
    """
    runs = runs_of(scenarios)
    integrate_all(open_integrations(runs), timeline(common_settings(scenarios)))
    return response_of(runs)


def runs_of(scenarios: list[Scenario], known: Mapping[int, Integration] | None = None) -> list[Run]:
    """Integrations that scenarios need; ``known`` are records without their faults that were integrated before, by number.

    Records of a group differ in their severity alone, so they share one twin: the record before the damage, if it is among them.

    Raises
    ------
    SimulationError
        If a step would be too coarse for the stiffest mode of a scenario, or for its shaft, or if settings differ.
    """
    known, runs, settings = known or {}, [], common_settings(scenarios)
    of_group: dict[tuple[int, int], Integration | None] = {}
    inputs, failures = kernel_inputs(scenarios, timeline(settings))
    for place, (scenario, given) in enumerate(zip(scenarios, inputs, strict=True)):
        number = scenario.record.number
        if given is None:
            runs.append(Run(scenario, None, failures[place], None, None))
            continue
        steps = steps_per_sample(given, number, settings)
        own, twin = Integration(number, given, group_of(given, steps)), None
        before = known.get(number)
        if before is not None and before.group.steps != steps:
            before = None
        if _has_twin(scenario):
            twin = before or of_group.get((scenario.record.pair, steps))
            if twin is None:
                healthy = _healthy_input(scenario, given)
                # it takes the step of the record with the fault, so the difference of the two is due to the fault alone
                twin = Integration(number, healthy, group_of(healthy, steps))
        elif before is not None:
            own = before
        runs.append(Run(scenario, given, "", own, twin))
        if scenario.record.pair >= 0:
            of_group.setdefault((scenario.record.pair, steps), runs[-1].healthy)
    return runs


def open_integrations(runs: Iterable[Run]) -> list[Integration]:
    """Integrations that have not been done yet, each once."""
    every = (one for run in runs for one in (run.own, run.twin) if one is not None and one.response is None)
    return list(dict.fromkeys(every))


def response_of(runs: Sequence[Run]) -> Response:
    """Response and truth of scenarios that have been integrated."""
    settings = common_settings([run.scenario for run in runs])
    axis, full = timeline(settings), settings.twins
    acceleration = np.empty((len(runs), len(settings.channels), axis.returned), np.float32)
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
        acceleration[place] = np.nan if sentence else motion_of(run.own)
        if full:
            healthy[place] = acceleration[place] if sentence or run.twin is None else motion_of(run.twin)
    truth, inputs = [truth_of(run.scenario, axis, run.given) for run in runs], [run.given for run in runs]
    twins = None
    if full:
        truth = with_loaded_hits(truth, inputs, axis)
        twins = Twins(
            healthy, [lines_of_faults(run.scenario, one.orders) for run, one in zip(runs, truth, strict=True)]
        )
    return Response(acceleration, oversampling, phases, failures, inputs, truth, twins)


def motion_of(of: Integration | None) -> NDArray[np.float32]:
    """Response of a record that has been integrated, shape (channel, time) [m s-2]."""
    assert of is not None and of.response is not None  # noqa: S101, PT018
    return of.response


def integrations(scenarios: Sequence[Scenario]) -> int:
    """Number of integrations that records need: one each, and one without the fault of a record or of all in its group."""
    groups = [
        scenario.record.pair if scenario.record.pair >= 0 else -1 - scenario.record.number for scenario in scenarios
    ]
    damaged = {group for group, scenario in zip(groups, scenarios, strict=True) if _has_twin(scenario)}
    before = {group for group, scenario in zip(groups, scenarios, strict=True) if scenario.specimen.fault == "healthy"}
    return len(scenarios) + len(damaged - before)


def _has_twin(scenario: Scenario) -> bool:
    return scenario.settings.twins and scenario.specimen.fault != "healthy"


def _healthy_input(scenario: Scenario, given: KernelInput) -> KernelInput:
    """Kernel input of a record as it was without its fault."""
    specimen, healthy = scenario.specimen, scenario.specimen.at_severity(0)
    changed = {
        field.name for field in fields(specimen) if getattr(specimen, field.name) != getattr(healthy, field.name)
    }
    if changed <= {"fault", "spalls", "axis"} and not specimen.axis.get("jumps"):
        return given._replace(spalls=())  # without spalls a tilted spin axis changes nothing, but its jumps do
    return without_fault(given, scenario, timeline(scenario.settings))


def laid_out(scenarios: list[Scenario]) -> list[tuple[Group, Batch]]:
    """Scenarios in lanes, batch by batch, as :func:`simulate` integrates them; all must be possible."""
    runs, fs = runs_of(scenarios), common_settings(scenarios).sample_rate
    every = open_integrations(runs)
    return [
        (group, lay_out([every[place].given for place in places], group.shape, 1 / fs))
        for group, places in batches({place: one.group for place, one in enumerate(every)})
    ]
