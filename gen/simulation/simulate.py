"""Scenarios integrated: each record, with and without its fault."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gen.physics.kernel_input import KernelInput
from gen.scenarios import Scenario, same_recording
from gen.simulation.batches import Integration, integrate_all
from gen.simulation.inputs import kernel_inputs, without_fault
from gen.simulation.motion import Motion, draw_motion
from gen.simulation.steps import failure, step_phase, steps_per_sample
from gen.simulation.timeline import timeline
from gen.support.errors import SimulationError


@dataclass(eq=False)
class Run:
    """A record with the integrations that it needs, and what the simulation knows of it by construction."""

    scenario: Scenario
    motion: Motion
    """Course of shaft, cage and balls."""
    own: Integration | SimulationError
    """Of the record itself; an error if no such machine is possible."""
    twin: Integration | None = None
    """Without the fault; None for a record without a fault, and with ``truth.twins: false``."""

    @property
    def integrations(self) -> list[Integration]:
        """Of the record and of its twin, as far as there are any."""
        return [integration for integration in (self.own, self.twin) if isinstance(integration, Integration)]

    @property
    def healthy(self) -> Integration | None:
        """The record without a fault, if it is integrated."""
        return self.integrations[-1] if self.twin or self.scenario.fault == "healthy" else None

    @property
    def kernel_input(self) -> KernelInput:
        """Kernel input of a record that is possible."""
        return self.integrations[0].kernel_input

    @property
    def acceleration(self) -> NDArray[np.float32]:
        """Acceleration that each channel measures, from the lead ahead of the record to its end, shape (channel, time) [m s-2]."""
        return acceleration_of(self.integrations[0])

    @property
    def oversampling(self) -> int:
        """Steps per sample."""
        return self.integrations[0].steps

    @property
    def step_phase(self) -> float:
        """Fastest angular frequency at the largest contact stiffness of the record, times the step [rad]."""
        fs = self.scenario.recipe.recording.sample_rate_hz
        return step_phase(self.kernel_input, self.integrations[0].steepest, self.oversampling, fs)

    @property
    def failure(self) -> str | None:
        """Why the record, which is integrated, cannot be used: it is not possible or it diverged; None if it can."""
        if isinstance(self.own, SimulationError):
            return str(self.own)
        # with its twin: if that diverged, what the fault adds is not known
        diverged = (
            max(integration.diverged for integration in self.integrations)
            / self.scenario.recipe.recording.sample_rate_hz
        )
        return failure(self.scenario.origin.record, self.oversampling, diverged, self.step_phase)


def simulate(scenarios: list[Scenario]) -> list[Run]:
    """Integrate scenarios, which have the same recording.

    Raises
    ------
    SimulationError
        Before anything runs, if a step would be too coarse for the stiffest mode of a scenario, or for its shaft, or if recordings differ.
    """
    runs = runs_of(scenarios)
    integrate_runs(runs)
    return runs


def runs_of(scenarios: list[Scenario], earlier: Mapping[int, Run] = {}) -> list[Run]:
    """Integrations that scenarios need; ``earlier`` are integrated runs, by number, of the same records with another fault.

    Records of a group differ in their severity alone, so they share one twin: the record before the damage, if it is among them.

    Raises
    ------
    SimulationError
        If a step would be too coarse for the stiffest mode of a scenario, or for its shaft, or if recordings differ.
    """
    twins, motions = same_recording(scenarios).truth.twins, [draw_motion(scenario) for scenario in scenarios]
    # a fault that is drawn again needs no second integration of its twin
    integrated = {(number, healthy.steps): healthy for number, run in earlier.items() if (healthy := run.healthy)}
    of_group = dict[tuple[int, int], Integration | None]()
    runs = list[Run]()
    for motion, kernel_input in zip(motions, kernel_inputs(motions), strict=True):
        scenario = motion.scenario
        if isinstance(kernel_input, SimulationError):
            runs.append(Run(scenario, motion, kernel_input))
            continue
        steps, pair = steps_per_sample(kernel_input, scenario), scenario.origin.pair
        before, own, twin = integrated.get((scenario.origin.record, steps)), Integration(kernel_input, steps), None
        if scenario.fault == "healthy":
            # a healthy record is the twin of another one, or of itself
            own = before or own
        elif twins:
            # it takes the step of the record with the fault, so the difference of the two is due to the fault alone
            twin = before or of_group.get((pair, steps)) or Integration(without_fault(kernel_input, scenario), steps)
        runs.append(Run(scenario, motion, own, twin))
        if pair >= 0:
            # one twin serves all severities of a group
            of_group.setdefault((pair, steps), runs[-1].healthy)
    return runs


def open_integrations(runs: Iterable[Run]) -> list[Integration]:
    """Integrations that have not been done yet, each once."""
    return list(
        dict.fromkeys(integration for run in runs for integration in run.integrations if integration.response is None)
    )


def integrate_runs(runs: list[Run]) -> None:
    """Integrate what some runs need and do not have yet."""
    integrate_all(open_integrations(runs), timeline(same_recording([run.scenario for run in runs])))


def acceleration_of(integration: Integration) -> NDArray[np.float32]:
    """Result of an integration that has been done, shape (channel, time) [m s-2]."""
    assert integration.response is not None  # noqa: S101
    return integration.response
