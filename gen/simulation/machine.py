"""What the kernel needs of a scenario: constants of the machine, its motion, and the profiles of speed and load.

Temperature, oil and axial load act here, once per record: they change clearance, contact stiffness and damping.
"""

import functools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.physics.axial import axial_approach
from gen.physics.bearing import Bearing, Orders, orders, slipping_orders
from gen.physics.elementary import exponential, power
from gen.physics.hertz import contact_exponent, load_deflection_factor
from gen.physics.kernel import turning as motion
from gen.physics.kernel.batch import Motion, Record, n_terms
from gen.physics.kernel.decimate import LEAD
from gen.physics.lubricant import Lubricant, film, lubricated_factor, warm_clearance
from gen.physics.profile import mean_share, share_at
from gen.physics.rating import LEAST_SAFETY, equivalent_load, static_rating
from gen.physics.rotor import STRIBECK, Machine, sensor_springs
from gen.recipe import Recipe
from gen.scenarios import Purpose, Scenario, stream
from gen.simulation.damage import kernel_spalls, waviness

FloatArray = NDArray[np.float64]

LEAVES_LOAD_ZONE = math.pi / 3  # where the pocket of a broken cage knocks, from the load on
LOAD_TERMS = 8
THICKEST_FILM = 10e-6  # m, both contacts; measured films are below 2 um
_BODIES = {"shaft": 0, "housing": 2, "sensor": 4}


def physical_record(scenario: Scenario, recipe: Recipe) -> Record:
    """What the kernel needs of a scenario; the recipe gives the times of the knots.

    Raises
    ------
    ValueError
        If no such machine can stand.
    """
    bare = bare_record(scenario, recipe)
    return bare._replace(
        spalls=kernel_spalls(scenario, heaviest_ball_load(scenario)),
        waves=waviness(scenario, recipe.recording.sample_rate_hz),
        schedule=schedule(scenario, recipe),
    )


def bare_record(scenario: Scenario, recipe: Recipe) -> Record:
    """What the kernel needs of a scenario but for its spalls, waviness and schedule, which take most of the time to make.

    Raises
    ------
    ValueError
        If no such machine can stand.
    """
    rig, specimen, record = scenario.rig, scenario.specimen, scenario.record
    drawn, conditions = rig.machine, record.conditions
    check_load(scenario)
    start = _start(scenario)
    # a balance grade is that of the highest speed a machine is made for (ISO 21940-11)
    highest_rate = recipe.operation.shaft_rpm.support()[1] / 60
    turning = Motion(
        shaft_rate=conditions["shaft"],
        speed_rms=conditions["speed_wander"],
        mean_slip=conditions["mean_slip"],
        slip_rms=conditions["slip"],
        spin_rms=conditions["spin_wander"],
        jitter_rms=conditions["jitter"],
        axis_offset=specimen.axis.get("axis_offset", 0.0),
        axis_rms=specimen.axis.get("axis_wander", 0.0),
        axis_limit=specimen.axis.get("track", 0.0),
        unbalance=drawn["shaft_mass"] * drawn["balance"] / (2 * math.pi * highest_rate),
        shaft_angle=start.shaft,
        cage_angle=start.cage,
        spin_angle=start.spin,
        bow=drawn["bow"],
        twice_x=drawn["misalignment"] * math.cos(drawn["misalignment_angle"]),
        twice_y=drawn["misalignment"] * math.sin(drawn["misalignment_angle"]),
        knock=specimen.cage.get("knock", 0.0),
        knock_angle=drawn["load_angle"] + LEAVES_LOAD_ZONE,
        knock_seed=int(scenario.rng(Purpose.KNOCKS).integers(2**52)) if specimen.cage else 0,
        late_ball=0 if specimen.cage else -1,
        late_by=specimen.cage.get("pitch_error", 0.0),
    )
    pickups = np.zeros((len(rig.channels), 6))
    for row, (body, angle) in zip(pickups, rig.channels, strict=True):
        row[_BODIES[body] : _BODIES[body] + 2] = math.cos(angle), math.sin(angle)
    machine = _machine(scenario, start.cage)
    return Record(specimen.bearing, machine, turning, (), start.frequencies, start.phases, pickups, np.empty(0))


