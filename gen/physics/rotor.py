"""The machine around the bearing: masses, springs, dampers and loads; static equilibrium and bounds of the eigenfrequencies.

Body 1 is the shaft with the inner ring, body 2 the housing with the outer ring, body r the mass of the sensor resonance; see docs/model.md.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from gen.physics.elementary import power

FloatArray = NDArray[np.float64]
Fields = TypeVar("Fields", bound=tuple[Any, ...])

# The largest static ball load is 5 W / Z after Stribeck; the dynamic load of simulated spalls stayed below three times that.
STRIBECK, DYNAMIC_FACTOR, LOADED_BALLS = 5.0, 3.0, 3


class Machine(NamedTuple):
    """Constants of the equations of motion of one record, in SI units."""

    load_deflection_factor: float
    contact_damping: float
    contact_cosine: float
    half_clearance: float
    ball_radius: float
    shaft_mass: float
    housing_mass: float
    sensor_mass: float
    """0 for a machine without a sensor resonance."""
    ring_damping: float
    shaft_damping: float
    shaft_stiffness: float
    ring_stiffness_x: float
    ring_stiffness_y: float
    support_stiffness_x: float
    support_stiffness_y: float
    support_damping_x: float
    support_damping_y: float
    sensor_stiffness_x: float
    sensor_stiffness_y: float
    sensor_damping: float
    load_x: float
    load_y: float
    looseness: float = 0.0
    """Half the free play of the housing in its support [m]."""
    contact_exponent: float = 1.5


def as_columns(items: Sequence[Fields]) -> Fields:
    """One item of the same type whose fields are arrays of the fields of several items, shape (item,)."""
    kind: Any = type(items[0])
    return kind(**{name: np.array([getattr(item, name) for item in items], float) for name in kind._fields})


def likely_stiffness(machine: Machine, n_balls: int, pull: float = 0.0) -> float:
    """Estimate of the largest contact stiffness of a record [N/m].

    The estimate has ``DYNAMIC_FACTOR`` times the static Stribeck load on three balls, and the preload on all balls. ``pull`` is the sum of
    the forces on the shaft other than the load [N].
    """
    load, n = float(np.hypot(machine.load_x, machine.load_y)) + pull, machine.contact_exponent
    factor = machine.load_deflection_factor
    ball_load = DYNAMIC_FACTOR * STRIBECK * load / n_balls
    squeeze = max(-machine.half_clearance, 0.0)
    loaded = n * factor ** (1 / n) * LOADED_BALLS * ball_load ** (1 - 1 / n)
    return loaded + n * factor * n_balls * float(power(squeeze, n - 1))


def highest_angular_frequency(machine: Machine, contact_stiffness: float) -> float:
    """Upper bound of the angular eigenfrequencies at a contact stiffness [N/m], in rad/s.

    The sum of the squared eigenfrequencies of a direction is not below the square of the largest one.
    """
    ring = max(machine.ring_stiffness_x, machine.ring_stiffness_y)
    support = max(machine.support_stiffness_x, machine.support_stiffness_y)
    square = (contact_stiffness + ring) * (1 / machine.shaft_mass + 1 / machine.housing_mass)
    square += machine.shaft_stiffness / machine.shaft_mass
    square += support / machine.housing_mass
    if machine.sensor_mass > 0:
        sensor = max(machine.sensor_stiffness_x, machine.sensor_stiffness_y)
        square += sensor * (1 / machine.sensor_mass + 1 / machine.housing_mass)
    return math.sqrt(square)


def highest_damping_rate(machine: Machine, n_balls: int) -> float:
    """Upper bound of the damping rates [1/s]; evenly spaced balls damp any direction like half of their number along it."""
    inverse = 1 / machine.shaft_mass + 1 / machine.housing_mass
    rate = (
        machine.ring_damping + 0.5 * n_balls * machine.contact_damping
    ) * inverse + machine.shaft_damping / machine.shaft_mass
    rate += max(machine.support_damping_x, machine.support_damping_y) / machine.housing_mass
    if machine.sensor_mass > 0:
        rate += machine.sensor_damping * (1 / machine.sensor_mass + 1 / machine.housing_mass)
    return rate


def ball_forces(machine: Machine, displacement: FloatArray, angles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Force and stiffness of every ball under a static displacement of the shaft relative to the housing.

    Parameters
    ----------
    machine : Machine
        Arrays of shape (record,).
    displacement : array, shape (record, axis)
        Relative displacement [m].
    angles : array, shape (record, ball)
        Angular positions of the balls [rad].

    Returns
    -------
    force, stiffness : arrays, shape (record, ball)
        [N] and [N/m].
    """
    along = displacement[:, :1] * np.cos(angles) + displacement[:, 1:] * np.sin(angles)
    cosine = np.asarray(machine.contact_cosine)[:, None]
    squeeze = np.maximum(along * cosine - np.asarray(machine.half_clearance)[:, None], 0.0)
    factor, n = np.asarray(machine.load_deflection_factor)[:, None], np.asarray(machine.contact_exponent)[:, None]
    root = power(squeeze, n - 1)
    return factor * squeeze * root * cosine, n * factor * root * cosine**2


