"""The kernel's slow, readable twin, and the same trip through the lanes to compare it with.

The twin follows one record with NumPy: every angle is an angle, every ball looks at every spall, every process is the sum of cosines it
was drawn as. All it shares with the kernel is what the kernel promises: between two knots slow quantities move along straight lines.
"""

import math
from hashlib import sha256
from inspect import getsource
from typing import NamedTuple

import numpy as np
from numba import njit

from gen.physics import gaps, kernel, lanes, motion, spall
from gen.physics.batch import Record, lay_out, record_shape
from gen.physics.integrate import place_balls, to_next_knot
from gen.physics.kernel import AXES, CAGE_C, N_DYNAMIC, N_STATE, PICKED, FloatArray, advance, param_rows
from gen.physics.lanes import KERNEL, LANES
from gen.physics.motion import ANGLE_ROWS

EVERY_ACCELERATION = np.eye(AXES)


class Trip(NamedTuple):
    """What becomes of one record from knot to knot."""

    states: FloatArray
    """Shape (knot, coordinate): x1 y1 x2 y2 xr yr [m], then their rates [m/s]."""
    accelerations: FloatArray
    """At the start of each step, shape (step, coordinate) [m s-2]."""
    angles: FloatArray
    """Of shaft, cage and ball spin, shape (knot, angle) [rad]."""
    directions: FloatArray
    """Cosine and sine of the cage's and of the shaft's angle, as the steps use them, shape (knot, 4)."""


class Slow(NamedTuple):
    """What moves along a straight line between two knots."""

    angles: FloatArray
    """Of shaft, cage and ball spin, shape (knot, angle) [rad]."""
    gaps: FloatArray
    """Under each ball, waviness taken off, shape (knot, ball) [m]."""
    jitter: FloatArray
    """Of each ball in its pocket, shape (knot, ball) [rad]."""
    share: FloatArray
    """Of its drop that a ball spall gives up to this knot, shape (knot,) [1]."""


def process(record: Record, first: int, terms: int, times: FloatArray) -> FloatArray:
    """Values of a process of unit rms, shape (time,)."""
    some = slice(first, first + terms)
    turns = 2 * np.pi * np.outer(times, record.frequencies[some]) + record.phases[some]
    return math.sqrt(2 / terms) * np.cos(turns).sum(axis=1)


def slow_motion(record: Record, knot: float, n_knots: int) -> Slow:
    """Slow quantities at the knots, ``knot`` seconds apart; rates hold from one knot to the next."""
    bearing, drawn = record.bearing, record.motion
    gamma, size = bearing.gamma, bearing.pitch_diameter / bearing.ball_diameter
    times = knot * np.arange(n_knots + 1)
    shaft = 2 * np.pi * drawn.shaft_rate * (1 + drawn.speed_rms * process(record, 0, motion.SPEED_TERMS, times))
    slip = drawn.mean_slip + drawn.slip_rms * process(record, motion.SLIP_FIRST, motion.SLIP_TERMS, times)
    wander = 1 + drawn.spin_rms * process(record, motion.SPIN_FIRST, motion.SPIN_TERMS, times)
    rates = np.stack([shaft, shaft * (1 - gamma) / 2 * (1 - slip), shaft * size / 2 * (1 - gamma**2) * wander], axis=1)
    start = np.array([drawn.shaft_angle, drawn.cage_angle, drawn.spin_angle])
    angles = start + np.concatenate([np.zeros((1, 3)), np.cumsum(knot * rates[:-1], axis=0)])
    jitter = [
        drawn.jitter_rms * process(record, motion.JITTER_FIRST + ball * motion.JITTER_TERMS, motion.JITTER_TERMS, times)
        for ball in range(bearing.n_balls)
    ]
    places = angles[:, 1:2] + 2 * np.pi * np.arange(bearing.n_balls) / bearing.n_balls
    gaps = record.machine.half_clearance - waviness(record, places - angles[:, :1], places)
    tilt = drawn.axis_offset + drawn.axis_rms * process(record, motion.AXIS_FIRST, motion.AXIS_TERMS, times)
    share = np.maximum(0.0, 1 - (tilt / drawn.axis_limit) ** 2) if drawn.axis_limit > 0 else np.ones(n_knots + 1)
    return Slow(angles, gaps, np.stack(jitter, axis=1), share)


