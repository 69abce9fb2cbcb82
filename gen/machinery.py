"""What the kernel needs of a scenario: constants of the machine, its motion, its spalls and the course of speed and load.

Temperature, oil and axial load act here, once per record: they change clearance, contact stiffness and damping.
"""

import functools
import math

import numpy as np
from numpy.typing import NDArray

from gen.physics import motion
from gen.physics.axial import axial_approach
from gen.physics.batch import Motion, Record, n_terms
from gen.physics.batch import Spall as KernelSpall
from gen.physics.bearing import Bearing, Orders, orders, slipping_orders
from gen.physics.course import mean_share, share_at
from gen.physics.hertz import contact_exponent, footprints, load_deflection_factor
from gen.physics.integrate import HALF_TAPS
from gen.physics.lubricant import Lubricant, film, lubricated_factor, warm_clearance
from gen.physics.rotor import STRIBECK, Machine, sensor_springs
from gen.physics.spall import PROFILES, drop, largest_drop
from gen.physics.trace import felt, places, rolled, roughened
from gen.recipe import Recipe
from gen.scenarios import Purpose, Scenario, Spall, stream

FloatArray = NDArray[np.float64]

LEAVES_LOAD_ZONE = math.pi / 3  # where the pocket of a broken cage knocks, from the load on
LOAD_TERMS = 8
_BODIES = {"shaft": 0, "housing": 2, "sensor": 4}


def physical_record(scenario: Scenario, recipe: Recipe) -> Record:
    """What the kernel needs of a scenario; the recipe gives the times of the knots."""
    rig, specimen, record = scenario.rig, scenario.specimen, scenario.record
    drawn, conditions = rig.machine, record.conditions
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
        unbalance=drawn["shaft_mass"] * drawn["balance"] / omega,
        shaft_angle=shaft,
        cage_angle=cage,
        spin_angle=spin,
        bow=drawn["bow"],
        twice_x=drawn["misalignment"] * math.cos(drawn["misalignment_angle"]),
        twice_y=drawn["misalignment"] * math.sin(drawn["misalignment_angle"]),
        knock=specimen.cage.get("knock", 0.0),
        knock_angle=drawn["load_angle"] + LEAVES_LOAD_ZONE,
        late_ball=0 if specimen.cage else -1,
        late_by=specimen.cage.get("pitch_error", 0.0),
    )
    pickups = np.zeros((len(rig.channels), 6))
    for row, (body, angle) in zip(pickups, rig.channels, strict=True):
        row[_BODIES[body] : _BODIES[body] + 2] = math.cos(angle), math.sin(angle)
    frequencies, phases = _processes(specimen.bearing, conditions["shaft"], rng)
    return Record(
        specimen.bearing, _machine(scenario, cage), turning, _kernel_spalls(scenario), frequencies, phases, pickups,
        _waviness(scenario), _schedule(scenario, recipe),
    )  # fmt: skip


def _machine(scenario: Scenario, cage_angle: float) -> Machine:
    drawn, resonator = scenario.rig.machine, scenario.rig.resonator
    bearing, load = scenario.specimen.bearing, scenario.record.conditions["load"]
    mass = drawn["shaft_mass"] + drawn["housing_mass"]
    stiffness_x = mass * (2 * math.pi * drawn["support_frequency"]) ** 2
    stiffness_y = stiffness_x * drawn["support_ratio"]
    spring, damper = (0.0, 0.0) if resonator is None else sensor_springs(*resonator.values())
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
    return machine._replace(half_clearance=half_clearance - axial_approach(machine, axial, angles))


def _contact(scenario: Scenario) -> tuple[float, float, float]:
    """Load-deflection factor, damping [N s/m] and half the clearance [m] of a ball, as warm and as oiled as it runs."""
    bearing, conditions, oil = scenario.specimen.bearing, scenario.record.conditions, scenario.rig.lubricant
    factor, clearance = stiffness_of(bearing), scenario.specimen.properties["diametral_clearance"]
    clearance = warm_clearance(bearing, clearance, conditions["inner_ring_hotter"])
    if oil is None:
        return factor, 0.0, clearance / 2
    heaviest = heaviest_ball_load(scenario)
    made = film(bearing, Lubricant(*oil.values()), conditions["temperature"], conditions["shaft"], heaviest)
    softer = lubricated_factor(factor, contact_exponent(bearing), heaviest, made.stiffness)
    return softer, made.damping, clearance / 2 - made.thickness


def heaviest_ball_load(scenario: Scenario) -> float:
    """Static load of the most loaded ball after Stribeck [N]."""
    return STRIBECK * scenario.record.conditions["load"] / scenario.specimen.bearing.n_balls


