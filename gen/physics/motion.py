"""From one knot to the next: how shaft, cage, balls and spalls move while the kernel takes its steps.

Speed, slip, spin, jitter and spin-axis wander are sums of a few cosines with drawn frequencies and phases; each cosine is a phasor
turned once per knot, so no process needs a table in memory and none depends on the step. Race waviness is a Fourier series too: the
sum over orders is folded onto the balls, since ball ``i`` sees order ``n`` with the phase ``2 pi i n / n_balls``.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from gen.physics.kernel import (
    BALL_ROWS,
    BALLS,
    CAGE_C,
    CAGE_S,
    CAGE_TURN_C,
    CAGE_TURN_S,
    COS,
    GAP0,
    GAP1,
    JITTER0,
    JITTER1,
    OFFSET0,
    OFFSET1,
    RACE,
    SHAFT_C,
    SHAFT_S,
    SHAFT_TURN_C,
    SHAFT_TURN_S,
    SHARE0,
    SHARE1,
    SIN,
    SLOT_ROWS,
    UNBALANCE_P,
    UNBALANCE_Q,
    UNDER,
    FloatArray,
    Shape,
    slot_row,
)  # fmt: skip
from gen.physics.lanes import COMPILED, INLINE, LANES, cosine, sine

# Rows of ``drive``: what a record's motion is made of.
(
    SHAFT_STEP, CAGE_RATIO, SPIN_RATIO, MEAN_SLIP, SPEED_RMS, SLIP_RMS, SPIN_RMS, JITTER_RMS, AXIS_OFFSET, AXIS_RMS, AXIS_LIMIT,
    UNBALANCE, CLEARANCE, INNER_RADIUS, OUTER_RADIUS, DRIVE_ROWS,
) = range(16)  # fmt: skip
SHAFT, CAGE, SPIN, ANGLE_ROWS = range(4)  # rows of ``angles`` [rad]
SITE, POSITION, CARRIER, RANK, SPALL_ROWS = range(5)  # rows of ``spalls``, per slot
NO_SITE, INNER, OUTER, BALL_SITE = range(4)

# Rows of the phasors: each process has its own, the jitter has JITTER_TERMS per ball.
SPEED_TERMS, SLIP_TERMS, SPIN_TERMS, AXIS_TERMS, JITTER_TERMS = 6, 12, 6, 8, 4
SLIP_FIRST = SPEED_TERMS
SPIN_FIRST = SLIP_FIRST + SLIP_TERMS
AXIS_FIRST = SPIN_FIRST + SPIN_TERMS
JITTER_FIRST = AXIS_FIRST + AXIS_TERMS

LOWEST_ORDER, HIGHEST_ORDER = 2, 60  # waviness per turn of a race
N_ORDERS = HIGHEST_ORDER - LOWEST_ORDER + 1
WAVE_ROWS = 4 * N_ORDERS  # real and imaginary amplitude of each order, inner race then outer race


class Lanes(NamedTuple):
    """A batch of records, one per lane; every array is flat, ``row * LANES + lane``."""

    state: FloatArray
    params: FloatArray
    drive: FloatArray
    angles: FloatArray
    spalls: FloatArray
    phasors: FloatArray
    """Cosine, sine, and cosine and sine of the turn per knot, of every term: 4 blocks of rows."""
    waves: FloatArray
    """Waviness amplitudes [m], WAVE_ROWS rows, or empty."""


@njit(**INLINE)
def turn_phasors(phasors: FloatArray, n_terms: int) -> None:
    """Turn every phasor by one knot."""
    block = n_terms * LANES
    for i in range(block):
        c, s = phasors[i], phasors[block + i]
        dc, ds = phasors[2 * block + i], phasors[3 * block + i]
        phasors[i] = c * dc - s * ds
        phasors[block + i] = s * dc + c * ds


@njit(**INLINE)
def process(phasors: FloatArray, first: int, terms: int, lane: int) -> float:
    """Value of a process of unit rms [1]."""
    total = 0.0
    for term in range(first, first + terms):
        total += phasors[term * LANES + lane]
    return total * math.sqrt(2.0 / terms)


@njit(**INLINE)
def wrapped(angle: float) -> float:
    """Angle in [-pi, pi]."""
    return angle - 2 * math.pi * np.rint(angle / (2 * math.pi))


@njit(**INLINE)
def turn_rings(lanes: Lanes, n_steps: int, dt: float, moves: FloatArray) -> None:
    """Set the turning rates to the next knot, and note how far shaft, cage and ball spin will move in ``moves``."""
    params, drive, phasors, state = lanes.params, lanes.drive, lanes.phasors, lanes.state
    for lane in range(LANES):
        speed = 1 + drive[SPEED_RMS * LANES + lane] * process(phasors, 0, SPEED_TERMS, lane)
        shaft = drive[SHAFT_STEP * LANES + lane] * speed
        slip = drive[MEAN_SLIP * LANES + lane] + drive[SLIP_RMS * LANES + lane] * process(
            phasors, SLIP_FIRST, SLIP_TERMS, lane
        )
        cage = drive[CAGE_RATIO * LANES + lane] * shaft * (1 - slip)
        wander = 1 + drive[SPIN_RMS * LANES + lane] * process(phasors, SPIN_FIRST, SPIN_TERMS, lane)
        moves[SHAFT * LANES + lane] = shaft
        moves[CAGE * LANES + lane] = cage
        moves[SPIN * LANES + lane] = drive[SPIN_RATIO * LANES + lane] * shaft * wander
        half = 0.5 / n_steps
        params[CAGE_TURN_C * LANES + lane], params[CAGE_TURN_S * LANES + lane] = (
            cosine(cage * half),
            sine(cage * half),
        )
        params[SHAFT_TURN_C * LANES + lane], params[SHAFT_TURN_S * LANES + lane] = (
            cosine(shaft * half),
            sine(shaft * half),
        )
        omega = shaft / (n_steps * dt)
        params[UNBALANCE_P * LANES + lane] = drive[UNBALANCE * LANES + lane] * omega * omega
        params[UNBALANCE_Q * LANES + lane] = 0.0
        for row in (
            CAGE_C,
            SHAFT_C,
        ):  # a phasor turned 1e5 times keeps its angle to 1e-13, its length needs help
            c, s = state[row * LANES + lane], state[(row + 1) * LANES + lane]
            stretch = 1.5 - 0.5 * (c * c + s * s)
            state[row * LANES + lane], state[(row + 1) * LANES + lane] = c * stretch, s * stretch


@njit(**INLINE)
def fold_waviness(lanes: Lanes, n_balls: int, race: int, c: FloatArray, s: FloatArray, folded: FloatArray) -> None:
    """Add the waviness of one race, turned to direction ``c, s``, to the ``n_balls`` complex amplitudes in ``folded``."""
    waves = lanes.waves
    zc, zs = np.empty(LANES), np.empty(LANES)
    for lane in range(LANES):
        zc[lane] = c[lane] * c[lane] - s[lane] * s[lane]
        zs[lane] = 2 * c[lane] * s[lane]
    for order in range(N_ORDERS):
        row = (2 * race * N_ORDERS + order) * LANES
        bin_ = ((order + LOWEST_ORDER) % n_balls) * LANES
        for lane in range(LANES):
            real, imag = waves[row + lane], waves[row + N_ORDERS * LANES + lane]
            zr, zi = zc[lane], zs[lane]
            folded[bin_ + lane] += real * zr - imag * zi
            folded[n_balls * LANES + bin_ + lane] += real * zi + imag * zr
            zc[lane] = zr * c[lane] - zi * s[lane]
            zs[lane] = zi * c[lane] + zr * s[lane]


@njit(**INLINE)
def waviness(
    lanes: Lanes,
    n_balls: int,
    cage_c: FloatArray,
    cage_s: FloatArray,
    in_c: FloatArray,
    in_s: FloatArray,
    w: FloatArray,
) -> None:
    """Waviness under every ball, both races together, into ``w`` (ball * LANES + lane) [m]."""
    folded = np.zeros(2 * n_balls * LANES)
    fold_waviness(lanes, n_balls, 0, in_c, in_s, folded)
    fold_waviness(lanes, n_balls, 1, cage_c, cage_s, folded)
    for ball in range(n_balls):
        for lane in range(LANES):
            w[ball * LANES + lane] = 0.0
        for order in range(n_balls):
            turn = (ball * order) % n_balls
            for lane in range(LANES):
                real, imag = folded[order * LANES + lane], folded[(n_balls + order) * LANES + lane]
                w[ball * LANES + lane] += real * COS[n_balls, turn] - imag * SIN[n_balls, turn]


@njit(**INLINE)
def move_balls(lanes: Lanes, n_balls: int, n_steps: int, moves: FloatArray) -> None:
    """Set gap and jitter of every ball to run from where they are to their values at the next knot."""
    params, drive, state = lanes.params, lanes.drive, lanes.state
    cage_c, cage_s, in_c, in_s = np.empty(LANES), np.empty(LANES), np.empty(LANES), np.empty(LANES)
    w = np.zeros(n_balls * LANES)
    if lanes.waves.size:
        for lane in range(LANES):
            c, s = state[CAGE_C * LANES + lane], state[CAGE_S * LANES + lane]
            dc, ds = cosine(moves[CAGE * LANES + lane]), sine(moves[CAGE * LANES + lane])
            c, s = c * dc - s * ds, s * dc + c * ds
            p, q = state[SHAFT_C * LANES + lane], state[SHAFT_S * LANES + lane]
            dc, ds = cosine(moves[SHAFT * LANES + lane]), sine(moves[SHAFT * LANES + lane])
            p, q = p * dc - q * ds, q * dc + p * ds
            cage_c[lane], cage_s[lane] = c, s
            in_c[lane], in_s[lane] = c * p + s * q, s * p - c * q
        waviness(lanes, n_balls, cage_c, cage_s, in_c, in_s, w)
    for ball in range(n_balls):
        row = BALLS + ball * BALL_ROWS
        for lane in range(LANES):
            gap = drive[CLEARANCE * LANES + lane] - w[ball * LANES + lane]
            eta = process(lanes.phasors, JITTER_FIRST + ball * JITTER_TERMS, JITTER_TERMS, lane)
            jitter = drive[JITTER_RMS * LANES + lane] * eta
            last_gap = params[(row + GAP0) * LANES + lane] + 2 * n_steps * params[(row + GAP1) * LANES + lane]
            last_jitter = params[(row + JITTER0) * LANES + lane] + 2 * n_steps * params[(row + JITTER1) * LANES + lane]
            params[(row + GAP0) * LANES + lane] = last_gap
            params[(row + GAP1) * LANES + lane] = (gap - last_gap) / (2 * n_steps)
            params[(row + JITTER0) * LANES + lane] = last_jitter
            params[(row + JITTER1) * LANES + lane] = (jitter - last_jitter) / (2 * n_steps)


@njit(**INLINE)
def share_on_track(lanes: Lanes, lane: int) -> float:
    """Share of its drop that a ball spall gives while the spin axis leaves it off the track, 1 if it never does [1]."""
    limit = lanes.drive[AXIS_LIMIT * LANES + lane]
    if limit <= 0.0:
        return 1.0
    tilt = lanes.drive[AXIS_OFFSET * LANES + lane]
    tilt += lanes.drive[AXIS_RMS * LANES + lane] * process(lanes.phasors, AXIS_FIRST, AXIS_TERMS, lane)
    return max(0.0, 1 - (tilt / limit) ** 2)


@njit(**INLINE)
def move_slots(shape: Shape, lanes: Lanes, n_steps: int, moves: FloatArray) -> None:
    """Put each spall under the ball nearest to it half way to the next knot, and set how it passes below."""
    n_balls = len(shape.balls)
    pitch = 2 * math.pi / n_balls
    params, angles, spalls = lanes.params, lanes.angles, lanes.spalls
    for slot in range(len(shape.slots)):
        row = slot_row(shape) + slot * SLOT_ROWS
        for lane in range(LANES):
            site = spalls[(slot * SPALL_ROWS + SITE) * LANES + lane]
            place = spalls[(slot * SPALL_ROWS + POSITION) * LANES + lane]
            ball = -1.0
            start = slope = 0.0
            if site == BALL_SITE:
                ball = spalls[(slot * SPALL_ROWS + CARRIER) * LANES + lane]
                slope = moves[SPIN * LANES + lane]
                start = angles[SPIN * LANES + lane] + place
                middle = wrapped(start + 0.5 * slope)
                inner = abs(middle) < 0.5 * math.pi
                params[(row + RACE) * LANES + lane] = (
                    lanes.drive[INNER_RADIUS * LANES + lane] if inner else -lanes.drive[OUTER_RADIUS * LANES + lane]
                )
                start = (middle if inner else wrapped(middle - math.pi)) - 0.5 * slope
                share = params[(row + SHARE0) * LANES + lane] + 2 * n_steps * params[(row + SHARE1) * LANES + lane]
                params[(row + SHARE0) * LANES + lane] = share
                params[(row + SHARE1) * LANES + lane] = (share_on_track(lanes, lane) - share) / (2 * n_steps)
            elif site != NO_SITE:
                start = place - angles[CAGE * LANES + lane]
                slope = -moves[CAGE * LANES + lane]
                if site == INNER:
                    start += angles[SHAFT * LANES + lane]
                    slope += moves[SHAFT * LANES + lane]
                nearest = np.rint((start + 0.5 * slope) / pitch) + spalls[(slot * SPALL_ROWS + RANK) * LANES + lane]
                start, slope = nearest * pitch - start, -slope
                ball = nearest - n_balls * np.floor(nearest / n_balls)
                if len(shape.uneven):
                    source = BALLS + int(ball) * BALL_ROWS
                    start += params[(source + JITTER0) * LANES + lane]
                    slope += 2 * n_steps * params[(source + JITTER1) * LANES + lane]
            params[(row + UNDER) * LANES + lane] = ball
            params[(row + OFFSET0) * LANES + lane] = start
            params[(row + OFFSET1) * LANES + lane] = slope / (2 * n_steps)


@njit(**INLINE)
def to_next_knot(shape: Shape, lanes: Lanes, n_steps: int, dt: float, moves: FloatArray) -> None:
    """Prepare ``lanes.params`` for the steps up to the next knot, and move the angles there."""
    turn_rings(lanes, n_steps, dt, moves)
    turn_phasors(lanes.phasors, JITTER_FIRST + len(shape.balls) * JITTER_TERMS)
    if len(shape.uneven):
        move_balls(lanes, len(shape.balls), n_steps, moves)
    move_slots(shape, lanes, n_steps, moves)
    for i in range(ANGLE_ROWS * LANES):
        lanes.angles[i] += moves[i]


@njit(**COMPILED)
def place_balls(shape: Shape, lanes: Lanes, n_steps: int) -> None:
    """Let gaps, jitter and shares start at their values at the first knot instead of running there from zero."""
    moves = np.zeros(ANGLE_ROWS * LANES)
    for lane in range(LANES):
        for slot in range(len(shape.slots)):
            row = slot_row(shape) + slot * SLOT_ROWS
            lanes.params[(row + SHARE1) * LANES + lane] = 0.0
            lanes.params[(row + SHARE0) * LANES + lane] = (
                share_on_track(lanes, lane)
                if lanes.spalls[(slot * SPALL_ROWS + SITE) * LANES + lane] == BALL_SITE
                else 1.0
            )
    if len(shape.uneven):
        move_balls(lanes, len(shape.balls), n_steps, moves)
        for ball in range(len(shape.balls)):
            row = BALLS + ball * BALL_ROWS
            for value, slope in ((GAP0, GAP1), (JITTER0, JITTER1)):
                for lane in range(LANES):
                    lanes.params[(row + value) * LANES + lane] += (
                        2 * n_steps * lanes.params[(row + slope) * LANES + lane]
                    )
                    lanes.params[(row + slope) * LANES + lane] = 0.0