def waviness(record: Record, on_inner: FloatArray, on_outer: FloatArray) -> FloatArray:
    """Height of both races under balls at angles measured from each race's own mark, shape of the angles [m]."""
    if record.waves.size == 0:
        return np.zeros_like(on_outer)
    orders = np.arange(motion.LOWEST_ORDER, motion.HIGHEST_ORDER + 1)
    amplitudes = record.waves.reshape(2, 2, -1)
    height = np.zeros_like(on_outer)
    for (real, imaginary), angles in zip(amplitudes, (on_inner, on_outer), strict=True):
        turns = angles[..., None] * orders
        height += (real * np.cos(turns) - imaginary * np.sin(turns)).sum(axis=-1)
    return height


def wrapped(angle: float) -> float:
    """Angle in (-pi, pi]."""
    return math.remainder(angle, 2 * math.pi)


def rigid_path(offset: float, half: float, arc: float, ball: float, race: float, depth: float) -> float:
    """Drop of the centre of a rigid ball over two sharp edges, from the triangle of ball, edge and ring [m].

    ``race`` is positive if convex (inner race), negative if concave (outer race); see MODEL.md section 5.1.
    """
    u = half - abs(offset)
    if u <= 0:
        return 0.0
    chord = arc * math.sin(u)
    if chord >= ball:  # an extended spall: the ball lies on its floor
        return depth
    lens = ball - math.sqrt(ball**2 - chord**2)
    bend = abs(race) - math.sqrt(race**2 - chord**2)
    return min(lens + math.copysign(bend, race), depth)


def drops(record: Record, angles: FloatArray, places: FloatArray, share: float) -> FloatArray:
    """How far each ball, at the angle ``places``, has dropped into all spalls together, shape (ball,) [m]."""
    bearing = record.bearing
    shaft, _, spin = angles
    ball, inner, outer = bearing.ball_diameter / 2, bearing.inner_radius, bearing.outer_radius
    total = np.zeros(bearing.n_balls)
    for fault in record.spalls:
        if fault.site == "ball":
            half = fault.width / 2 / ball
            on_inner, on_outer = wrapped(spin + fault.angle), wrapped(spin + fault.angle - math.pi)
            fallen = rigid_path(on_inner, half, ball, ball, inner, fault.depth)
            fallen += rigid_path(on_outer, half, ball, ball, -outer, fault.depth)
            total[fault.ball] += share * fallen
            continue
        race, centre = (inner, shaft + fault.angle) if fault.site == "inner" else (-outer, fault.angle)
        for number, place in enumerate(places):
            offset = wrapped(place - centre)
            total[number] += rigid_path(offset, fault.width / 2 / abs(race), abs(race), ball, race, fault.depth)
    return total


def contact_force(
    record: Record, y: FloatArray, angles: FloatArray, gaps: FloatArray, jitter: FloatArray, share: float
):
    """Force of all balls on the housing, shape (axis,) [N]."""
    machine, n_balls = record.machine, record.bearing.n_balls
    places = angles[1] + 2 * np.pi * np.arange(n_balls) / n_balls
    directions = np.stack([np.cos(places + jitter), np.sin(places + jitter)], axis=1)
    cosine = machine.contact_cosine
    squeeze = cosine * directions @ (y[0:2] - y[2:4]) - gaps - drops(record, angles, places + jitter, share)
    touching = squeeze > 0
    force = machine.load_deflection_factor * np.where(touching, squeeze, 0.0) ** 1.5
    approach = cosine * directions @ (y[6:8] - y[8:10])
    force = np.where(touching, np.maximum(force + machine.contact_damping * approach, 0.0), 0.0)
    return cosine * force @ directions


def right_hand_side(record: Record, slow: Slow, knot: float, at: int, tau: float, y: FloatArray) -> FloatArray:
    """Derivative of the state, shape (coordinate,), a share ``tau`` of the way from knot ``at`` to the next.

    MODEL.md section 4.2, term by term.
    """
    machine = record.machine
    angles, gaps, jitter = ((1 - tau) * values[at] + tau * values[at + 1] for values in slow[:3])
    share = slow.share[at + 1]
    force = contact_force(record, y, angles, gaps, jitter, share)
    (first, second, sensor), (u, v, w) = y[:6].reshape(3, 2), y[6:].reshape(3, 2)
    shaft_rate = (slow.angles[at + 1, 0] - slow.angles[at, 0]) / knot
    turning = np.array([math.cos(angles[0]), math.sin(angles[0])])
    unbalance = record.motion.unbalance * shaft_rate**2 * turning
    load = np.array([machine.load_x, machine.load_y])
    ring = np.array([machine.ring_stiffness_x, machine.ring_stiffness_y])
    support = np.array([machine.support_stiffness_x, machine.support_stiffness_y])
    leak = np.array([machine.support_damping_x, machine.support_damping_y])
    spring = np.array([machine.sensor_stiffness_x, machine.sensor_stiffness_y])
    between = force + machine.ring_damping * (u - v) + ring * (first - second)
    to_sensor = spring * (second - sensor) + machine.sensor_damping * (v - w)
    on_shaft = load + unbalance - between - machine.shaft_damping * u - machine.shaft_stiffness * first
    on_housing = between - leak * v - support * second - to_sensor
    sensor_rate = to_sensor / machine.sensor_mass if machine.sensor_mass > 0 else np.zeros(2)
    return np.concatenate([y[6:], on_shaft / machine.shaft_mass, on_housing / machine.housing_mass, sensor_rate])


