"""Records drawn, simulated and measured. What becomes of a fault that cannot be seen is decided here.

A fault that no loaded ball meets is drawn again before anything is simulated. After the measurement, a record whose fault cannot be seen
gets other levels; if that does not help, its specimen gets another fault. Everything else of rig, specimen and record stays, so the
operating conditions of a class do not depend on what can be seen in them. All records of a specimen are judged together, also those of
another part, so that every part finds the same fault.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.measurement.lives import with_ends
from gen.measurement.measure import Measured, measure
from gen.recipe import Recipe
from gen.scenarios import Scenario, draw_scenarios, further_ratios, same_recording
from gen.simulation.batches import integrate_all
from gen.simulation.hits import felt_places
from gen.simulation.simulate import Response, Run, open_integrations, response_of, runs_of
from gen.simulation.timeline import timeline
from gen.support.errors import SimulationError

LEVEL_TRIES = 8  # draws of the level of a record whose fault cannot be seen
FAULT_TRIES = 12  # faults drawn for a specimen until one can be seen in all of its records


@dataclass(frozen=True)
class MadeRecords:
    """Records as they were made; ``measured.scenarios`` has their final scenarios."""

    response: Response
    measured: Measured


def make_records(recipe: Recipe, numbers: range) -> MadeRecords:
    """Make the records with the given numbers, in their order.

    Raises
    ------
    SimulationError
        If there are none, since every life has ended before them.
    """
    drawing, axis = Drawing(recipe), timeline(recipe)
    final: dict[int, tuple[MadeRecords, int]] = {}
    runs = drawing.first(numbers)
    while runs:
        integrate_all(open_integrations(runs), axis)
        made, runs = drawing.judge(runs)
        redrawn = {run.scenario.origin.record for run in runs}
        for place, scenario in enumerate(made.measured.scenarios):
            if scenario.origin.record in numbers and scenario.origin.record not in redrawn:
                final[scenario.origin.record] = made, place
    if not final:
        raise SimulationError(f"records {numbers.start}-{numbers.stop - 1}: every life has ended before them.")
    return _picked([final[number] for number in numbers if number in final])


def _picked(rows: list[tuple[MadeRecords, int]]) -> MadeRecords:
    """Records from some places of others."""
    response, measured = rows[0][0].response, rows[0][0].measured
    failures = {
        new: made.response.failures[place] for new, (made, place) in enumerate(rows) if place in made.response.failures
    }
    columns = [
        {name: _column([getattr(getattr(made, of), name)[place] for made, place in rows]) for name in _columns(one)}
        for of, one in (("response", response), ("measured", measured))
    ]
    return MadeRecords(replace(response, failures=failures, **columns[0]), replace(measured, **columns[1]))


def _column(rows: list[Any]) -> NDArray[Any] | list[Any]:
    return np.stack(rows) if isinstance(rows[0], np.ndarray | np.generic) else rows


def _columns(of: Response | Measured) -> list[str]:
    """Fields that have one row for each record."""
    return [field.name for field in fields(of) if field.name not in ("failures", "twins", "counts_per_unit")]


class Drawing:
    """Records of whole specimens or groups: drawn, and judged once they are integrated."""

    def __init__(self, recipe: Recipe) -> None:
        self.recipe = recipe
        self._redraws = recipe.truth.undetected == "redraw" and recipe.truth.twins
        self._tries: dict[int, int] = {}

    def first(self, numbers: range) -> list[Run]:
        """Records with the given numbers, and all that are judged together with them, with their first fault."""
        corpus, whole = self.recipe.corpus, self._redraws or self.recipe.life is not None
        size = corpus.records_of_a_specimen if whole else corpus.n_rungs
        stop = min(-(-numbers.stop // size) * size, self.recipe.n_records)
        scenarios = draw_scenarios(self.recipe, numbers.start // size * size, stop)
        return runs_of(self._with_hits(scenarios)) if scenarios else []

    def judge(self, runs: list[Run]) -> tuple[MadeRecords, list[Run]]:
        """Records of integrated runs, and the runs of specimens whose fault is drawn again."""
        made = made_of(runs, self._further_ratios([run.scenario for run in runs]))
        if self.recipe.life is not None:
            measured, behind = with_ends(made.measured, self.recipe.life.end)
            made = replace(made, measured=measured)
            made.response.failures.update(dict.fromkeys(behind, ""))
        if not self._redraws:
            return made, []
        unseen = _unseen_places(made)
        specimens = dict.fromkeys(made.measured.scenarios[place].origin.specimen for place in unseen)
        again = sorted(number for number in specimens if self._tries.get(number, 0) < FAULT_TRIES - 1)
        advice = "raise level.faulty_db" if self.recipe.level.kind == "snr" else "lower level.background_m_s2"
        for place in unseen:
            scenario = made.measured.scenarios[place]
            if scenario.origin.specimen not in again:
                made.response.failures[place] = (
                    f"record {scenario.origin.record}: none of {FAULT_TRIES} drawn faults of class {scenario.fault} can be seen "
                    f"in it; {advice}, or choose truth.undetected: keep."
                )
        if not again:
            return made, []
        known = {
            run.scenario.origin.record: run for place, run in enumerate(runs) if place not in made.response.failures
        }
        return made, runs_of(self._with_hits(self._redrawn(again)), known)

    def _further_ratios(self, scenarios: list[Scenario]) -> dict[int, list[float]]:
        """Ratios of the further tries of the level of records with a fault, by their place."""
        if not (self._redraws and self.recipe.level.kind == "snr"):
            return {}
        return {
            place: further_ratios(self.recipe, scenarios[place], LEVEL_TRIES - 1)
            for place in _largest_places(scenarios)
        }

    def _redrawn(self, specimens: Iterable[int]) -> list[Scenario]:
        """Scenarios of all records of some specimens with their next fault."""
        redrawn = []
        for number in specimens:
            self._tries[number] = self._tries.get(number, 0) + 1
            records = self.recipe.records_of(number)
            redrawn += draw_scenarios(self.recipe, records.start, records.stop, fault_tries=self._tries)
        return redrawn

    def _with_hits(self, scenarios: list[Scenario]) -> list[Scenario]:
        """Scenarios of whole specimens, those with another fault whose spalls no loaded ball meets in some record.

        Of a group, the largest severity alone counts, as in :func:`_unseen_places`.
        """
        by_number = {scenario.origin.record: scenario for scenario in scenarios}
        tried = scenarios if self._redraws else []
        while tried:
            largest = [tried[place] for place in _largest_places(tried)]
            missed = {
                one.origin.specimen for one, is_felt in zip(largest, felt_places(largest), strict=True) if not is_felt
            }
            tried = self._redrawn(sorted(n for n in missed if self._tries.get(n, 0) < FAULT_TRIES - 1))
            by_number.update({scenario.origin.record: scenario for scenario in tried})
        return list(by_number.values())


def made_from(scenarios: list[Scenario]) -> MadeRecords:
    """Records of scenarios as they are; nothing is drawn again."""
    runs = runs_of(scenarios)
    integrate_all(open_integrations(runs), timeline(same_recording(scenarios)))
    return made_of(runs)


def made_of(runs: list[Run], ratios: Mapping[int, Sequence[float]] = {}) -> MadeRecords:
    """Records of scenarios that have been integrated; ``ratios`` as for :func:`gen.measurement.measure.measure`."""
    response, scenarios = response_of(runs), [run.scenario for run in runs]
    measured = measure(response.acceleration, scenarios, response.twins, motions=response.motions, ratios=ratios)
    return MadeRecords(replace(response, twins=[]), measured)


def _unseen_places(made: MadeRecords) -> list[int]:
    """Places of the records that were made and whose fault cannot be seen; of a group, that of the largest severity alone is looked at."""
    detectable, failures = made.measured.detectable, made.response.failures
    largest = _largest_places(made.measured.scenarios)
    return [place for place in largest if not detectable[place] and place not in failures]


def _largest_places(scenarios: list[Scenario]) -> list[int]:
    """Places of the records with a fault; of a group, that of the largest severity alone."""
    return [
        place
        for place, scenario in enumerate(scenarios)
        if scenario.fault != "healthy"
        and (place + 1 == len(scenarios) or scenarios[place + 1].origin.rung <= scenario.origin.rung)
    ]
