"""A slow, readable twin of the kernel in NumPy; :mod:`tests.lanes` runs the kernel over the same time.

The twin integrates one record, and compares every ball with every spall. It shares one property with the kernel: between two knots slow
quantities change linearly (:mod:`tests.reference_motion`).
"""

import math
from typing import NamedTuple

import numpy as np

from gen.physics.kernel.drop import RAISED_EDGE
from gen.physics.kernel.layout import FloatArray
from gen.physics.kernel_input import KernelInput, Spall
from gen.physics.rotor import Machine
from tests.reference_motion import Slow, slow_motion, standard_normal


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


def wrapped(angle: float) -> float:
    """Angle in (-pi, pi]."""
    return math.remainder(angle, 2 * math.pi)


def rigid_path(offset: float, half: float, arc: float, ball: float, race: float, depth: float) -> float:
    """Drop of the centre of a rigid ball over two sharp edges, from the triangle of ball, edge and ring [m].

    ``race`` is positive if convex (inner race), negative if concave (outer race); see docs/model.md, Spalls.
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


def fall(fault: Spall, offset: float, arc: float, ball: float, race: float) -> float:
    """Drop of a ball whose contact is ``offset`` [rad] from the centre of a spall, see docs/model.md, Spalls [m]."""
    half = fault.width / 2 / arc
    inside = half - abs(offset)
    if inside <= 0:
        return 0.0
    if fault.profile == "geometric":
        return rigid_path(offset, half, arc, ball, race, fault.depth)
    if fault.profile == "half_sine":
        return fault.depth * math.cos(math.pi * offset / (2 * half))
    if fault.profile == "raised_cosine":
        return fault.depth * (1 - math.cos(math.pi * min(inside / (RAISED_EDGE * half), 1))) / 2
    if fault.profile == "table":
        drops_there = fault.table[1 if fault.site == "ball" and race < 0 else 0]
        return float(np.interp(offset, np.linspace(-half, half, len(drops_there)), drops_there))
    return fault.depth


class Meeting(NamedTuple):
    """A ball near a spall."""

    fault: Spall
    ball: int
    offset: float
    """Of its contact from the middle of the spall [rad]."""
    race: float
    """Radius of the race, negative for the outer one [m]."""
    number: int
    """Of the passage."""
    share: float
    """Factor of its drop [1]."""


def meetings(record: KernelInput, angles: FloatArray, jitter: FloatArray, share: float) -> list[Meeting]:
    """Every ball with every spall, a damaged ball with both races; ``angles`` are those of shaft, cage and ball spin."""
    bearing, met = record.bearing, []
    shaft, cage, spin = angles
    inner, outer, n_balls = bearing.inner_radius, -bearing.outer_radius, bearing.n_balls
    for fault in record.spalls:
        if fault.site == "ball":
            turned = spin + fault.angle
            for half, race in enumerate((inner, outer)):
                offset = wrapped(turned - half * math.pi)
                number = round((turned - offset) / math.pi)
                met.append(Meeting(fault, fault.ball, offset, race, number, share * scatter(fault, number)))
            continue
        race, centre = (inner, shaft + fault.angle) if fault.site == "inner" else (outer, fault.angle)
        for ball in range(n_balls):
            place = cage + 2 * np.pi * ball / n_balls - centre
            number = n_balls * round((place - wrapped(place)) / (2 * np.pi)) - ball
            met.append(Meeting(fault, ball, wrapped(place) + jitter[ball], race, number, scatter(fault, number)))
    return met


def scatter(fault: Spall, number: int) -> float:
    """Log-normal factor of the drop in one passage [1]."""
    return math.exp(fault.scatter * standard_normal(number, fault.seed)) if fault.scatter > 0 else 1.0


def drops(record: KernelInput, angles: FloatArray, jitter: FloatArray, share: float) -> FloatArray:
    """How far each ball has dropped into all spalls together, shape (ball,) [m]."""
    ball, total = record.bearing.ball_diameter / 2, np.zeros(record.bearing.n_balls)
    for fault, number, offset, race, _, part in meetings(record, angles, jitter, share):
        arc = ball if fault.site == "ball" else abs(race)
        total[number] += part * fall(fault, offset, arc, ball, race)
    return total


class Contacts(NamedTuple):
    """Of every ball with its races, shape (ball,) unless it says otherwise."""

    directions: FloatArray
    """Shape (ball, axis) [1]."""
    squeeze: FloatArray
    """Negative where ball and races are apart [m]."""
    approach: FloatArray
    """Rate of the squeeze, the balls' own motion aside [m/s]."""


