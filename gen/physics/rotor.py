"""The machine around the bearing: masses, springs, dampers and loads; static equilibrium and bounds of the eigenfrequencies.

Body 1 is the shaft with the inner ring, body 2 the housing with the outer ring, body r the mass of the sensor resonance; see docs/model.md.
"""

import math
from collections.abc import Sequence
from itertools import chain
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from gen.physics.elementary import power
from gen.physics.hertz import POINT_EXPONENT

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
    numbers = np.fromiter(chain.from_iterable(items), float, len(items) * len(kind._fields))
    return kind(*numbers.reshape(len(items), -1).T.copy())


def ball_angles(n_balls: Sequence[int], cage_angles: Sequence[float]) -> FloatArray:
    """Angles of the balls of some bearings, NaN where a bearing has fewer balls than another, shape (record, ball) [rad]."""
    count, place = np.array(n_balls)[:, None], np.arange(max(n_balls))
    return np.where(place < count, np.array(cage_angles)[:, None] + 2 * np.pi * place / count, np.nan)


def likely_stiffness(machine: Machine, n_balls: int, pull: float = 0.0) -> float:
    """Estimate of the largest contact stiffness of a record [N/m].

    The estimate has ``DYNAMIC_FACTOR`` times the static Stribeck load on three balls, or on half of the rollers, since the stiffness of a
    line contact hardly falls with its load; and the preload on all balls. ``pull`` is the sum of the forces on the shaft other than the
    load [N].
    """
    load, n = float(np.hypot(machine.load_x, machine.load_y)) + pull, machine.contact_exponent
    factor = machine.load_deflection_factor
    ball_load = DYNAMIC_FACTOR * STRIBECK * load / n_balls
    squeeze = max(-machine.half_clearance, 0.0)
    count = LOADED_BALLS if n == POINT_EXPONENT else n_balls / 2
    loaded = n * factor ** (1 / n) * count * ball_load ** (1 - 1 / n)
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
    balance = _balance(machine, angles)
    force, stiffness = balance.pressed(displacement.T)
    return force.T, stiffness.T


