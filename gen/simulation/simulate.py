"""Scenarios integrated: accelerations of the bodies, and what is true of each record."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.physics.inputs import KernelInput
from gen.physics.kernel.batch import lay_out
from gen.physics.kernel.layout import Batch
from gen.scenarios import Scenario, same_recording
from gen.simulation.batches import Group, Integration, batches, group_of, integrate_all
from gen.simulation.inputs import kernel_inputs, without_fault
from gen.simulation.motion import Motion, draw_motion
from gen.simulation.steps import failure, step_phase, steps_per_sample
from gen.simulation.timeline import timeline
from gen.simulation.truth import Truth, lines_of_faults, truth_of

FloatArray = NDArray[np.float64]


class Twin(NamedTuple):
    """A record without its fault."""

    place: int
    """Of the record."""
    acceleration: NDArray[np.float32]
    """Shape (channel, time) [m s-2]."""
    orders: tuple[float, ...]
    """Orders at which the fault repeats [1]."""


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
    motions: list[Motion]
    """Course of shaft, cage and balls of each record."""
    truth: list[Truth]
    twins: list[Twin]
    """Of the records with a fault that were made; empty with ``truth.twins: false``."""


class Run(NamedTuple):
    """A record with the integrations that it needs."""

    motion: Motion
    given: KernelInput | None
    """None if no such machine is possible."""
    impossible: str
    """Why it is not possible, else empty."""
    own: Integration | None
    """None if no such machine is possible."""
    twin: Integration | None
    """Without the fault; None for a record without a fault, and with ``truth.twins: false``."""

    @property
    def scenario(self) -> Scenario:
        """Its scenario."""
        return self.motion.scenario

    @property
    def integrations(self) -> list[Integration]:
        """Of the record and of its twin, as far as there are any."""
        return [one for one in (self.own, self.twin) if one is not None]

    @property
    def healthy(self) -> Integration | None:
        """The record without a fault, if it is integrated."""
        return self.twin or (self.own if self.scenario.fault == "healthy" else None)


def simulate(scenarios: list[Scenario]) -> Response:
    """Integrate scenarios.

    Parameters
    ----------
    scenarios : list of Scenario
        Records to simulate; they have the same recording.

    Returns
    -------
    Response
        One row per scenario.

    Raises
    ------
    SimulationError
        Before anything runs, if a step would be too coarse for the stiffest mode of a scenario, or for its shaft, or if recordings differ.
    """
    runs = runs_of(scenarios)
    integrate_all(open_integrations(runs), timeline(same_recording(scenarios)))
    return response_of(runs)


def runs_of(scenarios: list[Scenario], known: Mapping[int, Run] | None = None) -> list[Run]:
    """Integrations that scenarios need; ``known`` are integrated runs, by number, of the same records with another fault.

    Records of a group differ in their severity alone, so they share one twin: the record before the damage, if it is among them.

    Raises
    ------
    SimulationError
        If a step would be too coarse for the stiffest mode of a scenario, or for its shaft, or if recordings differ.
    """
    axis, motions = timeline(same_recording(scenarios)), [draw_motion(scenario) for scenario in scenarios]
    integrated = {number: run.healthy for number, run in (known or {}).items()}
    runs: list[Run] = []
    of_group: dict[tuple[int, int], Integration | None] = {}
    inputs, failures = kernel_inputs(motions, axis)
    for place, (motion, given) in enumerate(zip(motions, inputs, strict=True)):
        scenario, number = motion.scenario, motion.scenario.origin.record
        if given is None:
            runs.append(Run(motion, None, failures[place], None, None))
            continue
        steps = steps_per_sample(given, scenario)
        own, twin = Integration(given, group_of(given, steps)), None
        before = integrated.get(number)
        if before is not None and before.group.steps != steps:
            before = None
        if _has_twin(scenario):
            twin = before or of_group.get((scenario.origin.pair, steps))
            if twin is None:
                healthy = without_fault(given, scenario, axis)
                # it takes the step of the record with the fault, so the difference of the two is due to the fault alone
                twin = Integration(healthy, group_of(healthy, steps))
        elif before is not None:
            own = before
        runs.append(Run(motion, given, "", own, twin))
        if scenario.origin.pair >= 0:
            of_group.setdefault((scenario.origin.pair, steps), runs[-1].healthy)
    return runs


def open_integrations(runs: Iterable[Run]) -> list[Integration]:
    """Integrations that have not been done yet, each once."""
    return list(dict.fromkeys(one for run in runs for one in run.integrations if one.response is None))


def response_of(runs: Sequence[Run]) -> Response:
    """Response and truth of scenarios that have been integrated."""
    recipe = same_recording([run.scenario for run in runs])
    axis = timeline(recipe)
    acceleration = np.empty((len(runs), len(recipe.recording.channels), axis.returned), np.float32)
    oversampling, phases, failures = np.zeros(len(runs), np.int64), np.full(len(runs), np.nan), {}
    for place, run in enumerate(runs):
        oversampling[place], phases[place], sentence = _step_of(run, axis.fs)
        if sentence:
            failures[place] = sentence
        acceleration[place] = np.nan if sentence else acceleration_of(run.own)
    truth = [truth_of(run.motion, axis, run.given) for run in runs]
    twins = [
        Twin(place, acceleration_of(run.twin), lines_of_faults(truth[place]))
        for place, run in enumerate(runs)
        if place not in failures and run.twin is not None
    ]
    return Response(acceleration, oversampling, phases, failures, [run.motion for run in runs], truth, twins)


def _step_of(run: Run, fs: float) -> tuple[int, float, str | None]:
    """Steps per sample and step phase [rad] of a record, and a sentence if it cannot be used."""
    if run.own is None or run.given is None:
        return 0, math.nan, run.impossible
    steps = run.own.group.steps
    phase = step_phase(run.given, run.own.steepest, steps, fs)
    # with its twin: if that diverged, what the fault adds is not known
    diverged = max(one.diverged for one in run.integrations) / fs
    return steps, phase, failure(run.scenario.origin.record, steps, diverged, phase)


def acceleration_of(integration: Integration | None) -> NDArray[np.float32]:
    """Result of an integration that has been done, shape (channel, time) [m s-2]."""
    assert integration is not None and integration.response is not None  # noqa: S101, PT018
    return integration.response


def _has_twin(scenario: Scenario) -> bool:
    return scenario.recipe.truth.twins and scenario.fault != "healthy"


def laid_out(scenarios: list[Scenario]) -> list[tuple[Group, Batch]]:
    """Scenarios in lanes, batch by batch, as :func:`simulate` integrates them; all must be possible."""
    runs, fs = runs_of(scenarios), same_recording(scenarios).recording.sample_rate_hz
    every = open_integrations(runs)
    return [
        (group, lay_out([every[place].given for place in places], group.shape, 1 / fs))
        for group, places in batches({place: one.group for place, one in enumerate(every)})
    ]
