"""The step of the integration, chosen before the run from the stiffest mode, and compared with the contacts after it."""

import math

import numpy as np
from numpy.typing import NDArray

from gen.physics.kernel_input import KernelInput
from gen.physics.rotor import highest_angular_frequency, highest_damping_rate, likely_stiffness
from gen.recipe import MAX_OVERSAMPLING
from gen.scenarios import Scenario
from gen.support.errors import SimulationError
from gen.support.units import to_si

FloatArray = NDArray[np.float64]

ENOUGH = 6  # steps per sample for all modes up to half the sample rate
# omega * dt of the stiffest mode that is recorded, and of a faster one, which the anti-alias filter removes and the integration has only to
# follow; at 1.0 a mode still rings at its frequency, and above 2.8 the method is unstable
FINE_STEP, FOLLOWED_STEP, COARSEST_STEP = math.pi / ENOUGH, 0.75, 1.0
PASSAGE_STEPS = 4  # in which a ball rolls over the narrowest spall at least; with fewer the edges of the spall fall between two steps
_FACTORS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, MAX_OVERSAMPLING)
LARGEST_TURN = 0.7  # of the shaft per sample [rad]: its rate is constant within a sample


def steps_per_sample(kernel_input: KernelInput, scenario: Scenario) -> int:
    """Steps per sample that the modes and the spalls of a record need; the records of a group have the same.

    Raises
    ------
    SimulationError
        If the recipe asks for too few, or the mode needs more than are allowed.
    """
    number, recording = scenario.origin.record, scenario.recipe.recording
    fs, asked = recording.sample_rate_hz, recording.oversampling
    turn = 2 * math.pi * _fastest_shaft_rate(kernel_input)
    if turn / fs > LARGEST_TURN:
        raise SimulationError(
            f"record {number}: its shaft turns {math.degrees(turn / fs):.3g} degrees per sample; raise "
            f"recording.sample_rate_hz to {math.ceil(turn / LARGEST_TURN)}."
        )
    # the step follows the fastest mode of the machine and the narrowest spall
    rate, narrowest = fastest_rate(kernel_input), scenario.origin.narrowest_mm  # of the spalls of a group
    need = max(min(rate / (FINE_STEP * fs), ENOUGH), rate / (FOLLOWED_STEP * fs))
    passages = passage_rate(kernel_input, None if narrowest is None else to_si(narrowest, "mm"))
    need = max(need, min(PASSAGE_STEPS * passages / fs, MAX_OVERSAMPLING))
    # a step of the recipe's own is refused only where it would be unstable
    if asked is not None:
        if rate / (asked * fs) > COARSEST_STEP:
            raise SimulationError(
                f"record {number}: its stiffest mode of {rate / 2 / math.pi:.0f} Hz is too fast for a step of "
                f"{1e6 / (asked * fs):.3g} us; raise recording.oversampling to {math.ceil(need)} or leave it out."
            )
        return asked
    # steps divide a sample so that two filters can decimate them
    for factor in _FACTORS:
        if factor >= need:
            return factor
    raise SimulationError(
        f"record {number}: its stiffest mode of {rate / 2 / math.pi:.0f} Hz needs more than {_FACTORS[-1]} steps per "
        f"sample at {fs:g} Hz; soften the machine or raise recording.sample_rate_hz."
    )


def fastest_rate(kernel_input: KernelInput) -> float:
    """Angular frequency that the step must follow: that of the stiffest mode, or of the strongest damping [rad/s]."""
    machine, n_balls = kernel_input.machine, kernel_input.bearing.n_balls
    stiffness = likely_stiffness(machine, n_balls, largest_pull(kernel_input))
    return max(highest_angular_frequency(machine, stiffness), highest_damping_rate(machine, n_balls) / 2.5)


def passage_rate(kernel_input: KernelInput, narrowest: float | None = None) -> float:
    """Speed at which balls roll on the races over the ``narrowest`` spall [m] or one of their own, 0 without any [Hz]."""
    narrowest = min([narrowest or math.inf, *(spall.width for spall in kernel_input.spalls)])
    cage_rate = 0.5 * (1 - kernel_input.bearing.gamma) * _fastest_shaft_rate(kernel_input)
    return 2 * math.pi * cage_rate * kernel_input.bearing.radius("outer") / narrowest


def _fastest_shaft_rate(kernel_input: KernelInput) -> float:
    """Largest shaft rate of the speed profile [Hz]."""
    return abs(kernel_input.turning.shaft_rate) * (
        float(kernel_input.schedule[:, 0].max()) if kernel_input.schedule.size else 1.0
    )


def largest_pull(kernel_input: KernelInput) -> float:
    """Largest force on the shaft beside its steady load: unbalance, bent shaft, misalignment, profile of the load [N]."""
    turning = kernel_input.turning
    speeds, loads = kernel_input.schedule.T if kernel_input.schedule.size else (np.ones(1), np.ones(1))
    unbalance = turning.unbalance * (2 * math.pi * turning.shaft_rate * float(speeds.max())) ** 2
    steady = math.hypot(kernel_input.machine.load_x, kernel_input.machine.load_y)
    further = steady * (float(loads.max()) - 1)
    return max(unbalance + turning.bow + math.hypot(turning.twice_x, turning.twice_y) + further, 0.0)


def step_phase(kernel_input: KernelInput, steepest: float, steps: int, fs: float) -> float:
    """Fastest angular frequency at the contact stiffness ``steepest`` [N/m], times the step [rad]."""
    return highest_angular_frequency(kernel_input.machine, steepest) / (fs * steps)


def failure(number: int, steps: int, diverged: float, phase: float) -> str | None:
    """Why record ``number`` cannot be used: it diverged at ``diverged`` [s], negative if not, or its step was too coarse."""
    if diverged >= 0:
        return (
            f"record {number} diverged at t = {diverged:.4g} s with {steps} steps per sample; "
            f"raise recording.oversampling or soften the machine."
        )
    if phase > COARSEST_STEP:
        return (
            f"record {number}: its contacts became stiffer than {steps} steps per sample can follow; "
            f"set recording.oversampling to {math.ceil(steps * phase / FINE_STEP)}."
        )
    return None
