"""How shaft, cage and balls of one record turn, and how its speed and load run over time."""

import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gen.physics.bearing import Bearing, FaultOrders, orders, slipping_orders
from gen.physics.elementary import exponential, power, standard_normals
from gen.physics.kernel.layout import (
    JITTER_TERMS,
    SLIP_FIRST,
    SLIP_TERMS,
    SPEED_TERMS,
    SPIN_FIRST,
    SPIN_TERMS,
    TILT_FIRST,
    TILT_TERMS,
    n_process_terms,
)  # fmt: skip
from gen.physics.kernel.turning import STRIDE
from gen.physics.kernel_input import CONSTANT, Turning, walk_slip_rms
from gen.physics.profile import mean_share, share_at
from gen.scenarios import Scenario
from gen.simulation.timeline import Timeline, timeline

FloatArray = NDArray[np.float64]

LEAVES_LOAD_ZONE = math.pi / 3  # angle from the load at which the pocket of a broken cage knocks
LOAD_TERMS = 8


@dataclass(frozen=True, eq=False)
class Motion:
    """Course of shaft, cage and balls of one record, which tells kernel input, angles of the shaft and mean orders."""

    scenario: Scenario
    turning: Turning
    frequencies: FloatArray
    """Of the cosine terms of all processes, shape (term,) [Hz]."""
    phases: FloatArray
    """Shape (term,) [rad]."""

    @functools.cached_property
    def means(self) -> tuple[float, FaultOrders]:
        """Mean shaft rate [Hz] and fault orders [1] over the record, with speed profile, wander and slip."""
        return _means(self, timeline(self.scenario.recipe))


def draw_motion(scenario: Scenario) -> Motion:
    """Draw the motion of a record from its own random stream."""
    rng = scenario.stream("motion")
    turning = turning_of(scenario, *(2 * np.pi * rng.random(3)).tolist())
    return Motion(scenario, turning, *_processes(scenario.bearing, turning.shaft_rate, rng))


def turning_of(scenario: Scenario, shaft_angle: float, cage_angle: float, spin_angle: float) -> Turning:
    """Rotation of a record from its angles at the start [rad]."""
    drawn, conditions, walk = scenario.machine, scenario.conditions, scenario.recipe.operation.slip_walk
    of_fault = {name: value for part in scenario.components for name, value in part.turning().items()}
    # a random process has a stream of its own, and only if the record has it
    seeds = {
        seed: int(scenario.stream(name).integers(2**52))
        for seed, name, needed in (
            ("knock_seed", "knocks of the cage", "knock" in of_fault),
            ("walk_seed", "slip walk", walk is not None),
            ("axis_seed", "jumps of the axis", "axis_jumps" in of_fault),
        )
        if needed
    }
    return Turning(
        shaft_rate=conditions["shaft_rate"],
        speed_rms=conditions["speed_wander"],
        mean_slip=conditions["mean_slip"],
        slip_rms=conditions["slip"],
        spin_rms=conditions["spin_wander"],
        jitter_rms=conditions["jitter"],
        unbalance=scenario.recipe.machine.unbalance,
        shaft_angle=shaft_angle,
        cage_angle=cage_angle,
        spin_angle=spin_angle,
        bow=drawn["bow"],
        twice_x=drawn["misalignment"] * math.cos(drawn["misalignment_angle"]),
        twice_y=drawn["misalignment"] * math.sin(drawn["misalignment_angle"]),
        knock_angle=drawn["load_angle"] + LEAVES_LOAD_ZONE,
        walk=0.0 if walk is None else walk.si()["spacing"],
        **of_fault,
        **seeds,
    )


