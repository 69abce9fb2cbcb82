"""Records of one shape, laid out in lanes for the kernel.

A record is a :class:`Machine` in :class:`Motion` with its spalls. The last batch is padded with copies of its first record.
"""

import math
from typing import NamedTuple

import numpy as np

from gen.physics.bearing import Bearing
from gen.physics.kernel import equations, turning
from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.drop import PROFILES
from gen.physics.kernel.equations import FloatArray, Shape
from gen.physics.rotor import Machine, as_columns, rest

WAVES = 4 * turning.N_ORDERS  # amplitudes of both races


class Spall(NamedTuple):
    """One spall, in SI units; ``ball`` says which ball carries it if ``site`` is ``ball``."""

    site: str
    width: float
    depth: float
    angle: float
    ball: int = 0
    profile: str = "geometric"
    table: tuple[tuple[float, ...], ...] = ()
    """Drops from edge to edge, evenly spaced [m], if ``profile`` is ``table``: on the race, or for a ball on either race."""


class Motion(NamedTuple):
    """How one record turns and is pulled: rates, processes of unit rms with their rms, angles at the start, outer forces [SI units]."""

    shaft_rate: float
    speed_rms: float = 0.0
    mean_slip: float = 0.0
    slip_rms: float = 0.0
    spin_rms: float = 0.0
    jitter_rms: float = 0.0
    axis_offset: float = 0.0
    axis_rms: float = 0.0
    axis_limit: float = 0.0
    unbalance: float = 0.0
    shaft_angle: float = 0.0
    cage_angle: float = 0.0
    spin_angle: float = 0.0
    bow: float = 0.0
    """Force that turns with the shaft whatever its speed: a bent shaft in its bearings [N]."""
    twice_x: float = 0.0
    twice_y: float = 0.0
    """Force along a fixed direction at twice the shaft rate: misalignment [N]."""
    knock: float = 0.0
    knock_angle: float = 0.0
    """Knock of the cage on the housing, once per turn of the cage when its first pocket is there [N, rad]."""
    knock_seed: int = 0
    """Whole number that the scatter of the knocks follows from."""
    late_ball: int = -1
    late_by: float = 0.0
    """A ball that leads or lags its place in the cage [rad]."""


class Record(NamedTuple):
    """Everything the kernel needs of one record."""

    bearing: Bearing
    machine: Machine
    motion: Motion
    spalls: tuple[Spall, ...]
    frequencies: FloatArray
    """Frequencies of the terms of all processes, shape (term,) [Hz]; see :func:`n_terms`."""
    phases: FloatArray
    """Their phases, shape (term,) [rad]."""
    pickups: FloatArray
    """Weights of the six accelerations in each channel, shape (channel, coordinate) [1]."""
    waves: FloatArray
    """Waviness amplitudes [m], shape (race, real and imaginary part, order), in a row, and if the balls have some those of the balls, shape
    (order, part, ball); or empty."""
    schedule: FloatArray = np.empty((0, 2))
    """Factors of shaft rate (over the knot) and load (at its start), shape (knot, 2); (0, 2) if both are constant."""
    displacement: bool = False
    """Whether the channels give displacements [m] instead of accelerations [m s-2]."""


def n_terms(n_balls: int) -> int:
    """Number of cosine terms of all processes: speed, slip, spin, spin axis, and the jitter of every ball."""
    return turning.JITTER_FIRST + turning.JITTER_TERMS * n_balls


def spall_reach(bearing: Bearing, spall: Spall) -> tuple[float, float]:
    """Half the angle a spall spans [rad] and the radius on which it does [m]."""
    arc = {"inner": bearing.inner_radius, "outer": bearing.outer_radius, "ball": bearing.ball_diameter / 2}[spall.site]
    return 0.5 * spall.width / arc, arc


