"""A batch of records integrated from its first knot to its last, and decimated on the way.

Only the decimated output is returned; the history at the rate of the steps is kept for a few knots.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from gen.physics.kernel.compiling import ALLOCATING, INLINE, LANES, compiled_to_disk, copied, lane_count, zeros
from gen.physics.kernel.decimate import Decimation, Single, filter_rows
from gen.physics.kernel.layout import (
    AXES,
    Batch,
    FloatArray,
    Param,
    Shape,
    State,
    param_rows,
    slow_rows,
)  # fmt: skip
from gen.physics.kernel.outer_forces import move_forces
from gen.physics.kernel.spalls import move_spalls, none_met
from gen.physics.kernel.step import advance
from gen.physics.kernel.turning import (
    N_ANGLES,
    STRIDE,
    keep_turning,
    move_processes,
    new_walk,
    turn_rings,
)
from gen.physics.kernel.waviness import gap_work_rows, move_gaps

FAR_OFF = 1.0  # displacement beyond which a record has diverged [m]; soft supports sag by millimetres
BLOCK = 8  # knots between two runs of the filters, a multiple of ``OUTPUTS`` of the filters
ROOM = 16  # blocks of outputs of the first stage; then the newest are moved to the front

Columns = tuple[Single, NDArray[np.int64], FloatArray]


class Integral(NamedTuple):
    """Result of a batch."""

    response: Single
    """Output of the channels at the knots, shape (channel, knot, lane) [m s-2, or m]."""
    diverged: NDArray[np.int64]
    """Knot at which a record was farther off than ``FAR_OFF`` or not finite, -1 if never, shape (lane,)."""
    steepest: FloatArray
    """Largest contact stiffness at any step, summed over the balls: it bounds that in every direction, shape (lane,) [N/m]."""


class Work(NamedTuple):
    """Work arrays of a batch."""

    moves: FloatArray
    """Angles by which shaft, cage and ball spin turn up to the next knot, rows of :class:`Angle` [rad]."""
    gaps: FloatArray
    """Gap of every ball at the next knot without spalls, and room for as many [m]."""
    met: FloatArray
    """Which balls meet spalls, see :func:`gen.physics.kernel.spalls.none_met`."""
    scratch: FloatArray
    """Scratch of the function that runs."""


@njit(**ALLOCATING)
def set_out(shape: Shape, batch: Batch, n_steps: int) -> Batch:
    """A copy of a batch with all rows of ``params`` and ``slow``, for the kernel to change."""
    params = zeros(param_rows(shape, n_steps) * LANES)
    for i in range(batch.params.size):
        params[i] = batch.params[i]
    return Batch(
        n_records=batch.n_records,
        state=copied(batch.state),
        params=params,
        drive=copied(batch.drive),
        angles=copied(batch.angles),
        spalls=copied(batch.spalls),
        phasors=copied(batch.phasors),
        slow=zeros(2 * slow_rows(shape) * LANES),
        waves=copied(batch.waves),
        schedule=batch.schedule,
        tables=batch.tables,
    )


@njit(**ALLOCATING)
def prepare(shape: Shape, batch: Batch, n_steps: int) -> Work:
    """Work arrays."""
    return Work(
        moves=zeros(N_ANGLES * LANES),
        gaps=zeros(2 * shape.balls * LANES),
        met=none_met(shape, batch),
        scratch=zeros(gap_work_rows(shape) * LANES + 2 * n_steps + 1),
    )


@njit(**INLINE)
def to_next_knot(shape: Shape, batch: Batch, knot: int, n_steps: int, dt: float, work: Work) -> None:
    """Set ``batch.params`` for the steps up to the next knot, and advance the angles to it."""
    if knot % STRIDE == 0:
        move_processes(shape, batch, knot, n_steps, work.scratch)
        new_walk(batch, knot)
    turn_rings(shape, batch, knot, n_steps, dt, work.moves)
    if shape.forced:
        move_forces(batch, knot, n_steps, dt, work.moves, work.scratch)
    if shape.wavy:
        move_gaps(shape, batch, knot, n_steps, work.moves, work.scratch, work.gaps)
    if batch.spalls.size > 0:
        move_spalls(shape, batch, n_steps, work.moves, work.scratch, work.met)
    keep_turning(shape, batch, work.moves)


@njit(**INLINE)
def keep(history: Single, size: int, start: int) -> None:
    """Move ``size`` values, from ``start`` on, to the front."""
    newest = history[start:]
    for i in range(size):
        history[i] = newest[i]


@njit(**INLINE)
def watch(batch: Batch, knot: int, diverged: NDArray[np.int64]) -> None:
    """Store the knot in ``diverged`` for the lanes that first leave the finite range at it."""
    for lane in range(lane_count(batch.n_records)):
        inside = True
        for row in range(AXES):
            inside &= abs(batch.state[row * LANES + lane]) < FAR_OFF
        if not inside and diverged[lane] < 0:
            diverged[lane] = knot


@njit(**ALLOCATING)
def largest_stiffness(shape: Shape, batch: Batch) -> FloatArray:
    """Largest contact stiffness of each lane, shape (lane,) [N/m]: ``n K cos(alpha)^2`` times the largest sum of ``squeeze**(n - 1)``."""
    steepest = np.empty(LANES)
    exponent = 10 / 9 if shape.roller else 1.5
    for lane in range(lane_count(batch.n_records)):
        cosine, factor = (
            batch.params[Param.CONTACT_COSINE * LANES + lane],
            batch.params[Param.LOAD_DEFLECTION_FACTOR * LANES + lane],
        )
        steepest[lane] = batch.state[State.STEEPEST * LANES + lane] * (exponent * cosine**2 * factor)
    return steepest


@compiled_to_disk
def integrate_lanes(
    shape: Shape, batch: Batch, dt: float, n_steps: int, filters: Decimation, n_settle: int, n_out: int
) -> Columns:
    """Kernel of :func:`integrate`; a plain tuple, since numba builds a named tuple in Python, where a signal could interrupt it."""
    batch = set_out(shape, batch, n_steps)
    two_stages = len(filters.first.taps) > 0
    first_stage = filters.first if two_stages else filters.last
    kept, half_kept = first_stage.kept, filters.last.kept
    room, half_room = (kept + BLOCK * n_steps + 4) * LANES, (half_kept + 2 * BLOCK * ROOM + 4) * LANES  # of a channel
    history, halfway = zeros(shape.channels * room, np.float32), zeros(shape.channels * half_room, np.float32)
    lead = (kept + (half_kept * first_stage.factor if two_stages else 0)) // (2 * n_steps)
    out_room = (n_out + 2 * BLOCK) * LANES
    response = np.empty(shape.channels * out_room, np.float32)
    totals = zeros(2 * BLOCK * LANES, np.float32)
    diverged = np.full(LANES, -1)
    work = prepare(shape, batch, n_steps)
    for first in range(0, lead + n_settle + n_out, BLOCK):
        for knot in range(first, first + BLOCK):
            to_next_knot(shape, batch, knot, n_steps, dt, work)
            since = 2.0 * n_steps * (knot % STRIDE)
            advance(shape, batch, dt, n_steps, since, history, kept + (knot - first) * n_steps, room)
            watch(batch, knot, diverged)
        start = 2 * BLOCK * (first // BLOCK % ROOM) if two_stages else 0
        out = first - lead - n_settle + BLOCK  # one block later, so that earlier outputs have room before the first
        for channel in range(shape.channels):
            steps, halves = history[channel * room :], halfway[channel * half_room :]
            if two_stages:
                filter_rows(first_stage, 2 * BLOCK, steps, 0, halves, half_kept + start, totals)
            if out >= 0:
                source = halves if two_stages else steps
                filter_rows(filters.last, BLOCK, source, start, response[channel * out_room :], out, totals)
            keep(steps, kept * LANES, BLOCK * n_steps * LANES)
            if start == 2 * BLOCK * (ROOM - 1):
                keep(halves, half_kept * LANES, 2 * BLOCK * ROOM * LANES)
    steepest = largest_stiffness(shape, batch)
    return response.reshape((shape.channels, n_out + 2 * BLOCK, LANES))[:, BLOCK : BLOCK + n_out], diverged, steepest


def integrate(
    shape: Shape, batch: Batch, dt: float, n_steps: int, filters: Decimation, n_settle: int, n_out: int
) -> Integral:
    """Integrate a batch.

    Parameters
    ----------
    shape : Shape
        What the records of the batch have.
    batch : Lanes
        The batch; its arrays are left untouched.
    dt : float
        Step [s].
    n_steps : int
        Steps per knot.
    filters : Decimation
        Anti-alias filters.
    n_settle, n_out : int
        Number of knots dropped before the first output, and of outputs.
    """
    return Integral(*integrate_lanes(shape, batch, dt, n_steps, filters, n_settle, n_out))
