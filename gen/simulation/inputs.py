"""Kernel inputs of scenarios, put together from machine, motion and damage.

Static rest and axial load are solved for all records at once; the result does not depend on the other records.
"""

import math
from collections.abc import Sequence

import numpy as np

from gen.physics.inputs import KernelInput, at_rest
from gen.scenarios import Scenario
from gen.simulation.damage import spall_inputs, waviness_of
from gen.simulation.machine import check_load, heaviest_ball_load, machine_of, with_axial_loads
from gen.simulation.motion import Motion, draw_motion, schedule_of, turning_of
from gen.simulation.timeline import Timeline
from gen.support.errors import SimulationError

_FIRST_COORDINATE = {"shaft": 0, "housing": 2, "sensor": 4}

Failures = dict[int, str]
"""A sentence for each scenario of which no machine is possible, by its place."""


def kernel_inputs(motions: Sequence[Motion], timeline: Timeline) -> tuple[list[KernelInput | None], Failures]:
    """Everything the kernel needs of each record, None where no machine is possible."""
    inputs, failures = bare_inputs(motions)
    for place, (given, motion) in enumerate(zip(inputs, motions, strict=True)):
        scenario = motion.scenario
        if given is None:
            continue
        try:
            inputs[place] = given._replace(
                spalls=spall_inputs(scenario, heaviest_ball_load(scenario)),
                waviness=waviness_of(scenario, timeline.fs),
                schedule=schedule_of(scenario, timeline),
            )
        except ValueError as error:
            inputs[place], failures[place] = None, _name(scenario, error)
    return resting(inputs), failures


def kernel_input(scenario: Scenario, timeline: Timeline) -> KernelInput:
    """Everything the kernel needs of one scenario; SimulationError if no such machine is possible."""
    return only(kernel_inputs([draw_motion(scenario)], timeline))


def only(inputs: tuple[list[KernelInput | None], Failures]) -> KernelInput:
    """The kernel input of the only scenario; SimulationError if no such machine is possible."""
    (given,), failures = inputs
    if given is None:
        raise SimulationError(failures[0])
    return given


def bare_inputs(motions: Sequence[Motion]) -> tuple[list[KernelInput | None], Failures]:
    """Kernel inputs without spalls, waviness, schedule and rest, which take most of the time to make; None as above."""
    inputs: list[KernelInput | None] = [None] * len(motions)
    failures: Failures = {}
    possible: dict[int, KernelInput] = {}
    for place, motion in enumerate(motions):
        try:
            possible[place] = _without_axial_load(motion)
        except ValueError as error:
            failures[place] = _name(motion.scenario, error)
    machines = with_axial_loads(
        [given.machine for given in possible.values()],
        [motions[place].scenario for place in possible],
        [given.turning.cage_angle for given in possible.values()],
    )
    for (place, given), machine in zip(possible.items(), machines, strict=True):
        inputs[place] = given._replace(machine=machine)
    return inputs, failures


def resting(inputs: Sequence[KernelInput | None]) -> list[KernelInput | None]:
    """The same inputs, which start from static rest."""
    starts = iter(at_rest([given for given in inputs if given is not None]))
    return [None if given is None else next(starts) for given in inputs]


def without_fault(given: KernelInput, scenario: Scenario, timeline: Timeline) -> KernelInput:
    """Kernel input of a record without its fault, from that with it: the machine is the same."""
    sound = scenario.without_fault()
    angles = given.turning.shaft_angle, given.turning.cage_angle, given.turning.spin_angle
    return given._replace(spalls=(), turning=turning_of(sound, *angles), waviness=waviness_of(sound, timeline.fs))


def _without_axial_load(motion: Motion) -> KernelInput:
    check_load(motion.scenario)
    channels = motion.scenario.recipe.recording.channels
    pickups = np.zeros((len(channels), 6))
    for weights, channel in zip(pickups, channels, strict=True):
        first, angle = _FIRST_COORDINATE[channel.drawn_body], channel.si()["angle"]
        weights[first : first + 2] = math.cos(angle), math.sin(angle)
    return KernelInput(
        bearing=motion.scenario.bearing,
        machine=machine_of(motion.scenario),
        turning=motion.turning,
        spalls=(),
        frequencies=motion.frequencies,
        phases=motion.phases,
        pickups=pickups,
    )


def _name(scenario: Scenario, error: ValueError) -> str:
    return f"record {scenario.origin.record}: {error}"
