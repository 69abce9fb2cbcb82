"""Scenarios in, accelerations at the bodies out.

Each scenario becomes constants, motion and spalls of the model; records that need the same kernel and step share a batch. What a record
gives does not depend on the others in its batch.
"""

import functools
import math
from collections import defaultdict
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gen.errors import SimulationError
from gen.physics import motion
from gen.physics.batch import Motion, Record, lay_out, n_terms, record_shape
from gen.physics.bearing import Bearing, Orders, orders, slipping_orders
from gen.physics.hertz import load_deflection_factor
from gen.physics.integrate import decimation_taps, integrate
from gen.physics.kernel import Shape
from gen.physics.lanes import LANES
from gen.physics.rotor import Machine, fastest_swing, sensor_springs
from gen.recipe import MAX_OVERSAMPLING, Recipe
from gen.scenarios import Purpose, Scenario, stream

FloatArray = NDArray[np.float64]

# omega * dt of the stiffest mode: 0.30 keeps the acceleration to about 1e-3, 1.0 still rings as it should, 2.8 is unstable
FINE_STEP, COARSEST_STEP = 0.30, 1.0
LEAD_S = 0.05  # given ahead of the record, for the measurement's filters to start in
_FACTORS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, MAX_OVERSAMPLING)
_BODIES = {"shaft": 0, "housing": 2, "sensor": 4}


@dataclass(frozen=True)
class Response:
    """What the channels' bodies do, from ``LEAD_S`` before the record on."""

    acceleration: FloatArray
    """Shape (record, channel, time), NaN where a record diverged [m s-2]."""
    oversampling: NDArray[np.int64]
    """Steps per sample, shape (record,)."""
    failures: dict[int, str]
    """A sentence for each record that diverged, by its place in the batch."""


def simulate(scenarios: list[Scenario], recipe: Recipe) -> Response:
    """Integrate scenarios.

    Parameters
    ----------
    scenarios : list of Scenario
        Records to simulate.
    recipe : Recipe
        Gives sample rate, duration and settling time.

    Returns
    -------
    Response
        One row per scenario.

    Raises
    ------
    SimulationError
        Before anything runs, if a step would be too coarse for the stiffest mode of a scenario.
    """
    fs = recipe.recording.sample_rate_hz
    lead = lead_samples(recipe)
    n_settle = max(round(recipe.recording.settle_s * fs) - lead, 0)
    records = [physical_record(scenario) for scenario in scenarios]
    factors = [steps_per_sample(record, scenario, recipe) for record, scenario in zip(records, scenarios, strict=True)]
    batches: dict[tuple[Shape, int], list[int]] = defaultdict(list)
    for place, record in enumerate(records):
        batches[record_shape(record), factors[place]].append(place)
    acceleration = np.empty((len(records), len(recipe.recording.channels), lead + recipe.n_samples))
    failures: dict[int, str] = {}
    for (shape, factor), places in batches.items():
        for first in range(0, len(places), LANES):
            some = places[first : first + LANES]
            lanes = lay_out([records[place] for place in some], shape, 1 / fs)
            response, diverged = integrate(
                shape,
                lanes,
                1 / (fs * factor),
                factor,
                decimation_taps(factor),
                n_settle,
                lead + recipe.n_samples,
            )
            acceleration[some] = response.T[: len(some)]
            for lane, place in enumerate(some):
                if diverged[lane] >= 0:
                    acceleration[place] = np.nan
                    failures[place] = (
                        f"record {scenarios[place].record.number} diverged at t = {diverged[lane] / fs:.4g} s with "
                        f"{factor} steps per sample; raise recording.oversampling or soften the machine."
                    )
    return Response(acceleration, np.array(factors), failures)


def lead_samples(recipe: Recipe) -> int:
    """Samples that a response has ahead of the record."""
    return round(LEAD_S * recipe.recording.sample_rate_hz)


def compile_kernel(shape: Shape, scenario: Scenario) -> None:
    """Compile the kernel of a shape, or fetch it from numba's cache on disk; ``scenario`` is any that needs it."""
    lanes = lay_out([physical_record(scenario)], shape, 1e-4)
    integrate(shape, lanes, 1e-5, 1, decimation_taps(1), 0, 1)


