"""Records grouped by kernel shape and step, and integrated in lanes, ``LANES`` at a time.

A record does not depend on the others in its batch.
"""

import functools
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.physics.inputs import KernelInput
from gen.physics.kernel.batch import input_shape, lay_out
from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.decimate import decimation
from gen.physics.kernel.integrate import Integral, integrate
from gen.physics.kernel.layout import Batch, Shape
from gen.simulation.kernels import load_kernel
from gen.simulation.timeline import Timeline


class Group(NamedTuple):
    """Records of one group share their compiled kernel and their step, so they may share batches."""

    shape: Shape
    steps: int
    """Steps per sample."""


class Integrated(NamedTuple):
    """Result of the kernel for some records, in the order they were given."""

    response: NDArray[np.float32]
    """Shape (record, channel, time) [m s-2, or m]."""
    diverged: NDArray[np.int64]
    """Knot at which a record left the finite range, -1 if never, shape (record,)."""
    steepest: NDArray[np.float64]
    """Largest contact stiffness, shape (record,) [N/m]."""


_filters = functools.lru_cache(maxsize=16)(decimation)


def group_of(given: KernelInput, steps: int) -> Group:
    """Group of a record that takes ``steps`` per sample."""
    return Group(input_shape(given), steps)


def batches(groups: Mapping[int, Group]) -> Iterator[tuple[Group, list[int]]]:
    """Batches of records, given their groups by place: the group of each batch, and at most ``LANES`` places."""
    places: dict[Group, list[int]] = defaultdict(list)
    for place, group in groups.items():
        places[group].append(place)
    for group, members in places.items():
        for first in range(0, len(members), LANES):
            yield group, members[first : first + LANES]


def filled_lanes(count: int) -> int:
    """Lanes that the batches of ``count`` records of one group take, free lanes included."""
    return -(-count // LANES) * LANES


def integrate_batch(group: Group, batch: Batch, timeline: Timeline) -> Integral:
    """Integrate one batch along the time axis of the recipe."""
    load_kernel(group.shape)
    step = 1 / (timeline.fs * group.steps)
    return integrate(group.shape, batch, step, group.steps, _filters(group.steps), timeline.dropped, timeline.returned)


def integrate_all(
    inputs: Sequence[KernelInput],
    steps: Sequence[int],
    timeline: Timeline,
    report: Callable[[int], None] = lambda _: None,
) -> Integrated:
    """Integrate records, each with its steps per sample; ``report`` is called with the number of records done after each batch."""
    groups = {place: group_of(given, steps[place]) for place, given in enumerate(inputs)}
    n_channels = len(inputs[0].pickups) if inputs else 0
    response = np.empty((len(inputs), n_channels, timeline.returned), np.float32)
    diverged, steepest = np.empty(len(inputs), np.int64), np.empty(len(inputs))
    done = 0
    for group, places in batches(groups):
        batch = lay_out([inputs[place] for place in places], group.shape, 1 / timeline.fs)
        made = integrate_batch(group, batch, timeline)
        response[places] = made.response.T[: len(places)]
        diverged[places], steepest[places] = made.diverged[: len(places)], made.steepest[: len(places)]
        done += len(places)
        report(done)
    return Integrated(response, diverged, steepest)
