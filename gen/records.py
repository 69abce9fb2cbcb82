"""Records drawn, simulated and measured. What becomes of a fault that cannot be seen is decided here.

A fault that no loaded ball meets is drawn again before anything is simulated. After the measurement, a record whose fault cannot be seen
gets other levels; if that does not help, its specimen gets another fault. Everything else of rig, specimen and record stays, so the
operating conditions of a class do not depend on what can be seen in them. All records of a specimen are judged together, also those of
another part, so that every part finds the same fault.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from gen.measurement.measure import LEVEL_TRIES, Measured, measure
from gen.recipe import Recipe
from gen.scenarios import Scenario, draw_scenarios, with_level
from gen.simulation.hits import felt_places
from gen.simulation.simulate import Response, simulate

FAULT_TRIES = 12  # faults drawn for a specimen until one can be seen in all of its records


@dataclass(frozen=True)
class Records:
    """Records as they were made; ``measured.scenarios`` has their final scenarios."""

    response: Response
    measured: Measured


def made_records(recipe: Recipe, numbers: range, report: Callable[[int], None] = lambda _: None) -> Records:
    """Make the records with the given numbers; ``report`` is called with the number of simulated records."""
    redraws = recipe.corpus.undetected == "redraw" and recipe.corpus.truth == "full"
    # all records of a specimen are judged together, and those of a group have one level
    unit = recipe.corpus.records_of_a_specimen if redraws else recipe.corpus.n_rungs
    whole = range(numbers.start // unit * unit, min(-(-numbers.stop // unit) * unit, recipe.n_records))
    if not redraws:
        made = _made(draw_scenarios(recipe, whole.start, whole.stop), recipe, 1, report)
        return _rows(made, range(numbers.start - whole.start, numbers.stop - whole.start))
    tries: dict[int, int] = {}
    scenarios = _with_hits(draw_scenarios(recipe, whole.start, whole.stop), recipe, tries)
    made = _made(scenarios, recipe, LEVEL_TRIES, report)
    again = _unseen(made, tries)
    while again:
        redrawn = _with_hits(_redrawn(again, recipe, tries), recipe, tries)
        places = [scenario.record.number - whole.start for scenario in redrawn]
        _replace(made, _made(redrawn, recipe, LEVEL_TRIES, known_twins=_twins_at(made, places)), places)
        again = _unseen(made, tries)
    advice = "raise level.faulty_db" if recipe.level.kind == "snr" else "lower level.background_m_s2"
    for place in _unseen_places(made):
        scenario = made.measured.scenarios[place]
        made.response.failures[place] = (
            f"record {scenario.record.number}: none of {FAULT_TRIES} drawn faults of class {scenario.specimen.fault} can be seen in it; "
            f"{advice}, or choose corpus.undetected: keep."
        )
    return _rows(made, range(numbers.start - whole.start, numbers.stop - whole.start))


def made_again(recipe: Recipe, number: int, fault_try: int, level_try: int) -> Records:
    """Make one record again, with the fault and the level that were taken when it was made first."""
    n_rungs = recipe.corpus.n_rungs
    first, tries = number // n_rungs * n_rungs, {number // recipe.corpus.records_of_a_specimen: fault_try}
    group = draw_scenarios(recipe, first, first + n_rungs, fault_tries=tries)
    made = _made([with_level(scenario, recipe, level_try) for scenario in group], recipe, 1)
    return _rows(made, range(number - first, number - first + 1))


def _made(
    scenarios: list[Scenario],
    recipe: Recipe,
    level_tries: int,
    report: Callable[[int], None] = lambda _: None,
    known_twins: Mapping[int, NDArray[np.float32]] | None = None,
) -> Records:
    response = simulate(scenarios, recipe, report=report, known_twins=known_twins)
    measured = measure(response.acceleration, scenarios, recipe, response.twins, level_tries=level_tries)
    return Records(response, measured)


def _twins_at(made: Records, places: list[int]) -> dict[int, NDArray[np.float32]]:
    """Accelerations without the fault at some places, by rank: another fault does not change them."""
    twins = made.response.twins
    if twins is None:
        return {}
    return {rank: twins.acceleration[place] for rank, place in enumerate(places) if place not in made.response.failures}


def _redrawn(specimens: Iterable[int], recipe: Recipe, tries: dict[int, int]) -> list[Scenario]:
    """Scenarios of all records of some specimens with their next fault, which ``tries`` counts."""
    per, found = recipe.corpus.records_of_a_specimen, []
    for number in specimens:
        tries[number] = tries.get(number, 0) + 1
        found += draw_scenarios(recipe, number * per, (number + 1) * per, fault_tries=tries)
    return found


def _with_hits(scenarios: list[Scenario], recipe: Recipe, tries: dict[int, int]) -> list[Scenario]:
    """Scenarios of whole specimens, those with another fault whose spalls no loaded ball meets in some record.

    Of a group, the largest severity alone counts, as in :func:`_unseen_places`.
    """
    found = {scenario.record.number: scenario for scenario in scenarios}
    tried = scenarios
    while tried:
        largest = [tried[place] for place in _largest_places(tried)]
        missed = {
            one.specimen.number for one, is_felt in zip(largest, felt_places(largest), strict=True) if not is_felt
        }
        tried = _redrawn(sorted(n for n in missed if tries.get(n, 0) < FAULT_TRIES - 1), recipe, tries)
        found.update({scenario.record.number: scenario for scenario in tried})
    return list(found.values())


def _unseen(made: Records, tries: dict[int, int]) -> list[int]:
    """Numbers of the specimens that have a record whose fault cannot be seen, and may have another fault."""
    unseen = {made.measured.scenarios[place].specimen.number for place in _unseen_places(made)}
    return sorted(number for number in unseen if tries.get(number, 0) < FAULT_TRIES - 1)


def _unseen_places(made: Records) -> list[int]:
    """Places of the records that were made and whose fault cannot be seen; of a group, that of the largest severity alone is looked at."""
    detectable, failures = made.measured.detectable, made.response.failures
    largest = _largest_places(made.measured.scenarios)
    return [place for place in largest if not detectable[place] and place not in failures]


def _largest_places(scenarios: list[Scenario]) -> list[int]:
    """Places of the records with a fault; of a group, that of the largest severity alone."""
    return [
        place
        for place, scenario in enumerate(scenarios)
        if scenario.specimen.fault != "healthy"
        and (place + 1 == len(scenarios) or scenarios[place + 1].record.rung <= scenario.record.rung)
    ]


def _replace(made: Records, by: Records, places: list[int]) -> None:
    """Replace the records at some places, in place."""
    for new, place in enumerate(places):
        made.response.failures.pop(place, None)
        if new in by.response.failures:
            made.response.failures[place] = by.response.failures[new]
    for old, new in ((made.response, by.response), (made.measured, by.measured)):
        for name in _columns(old):
            for row, place in enumerate(places):
                getattr(old, name)[place] = getattr(new, name)[row]


def _rows(made: Records, places: range) -> Records:
    """The records at some places alone."""
    response, measured = made.response, made.measured
    if len(places) == len(measured.scenarios):
        return made
    failures = {place - places.start: said for place, said in response.failures.items() if place in places}
    some = slice(places.start, places.stop)
    rows = [{name: getattr(old, name)[some] for name in _columns(old)} for old in (response, measured)]
    return Records(replace(response, failures=failures, **rows[0]), replace(measured, **rows[1]))


def _columns(of: Response | Measured) -> list[str]:
    """Fields that have one row for each record."""
    return [field.name for field in fields(of) if field.name not in ("failures", "twins", "counts_per_unit")]