def steps_per_sample(record: Record, scenario: Scenario, recipe: Recipe) -> int:
    """Steps per sample that the stiffest mode of a record needs.

    Raises
    ------
    SimulationError
        If the recipe asks for fewer than the mode can bear, or the mode for more than are allowed.
    """
    fs = recipe.recording.sample_rate_hz
    machine = record.machine
    rate = max(float(fastest_swing(machine, record.bearing.n_balls)), fastest_decay(machine) / 2.5)
    asked = recipe.recording.oversampling
    if asked is not None:
        if rate / (asked * fs) > COARSEST_STEP:
            need = math.ceil(rate / (fs * FINE_STEP))
            raise SimulationError(
                f"record {scenario.record.number}: its stiffest mode of {rate / 2 / math.pi:.0f} Hz is too fast for a step of "
                f"{1e6 / (asked * fs):.3g} us; raise recording.oversampling to {need} or leave it out."
            )
        return asked
    for factor in _FACTORS:
        if rate / (factor * fs) <= FINE_STEP:
            return factor
    raise SimulationError(
        f"record {scenario.record.number}: its stiffest mode of {rate / 2 / math.pi:.0f} Hz needs more than {_FACTORS[-1]} steps per "
        f"sample at {fs:g} Hz; soften the machine or raise recording.sample_rate_hz."
    )


def fastest_decay(machine: Machine) -> float:
    """Upper bound of the damping rates [1/s]."""
    inverse = 1 / machine.shaft_mass + 1 / machine.housing_mass
    rate = (machine.ring_damping + 3 * machine.contact_damping) * inverse + machine.shaft_damping / machine.shaft_mass
    rate += max(machine.support_damping_x, machine.support_damping_y) / machine.housing_mass
    if machine.sensor_mass > 0:
        rate += machine.sensor_damping * (1 / machine.sensor_mass + 1 / machine.housing_mass)
    return rate


def physical_record(scenario: Scenario) -> Record:
    """What the kernel needs of a scenario."""
    rig, specimen, record = scenario.rig, scenario.specimen, scenario.record
    conditions = record.conditions
    rng = scenario.rng(Purpose.MOTION)
    shaft, cage, spin = rng.uniform(0, 2 * np.pi, 3)
    omega = 2 * math.pi * conditions["shaft"]
    turning = Motion(
        shaft_rate=conditions["shaft"],
        speed_rms=conditions["speed_wander"],
        mean_slip=conditions["mean_slip"],
        slip_rms=conditions["slip"],
        spin_rms=specimen.axis.get("spin_wander", 0.0),
        jitter_rms=conditions["jitter"],
        axis_offset=specimen.axis.get("axis_offset", 0.0),
        axis_rms=specimen.axis.get("axis_wander", 0.0),
        axis_limit=specimen.axis.get("track", 0.0),
        unbalance=rig.machine["shaft_mass"] * rig.machine["balance"] / omega,
        shaft_angle=shaft,
        cage_angle=cage,
        spin_angle=spin,
    )
    pickups = np.zeros((len(rig.channels), 6))
    for row, (body, angle) in zip(pickups, rig.channels, strict=True):
        row[_BODIES[body] : _BODIES[body] + 2] = math.cos(angle), math.sin(angle)
    shift = rig.machine["load_angle"]
    spalls = tuple(s._replace(angle=s.angle + shift) if s.site == "outer" else s for s in specimen.spalls)
    frequencies, phases = _processes(specimen.bearing, conditions["shaft"], rng)
    return Record(
        specimen.bearing, _machine(scenario), turning, spalls, frequencies, phases, pickups, _waviness(scenario)
    )