def _processes(bearing: Bearing, shaft_rate: float, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and phases [rad] of the terms of all processes, shape (term,): log-uniform within each process's band."""
    lowest, widths, unit = _bands(bearing.n_balls)
    u = rng.random((2, n_process_terms(bearing.n_balls)))
    units = np.array([1.0, shaft_rate, orders(bearing).ftf * shaft_rate])
    return lowest * units[unit] * exponential(widths * u[0]), 2 * np.pi * u[1]


@functools.lru_cache(maxsize=64)
def _bands(n_balls: int) -> tuple[FloatArray, FloatArray, NDArray[np.int_]]:
    """Lower end of the band of each term, logarithm of its upper over its lower end, and its unit, shape (term,).

    Units by number: 0 is 1 Hz, 1 the shaft rate, 2 the rate of the cage.
    """
    bands = np.array([[0.3, 3.0, 0], [0.2, 2, 1], [0.05, 0.6, 1], [0.05, 0.6, 1], [0.3, 3, 2]])
    terms = [SPEED_TERMS, SLIP_TERMS, SPIN_TERMS, TILT_TERMS, JITTER_TERMS * n_balls]
    low, high, unit = np.repeat(bands, terms, axis=0).T
    return low, np.array([math.log(ratio) for ratio in high / low]), unit.astype(int)


def schedule_of(scenario: Scenario) -> FloatArray:
    """Factors of shaft rate and load at the knots, shape (knot, 2); (0, 2) if both are constant."""
    speed, load, wander = scenario.speed_profile, scenario.load_profile, scenario.conditions["load_wander"]
    if (speed, load) == (None, None) and wander == 0:
        return CONSTANT
    axis = timeline(scenario.recipe)
    times = axis.knot_times()
    factors = np.ones((len(times), 2))
    if speed is not None:
        # speed at the middle of the step that begins at the knot, load at the knot itself
        factors[:, 0] = share_at(speed, times + 0.5 / axis.fs)
    if load is not None:
        factors[:, 1] = share_at(load, times)
    if wander > 0:
        factors[:, 1] *= _load_wander(scenario, times)
    return factors


def _load_wander(scenario: Scenario, times: FloatArray) -> FloatArray:
    """Factor of the load at evenly spaced ``times`` [s], of their shape [1]: slower than the shaft, never below 0."""
    rng, conditions = scenario.stream("load wander"), scenario.conditions
    rates = 2 * np.pi * conditions["shaft_rate"] * power(0.05, rng.random(LOAD_TERMS))
    amplitude = conditions["load_wander"] * math.sqrt(2 / LOAD_TERMS)
    return np.maximum(1 + amplitude * cosine_sum(times, rates, rng.uniform(0, 2 * np.pi, LOAD_TERMS)), 0.0)


def cosine_sum(
    times: NDArray[np.floating], rates: FloatArray, phases: FloatArray, amplitudes: FloatArray | float = 1.0
) -> FloatArray:
    """Sum over terms of ``amplitude * cos(rate * time + phase)`` at evenly spaced times, shape (time,); rates in rad/s, shape (term,).

    By ``cos(a + b) = cos(a) cos(b) - sin(a) sin(b)`` from the starts of blocks and the steps within a block: 16 times as fast as one
    cosine per sample, and exact to rounding. ``einsum`` without BLAS, whose last bits may change with its threads.
    """
    length = math.isqrt(len(times))
    starts = np.outer(times[::length], rates) + phases
    steps = np.outer(rates, (times[-1] - times[0]) / (len(times) - 1) * np.arange(length))
    of_start = np.hstack([amplitudes * np.cos(starts), -amplitudes * np.sin(starts)])
    of_step = np.vstack([np.cos(steps), np.sin(steps)])
    return np.einsum("bt,ts->bs", of_start, of_step).ravel()[: len(times)]


def _walk(bearing: Bearing, turning: Turning, axis: Timeline) -> FloatArray:
    """Slip of the random walk of the cage at the knots of the record, as the kernel draws it, shape (time,) [1]."""
    first, later = divmod(axis.settle, STRIDE)
    normals = standard_normals(np.arange(first, (axis.settle + axis.record - 1) // STRIDE + 1), turning.walk_seed)
    slips = walk_slip_rms(bearing, turning, STRIDE / axis.fs) * normals
    return np.repeat(slips, STRIDE)[later : later + axis.record]


def _means(motion: Motion, axis: Timeline) -> tuple[float, FaultOrders]:
    turning, profile, duration = motion.turning, motion.scenario.speed_profile, axis.duration
    bearing = motion.scenario.bearing
    terms = slice(TILT_FIRST)  # speed, slip and spin
    settle, turn, phase = axis.settle / axis.fs, 2 * np.pi * motion.frequencies[terms], motion.phases[terms]
    if profile is None:
        # at constant speed the mean of a cosine is known exactly
        means = (np.sin(turn * (settle + duration) + phase) - np.sin(turn * settle + phase)) / (turn * duration)
    else:  # weighted by the shaft rate, with 20 points per turn: ten to a cycle of the fastest process
        points = int(np.clip(20 * turning.shaft_rate * duration, 2**12, 2**17))
        times = (np.arange(points) + 0.5) * (duration / points)
        share = share_at(profile, times)
        means = np.einsum("t,tk->k", share, np.cos(np.outer(settle + times, turn) + phase)) / share.sum()

    def mean(first: int, count: int) -> float:
        return float(means[first : first + count].sum()) * math.sqrt(2 / count)

    rate = turning.shaft_rate * mean_share(profile, duration)
    rate *= 1 + turning.speed_rms * mean(0, SPEED_TERMS)
    slip = turning.mean_slip + turning.slip_rms * mean(SLIP_FIRST, SLIP_TERMS)
    if turning.walk > 0:
        walk, middles = _walk(bearing, turning, axis), (np.arange(axis.record) + 0.5) / axis.fs
        # the walk of the slip has been drawn already: its mean is taken
        slip += float(walk.mean() if profile is None else np.average(walk, weights=share_at(profile, middles)))
    orders = slipping_orders(bearing, slip)
    wander = turning.spin_rms * mean(SPIN_FIRST, SPIN_TERMS)
    return rate, orders._replace(bsf=orders.bsf * (1 + wander))