def record_shape(record: Record) -> Shape:
    """Shape of the kernel that a record needs; it depends on nothing but the record."""
    turning = record.motion
    return equations.make_shape(
        record.bearing.n_balls,
        len(record.pickups),
        displacement=record.displacement,
        resonator=record.machine.sensor_mass > 0,
        damped=record.machine.contact_damping > 0,
        wavy=record.waves.size > 0,
        spalled=bool(record.spalls) or record.waves.size > 0,  # a wavy bearing shares its kernel with its damaged twins
        jittered=turning.jitter_rms > 0 or turning.late_by != 0,
        forced=record.schedule.size > 0 or bool(turning.twice_x or turning.twice_y or turning.knock),
        loose=record.machine.looseness > 0,
        roller=record.bearing.roller_length is not None,
    )


def lay_out(records: list[Record], shape: Shape, knot: float, *, at_rest: bool = True) -> turning.Lanes:
    """Records in lanes, at most ``LANES`` of them and all of ``shape``, starting from rest or from zero.

    ``knot`` is the time between two knots [s].
    """
    padded = records + [records[0]] * (LANES - len(records))
    machines = as_columns([record.machine for record in padded])
    motions = Motion(*np.asarray([record.motion for record in padded], dtype=float).T)
    n_balls = len(shape.balls)
    state = np.zeros((equations.N_STATE, LANES))
    cage = np.asarray(motions.cage_angle)
    if at_rest:
        places = cage[:, None] + 2 * np.pi * np.arange(n_balls) / n_balls
        state[:4] = rest(machines, places).T
        state[4:6] = state[2:4]
    state[equations.CAGE_C], state[equations.CAGE_S] = np.cos(cage), np.sin(cage)
    state[equations.SHAFT_C], state[equations.SHAFT_S] = np.cos(motions.shaft_angle), np.sin(motions.shaft_angle)
    spalls, tables = _spalls(padded)
    return turning.Lanes(
        state.ravel(),
        _params(padded, machines, shape).ravel(),
        _drive(padded, motions, machines, knot).ravel(),
        np.stack([motions.shaft_angle, motions.cage_angle, motions.spin_angle]).ravel(),
        spalls.ravel(),
        _phasors(padded, knot).ravel(),
        np.empty(0),
        _waves(padded, shape).ravel(),
        _schedules(padded),
        tables,
    )


def _params(records: list[Record], machine: Machine, shape: Shape) -> FloatArray:
    params = np.zeros((equations.direction_row(shape), LANES))
    with np.errstate(divide="ignore"):
        sensor = np.where(np.asarray(machine.sensor_mass) > 0, 1 / np.asarray(machine.sensor_mass), 0.0)
    damping = np.divide(machine.contact_damping, machine.load_deflection_factor)
    params[: equations.N_CONSTANTS] = [
        machine.load_deflection_factor, damping, machine.contact_cosine, machine.half_clearance,
        1 / np.asarray(machine.shaft_mass), 1 / np.asarray(machine.housing_mass), sensor, machine.ring_damping,
        machine.shaft_damping, machine.shaft_stiffness, machine.ring_stiffness_x, machine.ring_stiffness_y,
        machine.support_stiffness_x, machine.support_stiffness_y, machine.support_damping_x, machine.support_damping_y,
        machine.sensor_stiffness_x, machine.sensor_stiffness_y, machine.sensor_damping, machine.looseness,
    ]  # fmt: skip
    params[equations.FORCES], params[equations.FORCES + 1] = machine.load_x, machine.load_y
    for lane, record in enumerate(records):
        params[equations.PICKUPS :, lane] = record.pickups.ravel()
    return params


def _drive(records: list[Record], motions: Motion, machine: Machine, knot: float) -> FloatArray:
    bearings = [record.bearing for record in records]
    gamma = np.array([bearing.gamma for bearing in bearings])
    size = np.array([bearing.pitch_diameter / bearing.ball_diameter for bearing in bearings])
    x, y = np.asarray(motions.twice_x), np.asarray(motions.twice_y)
    twice_c, twice_s = x * x - y * y, 2 * x * y  # of twice the angle, but for their size
    size_of_both = np.maximum(x * x + y * y, 1e-300)
    return np.array([
        2 * np.pi * knot * np.asarray(motions.shaft_rate), 0.5 * (1 - gamma), 0.5 * size * (1 - gamma**2), motions.mean_slip,
        motions.speed_rms, motions.slip_rms, motions.spin_rms, motions.jitter_rms, motions.axis_offset, motions.axis_rms,
        motions.axis_limit, motions.unbalance, machine.half_clearance, machine.ball_radius,
        [bearing.inner_radius for bearing in bearings], [bearing.outer_radius for bearing in bearings],
        machine.load_x, machine.load_y, motions.twice_x, motions.twice_y, twice_c / size_of_both, twice_s / size_of_both,
        motions.bow, motions.knock, motions.knock_angle, motions.late_ball, motions.late_by, motions.knock_seed,
    ])  # fmt: skip


