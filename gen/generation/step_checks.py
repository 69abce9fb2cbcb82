"""Check of the step: some records of a corpus are integrated again at half the step, and the relative change is stored with them."""

from collections.abc import Hashable, Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from gen.measurement.measure import Measured
from gen.physics.kernel.compiling import LANES
from gen.recipe import Recipe
from gen.scenarios import first_records
from gen.simulation.batches import Integration, integrate_all
from gen.simulation.simulate import acceleration_of
from gen.simulation.timeline import timeline

CHECKED_PARTS = 8  # every 8th part integrates a batch of its records again: 1 to 2 % of the time of a part


def step_errors(recipe: Recipe, numbers: range, records: Sequence[Measured]) -> NDArray[np.float64]:
    """Relative rms change between some records of a part and the same at half the step, NaN for the other records, shape (record,)."""
    axis, runs = timeline(recipe), [record.run for record in records]
    groups, faults = [run.integrations[0].group for run in runs], [record.scenario.fault for record in records]
    # all together, so that they fill the lanes of the kernel
    halved = {
        place: Integration(runs[place].kernel_input, 2 * runs[place].oversampling)
        for place in checked_places(recipe, numbers, faults, groups)
    }
    integrate_all(halved.values(), axis)
    errors = np.full(len(records), np.nan)
    for place, integration in halved.items():
        fine = acceleration_of(integration)[:, axis.kept]
        # of the bodies, before paths and background hide it
        change = runs[place].acceleration[:, axis.kept] - fine
        errors[place] = np.sqrt(np.sum(change**2, dtype=np.float64) / np.sum(fine**2, dtype=np.float64))
    return errors


def checked_places(recipe: Recipe, numbers: range, faults: Sequence[str], groups: Sequence[Hashable]) -> Iterable[int]:
    """Places of the records of a part whose step is checked, given their faults and groups.

    These are the first record of each class, in the part where the first specimen of the class begins; and in every ``CHECKED_PARTS``-th
    part the first records that share their kernel and step, as many as a batch has lanes. They do not depend on the number of records of
    the corpus.
    """
    begun = [fault for fault, number in first_records(recipe).items() if number in numbers]
    chosen = [faults.index(fault) for fault in begun if fault in faults]
    if groups and numbers.start % (CHECKED_PARTS * recipe.storage.records_per_part) == 0:
        chosen += [place for place, group in enumerate(groups) if group == groups[0]][:LANES]
    return dict.fromkeys(chosen)
