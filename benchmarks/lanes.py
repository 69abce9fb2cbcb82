"""Share of the kernel's lanes that work on a record, over all batches of a corpus, with the steps of a batch as its weight.

The corpus is generated in this process, and every call of the kernel is counted: repeats at half the step and redrawn faults too.
"""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

from benchmarks.pairs import Line, row
from gen.generation.corpus import generate
from gen.physics.kernel import integrate
from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.layout import Batch

RECIPES = ("domain_randomised", "quickstart")
Count = tuple[int, int]


def rows(recipes: tuple[Path | str, ...] = RECIPES) -> Iterator[Line]:
    """Lines of the table."""
    for recipe in recipes:
        counts: list[Count] = []
        with tempfile.TemporaryDirectory() as folder, counted(counts):
            made = generate(recipe, Path(folder) / "corpus")
        what = f"lanes at work, all {made.records:,} records of {Path(recipe).stem}"
        yield row(f"lanes {Path(recipe).stem}", what, "of the lanes", [share(counts)], "every lane", [1.0])


def share(counts: list[Count]) -> float:
    """Share of the lanes that work, of batches with so many records and steps each.

    >>> share([(LANES, 1), (LANES // 2, 3)])
    0.625
    """
    return sum(records * steps for records, steps in counts) / (LANES * sum(steps for _, steps in counts))


def records_in(batch: Batch) -> int:
    """Number of different records in a batch; idle lanes repeat its first record."""
    arrays = (batch.state, batch.params, batch.angles, batch.spalls, batch.phasors, batch.waves)
    columns = np.concatenate([np.ascontiguousarray(array).reshape(-1, LANES) for array in arrays])
    columns = np.nan_to_num(columns)  # rows that the kernel itself computes are not set yet
    return 1 + int(np.any(columns[:, 1:] != columns[:, :1], axis=0).sum())


@contextmanager
def counted(counts: list[Count]) -> Iterator[None]:
    """Append the records and steps per sample of every batch that the kernel integrates in this process to ``counts``."""
    kernel = integrate.integrate_lanes

    def counting(shape: Any, batch: Batch, dt: float, n_steps: int, *given: Any) -> Any:
        counts.append((records_in(batch), n_steps))
        return kernel(shape, batch, dt, n_steps, *given)

    with mock.patch.object(integrate, "integrate_lanes", counting):
        yield
