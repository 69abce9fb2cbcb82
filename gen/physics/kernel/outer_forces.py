"""Outer forces that change between knots: load, misalignment, and the knock of a broken cage."""

import math

from numba import njit

from gen.physics.kernel.chance import standard_normal
from gen.physics.kernel.compiling import INLINE, LANES, cosine, fma, lane_count, sine, wide
from gen.physics.kernel.layout import Angle, Batch, Drive, FloatArray, Param, State
from gen.physics.kernel.pulse import second_difference

KNOCK_SECONDS = 3e-4  # length of a knock, a half sine
KNOCK_SCATTER = 0.3  # standard deviation of the logarithm of its strength


@njit(**INLINE)
def knock(batch: Batch, knot_seconds: float, ahead: int, lane: int, moves: FloatArray) -> float:
    """Force of the knock of the cage on the housing ``ahead`` knots from now: a half sine once per turn of the cage [N].

    The steps see a force that changes linearly from knot to knot. Its values at the knots are second differences (see
    :mod:`gen.physics.kernel.pulse`), which give it the momentum of the half sine at any sample rate. Its strength has a log-normal scatter
    from turn to turn.
    """
    turned = batch.angles[Angle.CAGE * LANES + lane] - batch.drive[Drive.KNOCK_ANGLE * LANES + lane]
    turned += ahead * moves[Angle.CAGE * LANES + lane]
    turns = math.floor(turned / (2 * math.pi) + 0.5)
    since = (turned - 2 * math.pi * turns) * knot_seconds / moves[Angle.CAGE * LANES + lane]
    if (
        not -knot_seconds < since < KNOCK_SECONDS + knot_seconds
    ):  # also for a cage at a standstill, where it is NaN or infinite
        return 0.0
    there = second_difference(since, KNOCK_SECONDS, knot_seconds)
    scatter = math.exp(KNOCK_SCATTER * standard_normal(turns, batch.drive[Drive.KNOCK_SEED * LANES + lane]))
    return batch.drive[Drive.KNOCK * LANES + lane] * scatter * there / knot_seconds**2


@njit(**INLINE)
def outer_forces(batch: Batch, knot: int, knot_seconds: float, ahead: int, moves: FloatArray, out: FloatArray) -> None:
    """Outer forces ``ahead`` knots from now: x and y on the shaft, then x and y on the housing, into the rows of ``out`` [N].

    With the angle theta_s of the shaft, misalignment pulls along its fixed direction psi by ``cos 2 (theta_s - psi)``.
    """
    wide()
    drive, state = batch.drive, batch.state
    scheduled = min(knot + ahead, len(batch.schedule) - 1)
    for lane in range(lane_count(batch.n_records)):
        load = 1.0
        if scheduled >= 0:
            load = batch.schedule[scheduled, 1, lane]
        turn = ahead * moves[Angle.SHAFT * LANES + lane]
        dc, ds = cosine(turn), sine(turn)
        c, s = state[State.SHAFT_COS * LANES + lane], state[State.SHAFT_SIN * LANES + lane]
        c, s = fma(c, dc, -(s * ds)), fma(s, dc, c * ds)
        pull = (c * c - s * s) * drive[Drive.TWICE_COS * LANES + lane] + 2 * c * s * drive[
            Drive.TWICE_SIN * LANES + lane
        ]
        out[lane] = fma(load, drive[Drive.LOAD_X * LANES + lane], pull * drive[Drive.TWICE_X * LANES + lane])
        out[LANES + lane] = fma(load, drive[Drive.LOAD_Y * LANES + lane], pull * drive[Drive.TWICE_Y * LANES + lane])
    for lane in range(lane_count(batch.n_records)):
        hit, place = 0.0, drive[Drive.KNOCK_ANGLE * LANES + lane]
        if drive[Drive.KNOCK * LANES + lane] != 0.0:
            hit = knock(batch, knot_seconds, ahead, lane, moves)
        out[2 * LANES + lane] = hit * math.cos(place) if hit != 0.0 else 0.0
        out[3 * LANES + lane] = hit * math.sin(place) if hit != 0.0 else 0.0


@njit(**INLINE)
def move_forces(batch: Batch, knot: int, n_steps: int, dt: float, moves: FloatArray, work: FloatArray) -> None:
    """Set the outer forces at this knot, and their slopes up to the next; ``work`` has eight rows."""
    wide()
    for ahead in range(2):
        outer_forces(batch, knot, n_steps * dt, ahead, moves, work[4 * ahead * LANES :])
    for i in range(4 * lane_count(LANES)):
        batch.params[Param.SHAFT_FORCE_X * LANES + i] = work[i]
        batch.params[(Param.SHAFT_FORCE_X + 4) * LANES + i] = (work[4 * LANES + i] - work[i]) * (0.5 / n_steps)