def rest(machine: Machine, angles: FloatArray) -> FloatArray:
    """Static equilibrium under the load, without spalls, by damped Newton steps; a loose housing is at the limit of its play.

    Parameters
    ----------
    machine : Machine
        Arrays of shape (record,).
    angles : array, shape (record, ball)
        Angular positions of the balls [rad].

    Returns
    -------
    array, shape (record, coordinate)
        x1, y1, x2, y2 [m].
    """
    load = np.stack([machine.load_x, machine.load_y], axis=1)
    weight = np.maximum(np.hypot(*load.T), 1e-12)
    support = np.stack([machine.support_stiffness_x, machine.support_stiffness_y], axis=1)
    ring = np.stack([machine.ring_stiffness_x, machine.ring_stiffness_y], axis=1)
    ground = np.broadcast_to(np.asarray(machine.shaft_stiffness)[:, None], support.shape)
    play = np.broadcast_to(np.asarray(machine.looseness)[:, None], support.shape)
    reach = np.maximum(machine.half_clearance, 0) / machine.contact_cosine
    reach = reach + 2 * power(weight / machine.load_deflection_factor, 1 / np.asarray(machine.contact_exponent))
    housing = load / (support + ground) + play * np.sign(load)
    q = np.concatenate([housing + load / weight[:, None] * reach[:, None], housing], axis=1)
    for _ in range(200):
        residual, jacobian = _unbalanced_force(machine, q, angles, load, support, ring, ground, play)
        moving = np.abs(residual).max(axis=1) >= 1e-9 * weight
        if not moving.any():
            break
        # one loaded ball has no stiffness across its direction: a soft spring keeps the step finite, and becomes 0 with the residual
        soft = 1e-3 * np.abs(residual).max(axis=1) / 1e-6 + 1e-3
        step = _solved(jacobian + soft[:, None, None] * np.eye(4), residual)
        longest = np.abs(step).max(axis=1, keepdims=True)
        step *= np.minimum(1.0, 2e-6 / np.maximum(longest, 1e-30))
        q = np.where(
            moving[:, None], q + step, q
        )  # converged records are frozen, so that results do not depend on the batch
    return q


def _unbalanced_force(
    machine: Machine,
    q: FloatArray,
    angles: FloatArray,
    load: FloatArray,
    support: FloatArray,
    ring: FloatArray,
    ground: FloatArray,
    play: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Sum of the forces on each coordinate, shape (record, 4), and its negative derivative, shape (record, 4, 4)."""
    relative = q[:, :2] - q[:, 2:]
    force, stiffness = ball_forces(machine, relative, angles)
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=2)
    pushed = np.einsum("rb,rba->ra", force, directions) + ring * relative
    stretch = q[:, 2:] - np.clip(q[:, 2:], -play, play)
    held = np.where((stretch != 0) | (play == 0), support, 0.0)
    residual = np.concatenate([load - pushed - ground * q[:, :2], pushed - support * stretch], axis=1)
    contact = np.einsum("rb,rba,rbc->rac", stiffness, directions, directions) + ring[:, :, None] * np.eye(2)
    jacobian = np.empty((len(q), 4, 4))
    jacobian[:, :2, :2] = contact + ground[:, :, None] * np.eye(2)
    jacobian[:, :2, 2:] = jacobian[:, 2:, :2] = -contact
    jacobian[:, 2:, 2:] = contact + held[:, :, None] * np.eye(2)
    return residual, jacobian


def _solved(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solution of positive definite systems by elimination, shape (record, row); LAPACK has other bits on other processors."""
    matrix, right = matrix.copy(), right.copy()
    size = right.shape[1]
    for pivot in range(size):
        share = matrix[:, pivot + 1 :, pivot] / matrix[:, pivot, pivot, None]
        matrix[:, pivot + 1 :] -= share[..., None] * matrix[:, pivot, None]
        right[:, pivot + 1 :] -= share * right[:, pivot, None]
    for row in reversed(range(size)):
        right[:, row] -= np.einsum("rk,rk->r", matrix[:, row, row + 1 :], right[:, row + 1 :])
        right[:, row] /= matrix[:, row, row]
    return right


def sensor_springs(mass: float, frequency: float, damping_ratio: float) -> tuple[float, float]:
    """Stiffness [N/m] and damping [N s/m] of a resonance at ``frequency`` [Hz].

    >>> round(sensor_springs(0.2, 3000.0, 0.03)[1], 4)
    226.1947
    """
    omega = 2 * math.pi * frequency
    return mass * omega**2, 2 * damping_ratio * mass * omega