def check_load(scenario: Scenario) -> None:
    """Raise ValueError if the equivalent static load of a record is absurd for the bearing on the drawing."""
    drawing, conditions, profile = scenario.rig.bearing, scenario.record.conditions, scenario.record.load_profile
    radial = conditions["load"] * (1.0 if profile is None else max(profile.shares))
    load = equivalent_load(radial, conditions["axial_load"], scenario.specimen.bearing.contact_angle)
    rating = static_rating(drawing)
    if load * LEAST_SAFETY > rating:
        raise ValueError(
            f"an equivalent static load of {load:.4g} N is more than {1 / LEAST_SAFETY:g} times the static rating of its bearing "
            f"{drawing.designation}, {rating:.4g} N; lower operation.load_n and axial_load_n, or take a larger bearing."
        )


class Start(NamedTuple):
    """Angles at the start [rad], and frequencies [Hz] and phases [rad] of the terms of all processes, shape (term,)."""

    shaft: float
    cage: float
    spin: float
    frequencies: FloatArray
    phases: FloatArray


def _start(scenario: Scenario) -> Start:
    """What is random in the motion of a record."""
    place = scenario.seed, scenario.rig.number, scenario.specimen.number, scenario.record.number
    return _start_at(place, scenario.specimen.bearing, scenario.record.conditions["shaft"])


@functools.lru_cache(maxsize=1024)  # asked for twice, by the kernel and by the labels
def _start_at(place: tuple[int, int, int, int], bearing: Bearing, shaft_rate: float) -> Start:
    rng = stream(*place, Purpose.MOTION)
    shaft, cage, spin = (2 * np.pi * rng.random(3)).tolist()
    return Start(shaft, cage, spin, *_processes(bearing, shaft_rate, rng))


def _machine(scenario: Scenario, cage_angle: float) -> Machine:
    drawn, resonator = scenario.rig.machine, scenario.rig.resonator
    bearing, load = scenario.specimen.bearing, scenario.record.conditions["load"]
    mass = drawn["shaft_mass"] + drawn["housing_mass"]
    stiffness_x = mass * (2 * math.pi * drawn["support_frequency"]) ** 2
    stiffness_y = stiffness_x * drawn["support_ratio"]
    spring = damper = 0.0
    if resonator is not None:
        spring, damper = sensor_springs(resonator["mass"], resonator["frequency"], resonator["damping"])
    factor, damping, half_clearance = _contact(scenario)
    machine = Machine(
        load_deflection_factor=factor,
        contact_damping=drawn["contact_damping"] + damping,
        contact_cosine=math.cos(bearing.contact_angle),
        half_clearance=half_clearance,
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
        looseness=drawn["looseness"],
        contact_exponent=contact_exponent(bearing),
    )
    axial = scenario.record.conditions["axial_load"]
    if axial == 0:
        return machine
    angles = cage_angle + 2 * np.pi * np.arange(bearing.n_balls) / bearing.n_balls
    profile = scenario.record.load_profile
    return machine._replace(
        half_clearance=half_clearance
        - axial_approach(machine, axial, angles, heaviest=1.0 if profile is None else max(profile.shares))
    )


