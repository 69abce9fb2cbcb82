"""A batch of records from its first knot to its last, decimated on the way.

The history at the rate of the steps is kept for a few knots only: what leaves the batch are the outputs of the anti-alias filter.
"""

from collections.abc import Callable
from hashlib import sha256
from inspect import getsource
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gen.physics.kernel import compiling, decimate, drop, equations, spalls, step, turning
from gen.physics.kernel.compiling import ALLOCATING, INLINE, KERNEL, LANES, copied, lane_count, zeros
from gen.physics.kernel.decimate import OUTPUTS, Decimation, Single, filter_rows
from gen.physics.kernel.equations import COSA, N_DYNAMIC, STEEPEST, STIFFNESS, FloatArray, Shape, param_rows
from gen.physics.kernel.spalls import N_ROTATIONS, ball_gaps, move_gaps, move_spalls
from gen.physics.kernel.step import advance
from gen.physics.kernel.turning import (
    ANGLE_ROWS,
    JITTER,
    STRIDE,
    Lanes,
    keep_turning,
    move_forces,
    move_processes,
    slow_rows,
    start_processes,
    turn_rings,
)

FAR_OFF = 1.0  # displacement [m] beyond which a record has diverged; soft supports sag by millimetres
BLOCK = 8  # knots between two runs of the filters, a multiple of what they give in one pass
ROOM = 16  # blocks of outputs of the first stage, before the newest are moved to the front

Columns = tuple[Single, NDArray[np.int64], FloatArray]


class Integral(NamedTuple):
    """What comes out of a batch."""

    response: Single
    """What the pickups give at the knots, shape (knot, channel, lane) [m s-2, or m]."""
    diverged: NDArray[np.int64]
    """Knot at which a record left the finite range, -1 if it never did, shape (lane,)."""
    steepest: FloatArray
    """Largest contact stiffness at any step, summed over the balls: a bound for every direction, shape (lane,) [N/m]."""


class Work(NamedTuple):
    """Arrays that live as long as a batch."""

    moves: FloatArray
    """How far shaft, cage and ball spin move to the next knot, ANGLE_ROWS rows [rad]."""
    gaps: FloatArray
    """Gap of every ball at the next knot, spalls aside [m]."""
    dropped: FloatArray
    """Whether a ball was in a spall, a single number."""
    scratch: FloatArray
    """Room for whoever is at work."""


@njit(**ALLOCATING)
def set_out(shape: Shape, batch: Lanes, n_steps: int) -> Lanes:
    """The batch on its way: copies of what it was laid out in, and room for what holds between two knots."""
    params = zeros(param_rows(shape, n_steps) * LANES)
    for i in range(batch.params.size):
        params[i] = batch.params[i]
    return Lanes(
        copied(batch.state), params, copied(batch.drive), copied(batch.angles), copied(batch.spalls), copied(batch.phasors),
        zeros(2 * slow_rows(shape) * LANES), copied(batch.waves), batch.schedule, batch.tables,
    )  # fmt: skip


@njit(**ALLOCATING)
def prepare(shape: Shape, lanes: Lanes, n_steps: int) -> Work:
    """Work arrays, and what moves at its first knot."""
    n_balls = len(shape.balls)
    rows = 2 * N_ROTATIONS + 2 * n_balls + JITTER
    scratch = zeros(rows * LANES + 2 * n_steps + 1)
    work = Work(zeros(ANGLE_ROWS * LANES), zeros(n_balls * LANES), zeros(1), scratch)
    start_processes(shape, lanes)
    if len(shape.wavy):
        ball_gaps(shape, lanes, work.moves, work.scratch, work.gaps)
    return work


@njit(**INLINE)
def to_next_knot(shape: Shape, lanes: Lanes, knot: int, n_steps: int, dt: float, work: Work) -> None:
    """Prepare ``lanes.params`` for the steps up to the next knot, and move the angles there."""
    if knot % STRIDE == 0:
        move_processes(shape, lanes, n_steps, work.scratch)
    turn_rings(shape, lanes, knot, n_steps, dt, work.moves)
    if len(shape.forced):
        move_forces(lanes, knot, n_steps, dt, work.moves, work.scratch)
    if len(shape.wavy):
        move_gaps(shape, lanes, n_steps, work.moves, work.scratch, work.gaps)
    if len(shape.spalled):
        move_spalls(shape, lanes, n_steps, work.moves, work.scratch, work.dropped)
    keep_turning(shape, lanes, work.moves)