def _machine(scenario: Scenario) -> Machine:
    drawn, resonator = scenario.rig.machine, scenario.rig.resonator
    bearing, load = scenario.specimen.bearing, scenario.record.conditions["load"]
    mass = drawn["shaft_mass"] + drawn["housing_mass"]
    stiffness_x = mass * (2 * math.pi * drawn["support_frequency"]) ** 2
    stiffness_y = stiffness_x * drawn["support_ratio"]
    spring, damper = (0.0, 0.0) if resonator is None else sensor_springs(*resonator.values())
    return Machine(
        load_deflection_factor=stiffness_of(bearing),
        contact_damping=drawn["contact_damping"],
        contact_cosine=math.cos(bearing.contact_angle),
        half_clearance=scenario.specimen.properties["diametral_clearance"] / 2,
        ball_radius=bearing.ball_diameter / 2,
        shaft_mass=drawn["shaft_mass"],
        housing_mass=drawn["housing_mass"],
        sensor_mass=0.0 if resonator is None else resonator["mass"],
        ring_damping=drawn["ring_damping"],
        shaft_damping=drawn["shaft_damping"],
        shaft_stiffness=drawn["shaft_stiffness"],
        ring_stiffness_x=drawn["ring_stiffness"],
        ring_stiffness_y=drawn["ring_stiffness"],
        support_stiffness_x=stiffness_x,
        support_stiffness_y=stiffness_y,
        support_damping_x=2 * drawn["support_damping"] * math.sqrt(stiffness_x * mass),
        support_damping_y=2 * drawn["support_damping"] * math.sqrt(stiffness_y * mass),
        sensor_stiffness_x=spring,
        sensor_stiffness_y=spring,
        sensor_damping=damper,
        load_x=load * math.cos(drawn["load_angle"]),
        load_y=load * math.sin(drawn["load_angle"]),
    )


stiffness_of = functools.lru_cache(maxsize=4096)(load_deflection_factor)


def _processes(bearing: Bearing, shaft_rate: float, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and phases [rad] of the terms of all processes, shape (term,): log-uniform within each process's band."""
    ftf = orders(bearing).ftf * shaft_rate
    bands = np.repeat(
        np.array([[0.3, 3.0], [0.2 * shaft_rate, 2 * shaft_rate], [0.05 * shaft_rate, 0.6 * shaft_rate],
                  [0.05 * shaft_rate, 0.6 * shaft_rate], [0.3 * ftf, 3 * ftf]]),
        [motion.SPEED_TERMS, motion.SLIP_TERMS, motion.SPIN_TERMS, motion.AXIS_TERMS, motion.JITTER_TERMS * bearing.n_balls],
        axis=0,
    )  # fmt: skip
    u = rng.random((2, n_terms(bearing.n_balls)))
    return bands[:, 0] * (bands[:, 1] / bands[:, 0]) ** u[0], 2 * np.pi * u[1]


def _waviness(scenario: Scenario) -> FloatArray:
    """Fourier amplitudes of both races, shape (row,) [m]: falling with the order, random phases, the specimen's own."""
    rms = scenario.specimen.properties["waviness"]
    if rms == 0:
        return np.empty(0)
    rng = stream(scenario.seed, scenario.rig.number, scenario.specimen.number, 0, Purpose.WAVINESS)
    falling = 1 / np.arange(motion.LOWEST_ORDER, motion.HIGHEST_ORDER + 1)
    falling *= rms * math.sqrt(2) / np.linalg.norm(falling)
    phase = rng.uniform(0, 2 * np.pi, (2, motion.N_ORDERS))
    return np.concatenate([falling * part for race in phase for part in (np.cos(race), np.sin(race))])


def true_motion(scenario: Scenario, recipe: Recipe) -> tuple[float, Orders]:
    """Mean shaft rate [Hz] over the record and mean fault orders, wander and slip included."""
    conditions = scenario.record.conditions
    rng = scenario.rng(Purpose.MOTION)
    rng.uniform(0, 2 * np.pi, 3)
    frequencies, phases = _processes(scenario.specimen.bearing, conditions["shaft"], rng)
    start, duration = recipe.recording.settle_s, recipe.recording.duration_s

    def mean(first: int, terms: int) -> float:
        turn = 2 * np.pi * frequencies[first : first + terms]
        phase = phases[first : first + terms]
        swing = np.sin(turn * (start + duration) + phase) - np.sin(turn * start + phase)
        return float(np.sum(swing / (turn * duration)) * math.sqrt(2 / terms))

    rate = conditions["shaft"] * (1 + conditions["speed_wander"] * mean(0, motion.SPEED_TERMS))
    slip = conditions["mean_slip"] + conditions["slip"] * mean(motion.SLIP_FIRST, motion.SLIP_TERMS)
    found = slipping_orders(scenario.specimen.bearing, slip)
    wander = scenario.specimen.axis.get("spin_wander", 0.0) * mean(motion.SPIN_FIRST, motion.SPIN_TERMS)
    return rate, found._replace(bsf=found.bsf * (1 + wander))