def _contact(scenario: Scenario) -> tuple[float, float, float]:
    """Load-deflection factor, damping [N s/m] and half the clearance [m] of a ball, as warm and as oiled as it runs."""
    bearing, conditions, oil = scenario.specimen.bearing, scenario.record.conditions, scenario.rig.lubricant
    factor, clearance = stiffness_of(bearing), scenario.specimen.properties["diametral_clearance"]
    clearance = warm_clearance(bearing, clearance, conditions["inner_ring_hotter"])
    if oil is None:
        return factor, 0.0, clearance / 2
    heaviest = heaviest_ball_load(scenario)
    lubricant = Lubricant(oil["viscosity_40"], oil["viscosity_100"], oil["density"], oil["pressure_viscosity"])
    made = film(bearing, lubricant, conditions["temperature"], conditions["shaft"], heaviest)
    if made.thickness > THICKEST_FILM:
        raise ValueError(
            f"an oil film of {made.thickness * 1e6:.3g} um is beyond what film formulas hold for, {THICKEST_FILM * 1e6:g} um; "
            f"take thinner or warmer oil."
        )
    softer = lubricated_factor(factor, contact_exponent(bearing), heaviest, made.stiffness)
    return softer, made.damping, clearance / 2 - made.thickness


def heaviest_ball_load(scenario: Scenario) -> float:
    """Static load of the most loaded ball after Stribeck, and its share of the axial load on top [N]; preload is not counted."""
    bearing, conditions = scenario.specimen.bearing, scenario.record.conditions
    total = STRIBECK * conditions["load"]
    if conditions["axial_load"] > 0 and bearing.contact_angle != 0:
        total += conditions["axial_load"] / abs(math.sin(bearing.contact_angle))
    return total / bearing.n_balls


stiffness_of = functools.lru_cache(maxsize=4096)(load_deflection_factor)