def contacts(record: KernelInput, slow: Slow, at: int, tau: float, y: FloatArray) -> Contacts:
    """Contacts in the state ``y``, a share ``tau`` of the way from knot ``at`` to the next."""
    angles, gaps, jitter, in_cage = ((1 - tau) * values[at] + tau * values[at + 1] for values in slow[:4])
    angles[2] += slow.shift[at]
    c, s = math.cos(angles[1]), math.sin(angles[1])
    directions = in_cage @ np.array([[c, s], [-s, c]])
    seen = record.machine.contact_cosine * directions
    gaps = gaps + drops(record, angles, jitter, slow.share[at + 1])
    return Contacts(directions, seen @ (y[0:2] - y[2:4]) - gaps, seen @ (y[6:8] - y[8:10]))


def contact_force(machine: Machine, found: Contacts) -> FloatArray:
    """Force of all balls on the housing, shape (axis,) [N]."""
    touching = found.squeeze > 0
    elastic = machine.load_deflection_factor * np.where(touching, found.squeeze, 0.0) ** machine.contact_exponent
    force = np.where(touching, np.maximum(elastic + machine.contact_damping * found.approach, 0.0), 0.0)
    return machine.contact_cosine * force @ found.directions


def contact_stiffness(machine: Machine, squeeze: FloatArray) -> float:
    """Slope of the elastic force of all balls, as if they all pushed one way [N/m]."""
    n = machine.contact_exponent
    slopes = n * machine.load_deflection_factor * np.maximum(squeeze, 0.0) ** (n - 1)
    return float(machine.contact_cosine**2 * slopes.sum())


def right_hand_side(record: KernelInput, slow: Slow, knot: float, at: int, tau: float, y: FloatArray) -> FloatArray:
    """Derivative of the state, shape (coordinate,), a share ``tau`` of the way from knot ``at`` to the next.

    The equations of docs/model.md, Bodies and forces, term by term.
    """
    machine = record.machine
    force = contact_force(machine, contacts(record, slow, at, tau, y))
    (first, second, sensor), (u, v, w) = y[:6].reshape(3, 2), y[6:].reshape(3, 2)
    angle, rate = (1 - tau) * slow.angles[at, 0] + tau * slow.angles[at + 1, 0], slow.rates[at, 0]
    speeding_up = (rate - slow.rates[at - 1, 0]) / knot if at > 0 else 0.0
    outwards, across = np.array([math.cos(angle), math.sin(angle)]), np.array([math.sin(angle), -math.cos(angle)])
    turning = record.turning.unbalance * (rate**2 * outwards + speeding_up * across) + record.turning.bow * outwards
    outer = (1 - tau) * slow.forces[at, 0] + tau * slow.forces[at, 1]
    ring = np.array([machine.ring_stiffness_x, machine.ring_stiffness_y])
    support = np.array([machine.support_stiffness_x, machine.support_stiffness_y])
    leak = np.array([machine.support_damping_x, machine.support_damping_y])
    spring = np.array([machine.sensor_stiffness_x, machine.sensor_stiffness_y])
    stretch = np.sign(second) * np.maximum(np.abs(second) - machine.looseness, 0.0)
    between = force + machine.ring_damping * (u - v) + ring * (first - second)
    to_sensor = spring * (second - sensor) + machine.sensor_damping * (v - w)
    on_shaft = outer[:2] + turning - between - machine.shaft_damping * u - machine.shaft_stiffness * first
    on_housing = outer[2:] + between - leak * v - support * stretch - to_sensor
    sensor_rate = to_sensor / machine.sensor_mass if machine.sensor_mass > 0 else np.zeros(2)
    return np.concatenate([y[6:], on_shaft / machine.shaft_mass, on_housing / machine.housing_mass, sensor_rate])


def march_twin(record: KernelInput, start: FloatArray, n_knots: int, n_steps: int, knot: float) -> Trip:
    """Classical Runge-Kutta from the state ``start``, ``n_steps`` per knot, knots ``knot`` seconds apart."""
    slow, dt = slow_motion(record, knot, n_knots), knot / n_steps
    y = np.array(start, dtype=float)
    states, accelerations = [y], []
    for at in range(n_knots):
        for number in range(n_steps):
            begin, middle, end = number / n_steps, (number + 0.5) / n_steps, (number + 1) / n_steps
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
