"""The gap under every ball at the knots: clearance, waviness of the races and of the balls.

The waviness of a race is a Fourier series around it. Ball ``i`` of ``n`` is ``2 pi i / n`` further on, so orders that differ by ``n`` have
the same phase at every ball: they are folded into one sum by Horner's rule. One Fourier transform of the ``n`` sums gives the waviness
under every ball. The balls have even orders of their own.
"""

import math
from enum import IntEnum

import numpy as np
from numba import njit

from gen.physics.extent import BALL_ORDERS, MAX_BALLS
from gen.physics.kernel.compiling import INLINE, LANES, cosine, fma, in_both, lane_count, sine, wide
from gen.physics.kernel.layout import (
    CONTACT_ROWS,
    Angle,
    Batch,
    Contact,
    Drive,
    FloatArray,
    Shape,
    State,
    contact_row,
    n_folds,
    race_rows,
)  # fmt: skip


@in_both
def n_turns(n_balls: int) -> int:
    """Orders of the Fourier transform under the balls: 0, and half the number of balls in whole fours, which are added at once."""
    return 1 + 4 * ((n_balls // 2 + 3) // 4)


def _turns(n_balls: int) -> tuple[FloatArray, FloatArray]:
    """Cosine and sine of ``2 pi ball order / n_balls`` for balls up to half their number; shape (ball * order,)."""
    turns = np.arange(n_balls // 2 + 1)[:, None] * np.arange(n_turns(n_balls)) / n_balls
    cosines, sines = np.cos(2 * np.pi * turns), np.sin(2 * np.pi * turns)
    if n_balls % 2 == 0:
        sines[-1] = sines[:, n_balls // 2] = 0.0  # exactly, for half as many turns as there are balls
    return cosines.ravel(), sines.ravel()


_TURNS = [_turns(n_balls) for n_balls in range(1, MAX_BALLS + 1)]
COS_OF_TURNS: FloatArray = np.concatenate([cosines for cosines, _ in _TURNS])
SIN_OF_TURNS: FloatArray = np.concatenate([sines for _, sines in _TURNS])
FIRST_TURN = np.cumsum([0, 0] + [len(cosines) for cosines, _ in _TURNS])  # of each number of balls


@in_both
def gap_work_rows(shape: Shape) -> int:
    """Rows of the work array of :func:`ball_gaps`: rotations, two for each order that is folded and one more, two for each turn."""
    return N_ROTATION_ROWS + 2 * (shape.balls + 1) + 2 * n_turns(shape.balls)


class Rotation(IntEnum):
    """Rows of the work array of a race: four complex numbers per lane, real and imaginary part."""

    DIRECTION = 0  # e^(i angle) of ball 0 relative to the race
    POWER = 2  # DIRECTION to the power of the number of balls
    TURN = 4  # DIRECTION to the power of the order
    SUM = 6  # of the orders that are folded so far


N_ROTATION_ROWS = 16  # of both races, the inner race first
OUTER = N_ROTATION_ROWS // 2 * LANES  # where the outer race begins


@njit(**INLINE)
def multiplied(c: float, s: float, p: float, q: float) -> tuple[float, float]:
    """Product of two complex numbers."""
    return fma(c, p, -(s * q)), fma(c, q, s * p)


@njit(**INLINE)
def start_rotation(shape: Shape, n_records: int, z: FloatArray) -> None:
    """Set ``TURN`` of a race to 1, and ``POWER`` from ``DIRECTION``, by squaring."""
    wide()
    for lane in range(lane_count(n_records)):
        z[Rotation.POWER * LANES + lane], z[(Rotation.POWER + 1) * LANES + lane] = z[lane], z[LANES + lane]
        z[Rotation.TURN * LANES + lane], z[(Rotation.TURN + 1) * LANES + lane] = 1.0, 0.0
    n_bits = 0
    while shape.balls >> n_bits > 1:
        n_bits += 1
    for bit in range(n_bits - 1, -1, -1):
        odd = shape.balls >> bit & 1
        for lane in range(lane_count(n_records)):
            p, q = z[Rotation.POWER * LANES + lane], z[(Rotation.POWER + 1) * LANES + lane]
            p, q = multiplied(p, q, p, q)
            c, s = multiplied(p, q, z[lane], z[LANES + lane])
            z[Rotation.POWER * LANES + lane] = c if odd else p
            z[(Rotation.POWER + 1) * LANES + lane] = s if odd else q


@njit(**INLINE)
def add_orders(
    n_orders: int | np.int64, begun: bool, n_records: int, apart: int, amplitudes: FloatArray, z: FloatArray
) -> None:
    """Continue the sum of a race by 1, 2 or 4 orders, by Horner's rule down to the order whose rows ``amplitudes`` begins with.

    The other orders follow ``apart`` values on. The sum starts at 0 unless it is ``begun``. Several orders share a loop over lanes, because
    their sum stays in registers.
    """
    wide()
    second, third, fourth = amplitudes[apart:], amplitudes[2 * apart :], amplitudes[3 * apart :]
    for lane in range(lane_count(n_records)):
        c, s = z[Rotation.POWER * LANES + lane], z[(Rotation.POWER + 1) * LANES + lane]
        p, q = z[Rotation.SUM * LANES + lane], z[(Rotation.SUM + 1) * LANES + lane]
        p, q = p if begun else 0.0, q if begun else 0.0
        if n_orders > 2:
            p, q = fma(p, c, fma(-q, s, fourth[lane])), fma(p, s, fma(q, c, fourth[LANES + lane]))
            p, q = fma(p, c, fma(-q, s, third[lane])), fma(p, s, fma(q, c, third[LANES + lane]))
        if n_orders > 1:
            p, q = fma(p, c, fma(-q, s, second[lane])), fma(p, s, fma(q, c, second[LANES + lane]))
        p, q = fma(p, c, fma(-q, s, amplitudes[lane])), fma(p, s, fma(q, c, amplitudes[LANES + lane]))
        z[Rotation.SUM * LANES + lane], z[(Rotation.SUM + 1) * LANES + lane] = p, q


@njit(**INLINE)
def fold_race(shape: Shape, n_records: int, amplitudes: FloatArray, z: FloatArray, folded: FloatArray) -> None:
    """Add the waviness of a race, rotated to its direction in ``z``, to ``folded``: two rows for each ball.

    Each row is the sum of the orders that differ by a multiple of the number of balls.
    """
    wide()
    start_rotation(shape, n_records, z)
    apart, n = 2 * shape.balls * LANES, n_folds(shape)
    fours = n & ~3
    for order in range(shape.balls):
        own = amplitudes[2 * order * LANES :]
        # np.int64, because numba would compile the function once for each plain integer
        if n & 1:
            add_orders(np.int64(1), False, n_records, apart, own[(n - 1) * apart :], z)
        if n & 2:
            add_orders(np.int64(2), bool(n & 1), n_records, apart, own[fours * apart :], z)
        for below in range(4, fours + 1, 4):
            add_orders(np.int64(4), below > 4 or n > fours, n_records, apart, own[(fours - below) * apart :], z)
        sums = folded[2 * order * LANES :]
        for lane in range(lane_count(n_records)):
            p, q = z[Rotation.SUM * LANES + lane], z[(Rotation.SUM + 1) * LANES + lane]
            c, s = z[Rotation.TURN * LANES + lane], z[(Rotation.TURN + 1) * LANES + lane]
            p, q = multiplied(p, q, c, s)
            sums[lane] += p
            sums[LANES + lane] += q
            c, s = multiplied(c, s, z[lane], z[LANES + lane])
            z[Rotation.TURN * LANES + lane], z[(Rotation.TURN + 1) * LANES + lane] = c, s


@njit(**INLINE)
def split(shape: Shape, n_records: int, folded: FloatArray, parts: FloatArray) -> None:
    """Even and odd part of every order of ``folded`` up to half the number of balls, into two rows of ``parts`` each; the rest is zero."""
    wide()
    n_balls = shape.balls
    for i in range(2 * n_turns(n_balls) * lane_count(LANES)):
        parts[i] = 0.0
    for order in range(n_balls // 2 + 1):
        low, high = folded[2 * order * LANES :], folded[2 * (n_balls - order) * LANES :]
        part = parts[2 * order * LANES :]
        other = 1.0 if 0 < 2 * order < n_balls else 0.0
        for lane in range(lane_count(n_records)):
            part[lane] = fma(other, high[lane], low[lane])
            part[LANES + lane] = fma(-other, high[LANES + lane], low[LANES + lane])


@njit(**INLINE)
def unfold(
    shape: Shape, n_records: int, parts: FloatArray, clearance: FloatArray, sums: FloatArray, gaps: FloatArray
) -> None:
    """Set the gap under every ball: the clearance less the waviness, the real part of the Fourier transform of the folded orders.

    Balls ``i`` and ``n - i`` have the same sums of even and of odd parts. ``sums`` is a work array of two rows.
    """
    wide()
    n_balls = shape.balls
    for ball in range(n_balls // 2 + 1):
        first = int(FIRST_TURN[n_balls]) + ball * n_turns(n_balls)
        for lane in range(lane_count(n_records)):
            sums[lane], sums[LANES + lane] = parts[lane], 0.0
        for four in range(n_turns(n_balls) // 4):
            i, own = first + 4 * four + 1, parts[(8 * four + 2) * LANES :]
            c0, c1, c2, c3 = COS_OF_TURNS[i], COS_OF_TURNS[i + 1], COS_OF_TURNS[i + 2], COS_OF_TURNS[i + 3]
            s0, s1, s2, s3 = SIN_OF_TURNS[i], SIN_OF_TURNS[i + 1], SIN_OF_TURNS[i + 2], SIN_OF_TURNS[i + 3]
            for lane in range(lane_count(n_records)):
                even = fma(own[lane], c0, fma(own[2 * LANES + lane], c1, sums[lane]))
                odd = fma(own[LANES + lane], s0, fma(own[3 * LANES + lane], s1, sums[LANES + lane]))
                sums[lane] = fma(own[4 * LANES + lane], c2, fma(own[6 * LANES + lane], c3, even))
                sums[LANES + lane] = fma(own[5 * LANES + lane], s2, fma(own[7 * LANES + lane], s3, odd))
        here = gaps[ball * LANES :]
        for lane in range(lane_count(n_records)):
            here[lane] = clearance[lane] - (sums[lane] - sums[LANES + lane])
        if 0 < ball < n_balls - ball:
            mirror = gaps[(n_balls - ball) * LANES :]
            for lane in range(lane_count(n_records)):
                mirror[lane] = clearance[lane] - (sums[lane] + sums[LANES + lane])


@njit(**INLINE)
def subtract_ball_waviness(
    shape: Shape, batch: Batch, ahead: int, moves: FloatArray, z: FloatArray, gaps: FloatArray
) -> None:
    """Subtract the waviness of the balls, at both contacts of each, ``ahead`` knots from now; all balls spin at the same rate."""
    wide()
    n_balls = shape.balls
    for lane in range(lane_count(batch.n_records)):
        twice = 2 * (batch.angles[Angle.SPIN * LANES + lane] + ahead * moves[Angle.SPIN * LANES + lane])
        z[lane], z[LANES + lane] = math.cos(twice), math.sin(twice)
    for ball in range(n_balls):
        waves, here = batch.waves[(race_rows(shape) + 2 * ball) * LANES :], gaps[ball * LANES :]
        for lane in range(lane_count(batch.n_records)):
            c, s = z[lane], z[LANES + lane]
            real = imag = 0.0
            for order in range(BALL_ORDERS):
                row = 2 * (BALL_ORDERS - 1 - order) * n_balls * LANES + lane
                real, imag = fma(real, c, fma(-imag, s, waves[row])), fma(real, s, fma(imag, c, waves[row + LANES]))
            here[lane] -= fma(real, c, -(imag * s))


@njit(**INLINE)
def ball_gaps(shape: Shape, batch: Batch, ahead: int, moves: FloatArray, work: FloatArray, gaps: FloatArray) -> None:
    """Gap of every ball ``ahead`` knots from now, with waviness and without spalls, into ``gaps`` (ball * LANES + lane) [m].

    ``work`` has :func:`gap_work_rows`.
    """
    wide()
    state, n_balls = batch.state, shape.balls
    z, folded = work, work[N_ROTATION_ROWS * LANES :]
    parts = folded[2 * (n_balls + 1) * LANES :]
    for lane in range(lane_count(batch.n_records)):
        c, s = state[State.CAGE_COS * LANES + lane], state[State.CAGE_SIN * LANES + lane]
        cage, shaft = ahead * moves[Angle.CAGE * LANES + lane], ahead * moves[Angle.SHAFT * LANES + lane]
        dc, ds = cosine(cage), sine(cage)
        c, s = fma(c, dc, -(s * ds)), fma(s, dc, c * ds)
        p, q = state[State.SHAFT_COS * LANES + lane], state[State.SHAFT_SIN * LANES + lane]
        dc, ds = cosine(shaft), sine(shaft)
        p, q = fma(p, dc, -(q * ds)), fma(q, dc, p * ds)
        z[lane], z[LANES + lane] = fma(c, p, s * q), fma(s, p, -(c * q))
        z[OUTER + lane], z[OUTER + LANES + lane] = c, s
    for i in range(2 * n_balls * lane_count(LANES)):
        folded[i] = 0.0
    for race in range(2):
        amplitudes = batch.waves[race * (race_rows(shape) // 2) * LANES :]
        fold_race(shape, batch.n_records, amplitudes, z[race * OUTER :], folded)
    split(shape, batch.n_records, folded, parts)
    unfold(shape, batch.n_records, parts, batch.drive[Drive.HALF_CLEARANCE * LANES :], z[Rotation.SUM * LANES :], gaps)
    if batch.waves.size > race_rows(shape) * LANES:
        subtract_ball_waviness(shape, batch, ahead, moves, z, gaps)


@njit(**INLINE)
def move_gaps(
    shape: Shape, batch: Batch, knot: int, n_steps: int, moves: FloatArray, work: FloatArray, gaps: FloatArray
) -> None:
    """Set the gap of every ball at this knot and its slope to the next.

    ``gaps`` holds the gaps at this knot, unless it is the first, and receives those at the next; then it has room for as many.
    """
    wide()
    per_half_step, later = 0.5 / n_steps, gaps[shape.balls * LANES :]
    # in a loop, so that the code of ball_gaps is compiled once
    for ahead in range(0 if knot == 0 else 1, 2):
        ball_gaps(shape, batch, ahead, moves, work, later)
        advance_gaps(shape, batch, per_half_step, gaps, later)


@njit(**INLINE)
def advance_gaps(shape: Shape, batch: Batch, per_half_step: float, gaps: FloatArray, later: FloatArray) -> None:
    """Store the gaps and their slopes to those ``later``, which then take their place."""
    wide()
    contacts = batch.params[contact_row(shape) * LANES :]
    for ball in range(shape.balls):
        contact, gap, there = contacts[CONTACT_ROWS * ball * LANES :], gaps[ball * LANES :], later[ball * LANES :]
        for lane in range(lane_count(batch.n_records)):
            contact[Contact.GAP * LANES + lane] = gap[lane]
            contact[Contact.GAP_SLOPE * LANES + lane] = (there[lane] - gap[lane]) * per_half_step
            gap[lane] = there[lane]