def _processes(bearing: Bearing, shaft_rate: float, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and phases [rad] of the terms of all processes, shape (term,): log-uniform within each process's band."""
    lowest, widths, unit = _bands(bearing.n_balls)
    u = rng.random((2, n_terms(bearing.n_balls)))
    units = np.array([1.0, shaft_rate, orders(bearing).ftf * shaft_rate])
    return lowest * units[unit] * exponential(widths * u[0]), 2 * np.pi * u[1]


@functools.lru_cache(maxsize=64)
def _bands(n_balls: int) -> tuple[FloatArray, FloatArray, NDArray[np.int_]]:
    """Lower end of each term's band, log of its upper over its lower, and its unit: 1 Hz, the shaft's rate or the cage's; shape (term,)."""
    bands = np.array([[0.3, 3.0, 0], [0.2, 2, 1], [0.05, 0.6, 1], [0.05, 0.6, 1], [0.3, 3, 2]])
    terms = [motion.SPEED_TERMS, motion.SLIP_TERMS, motion.SPIN_TERMS, motion.AXIS_TERMS, motion.JITTER_TERMS * n_balls]
    low, high, unit = np.repeat(bands, terms, axis=0).T
    return low, np.array([math.log(ratio) for ratio in high / low]), unit.astype(int)


def is_scheduled(scenario: Scenario) -> bool:
    """Whether speed or load of a record follow a schedule."""
    record = scenario.record
    return not (record.speed_profile is None and record.load_profile is None and record.conditions["load_wander"] == 0)


def n_knots(recipe: Recipe) -> int:
    """Number of knots of a schedule: the samples that settle, those of the record, and what the filter takes up."""
    return round(recipe.recording.settle_s * recipe.recording.sample_rate_hz) + recipe.n_samples + LEAD + 2


def knot_times(recipe: Recipe, knots: NDArray[np.integer]) -> FloatArray:
    """Times of knots by their number, from the start of the record on, of their shape [s]."""
    fs = recipe.recording.sample_rate_hz
    return (knots - round(recipe.recording.settle_s * fs)) / fs


def schedule(scenario: Scenario, recipe: Recipe) -> FloatArray:
    """Factors of shaft rate and load at the knots, shape (knot, 2); (0, 2) if both are constant."""
    record = scenario.record
    if not is_scheduled(scenario):
        return np.empty((0, 2))
    times = knot_times(recipe, np.arange(n_knots(recipe)))
    factors = np.ones((len(times), 2))
    if record.speed_profile is not None:
        factors[:, 0] = share_at(record.speed_profile, times + 0.5 / recipe.recording.sample_rate_hz)
    if record.load_profile is not None:
        factors[:, 1] = share_at(record.load_profile, times)
    if record.conditions["load_wander"] > 0:
        factors[:, 1] *= load_wander(scenario, times)
    return factors


def load_wander(scenario: Scenario, times: FloatArray) -> FloatArray:
    """Factor of the load at evenly spaced ``times`` [s], of their shape [1]: slow, never below 0."""
    amplitude, rates, phases = wander_terms(scenario)
    return np.maximum(1 + amplitude * cosine_sum(times, rates, phases), 0.0)


def wander_terms(scenario: Scenario) -> tuple[float, FloatArray, FloatArray]:
    """Amplitude of all terms of the load's wander [1], their rates, none above that of the shaft [rad/s], and their phases [rad]."""
    rng, conditions = scenario.rng(Purpose.LOAD_WANDER), scenario.record.conditions
    rates = 2 * np.pi * conditions["shaft"] * power(0.05, rng.random(LOAD_TERMS))
    phases = rng.uniform(0, 2 * np.pi, LOAD_TERMS)
    return conditions["load_wander"] * math.sqrt(2 / LOAD_TERMS), rates, phases


def cosine_sum(times: NDArray[np.floating], rates: FloatArray, phases: FloatArray) -> FloatArray:
    """Sum over terms of ``cos(rate * time + phase)`` at evenly spaced times, shape (time,) [1]; rates in rad/s, shape (term,).

    By ``cos(a + b) = cos(a) cos(b) - sin(a) sin(b)`` from the starts of blocks and the steps within one: 16 times as fast as a
    cosine for each, and to rounding as exact. No BLAS, whose last bits may change with its threads.
    """
    length = math.isqrt(len(times))
    starts = np.outer(times[::length], rates) + phases
    steps = np.outer(rates, (times[-1] - times[0]) / (len(times) - 1) * np.arange(length))
    of_start, of_step = np.hstack([np.cos(starts), -np.sin(starts)]), np.vstack([np.cos(steps), np.sin(steps)])
    return np.einsum("bt,ts->bs", of_start, of_step).ravel()[: len(times)]


def true_motion(scenario: Scenario, recipe: Recipe) -> tuple[float, Orders]:
    """Mean shaft rate [Hz] over the record and mean fault orders, speed profile, wander and slip included."""
    conditions = scenario.record.conditions
    drawn = _start(scenario)
    start, duration, profile = recipe.recording.settle_s, recipe.recording.duration_s, scenario.record.speed_profile

    turn, phase = 2 * np.pi * drawn.frequencies[: motion.AXIS_FIRST], drawn.phases[: motion.AXIS_FIRST]
    if profile is None:
        means = (np.sin(turn * (start + duration) + phase) - np.sin(turn * start + phase)) / (turn * duration)
    else:  # over the turns of the shaft, ten to a cycle of the fastest process
        points = int(np.clip(20 * conditions["shaft"] * duration, 2**12, 2**17))
        times = (np.arange(points) + 0.5) * (duration / points)
        share = share_at(profile, times)
        means = np.einsum("t,tk->k", share, np.cos(np.outer(start + times, turn) + phase)) / share.sum()

    def mean(first: int, terms: int) -> float:
        return float(means[first : first + terms].sum()) * math.sqrt(2 / terms)

    rate = conditions["shaft"] * mean_share(profile, duration)
    rate *= 1 + conditions["speed_wander"] * mean(0, motion.SPEED_TERMS)
    slip = conditions["mean_slip"] + conditions["slip"] * mean(motion.SLIP_FIRST, motion.SLIP_TERMS)
    found = slipping_orders(scenario.specimen.bearing, slip)
    wander = conditions["spin_wander"] * mean(motion.SPIN_FIRST, motion.SPIN_TERMS)
    return rate, found._replace(bsf=found.bsf * (1 + wander))
