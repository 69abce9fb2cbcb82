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
from gen.physics.kernel.compiling import INLINE, LANES, cosine, fma, lane_count, sine, wide
from gen.physics.kernel.layout import Angle, Batch, Drive, FloatArray, Shape, State, gap_row, n_folds, race_rows


def _turns(n_balls: int) -> tuple[FloatArray, FloatArray]:
    """Cosine and sine of ``2 pi ball order / n_balls``, each up to half the number of balls; shape (ball * order,)."""
    half = np.arange(n_balls // 2 + 1)
    turns = half[:, None] * half / n_balls
    cosines, sines = np.cos(2 * np.pi * turns), np.sin(2 * np.pi * turns)
    if n_balls % 2 == 0:
        sines[:, -1] = 0.0  # exactly, for half as many turns as there are balls
    return cosines.ravel(), sines.ravel()


_TURNS = [_turns(n_balls) for n_balls in range(1, MAX_BALLS + 1)]
COS_OF_TURNS, SIN_OF_TURNS = (np.concatenate(tables) for tables in zip(*_TURNS, strict=True))
FIRST_TURN = np.cumsum([0, 0] + [len(cosines) for cosines, _ in _TURNS])  # of each number of balls


class Rotation(IntEnum):
    """Rows of the work array of a race: three complex numbers per lane, real and imaginary part."""

    DIRECTION = 0  # e^(i angle) of ball 0 relative to the race
    POWER = 2  # DIRECTION to the power of the number of balls
    TURN = 4  # DIRECTION to the power of the order


N_ROTATION_ROWS = 12  # of both races, the inner race first
OUTER = N_ROTATION_ROWS // 2 * LANES  # where the outer race begins


@njit(**INLINE)
def multiplied(c: float, s: float, p: float, q: float) -> tuple[float, float]:
    """Product of two complex numbers."""
    return fma(c, p, -(s * q)), fma(c, q, s * p)


@njit(**INLINE)
def powered(c: float, s: float, exponent: int) -> tuple[float, float]:
    """A complex number to a power of 1 to 31, by squaring: a chain of single products takes as long as a fold."""
    p, q = 1.0, 0.0
    for bit in range(5):
        shift = 4 - bit
        if exponent >> shift > 1:
            p, q = multiplied(p, q, p, q)
        if exponent >> shift & 1:
            p, q = (c, s) if exponent >> shift == 1 else multiplied(p, q, c, s)
    return p, q


@njit(**INLINE)
def start_rotations(shape: Shape, n_records: int, z: FloatArray) -> None:
    """Set ``TURN`` of both races to 1, and ``POWER`` from ``DIRECTION``."""
    wide()
    for lane in range(lane_count(n_records)):
        for race in range(2):
            i = race * OUTER + lane
            c, s = powered(z[i], z[i + LANES], len(shape.balls))
            z[i + Rotation.POWER * LANES], z[i + (Rotation.POWER + 1) * LANES] = c, s
            z[i + Rotation.TURN * LANES], z[i + (Rotation.TURN + 1) * LANES] = 1.0, 0.0


@njit(**INLINE)
def folded_orders(shape: Shape, amplitudes: FloatArray, z: FloatArray, i: int, lane: int) -> tuple[float, float]:
    """Sum of the orders of one race that differ by a multiple of the number of balls, rotated to its direction; ``TURN`` moves on."""
    n_balls = len(shape.balls)
    c, s = z[i + Rotation.POWER * LANES], z[i + (Rotation.POWER + 1) * LANES]
    top = 2 * (n_folds(shape) - 1) * n_balls * LANES + lane
    real, imag = amplitudes[top], amplitudes[top + LANES]
    for term in range(1, n_folds(shape)):
        row = top - 2 * term * n_balls * LANES
        real, imag = (
            fma(real, c, fma(-imag, s, amplitudes[row])), fma(real, s, fma(imag, c, amplitudes[row + LANES])),
        )  # fmt: skip
    c, s = z[i + Rotation.TURN * LANES], z[i + (Rotation.TURN + 1) * LANES]
    p, q = z[i], z[i + LANES]
    z[i + Rotation.TURN * LANES], z[i + (Rotation.TURN + 1) * LANES] = multiplied(c, s, p, q)
    return multiplied(real, imag, c, s)


@njit(**INLINE)
def fold_waviness(shape: Shape, batch: Batch, z: FloatArray, folded: FloatArray) -> None:
    """Fold the waviness of both races, rotated to the directions in ``z``: two rows of ``folded`` for each ball."""
    wide()
    start_rotations(shape, batch.n_records, z)
    for first in range(len(shape.balls)):
        inner, outer = batch.waves[2 * first * LANES :], batch.waves[(race_rows(shape) // 2 + 2 * first) * LANES :]
        sums = folded[2 * first * LANES :]
        for lane in range(lane_count(batch.n_records)):
            a, b = folded_orders(shape, inner, z, lane, lane)
            c, d = folded_orders(shape, outer, z, OUTER + lane, lane)
            sums[lane], sums[LANES + lane] = a + c, b + d


@njit(**INLINE)
def unfold(shape: Shape, n_records: int, folded: FloatArray, gaps: FloatArray) -> None:
    """Subtract the waviness under every ball, the real part of the Fourier transform of ``folded``, from ``gaps``.

    Balls ``i`` and ``n - i`` have the same sums of even and of odd parts.
    """
    wide()
    n_balls = len(shape.balls)
    for lane in range(lane_count(n_records)):
        for order in range(1, (n_balls + 1) // 2):
            low, high = 2 * order * LANES + lane, 2 * (n_balls - order) * LANES + lane
            folded[low] += folded[high]
            folded[low + LANES] -= folded[high + LANES]
    for ball in range(n_balls // 2 + 1):
        here, mirror = gaps[ball * LANES :], gaps[(n_balls - ball) % n_balls * LANES :]
        other = 1.0 if ball < n_balls - ball < n_balls else 0.0
        first = FIRST_TURN[n_balls] + ball * (n_balls // 2 + 1)
        cosines, sines = COS_OF_TURNS[first:], SIN_OF_TURNS[first:]
        for lane in range(lane_count(n_records)):
            even, odd = folded[lane], 0.0
            for order in range(1, n_balls // 2 + 1):
                even = fma(folded[2 * order * LANES + lane], cosines[order], even)
                odd = fma(folded[(2 * order + 1) * LANES + lane], sines[order], odd)
            here[lane] -= even - odd
            mirror[lane] -= other * (even + odd)


@njit(**INLINE)
def subtract_ball_waviness(
    shape: Shape, batch: Batch, ahead: int, moves: FloatArray, z: FloatArray, gaps: FloatArray
) -> None:
    """Subtract the waviness of the balls, at both contacts of each, ``ahead`` knots from now; all balls spin at the same rate."""
    wide()
    n_balls = len(shape.balls)
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

    ``work`` has ``N_ROTATION_ROWS`` rows, and two for each ball.
    """
    wide()
    state, n_balls = batch.state, len(shape.balls)
    for lane in range(lane_count(batch.n_records)):
        for ball in range(n_balls):
            gaps[ball * LANES + lane] = batch.drive[Drive.HALF_CLEARANCE * LANES + lane]
    z, folded = work, work[N_ROTATION_ROWS * LANES :]
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
    fold_waviness(shape, batch, z, folded)
    unfold(shape, batch.n_records, folded, gaps)
    if batch.waves.size > race_rows(shape) * LANES:
        subtract_ball_waviness(shape, batch, ahead, moves, z, gaps)


@njit(**INLINE)
def move_gaps(
    shape: Shape, batch: Batch, knot: int, n_steps: int, moves: FloatArray, work: FloatArray, next_gaps: FloatArray
) -> None:
    """Set the gap of every ball at this knot and its slope to the next.

    ``next_gaps`` holds the gaps at this knot, unless it is the first, and receives those at the next.
    """
    wide()
    gaps, per_half_step = batch.params[gap_row(shape) * LANES :], 0.5 / n_steps
    # in a loop, so that the code of ball_gaps is compiled once
    for ahead in range(0 if knot == 0 else 1, 2):
        if ahead == 1:
            for lane in range(lane_count(batch.n_records)):
                for ball in range(len(shape.balls)):
                    gaps[2 * ball * LANES + lane] = next_gaps[ball * LANES + lane]
        ball_gaps(shape, batch, ahead, moves, work, next_gaps)
    for lane in range(lane_count(batch.n_records)):
        for ball in range(len(shape.balls)):
            further = next_gaps[ball * LANES + lane] - gaps[2 * ball * LANES + lane]
            gaps[(2 * ball + 1) * LANES + lane] = further * per_half_step
