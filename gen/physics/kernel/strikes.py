"""The force of a ball that strikes the edge of a spall.

A ball that rolls over a spall at the speed ``v`` of its contact along the race moves along the contact normal at ``v`` times the slope of
its path. Where the slope changes by ``j``, at the trailing edge or where the ball meets the floor, the ball is thrown back: its velocity
changes by ``j v`` and the race takes the momentum ``m j v`` as a half sine of the length of an elastic impact (see
:mod:`gen.physics.impact`)::

    length = 2.87 (m^2 / (R E*^2))^(1/5) (j v / 2)^(-1/5)

at least the time that the slope takes to change. A ball strikes only if the races would hold it were there no spall; a ball outside the
load zone does not follow the path. An outer race is pushed outwards and the housing with it, an inner race inwards and the shaft with it.
The forces that bring the ball into the spall, and to rest after it, have the same momentum over the whole passage and are left out.

A pulse keeps its momentum at any step (:mod:`gen.physics.kernel.pulse`), so it needs no finer step than the machine: the steps are
shorter than a sample, and what is lost of a pulse shorter than a step lies above the frequencies that a record holds.
"""

import math
from typing import NamedTuple

from numba import njit

from gen.physics.extent import MOST_STRIKES
from gen.physics.kernel.compiling import INLINE, LANES, wide
from gen.physics.kernel.equations import COS, SIN
from gen.physics.kernel.layout import (
    Batch,
    Drive,
    FloatArray,
    Param,
    Shape,
    Site,
    SpallRow,
    State,
    drop_row,
    drop_width,
)
from gen.physics.kernel.pulse import second_difference

LONGEST_PULSE = 1e-3  # s; a ball of 60 mm that strikes at 1 mm/s takes 0.8 ms


class Passage(NamedTuple):
    """How one ball passes one spall."""

    start: float
    """Offset of the ball from the middle of the spall at the knot [rad]."""
    slope: float
    """Its change per half step [rad]."""
    share: float
    """Factor of the drop [1]."""
    race: float
    """Radius of the race under the ball: positive if convex (inner), negative if concave (outer) [m]."""


@njit(**INLINE)
def longest_pulse(slope: float, n_steps: int, dt: float) -> float:
    """Angle that a ball moves during the longest pulse, if it moves by ``slope`` from knot to knot [rad]."""
    return abs(slope) * (LONGEST_PULSE / (n_steps * dt) + 1)


@njit(**INLINE)
def squeezed(shape: Shape, batch: Batch, lane: int, ball: int) -> tuple[float, float, float]:
    """Squeeze of a ball at the knot, without spalls and waviness [m], and cosine and sine of its direction."""
    state = batch.state
    c, s = state[State.CAGE_COS * LANES + lane], state[State.CAGE_SIN * LANES + lane]
    ball_c, ball_s = COS[len(shape.balls), ball], SIN[len(shape.balls), ball]
    c, s = c * ball_c - s * ball_s, s * ball_c + c * ball_s
    x, y = state[lane] - state[2 * LANES + lane], state[LANES + lane] - state[3 * LANES + lane]
    gap = batch.drive[Drive.HALF_CLEARANCE * LANES + lane]
    return batch.params[Param.CONTACT_COSINE * LANES + lane] * (x * c + y * s) - gap, c, s


@njit(**INLINE)
def strike_edges(
    shape: Shape,
    batch: Batch,
    spall: FloatArray,
    lane: int,
    ball: int,
    passage: Passage,
    n_steps: int,
    dt: float,
    met: FloatArray,
) -> None:
    """Add the forces of one ball that strikes the edges of one spall, whose rows are ``spall``, at every half step up to the next knot.

    ``met`` receives the rows that are set.
    """
    wide()
    rate, row = 2 * passage.slope / dt, int(spall[SpallRow.STRIKES * LANES + lane])
    on_shaft = passage.race > 0.0
    if int(spall[SpallRow.SITE * LANES + lane]) == Site.BALL and not on_shaft:
        row += 1
    for number in range(MOST_STRIKES):
        place, change, spread = (
            batch.strikes[row, number, 0],
            batch.strikes[row, number, 1],
            batch.strikes[row, number, 2],
        )
        speed = passage.share * change * abs(rate) * spall[SpallRow.ARC * LANES + lane]
        if speed <= 0.0:
            continue
        length = batch.drive[Drive.HERTZ_TIME * LANES + lane] * math.exp(-0.2 * math.log(0.5 * speed))
        length = min(max(length, spread / abs(rate)), LONGEST_PULSE)
        since = (passage.start - place) / rate + 0.5 * spread / abs(rate)
        if since > length + dt or since + n_steps * dt < -dt:
            continue
        squeeze, c, s = squeezed(shape, batch, lane, ball)
        if squeeze <= 0.0:
            return
        # of a half sine of unit momentum the force is pi / (2 length)
        size = batch.drive[Drive.BALL_MASS * LANES + lane] * speed * math.pi / (2 * length * dt * dt)
        size *= (
            -batch.params[Param.CONTACT_COSINE * LANES + lane]
            if on_shaft
            else batch.params[Param.CONTACT_COSINE * LANES + lane]
        )
        first = len(shape.balls) + (0 if on_shaft else 2)
        met[first] = met[first + 1] = 1.0
        forces = batch.params[(drop_row(shape) + first) * LANES + lane :]
        for half_step in range(2 * n_steps + 1):
            force = size * second_difference(since + 0.5 * dt * half_step, length, dt)
            at = half_step * drop_width(shape) * LANES
            forces[at] += force * c
            forces[at + LANES] += force * s
