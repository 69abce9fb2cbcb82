"""Records grouped by kernel shape and step, and integrated in lanes, ``LANES`` at a time.

A record does not depend on the others in its batch.
"""

import functools
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from typing import Any, Generic, NamedTuple, TypeVar

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

Owner = TypeVar("Owner")
_Members = list[tuple[int, int, "Integration", Owner]]


class Group(NamedTuple):
    """Records of one group share their compiled kernel and their step, so they may share batches."""

    shape: Shape
    steps: int
    """Steps per sample."""


@dataclass(slots=True, eq=False)
class Integration:
    """One record that is integrated, with or without its fault, and the result."""

    number: int
    """Of the record."""
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
    load_kernel(group.shape)
    step = 1 / (timeline.fs * group.steps)
    return integrate(group.shape, batch, step, group.steps, _filters(group.steps), timeline.dropped, timeline.returned)


class Waiting(Generic[Owner]):
    """Integrations that wait until their batch is full, each with its owner."""

    def __init__(self) -> None:
        self._groups: dict[Group, _Members[Owner]] = defaultdict(list)
        self._added = 0

    def __bool__(self) -> bool:
        return any(self._groups.values())

    def add(self, integrations: Iterable[Integration], owner: Owner) -> None:
        """Let integrations wait. In their group, those of a record with a lower number come first."""
        for one in integrations:
            self._added += 1
            heappush(self._groups[one.group], (one.number, self._added, one, owner))

    def has_full_batch(self) -> bool:
        """Whether a group has a record for every lane."""
        return any(len(members) >= LANES for members in self._groups.values())

    def fullest(self) -> list[tuple[Integration, Owner]]:
        """Take the batch with the most records, of several full ones that of the lowest record number."""
        return self._take(lambda members: (-min(len(members), LANES), members[0][:2]))

    def oldest(self) -> list[tuple[Integration, Owner]]:
        """Take the batch of the lowest record number."""
        return self._take(lambda members: members[0][:2])

    def _take(self, order: Callable[[_Members[Owner]], Any]) -> list[tuple[Integration, Owner]]:
        members = min((members for members in self._groups.values() if members), key=order)
        return [heappop(members)[2:] for _ in range(min(LANES, len(members)))]


def integrate_all(integrations: Iterable[Integration], timeline: Timeline) -> None:
    """Integrate records, batch by batch."""
    waiting: Waiting[None] = Waiting()
    waiting.add(integrations, None)
    while waiting:
        integrate_together([one for one, _ in waiting.fullest()], timeline)


def integrate_together(integrations: Sequence[Integration], timeline: Timeline) -> None:
    """Integrate records of one group in one batch."""
    group = integrations[0].group
    batch = lay_out([one.given for one in integrations], group.shape, 1 / timeline.fs)
    made = integrate_batch(group, batch, timeline)
    for lane, one in enumerate(integrations):
        one.response = made.response[:, :, lane].T.copy()
        one.diverged, one.steepest = int(made.diverged[lane]), float(made.steepest[lane])