class _Balance(NamedTuple):
    """Constants of the static balance of some records; the last axis of every array is the record."""

    load: FloatArray
    """Shape (axis, record), as are the next four."""
    support: FloatArray
    ring: FloatArray
    ground: FloatArray
    play: FloatArray
    directions: FloatArray
    """Of the balls, shape (axis, ball, record)."""
    weight: FloatArray
    """Size of the load, shape (record,), as are the next four."""
    cosine: FloatArray
    half_clearance: FloatArray
    factor: FloatArray
    exponent: FloatArray

    def pressed(self, displacement: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Force and stiffness of every ball, shape (ball, record), under a displacement of shape (axis, record)."""
        along = displacement[0] * self.directions[0] + displacement[1] * self.directions[1]
        squeeze = np.maximum(along * self.cosine - self.half_clearance, 0.0)
        root = power(squeeze, self.exponent - 1)
        return self.factor * squeeze * root * self.cosine, self.exponent * self.factor * root * self.cosine**2


def rest(machine: Machine, angles: FloatArray) -> FloatArray:
    """Static equilibrium under the load, without spalls, by damped Newton steps; a loose housing is at the limit of its play.

    A record does not depend on the others: it is frozen when it has converged, and every sum has a fixed order.

    Parameters
    ----------
    machine : Machine
        Arrays of shape (record,); all records have the same ``contact_exponent``.
    angles : array, shape (record, ball)
        Angular positions of the balls, NaN for balls that a bearing does not have [rad].

    Returns
    -------
    array, shape (record, coordinate)
        x1, y1, x2, y2 [m].
    """
    balance = _balance(machine, angles)
    reach = np.maximum(balance.half_clearance, 0) / balance.cosine + 2 * power(
        balance.weight / balance.factor, 1 / balance.exponent
    )
    housing = balance.load / (balance.support + balance.ground) + balance.play * np.sign(balance.load)
    q = np.concatenate([housing + balance.load / balance.weight * reach, housing])
    places: NDArray[np.intp] = np.arange(q.shape[1])
    equilibrium = q.copy()
    for _ in range(200):
        residual, jacobian = _unbalanced_force(balance, q)
        largest = np.abs(residual).max(axis=0)
        moving = largest >= 1e-9 * balance.weight
        if not moving.all():
            equilibrium[:, places[~moving]] = q[:, ~moving]
            balance = _Balance(*(array[..., moving] for array in balance))
            places, q, largest = places[moving], q[:, moving], largest[moving]
            residual, jacobian = residual[:, moving], jacobian[..., moving]
        if not len(places):
            break
        # one loaded ball has no stiffness across its direction: a soft spring keeps the step finite, and becomes 0 with the residual
        for row in range(4):
            jacobian[row, row] += 1e-3 * largest / 1e-6 + 1e-3
        step = solve(jacobian, residual)
        q += step * np.minimum(1.0, 2e-6 / np.maximum(np.abs(step).max(axis=0), 1e-30))
    equilibrium[:, places] = q
    return equilibrium.T


def _balance(machine: Machine, angles: FloatArray) -> _Balance:
    load = np.stack([machine.load_x, machine.load_y])
    loose = np.isnan(angles.T)
    return _Balance(
        load=load,
        support=np.stack([machine.support_stiffness_x, machine.support_stiffness_y]),
        ring=np.stack([machine.ring_stiffness_x, machine.ring_stiffness_y]),
        ground=np.stack([machine.shaft_stiffness] * 2),
        play=np.stack([machine.looseness] * 2),
        # balls without a direction press on nothing
        directions=np.where(loose, 0.0, np.stack([np.cos(angles).T, np.sin(angles).T])),
        weight=np.maximum(np.hypot(*load), 1e-12),
        cosine=np.asarray(machine.contact_cosine),
        half_clearance=np.asarray(machine.half_clearance),
        factor=np.asarray(machine.load_deflection_factor),
        exponent=np.asarray(machine.contact_exponent),
    )


def _unbalanced_force(balance: _Balance, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Sum of the forces on each coordinate, shape (4, record), and its negative derivative, shape (4, 4, record)."""
    relative = q[:2] - q[2:]
    force, stiffness = balance.pressed(relative)
    of_balls = np.empty((6, *force.shape))
    np.multiply(force, balance.directions, out=of_balls[:2])
    stiff = stiffness * balance.directions
    np.multiply(stiff[:, None], balance.directions, out=of_balls[2:].reshape(2, 2, *force.shape))
    # accumulate adds ball by ball; the order of a sum would depend on the number of records
    sums = np.add.accumulate(of_balls, axis=1)[:, -1]
    pushed, contact = sums[:2] + balance.ring * relative, sums[2:].reshape(2, 2, -1)
    stretch = q[2:] - np.clip(q[2:], -balance.play, balance.play)
    held = np.where((stretch != 0) | (balance.play == 0), balance.support, 0.0)
    residual = np.concatenate([balance.load - pushed - balance.ground * q[:2], pushed - balance.support * stretch])
    for axis in range(2):
        contact[axis, axis] += balance.ring[axis]
    jacobian = np.empty((4, 4, q.shape[1]))
    jacobian[:2, :2] = jacobian[2:, 2:] = contact
    jacobian[:2, 2:] = jacobian[2:, :2] = -contact
    for axis in range(2):
        jacobian[axis, axis] += balance.ground[axis]
        jacobian[2 + axis, 2 + axis] += held[axis]
    return residual, jacobian


def solve(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solution of some positive definite equations by elimination, shape (row, record); LAPACK has other bits on other processors.

    ``matrix``, of shape (row, column, record), and ``right``, of shape (row, record), are changed.
    """
    last = len(right) - 1
    for pivot in range(last):
        below = slice(pivot + 1, None)
        share = matrix[below, pivot] / matrix[pivot, pivot]
        matrix[below, below] -= share[:, None] * matrix[pivot, below]
        right[below] -= share * right[pivot]
    for row in range(last, -1, -1):
        columns = *range(row + 1, last + 1, 2), *range(row + 2, last + 1, 2)
        right[row] = (right[row] - sum(matrix[row, at] * right[at] for at in columns)) / matrix[row, row]
    return right


def sensor_springs(mass: float, frequency: float, damping_ratio: float) -> tuple[float, float]:
    """Stiffness [N/m] and damping [N s/m] of a resonance at ``frequency`` [Hz].

    >>> round(sensor_springs(0.2, 3000.0, 0.03)[1], 4)
    226.1947
    """
    omega = 2 * math.pi * frequency
    return mass * omega**2, 2 * damping_ratio * mass * omega
