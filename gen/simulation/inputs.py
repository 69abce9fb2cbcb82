"""Kernel input of a scenario, put together from machine, motion and damage."""

import math
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from gen.errors import SimulationError
from gen.physics.impact import hertz_time, rolling_mass
from gen.physics.inputs import KernelInput
from gen.scenarios import Scenario
from gen.simulation.damage import spall_inputs, waviness_of
from gen.simulation.machine import check_load, heaviest_ball_load, machine_of
from gen.simulation.motion import schedule_of, start_of, turning_of
from gen.simulation.timeline import Timeline

_FIRST_COORDINATE = {"shaft": 0, "housing": 2, "sensor": 4}


def kernel_input(scenario: Scenario, timeline: Timeline) -> KernelInput:
    """Everything the kernel needs of a scenario.

    Raises
    ------
    SimulationError
        If no such machine is possible, with the number of the record.
    """
    with failures_named(scenario):
        return bare_input(scenario)._replace(
            spalls=spall_inputs(scenario, heaviest_ball_load(scenario)),
            waviness=waviness_of(scenario, timeline.fs),
            schedule=schedule_of(scenario, timeline),
        )


def bare_input(scenario: Scenario) -> KernelInput:
    """A kernel input without spalls, waviness and schedule, which take most of the time to make.

    Raises
    ------
    ValueError
        If no such machine is possible.
    """
    check_load(scenario)
    start, bearing = start_of(scenario), scenario.specimen.bearing
    channels = scenario.rig.channels
    pickups = np.zeros((len(channels), 6))
    for weights, channel in zip(pickups, channels, strict=True):
        first = _FIRST_COORDINATE[channel.body]
        weights[first : first + 2] = math.cos(channel.angle), math.sin(channel.angle)
    return KernelInput(
        bearing=bearing,
        machine=machine_of(scenario, start.cage),
        turning=turning_of(scenario, start),
        spalls=(),
        frequencies=start.frequencies,
        phases=start.phases,
        pickups=pickups,
        ball_mass=rolling_mass(bearing) if scenario.rig.ball_mass else 0.0,
        hertz_time=hertz_time(bearing) if scenario.rig.ball_mass else 0.0,
    )


@contextmanager
def failures_named(scenario: Scenario) -> Iterator[None]:
    """Turn the ValueError of a machine that is not possible into a SimulationError with the number of the record."""
    try:
        yield
    except ValueError as error:
        raise SimulationError(f"record {scenario.record.number}: {error}") from None
