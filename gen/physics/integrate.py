"""A batch of records from its first knot to its last, decimated on the way.

The full-rate history is kept for a few knots only: long enough for the anti-alias filter, whose outputs are all that leaves the batch.
"""

from collections.abc import Callable
from hashlib import sha256
from inspect import getsource
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.signal import firwin

from gen.physics import gaps, kernel, lanes, motion, spall
from gen.physics.gaps import ball_gaps, move_gaps, move_spalls
from gen.physics.kernel import COSA, N_DYNAMIC, STEEPEST, STIFFNESS, FloatArray, Shape, advance, jitter_row, param_rows
from gen.physics.lanes import INLINE, KERNEL, LANES
from gen.physics.motion import (
    ANGLE_ROWS,
    JITTER_FIRST,
    JITTER_TERMS,
    Lanes,
    move_forces,
    move_jitter,
    turn_phasors,
    turn_rings,
)

HALF_TAPS = 34  # per output sample; with beta 8 at least 80 dB from 1.025 Nyquist on
FAR_OFF = 1.0  # displacement [m] beyond which a record has diverged; soft supports sag by millimetres
_BLOCK = 32  # knots between two runs of the filter

Columns = tuple[FloatArray, NDArray[np.int64], FloatArray]


class Integral(NamedTuple):
    """What comes out of a batch."""

    response: FloatArray
    """What the pickups give at the knots, shape (knot, channel, lane) [m s-2, or m]."""
    diverged: NDArray[np.int64]
    """Knot at which a record left the finite range, -1 if it never did, shape (lane,)."""
    steepest: FloatArray
    """Largest contact stiffness at any step, summed over the balls: a bound for every direction, shape (lane,) [N/m]."""


def decimation_taps(factor: int) -> FloatArray:
    """Linear-phase low-pass for decimation by ``factor``, shape (tap,); a single 1 if there is nothing to decimate.

    Cut-off at 0.875 of the new Nyquist frequency with a transition of 0.15 of it (Kaiser window, 80 dB).
    """
    if factor == 1:
        return np.ones(1)
    return firwin(2 * HALF_TAPS * factor + 1, 0.875 / factor, window=("kaiser", 7.857))


def lead_knots(factor: int) -> int:
    """Knots by which an output of the filter lags its newest input."""
    return 0 if factor == 1 else HALF_TAPS


@njit(**INLINE)
def to_next_knot(
    shape: Shape,
    lanes: Lanes,
    knot: int,
    n_steps: int,
    dt: float,
    moves: FloatArray,
    last: FloatArray,
    widths: FloatArray,
) -> None:
    """Prepare ``lanes.params`` for the steps up to the next knot, and move the angles there.

    ``last`` holds the gaps at this knot and receives those at the next; ``moves`` and ``widths`` are work arrays.
    """
    turn_rings(lanes, knot, n_steps, dt, moves)
    turn_phasors(lanes.phasors, JITTER_FIRST + len(shape.balls) * JITTER_TERMS)
    if len(shape.forced):
        move_forces(lanes, knot, n_steps, dt, moves)
    if len(shape.jittered):
        move_jitter(shape, lanes, n_steps)
    if len(shape.uneven):
        move_gaps(shape, lanes, n_steps, moves, last, widths)
        move_spalls(shape, lanes, n_steps, moves)
    for i in range(ANGLE_ROWS * LANES):
        lanes.angles[i] += moves[i]


@njit(**INLINE)
def place_balls(shape: Shape, lanes: Lanes, n_steps: int, moves: FloatArray, last: FloatArray) -> None:
    """Gaps into ``last`` and jitter at the first knot."""
    moves[:] = 0.0
    if len(shape.uneven):
        ball_gaps(lanes, len(shape.balls), moves, last)
    if len(shape.jittered):
        move_jitter(shape, lanes, n_steps)
        for ball in range(len(shape.balls)):
            row = jitter_row(shape) + 2 * ball
            for lane in range(LANES):
                lanes.params[row * LANES + lane] += 2 * n_steps * lanes.params[(row + 1) * LANES + lane]
                lanes.params[(row + 1) * LANES + lane] = 0.0