stiffness_of = functools.lru_cache(maxsize=4096)(load_deflection_factor)


def _kernel_spalls(scenario: Scenario) -> tuple[KernelSpall, ...]:
    """Spalls as the kernel knows them; outer race angles count from x there, and rough or wide contacts make tables."""
    shift = scenario.rig.machine["load_angle"]
    found = []
    for number, spall in enumerate(scenario.specimen.spalls):
        angle = spall.angle + (shift if spall.site == "outer" else 0.0)
        plain = KernelSpall(spall.site, spall.width, spall.depth, angle, spall.ball, spall.profile)
        found.append(_tabulated(scenario, number, plain) if _needs_table(scenario, spall) else plain)
    return tuple(found)


def _needs_table(scenario: Scenario, spall: Spall) -> bool:
    return scenario.rig.footprint or spall.profile == "trace" or spall.roughness > 0


def _tabulated(scenario: Scenario, number: int, plain: KernelSpall) -> KernelSpall:
    paths = spall_paths(scenario, number)
    if not scenario.rig.footprint:
        return plain._replace(profile="table", table=tuple(tuple(path) for path in paths))
    inner, outer = footprints(scenario.specimen.bearing, heaviest_ball_load(scenario))
    widths = {"inner": (inner,), "outer": (outer,), "ball": (inner, outer)}[plain.site]
    margin = max(widths)
    table = tuple(tuple(felt(path, plain.width, b, margin)) for path, b in zip(paths, widths, strict=True))
    return plain._replace(profile="table", width=plain.width + 2 * margin, table=table)


def spall_paths(scenario: Scenario, number: int) -> tuple[FloatArray, ...]:
    """Path of the middle of a contact over a spall, shape (point,), on each race that its balls roll on there [m]."""
    specimen, spall = scenario.specimen, scenario.specimen.spalls[number]
    bearing = specimen.bearing
    inner, outer = bearing.inner_radius, -bearing.outer_radius
    races = {"inner": (inner,), "outer": (outer,), "ball": (inner, outer)}[spall.site]
    place = scenario.seed, scenario.rig.number, specimen.number, number
    return _paths(spall, bearing.ball_diameter / 2, races, place)


def deepest(scenario: Scenario, number: int) -> float:
    """Largest drop over a spall, on whichever race is deeper [m]."""
    spall, bearing = scenario.specimen.spalls[number], scenario.specimen.bearing
    if spall.profile != "geometric" or spall.roughness > 0:
        return max(float(path.max()) for path in spall_paths(scenario, number))
    ball = bearing.ball_diameter / 2
    arc = {"inner": bearing.inner_radius, "outer": bearing.outer_radius, "ball": ball}[spall.site]
    race = -bearing.outer_radius if spall.site == "outer" else bearing.inner_radius
    return largest_drop(spall.width, arc, ball, race, spall.depth)


@functools.lru_cache(maxsize=256)
def _paths(
    spall: Spall, ball: float, races: tuple[float, ...], place: tuple[int, int, int, int]
) -> tuple[FloatArray, ...]:
    at = places(spall.width)
    if spall.profile not in ("geometric", "trace"):
        arc = ball if spall.site == "ball" else abs(races[0])
        profile, half = PROFILES.index(spall.profile), 0.5 * spall.width / arc
        one = np.array([drop(profile, x / arc, half, arc, ball, races[0], spall.depth) for x in at])
        return (one,) * len(races)
    depths = np.full(len(at), spall.depth)
    if spall.profile == "trace":
        depths = np.interp(at, np.linspace(at[0], at[-1], len(spall.trace)), spall.trace)
    if spall.roughness > 0:
        depths = roughened(depths, spall.roughness, stream(*place, Purpose.ROUGHNESS))
    return tuple(rolled(depths, spall.width, ball, race) for race in races)


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


def _schedule(scenario: Scenario, recipe: Recipe) -> FloatArray:
    """Factors of shaft rate and load at the knots, shape (knot, 2); (0, 2) if both are constant."""
    record = scenario.record
    wander = record.conditions["load_wander"]
    if record.speed_course is None and record.load_course is None and wander == 0:
        return np.empty((0, 2))
    fs = recipe.recording.sample_rate_hz
    settling = round(recipe.recording.settle_s * fs)
    times = (np.arange(settling + recipe.n_samples + HALF_TAPS + 2) - settling) / fs
    factors = np.ones((len(times), 2))
    if record.speed_course is not None:
        factors[:, 0] = share_at(record.speed_course, times + 0.5 / fs)
    if record.load_course is not None:
        factors[:, 1] = share_at(record.load_course, times)
    if wander > 0:
        rng, shaft_rate = scenario.rng(Purpose.COURSE), record.conditions["shaft"]
        rates = 2 * np.pi * shaft_rate * 0.05 ** rng.random(LOAD_TERMS)
        waves = np.cos(times[:, None] * rates + rng.uniform(0, 2 * np.pi, LOAD_TERMS))
        factors[:, 1] *= np.maximum(1 + wander * math.sqrt(2 / LOAD_TERMS) * waves.sum(axis=1), 0.0)
    return factors


