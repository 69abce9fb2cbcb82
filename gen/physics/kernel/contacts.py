"""The force of the rolling elements, in the frame of the cage: there they stand still but for their jitter.

The number of balls is known only when the kernel runs. A loop over lanes with a loop over balls in it would be scalar code, so the loop
over balls is outside, and each of its turns adds four balls in all lanes: their sum stays in registers, and the passages through memory
between two turns cost little. The balls are added one after the other, so the bits do not depend on how they are grouped.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from gen.physics.extent import MAX_BALLS
from gen.physics.kernel.compiling import INLINE, LANES, as_lane, fma, lane_count, ninth_root, root, wide
from gen.physics.kernel.layout import CONTACT_ROWS, Batch, Contact, FloatArray, Param, Shape, State

_COUNT, _BALL = np.maximum(np.arange(MAX_BALLS + 1), 1)[:, None], np.arange(MAX_BALLS)
# angles counted from -pi to pi, so that the cosines of mirror images have the same bits
_ANGLE = 2 * np.pi * np.where(2 * _BALL > _COUNT, _BALL - _COUNT, _BALL) / _COUNT
COS, SIN = np.cos(_ANGLE), np.sin(_ANGLE)  # (number of balls, ball): direction in the cage's frame

Relative = tuple[float, float, float, float]
"""Displacement and velocity of the shaft relative to the housing: x, y [m], x', y' [m/s]."""
Push = tuple[float, float, float]
"""Force along and across the direction of the cage, over K, and the sum of ``squeeze**(n - 1)``."""


class Kind(NamedTuple):
    """Terms of the force of a ball. They are constants where the force is compiled, so that each kind has its own code without branches."""

    moving: bool
    """Whether directions and gaps of the balls change between knots."""
    damped: bool
    roller: bool


STILL, MOVING = Kind(moving=False, damped=False, roller=False), Kind(moving=True, damped=False, roller=False)
DAMPED, ROLLER = Kind(moving=True, damped=True, roller=False), Kind(moving=True, damped=True, roller=True)


class Instant(NamedTuple):
    """A time between two knots, and the balls at it."""

    half_step: float
    """Half steps since the last knot."""
    since: float
    """Half steps since the directions of the balls were last computed."""
    contacts: FloatArray
    """Rows of :class:`Contact`, ball after ball."""
    drops: FloatArray
    """Drop of each ball into spalls [m], shape (ball * LANES + lane)."""


@njit(**INLINE)
def add_ball(
    kind: Kind, ball: int | np.int64, total: Push, motion: Relative, instant: Instant, lane: int, damping: float
) -> Push:
    """Add the force of one ball to a sum.

    With the direction ``(c, s)`` of the ball, its squeeze and its force over K are::

        squeeze = x c + y s - gap - drop
        force   = squeeze**n  (+ c_b / K (x' c + y' s) while squeeze > 0, never below 0)        n = 3/2 for balls, 10/9 for rollers
    """
    x, y, u, v = motion
    contacts, row = instant.contacts, CONTACT_ROWS * ball * LANES + lane
    c, s = contacts[row + Contact.COS * LANES], contacts[row + Contact.SIN * LANES]
    gap = contacts[row + Contact.GAP * LANES]
    if kind.moving:
        c = fma(contacts[row + Contact.COS_SLOPE * LANES], instant.since, c)
        s = fma(contacts[row + Contact.SIN_SLOPE * LANES], instant.since, s)
        gap = fma(contacts[row + Contact.GAP_SLOPE * LANES], instant.half_step, gap)
    squeeze = max(fma(y, s, fma(x, c, -gap)) - instant.drops[ball * LANES + lane], 0.0)
    if kind.roller:
        power = ninth_root(squeeze)
    elif ball & 1:
        power = root(squeeze)
    else:  # a slow divider computes every other square root beside the rest
        power = math.sqrt(squeeze)
    force = squeeze * power
    if kind.damped:
        damped = max(fma(damping, fma(u, c, v * s), force), 0.0)
        force = damped if squeeze > 0.0 else 0.0
    along, across, powers = total
    return fma(force, c, along), fma(force, s, across), powers + power


@njit(**INLINE)
def add_balls(kind: Kind, count: int | np.int64, first: int, batch: Batch, instant: Instant) -> None:
    """Add the forces of 1, 2 or 4 balls to the rows of ``State.PUSH``."""
    wide()
    state, damping = batch.state, batch.params[Param.CONTACT_DAMPING * LANES :]
    # views, so that LLVM sees rows at constant distances: otherwise it would gather every vector value by value
    contacts, drops = instant.contacts[CONTACT_ROWS * first * LANES :], instant.drops[first * LANES :]
    own = Instant(instant.half_step, instant.since, contacts, drops)
    for number in range(lane_count(batch.n_records)):
        lane = as_lane(number)
        i = State.RELATIVE * LANES + lane
        motion = state[i], state[i + LANES], state[i + 2 * LANES], state[i + 3 * LANES]
        i = State.PUSH * LANES + lane
        total = state[i], state[i + LANES], state[i + 2 * LANES]
        # np.int64, because numba would compile the function once for each plain integer
        total = add_ball(kind, np.int64(0), total, motion, own, lane, damping[lane])
        if count > 1:
            total = add_ball(kind, np.int64(1), total, motion, own, lane, damping[lane])
        if count > 2:
            total = add_ball(kind, np.int64(2), total, motion, own, lane, damping[lane])
            total = add_ball(kind, np.int64(3), total, motion, own, lane, damping[lane])
        state[i], state[i + LANES], state[i + 2 * LANES] = total


@njit(**INLINE)
def add_all_balls(kind: Kind, n_balls: int, batch: Batch, instant: Instant) -> None:
    """Add the forces of all balls: four by four, then two, then one."""
    for four in range(n_balls >> 2):
        add_balls(kind, np.int64(4), 4 * four, batch, instant)
    if n_balls & 2:
        add_balls(kind, np.int64(2), n_balls & ~3, batch, instant)
    if n_balls & 1:
        add_balls(kind, np.int64(1), n_balls - 1, batch, instant)


@njit(**INLINE)
def turn_to_cage(batch: Batch) -> None:
    """Set ``State.RELATIVE``: only the part along the contact angle alpha squeezes a ball. Clear ``State.PUSH``."""
    wide()
    state, params = batch.state, batch.params
    for number in range(lane_count(batch.n_records)):
        lane = as_lane(number)
        cosa = params[Param.CONTACT_COSINE * LANES + lane]
        c, s = cosa * state[State.CAGE_COS * LANES + lane], cosa * state[State.CAGE_SIN * LANES + lane]
        i = State.COORDINATES * LANES + lane
        x, y = state[i] - state[i + 2 * LANES], state[i + LANES] - state[i + 3 * LANES]
        i = State.RATES * LANES + lane
        u, v = state[i] - state[i + 2 * LANES], state[i + LANES] - state[i + 3 * LANES]
        i = State.RELATIVE * LANES + lane
        state[i], state[i + LANES] = fma(x, c, y * s), fma(y, c, -(x * s))
        state[i + 2 * LANES], state[i + 3 * LANES] = fma(u, c, v * s), fma(v, c, -(u * s))
        i = State.PUSH * LANES + lane
        state[i], state[i + LANES], state[i + 2 * LANES] = 0.0, 0.0, 0.0


@njit(**INLINE)
def push_of_balls(shape: Shape, batch: Batch, instant: Instant) -> None:
    """Set ``State.PUSH`` for the present coordinates and rates."""
    turn_to_cage(batch)
    if shape.roller:
        add_all_balls(ROLLER, shape.balls, batch, instant)
    elif shape.damped:
        add_all_balls(DAMPED, shape.balls, batch, instant)
    elif shape.jittered or shape.wavy:
        add_all_balls(MOVING, shape.balls, batch, instant)
    else:
        add_all_balls(STILL, shape.balls, batch, instant)