@njit(**INLINE)
def filter_knot(taps: FloatArray, history: FloatArray, first: int, width: int, total: FloatArray) -> None:
    """Weighted sum of the rows of ``history`` from element ``first`` on, into ``total`` (shape ``width``)."""
    total[:] = 0.0
    whole = taps.size - taps.size % 8
    for tap in range(0, whole, 8):  # eight taps per pass over the lanes: one at a time waits for the sum to be stored
        a, b, c, d = taps[tap], taps[tap + 1], taps[tap + 2], taps[tap + 3]
        e, f, g, h = taps[tap + 4], taps[tap + 5], taps[tap + 6], taps[tap + 7]
        at = first + tap * width
        for i in range(width):
            low = (
                a * history[at + i]
                + b * history[at + width + i]
                + c * history[at + 2 * width + i]
                + d * history[at + 3 * width + i]
            )
            at4 = at + 4 * width
            high = (
                e * history[at4 + i]
                + f * history[at4 + width + i]
                + g * history[at4 + 2 * width + i]
                + h * history[at4 + 3 * width + i]
            )
            total[i] += low + high
    for tap in range(whole, taps.size):
        for i in range(width):
            total[i] += taps[tap] * history[first + tap * width + i]


@njit(**INLINE)
def integrate_lanes(
    shape: Shape, batch: Lanes, dt: float, n_steps: int, taps: FloatArray, n_settle: int, n_out: int
) -> Columns:
    """See :func:`integrate`; a named tuple would be made in Python, where a signal could leave its making half done."""
    params = np.zeros(param_rows(shape, n_steps) * LANES)
    params[: batch.params.size] = batch.params
    batch = Lanes(
        batch.state.copy(), params, batch.drive, batch.angles.copy(), batch.spalls, batch.phasors.copy(), batch.waves,
        batch.schedule, batch.tables,
    )  # fmt: skip
    n_channels, n_taps = len(shape.channels), taps.size
    width = n_channels * LANES
    lead = (n_taps - 1) // (2 * n_steps) + n_settle
    history = np.zeros((n_taps - 1 + _BLOCK * n_steps) * width)
    response = np.empty((n_out, n_channels, LANES))
    diverged = np.full(LANES, -1)
    moves = np.empty(ANGLE_ROWS * LANES)
    total = np.empty(width)
    last, widths = np.zeros(len(shape.balls) * LANES), np.zeros(len(shape.balls) * LANES)
    place_balls(shape, batch, n_steps, moves, last)
    for first in range(0, lead + n_out, _BLOCK):
        for knot in range(_BLOCK):
            to_next_knot(shape, batch, first + knot, n_steps, dt, moves, last, widths)
            advance(
                shape,
                batch.state,
                batch.params,
                dt,
                n_steps,
                history,
                (n_taps - 1 + knot * n_steps) * n_channels,
            )
            for lane in range(LANES):
                inside = True
                for row in range(N_DYNAMIC // 2):
                    inside &= abs(batch.state[row * LANES + lane]) < FAR_OFF
                if not inside and diverged[lane] < 0:
                    diverged[lane] = first + knot
        for knot in range(_BLOCK):
            out = first + knot - lead
            if 0 <= out < n_out:
                filter_knot(taps, history, knot * n_steps * width, width, total)
                for i in range(width):
                    response[out, i // LANES, i % LANES] = total[i]
        for i in range((n_taps - 1) * width):
            history[i] = history[_BLOCK * n_steps * width + i]
    steepest = batch.state[STEEPEST * LANES : (STEEPEST + 1) * LANES].copy()
    for lane in range(LANES):
        exponent = 10 / 9 if len(shape.roller) else 1.5
        squared = batch.params[COSA * LANES + lane] ** 2
        steepest[lane] *= exponent * squared * batch.params[STIFFNESS * LANES + lane]
    return response, diverged, steepest


def _cached(sources: str) -> Callable[..., Columns]:
    """Compile and cache; numba looks for changes in this file alone, but what a function closes over is part of its key."""

    @njit(**KERNEL)
    def cached(
        shape: Shape, batch: Lanes, dt: float, n_steps: int, taps: FloatArray, n_settle: int, n_out: int
    ) -> Columns:
        _ = sources
        return integrate_lanes(shape, batch, dt, n_steps, taps, n_settle, n_out)

    return cached


_compiled = _cached(
    sha256("".join(getsource(module) for module in (lanes, spall, kernel, motion, gaps)).encode()).hexdigest()
)


def integrate(
    shape: Shape, batch: Lanes, dt: float, n_steps: int, taps: FloatArray, n_settle: int, n_out: int
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
    taps : array, shape (tap,)
        Anti-alias filter at the full rate.
    n_settle, n_out : int
        Knots dropped before the first output, and outputs.
    """
    return Integral(*_compiled(shape, batch, dt, n_steps, taps, n_settle, n_out))