def _waviness(scenario: Scenario) -> FloatArray:
    """Fourier amplitudes of both races, and of the balls if they have some, shape (row,) [m]: the specimen's own, phases random."""
    specimen, properties = scenario.specimen, scenario.specimen.properties
    rms, of_balls, wear = properties["waviness"], properties["ball_waviness"], specimen.wear
    if rms == 0 and of_balls == 0 and wear is None:
        return np.empty(0)
    rng = stream(scenario.seed, scenario.rig.number, specimen.number, 0, Purpose.WAVINESS)
    every = np.arange(motion.LOWEST_ORDER, motion.HIGHEST_ORDER + 1)
    races = _falling(every) * rms * np.exp(1j * rng.uniform(0, 2 * np.pi, (2, motion.N_ORDERS)))
    even = 2 * np.arange(1, motion.BALL_ORDERS + 1)
    n_balls = specimen.bearing.n_balls
    # a ball's two contacts see the same height in even orders: together twice as much
    balls = 2 * of_balls * _falling(even)[:, None] * np.exp(1j * rng.uniform(0, 2 * np.pi, (len(even), n_balls)))
    if wear is not None:
        rng = stream(scenario.seed, scenario.rig.number, specimen.number, 0, Purpose.WEAR)
        worn = _falling(every) if wear.order is None else math.sqrt(2) * (every == wear.order)
        races[("inner", "outer").index(wear.site)] += (
            worn * wear.waviness * np.exp(1j * rng.uniform(0, 2 * np.pi, len(every)))
        )
    rows = np.concatenate([part for race in races for part in (race.real, race.imag)])
    if of_balls == 0:
        return rows
    return np.concatenate([rows, np.stack([balls.real, balls.imag], axis=1).ravel()])


def _falling(orders_of_turn: NDArray[np.int_]) -> FloatArray:
    """Amplitudes that fall as 1/order, of unit rms together [1]."""
    falling = 1 / orders_of_turn
    return falling * (math.sqrt(2) / np.linalg.norm(falling))


def true_motion(scenario: Scenario, recipe: Recipe) -> tuple[float, Orders]:
    """Mean shaft rate [Hz] over the record and mean fault orders, course, wander and slip included."""
    conditions = scenario.record.conditions
    rng = scenario.rng(Purpose.MOTION)
    rng.uniform(0, 2 * np.pi, 3)
    frequencies, phases = _processes(scenario.specimen.bearing, conditions["shaft"], rng)
    start, duration, course = recipe.recording.settle_s, recipe.recording.duration_s, scenario.record.speed_course

    def mean(first: int, terms: int) -> float:
        """Over the turns of the shaft, which are even in time without a course."""
        turn = 2 * np.pi * frequencies[first : first + terms]
        phase = phases[first : first + terms]
        if course is not None:
            points = int(
                np.clip(20 * conditions["shaft"] * duration, 2**12, 2**17)
            )  # ten to a cycle of the fastest process
            times = (np.arange(points) + 0.5) * (duration / points)
            share = share_at(course, times)
            waves = np.cos(np.outer(start + times, turn) + phase).sum(axis=1)
            return float(share @ waves / share.sum() * math.sqrt(2 / terms))
        swing = np.sin(turn * (start + duration) + phase) - np.sin(turn * start + phase)
        return float(np.sum(swing / (turn * duration)) * math.sqrt(2 / terms))

    rate = conditions["shaft"] * mean_share(course, duration)
    rate *= 1 + conditions["speed_wander"] * mean(0, motion.SPEED_TERMS)
    slip = conditions["mean_slip"] + conditions["slip"] * mean(motion.SLIP_FIRST, motion.SLIP_TERMS)
    found = slipping_orders(scenario.specimen.bearing, slip)
    wander = scenario.specimen.axis.get("spin_wander", 0.0) * mean(motion.SPIN_FIRST, motion.SPIN_TERMS)
    return rate, found._replace(bsf=found.bsf * (1 + wander))
