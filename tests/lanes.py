"""The lane kernel run over some knots with every state kept, to compare it with its twin in :mod:`tests.reference`."""

import numpy as np

from gen.physics.kernel.batch import input_shape, lay_out
from gen.physics.kernel.compiling import LANES, compiled_to_disk
from gen.physics.kernel.integrate import prepare, to_next_knot
from gen.physics.kernel.layout import (
    AXES,
    N_DYNAMIC,
    STATE_ROWS,
    Batch,
    FloatArray,
    Shape,
    State,
    param_rows,
    slow_rows,
)
from gen.physics.kernel.step import advance
from gen.physics.kernel.turning import N_ANGLES, STRIDE
from gen.physics.kernel_input import KernelInput, at_rest
from tests.reference import Trip

EVERY_ACCELERATION = np.eye(AXES)


def march_lanes(
    records: list[KernelInput], n_knots: int, n_steps: int, knot: float, start: FloatArray | None = None
) -> list[Trip]:
    """The same by the lane kernel, one trip per record; all of one shape, from static rest unless a ``start`` is given."""
    every = [record._replace(pickups=EVERY_ACCELERATION) for record in records]
    shape = input_shape(every[0])
    batch = lay_out(at_rest(every), shape, knot)
    if start is not None:
        batch.state.reshape(-1, LANES)[:N_DYNAMIC] = np.asarray(start)[:, None]
    return march_batch(shape, batch, n_knots, n_steps, knot)[: len(records)]


def march_batch(shape: Shape, batch: Batch, n_knots: int, n_steps: int, knot: float) -> list[Trip]:
    """A batch by the lane kernel, one trip per lane; its channels are the six accelerations."""
    own = with_room(shape, batch, n_steps)
    states = np.empty((n_knots + 1, STATE_ROWS, LANES))
    angles = np.empty((n_knots + 1, N_ANGLES, LANES))
    history = np.empty(n_knots * n_steps * AXES * LANES)
    _march(shape, own, knot / n_steps, n_steps, states, angles, history)
    accelerations = history.reshape(AXES, -1, LANES)
    return [
        Trip(
            states[:, :N_DYNAMIC, i],
            accelerations[..., i].T,
            angles[..., i],
            states[:, State.CAGE_COS : State.STEEPEST, i],
        )
        for i in range(LANES)
    ]


def with_room(shape: Shape, batch: Batch, n_steps: int) -> Batch:
    """A copy of a batch that the kernel may change, with all rows of ``params`` and ``slow``."""
    params = np.zeros(param_rows(shape, n_steps) * LANES)
    params[: batch.params.size] = batch.params
    own = {name: array.copy() for name, array in batch._asdict().items() if name != "n_records"}
    own |= {"params": params, "slow": np.zeros(2 * slow_rows(shape) * LANES)}
    return Batch(batch.n_records, **own)


@compiled_to_disk
def _march(shape, batch, dt, n_steps, states, angles, history):
    work = prepare(shape, batch, n_steps)
    for knot in range(len(states)):
        states[knot] = batch.state.reshape(STATE_ROWS, LANES)
        angles[knot] = batch.angles.reshape(N_ANGLES, LANES)
        if knot + 1 < len(states):
            to_next_knot(shape, batch, knot, n_steps, dt, work)
            since = 2.0 * n_steps * (knot % STRIDE)
            advance(shape, batch, dt, n_steps, since, history, knot * n_steps, history.size // AXES)