def march_twin(record: Record, start: FloatArray, n_knots: int, n_steps: int, knot: float) -> Trip:
    """Classical Runge-Kutta from the state ``start``, ``n_steps`` per knot, knots ``knot`` seconds apart."""
    slow, dt = slow_motion(record, knot, n_knots), knot / n_steps
    y = np.array(start, dtype=float)
    states, accelerations = [y], []
    for at in range(n_knots):
        for step in range(n_steps):
            begin, middle, end = step / n_steps, (step + 0.5) / n_steps, (step + 1) / n_steps
            k1 = right_hand_side(record, slow, knot, at, begin, y)
            k2 = right_hand_side(record, slow, knot, at, middle, y + dt / 2 * k1)
            k3 = right_hand_side(record, slow, knot, at, middle, y + dt / 2 * k2)
            k4 = right_hand_side(record, slow, knot, at, end, y + dt * k3)
            accelerations.append(k1[6:])
            y = y + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        states.append(y)
    cage, shaft = slow.angles[:, 1], slow.angles[:, 0]
    directions = np.stack([np.cos(cage), np.sin(cage), np.cos(shaft), np.sin(shaft)], axis=1)
    return Trip(np.array(states), np.array(accelerations), slow.angles, directions)


def march_lanes(
    records: list[Record], n_knots: int, n_steps: int, knot: float, start: FloatArray | None = None
) -> list[Trip]:
    """The same by the lane kernel, one trip per record; all of one shape, from static rest unless a ``start`` is given."""
    every = [record._replace(pickups=EVERY_ACCELERATION) for record in records]
    shape = record_shape(every[0])
    batch = lay_out(every, shape, knot)
    params = np.zeros(param_rows(shape, n_steps) * LANES)
    params[: batch.params.size] = batch.params
    batch = batch._replace(params=params)
    if start is not None:
        batch.state.reshape(-1, LANES)[:N_DYNAMIC] = np.asarray(start)[:, None]
    states = np.empty((n_knots + 1, N_STATE, LANES))
    angles = np.empty((n_knots + 1, ANGLE_ROWS, LANES))
    history = np.empty(n_knots * n_steps * AXES * LANES)
    _march(shape, batch, knot / n_steps, n_steps, states, angles, history)
    accelerations = history.reshape(-1, AXES, LANES)
    return [
        Trip(states[:, :N_DYNAMIC, i], accelerations[..., i], angles[..., i], states[:, CAGE_C:PICKED, i])
        for i in range(len(records))
    ]


def _cached(sources: str):
    """Compile and cache; numba sees changes in this file alone, but what a function closes over is part of its key."""

    @njit(**KERNEL)
    def march(shape, lanes, dt, n_steps, states, angles, history):
        _ = sources
        moves = np.empty(ANGLE_ROWS * LANES)
        last, widths = np.zeros(len(shape.balls) * LANES), np.zeros(len(shape.balls) * LANES)
        place_balls(shape, lanes, n_steps, moves, last)
        for knot in range(len(states)):
            states[knot] = lanes.state.reshape(N_STATE, LANES)
            angles[knot] = lanes.angles.reshape(ANGLE_ROWS, LANES)
            if knot + 1 < len(states):
                to_next_knot(shape, lanes, knot, n_steps, dt, moves, last, widths)
                advance(shape, lanes.state, lanes.params, dt, n_steps, history, knot * n_steps * AXES)

    return march


_march = _cached(sha256("".join(map(getsource, (lanes, spall, kernel, motion, gaps))).encode()).hexdigest())