@njit(**INLINE)
def keep(history: Single, size: int, start: int) -> None:
    """Move ``size`` values from ``start`` on to the front."""
    newest = history[start:]
    for i in range(size):
        history[i] = newest[i]


def _cached(sources: str) -> Callable[..., Columns]:
    """What :func:`integrate` does; a named tuple would be made in Python, where a signal could leave its making half done.

    Numba looks for changes in this file alone, but what a function closes over is part of its key.
    """

    @njit(**KERNEL)
    def integrate_lanes(
        shape: Shape, batch: Lanes, dt: float, n_steps: int, filters: Decimation, n_settle: int, n_out: int
    ) -> Columns:
        _ = sources
        batch = set_out(shape, batch, n_steps)
        n_channels, width = len(shape.channels), len(shape.channels) * LANES
        two_stages = len(filters.first.taps) > 0
        first_stage = filters.first if two_stages else filters.last
        kept, half_kept = first_stage.kept, filters.last.kept
        history = zeros((kept + BLOCK * n_steps + 4) * width, np.float32)
        halfway = zeros((half_kept + 2 * BLOCK * ROOM + 4) * width, np.float32)
        lead = (kept + (half_kept * first_stage.factor if two_stages else 0)) // (2 * n_steps)
        response = np.empty((n_out + 2 * BLOCK) * width, np.float32)
        totals = zeros(OUTPUTS * width, np.float32)
        diverged = np.full(LANES, -1)
        work = prepare(shape, batch, n_steps)
        for first in range(0, lead + n_settle + n_out, BLOCK):
            for knot in range(first, first + BLOCK):
                to_next_knot(shape, batch, knot, n_steps, dt, work)
                since = 2.0 * n_steps * (knot % STRIDE)
                at = (kept + (knot - first) * n_steps) * n_channels
                advance(shape, batch.state, batch.params, dt, n_steps, since, history, at)
                for lane in range(lane_count()):
                    inside = True
                    for row in range(N_DYNAMIC // 2):
                        inside &= abs(batch.state[row * LANES + lane]) < FAR_OFF
                    if not inside and diverged[lane] < 0:
                        diverged[lane] = knot
            start = 2 * BLOCK * (first // BLOCK % ROOM) if two_stages else 0
            if two_stages:
                for output in range(0, 2 * BLOCK, OUTPUTS):
                    filter_rows(
                        shape.channels, first_stage.taps, history, output * first_stage.factor, halfway, half_kept + start + output,
                        totals,
                    )  # fmt: skip
            out = (
                first - lead - n_settle + BLOCK
            )  # one block later: there is room for what comes out before the first output
            if out >= 0:
                source = halfway if two_stages else history
                for output in range(0, BLOCK, OUTPUTS):
                    filter_rows(
                        shape.channels, filters.last.taps, source, start + output * filters.last.factor, response, out + output,
                        totals,
                    )  # fmt: skip
            keep(history, kept * width, BLOCK * n_steps * width)
            if start == 2 * BLOCK * (ROOM - 1):
                keep(halfway, half_kept * width, 2 * BLOCK * ROOM * width)
        steepest = np.empty(LANES)
        exponent = 10 / 9 if len(shape.roller) else 1.5
        for lane in range(lane_count()):
            slope = exponent * batch.params[COSA * LANES + lane] ** 2 * batch.params[STIFFNESS * LANES + lane]
            steepest[lane] = batch.state[STEEPEST * LANES + lane] * slope
        return response.reshape((n_out + 2 * BLOCK, n_channels, LANES))[BLOCK : BLOCK + n_out], diverged, steepest

    return integrate_lanes


integrate_lanes = _cached(
    sha256(
        "".join([str(LANES), *map(getsource, (compiling, drop, equations, step, turning, spalls, decimate))]).encode()
    ).hexdigest()
)


def integrate(
    shape: Shape, batch: Lanes, dt: float, n_steps: int, filters: Decimation, n_settle: int, n_out: int
) -> Integral:
    """Integrate a batch.

    Parameters
    ----------
    shape : Shape
        What the kernel contains.
    batch : Lanes
        The batch; its arrays are left untouched.
    dt : float
        Step [s].
    n_steps : int
        Steps per knot.
    filters : Decimation
        Anti-alias filters.
    n_settle, n_out : int
        Knots dropped before the first output, and outputs.
    """
    return Integral(*integrate_lanes(shape, batch, dt, n_steps, filters, n_settle, n_out))
