"""Records grouped by shape and step, and integrated in lanes, ``LANES`` at a time.

A record does not depend on the others in its batch.
"""

import functools
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gen.physics.kernel.batch import input_shape, lay_out
from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.decimate import decimation
from gen.physics.kernel.integrate import Integral, integrate
from gen.physics.kernel.layout import Batch, Shape
from gen.physics.kernel_input import KernelInput
from gen.simulation.compiled_kernel import load_kernel
from gen.simulation.timeline import Timeline


@dataclass(slots=True, eq=False)
class Integration:
    """One record that is integrated, with or without its fault, and the result."""

    kernel_input: KernelInput
    steps: int
    """Per sample."""
    response: NDArray[np.float32] | None = None
    """Shape (channel, time) [m s-2, or m]; None until it is integrated."""
    diverged: int = -1
    """Knot at which the record left the finite range, -1 if never."""
    steepest: float = 0.0
    """Largest contact stiffness [N/m]."""

    @property
    def group(self) -> tuple[Shape, int]:
        """Shape and steps per sample: records that have the same may share batches."""
        return input_shape(self.kernel_input), self.steps


_filters = functools.lru_cache(maxsize=16)(decimation)


def batches(integrations: Iterable[Integration]) -> list[list[Integration]]:
    """Records of one group each, at most ``LANES`` of them."""
    groups = defaultdict[tuple[Shape, int], list[Integration]](list)
    for integration in integrations:
        groups[integration.group].append(integration)
    return [group[first : first + LANES] for group in groups.values() for first in range(0, len(group), LANES)]


def integrate_batch(shape: Shape, steps: int, batch: Batch, axis: Timeline) -> Integral:
    """Integrate one batch along the time axis of the recipe."""
    load_kernel()
    return integrate(shape, batch, 1 / (axis.fs * steps), steps, _filters(steps), axis.dropped, axis.returned)


def integrate_all(integrations: Iterable[Integration], axis: Timeline) -> None:
    """Integrate records, batch by batch."""
    for records in batches(integrations):
        shape, steps = records[0].group
        batch = lay_out([record.kernel_input for record in records], shape, 1 / axis.fs)
        result = integrate_batch(shape, steps, batch, axis)
        for lane, record in enumerate(records):
            record.response = result.response[:, :, lane].copy()
            record.diverged, record.steepest = int(result.diverged[lane]), float(result.steepest[lane])
