"""Kernel inputs of scenarios, put together from machine, motion and damage.

Static rest and axial load are solved for all records at once; the result does not depend on the other records. A machine that is not
possible has an error in place of its input.
"""

import math
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from gen.physics.kernel_input import KernelInput, at_rest
from gen.scenarios import Scenario
from gen.simulation.damage import spall_inputs, waviness_of
from gen.simulation.motion import Motion, schedule_of, turning_of
from gen.simulation.surroundings import check_load, heaviest_ball_load, machine_of, with_axial_loads
from gen.support.errors import SimulationError

_FIRST_COORDINATE = {"shaft": 0, "housing": 2, "sensor": 4}


def kernel_inputs(motions: Sequence[Motion]) -> list[KernelInput | SimulationError]:
    """Everything the kernel needs of each record, or an error that says why no such machine is possible."""
    return resting(
        kernel_input if isinstance(kernel_input, SimulationError) else _possible(_damaged, motion, kernel_input)
        for kernel_input, motion in zip(bare_inputs(motions), motions, strict=True)
    )


def bare_inputs(motions: Sequence[Motion]) -> list[KernelInput | SimulationError]:
    """Kernel inputs without spalls, waviness, schedule and rest, which take most of the time to make."""
    inputs = [_possible(_without_axial_load, motion) for motion in motions]
    return with_axial_loads(inputs, [motion.scenario.conditions["axial_load"] for motion in motions])


def resting(inputs: Iterable[KernelInput | SimulationError]) -> list[KernelInput | SimulationError]:
    """The same inputs, which start from static rest."""
    every = [*inputs]
    starts = iter(at_rest([kernel_input for kernel_input in every if isinstance(kernel_input, KernelInput)]))
    return [next(starts) if isinstance(kernel_input, KernelInput) else kernel_input for kernel_input in every]


def without_fault(kernel_input: KernelInput, scenario: Scenario) -> KernelInput:
    """Kernel input of a record without its fault, from that with it: the machine is the same."""
    sound, turning = scenario.without_fault(), kernel_input.turning
    angles = turning.shaft_angle, turning.cage_angle, turning.spin_angle
    return kernel_input._replace(spalls=(), turning=turning_of(sound, *angles), waviness=waviness_of(sound))


def _possible(
    make: Callable[..., KernelInput], motion: Motion, *kernel_input: KernelInput
) -> KernelInput | SimulationError:
    try:
        return make(motion, *kernel_input)
    except ValueError as error:
        return SimulationError(f"record {motion.scenario.origin.record}: {error}")


def _without_axial_load(motion: Motion) -> KernelInput:
    scenario = motion.scenario
    check_load(scenario)
    channels = scenario.recipe.recording.channels
    pickups = np.zeros((len(channels), 6))
    for weights, channel in zip(pickups, channels, strict=True):
        first, angle = _FIRST_COORDINATE[channel.drawn_body], channel.si()["angle"]
        weights[first : first + 2] = math.cos(angle), math.sin(angle)
    machine = machine_of(scenario)
    return KernelInput(scenario.bearing, machine, motion.turning, (), motion.frequencies, motion.phases, pickups)


def _damaged(motion: Motion, kernel_input: KernelInput) -> KernelInput:
    scenario = motion.scenario
    return kernel_input._replace(
        spalls=spall_inputs(scenario, heaviest_ball_load(scenario)),
        waviness=waviness_of(scenario),
        schedule=schedule_of(scenario),
    )
