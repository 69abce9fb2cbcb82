"""Records grouped by shape and step, and integrated in lanes, ``LANES`` at a time.

A record does not depend on the others in its batch.
"""

import functools
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
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
    """Records of one group share their shape and their step, so they may share batches."""

    shape: Shape
    steps: int
    """Steps per sample."""


@dataclass(slots=True, eq=False)
class Integration:
    """One record that is integrated, with or without its fault, and the result."""

    given: KernelInput
    group: Group
    response: NDArray[np.float32] | None = None
    """Shape (channel, time) [m s-2, or m]; None until it is integrated."""
    diverged: int = -1
    """Knot at which the record left the finite range, -1 if never."""
    steepest: float = 0.0
    """Largest contact stiffness [N/m]."""


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


def integrate_batch(group: Group, batch: Batch, timeline: Timeline) -> Integral:
    """Integrate one batch along the time axis of the recipe."""
    load_kernel()
    step = 1 / (timeline.fs * group.steps)
    return integrate(group.shape, batch, step, group.steps, _filters(group.steps), timeline.dropped, timeline.returned)


def integrate_all(integrations: Sequence[Integration], timeline: Timeline) -> None:
    """Integrate records, batch by batch."""
    for _, places in batches({place: one.group for place, one in enumerate(integrations)}):
        integrate_together([integrations[place] for place in places], timeline)


def integrate_together(integrations: Sequence[Integration], timeline: Timeline) -> None:
    """Integrate records of one group in one batch."""
    group = integrations[0].group
    batch = lay_out([one.given for one in integrations], group.shape, 1 / timeline.fs)
    made = integrate_batch(group, batch, timeline)
    for lane, one in enumerate(integrations):
        one.response = made.response[:, :, lane].copy()
        one.diverged, one.steepest = int(made.diverged[lane]), float(made.steepest[lane])