def _spalls(records: list[Record]) -> tuple[FloatArray, FloatArray]:
    """Spalls, shape (spall, row, lane), and the tables of those that have one, shape (table, point)."""
    sites = {"inner": turning.INNER, "outer": turning.OUTER, "ball": turning.BALL_SITE}
    spalls = np.zeros((max(len(record.spalls) for record in records), turning.SPALL_ROWS, LANES))
    tables = [np.zeros(turning.TABLE_POINTS)]
    # of a ball from its place in the cage, at most: all terms at their peaks
    farthest = [r.motion.jitter_rms * math.sqrt(2 * turning.JITTER_TERMS) + abs(r.motion.late_by) for r in records]
    spalls[:, turning.PERIOD] = 1.0
    spalls[:, turning.REACH] = -1.0  # where there is no spall, no ball is near
    for lane, record in enumerate(records):
        for place, spall in enumerate(record.spalls):
            half, arc = spall_reach(record.bearing, spall)
            profile = PROFILES.index(spall.profile)
            with_rings = {
                "inner": (1, -1, 0, -spall.angle),
                "outer": (1, 0, 0, -spall.angle),
                "ball": (0, 0, 1, spall.angle),
            }
            period = np.pi if spall.site == "ball" else 2 * np.pi / record.bearing.n_balls
            spalls[place, :, lane] = (
                *with_rings[spall.site], period, half + farthest[lane], sites[spall.site], spall.ball, half, arc, spall.depth, profile,
                len(tables),
            )  # fmt: skip
            for drops in spall.table:
                points = np.linspace(0, len(drops) - 1, turning.TABLE_POINTS)
                tables.append(np.interp(points, np.arange(len(drops)), drops))
    return spalls, np.stack(tables)


def _waves(records: list[Record], shape: Shape) -> FloatArray:
    """Waviness amplitudes as :class:`turning.Lanes` has them, shape (row, lane)."""
    n_balls, terms = len(shape.balls), turning.n_terms(shape)
    of_races = max(record.waves.size > 0 for record in records)
    of_balls = max(record.waves.size > WAVES for record in records)
    waves = np.zeros((turning.race_rows(shape) * of_races + 2 * turning.BALL_ORDERS * n_balls * of_balls, LANES))
    for lane, record in enumerate(records):
        if record.waves.size:
            races = np.zeros((2, terms * n_balls, 2))
            own = record.waves[:WAVES].reshape(2, 2, -1).transpose(0, 2, 1)
            races[:, turning.LOWEST_ORDER : turning.HIGHEST_ORDER + 1] = own
            waves[: races.size, lane] = races.ravel()
        if record.waves.size > WAVES:
            balls = record.waves[WAVES:].reshape(turning.BALL_ORDERS, 2, n_balls).transpose(0, 2, 1)
            waves[turning.race_rows(shape) :, lane] = balls.ravel()
    return waves


def _schedules(records: list[Record]) -> FloatArray:
    """Factors of shaft rate and load, shape (knot, 2, lane): the last ones hold, and 1 where there is no schedule."""
    length = max(len(record.schedule) for record in records)
    schedules = np.ones((length, 2, LANES))
    for lane, record in enumerate(records):
        if len(record.schedule):
            schedules[:, :, lane] = record.schedule[np.minimum(np.arange(length), len(record.schedule) - 1)]
    return schedules


def _phasors(records: list[Record], knot: float) -> FloatArray:
    phases = np.stack([record.phases for record in records], axis=1)
    turns = 2 * np.pi * knot * turning.STRIDE * np.stack([record.frequencies for record in records], axis=1)
    return np.stack([np.cos(phases), np.sin(phases), np.cos(turns), np.sin(turns)], axis=1)
