"""Check of the step: some records of a corpus are integrated again at half the step, and the relative change is stored with them."""

import math
from collections.abc import Collection, Mapping

import numpy as np
from numpy.typing import NDArray

from gen.recipe import Recipe
from gen.scenarios import Scenario, first_records, settings_of
from gen.simulation.batches import Integration, group_of
from gen.simulation.simulate import Response, Run, acceleration_of
from gen.simulation.timeline import timeline

FloatArray = NDArray[np.float64]

CHECKED_PARTS, CHECKED_SHARE = 32, 0.01  # every 32nd part repeats 1 % of the records of 32 parts at half the step


def step_checks(scenarios: list[Scenario], recipe: Recipe, response: Response) -> dict[int, Run]:
    """Some records of a part at half their step, by place."""
    usable = {place: some for place, some in enumerate(response.inputs) if some and place not in response.failures}
    finer = {}
    for place in checked_places(scenarios, recipe, usable):
        given, steps = usable[place], 2 * int(response.oversampling[place])
        own = Integration(scenarios[place].record.number, given, group_of(given, steps))
        finer[place] = Run(response.motions[place], given, "", own, None)
    return finer


def step_changes(finer: Mapping[int, Run], response: Response, recipe: Recipe) -> FloatArray:
    """Relative rms change between records and the same at half the step, NaN for the other records, shape (record,)."""
    errors, kept = np.full(len(response.oversampling), np.nan), timeline(settings_of(recipe)).kept
    tried = list(finer)
    if tried:
        coarse, halved = response.acceleration[tried], np.stack([acceleration_of(one.own) for one in finer.values()])
        pair = coarse[..., kept] - halved[..., kept], halved[..., kept]
        change, whole = (np.sum(some**2, axis=(1, 2), dtype=np.float64) for some in pair)
        errors[tried] = np.sqrt(change / whole)
    return errors


def checked_places(scenarios: list[Scenario], recipe: Recipe, usable: Collection[int]) -> list[int]:
    """Places in a part of the records whose step is to be checked, of those that are ``usable``.

    These are the first record of each class, in the part where the first specimen of the class begins; and in every ``CHECKED_PARTS``-th
    part ``CHECKED_SHARE`` of the records of so many parts.
    """
    begun = {scenario.record.number for scenario in scenarios}
    new = {fault for fault, number in first_records(recipe).items() if number in begun}
    first: dict[str, int] = {}
    for place in usable:
        if scenarios[place].specimen.fault in new:
            first.setdefault(scenarios[place].specimen.fault, place)
    span = CHECKED_PARTS * recipe.storage.records_per_part
    done = scenarios[0].record.number
    wanted = CHECKED_SHARE * min(span, recipe.n_records - done) if done % span == 0 else 0
    every = [*dict.fromkeys([*first.values(), *usable])]
    return every[: max(len(first), math.ceil(wanted))]


def has_checks(recipe: Recipe, numbers: range) -> bool:
    """Whether the step of any of the records of a part may be checked, by :func:`checked_places`."""
    every = numbers.start % (CHECKED_PARTS * recipe.storage.records_per_part) == 0
    return every or any(number in numbers for number in first_records(recipe).values())
