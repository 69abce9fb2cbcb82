"""Records drawn, simulated and measured. What becomes of a fault that cannot be seen is decided here.

A fault that no loaded ball meets is drawn again before anything is simulated. After the measurement, a record whose fault cannot be seen
gets other levels; if that does not help, its specimen gets another fault. Everything else of rig, specimen and record stays, so the
operating conditions of a class do not depend on what can be seen in them. All records of a specimen are judged together, also those of
another part, so that every part finds the same fault.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.measurement.lives import with_ends
from gen.measurement.measure import Measured, measure
from gen.recipe import Recipe
from gen.scenarios import Scenario, common_settings, draw_scenarios, simulation_errors, with_level
from gen.simulation.batches import integrate_all
from gen.simulation.hits import felt_places
from gen.simulation.simulate import Response, Run, open_integrations, response_of, runs_of
from gen.simulation.timeline import timeline

LEVEL_TRIES = 8  # draws of the level of a record whose fault cannot be seen
FAULT_TRIES = 12  # faults drawn for a specimen until one can be seen in all of its records


@dataclass(frozen=True)
class MadeRecords:
    """Records as they were made; ``measured.scenarios`` has their final scenarios."""

    response: Response
    measured: Measured


Family = list[Run]
"""Records that are judged together."""


class Families:
    """The families of a recipe: drawn, and judged once they are integrated."""

    def __init__(self, recipe: Recipe) -> None:
        self.recipe = recipe
        self._redraws = recipe.truth.undetected == "redraw" and recipe.truth.twins
        self._whole = self._redraws or recipe.life is not None
        # all records of a specimen are judged together, and those of a group have one level
        self.size = recipe.corpus.records_of_a_specimen if self._whole else recipe.corpus.n_rungs
        self._tries: dict[int, int] = {}

    def numbers(self, of: range) -> range:
        """Numbers of the records of all families that some records belong to."""
        size = self.size
        return range(of.start // size * size, min(-(-of.stop // size) * size, self.recipe.n_records))

    def draw(self, numbers: range) -> list[Family]:
        """Families with the given numbers of records, which are those of whole families."""
        scenarios = draw_scenarios(self.recipe, numbers.start, numbers.stop)
        return self._cut(self._with_hits(scenarios) if self._redraws else scenarios, {})

    def judge(self, families: list[Family]) -> tuple[MadeRecords, list[Family]]:
        """Records of integrated families, and the families again whose fault is drawn again."""
        every = [run for family in families for run in family]
        made = made_of(every, self._other_levels)
        if self.recipe.life is not None:
            measured, behind = with_ends(made.measured, self.recipe.life.end)
            made = replace(made, measured=measured)
            made.response.failures.update(dict.fromkeys(behind, ""))
        if not self._redraws:
            return made, []
        unseen = _unseen_places(made)
        specimens = dict.fromkeys(made.measured.scenarios[place].specimen.number for place in unseen)
        again = sorted(number for number in specimens if self._tries.get(number, 0) < FAULT_TRIES - 1)
        known = {
            run.scenario.record.number: run for place, run in enumerate(every) if place not in made.response.failures
        }
        advice = "raise level.faulty_db" if self.recipe.level.kind == "snr" else "lower level.background_m_s2"
        for place in unseen:
            scenario = made.measured.scenarios[place]
            if scenario.specimen.number not in again:
                made.response.failures[place] = (
                    f"record {scenario.record.number}: none of {FAULT_TRIES} drawn faults of class {scenario.specimen.fault} can be seen "
                    f"in it; {advice}, or choose truth.undetected: keep."
                )
        return made, self._cut(self._with_hits(self._redrawn(again)), known)

    def _other_levels(self, scenario: Scenario) -> Iterator[Scenario]:
        """The same record with its further levels, one after the other."""
        tries = LEVEL_TRIES if self._redraws and self.recipe.level.kind == "snr" else 1
        return (with_level(scenario, self.recipe, level_try) for level_try in range(1, tries))

    def _cut(self, scenarios: list[Scenario], known: Mapping[int, Run]) -> list[Family]:
        """Families of scenarios; ``known`` as for `runs_of`."""
        families: dict[tuple[int, int], Family] = {}
        for scenario, run in zip(scenarios, runs_of(scenarios, known) if scenarios else [], strict=True):
            group = 0 if self._whole else scenario.record.number // self.size
            families.setdefault((scenario.specimen.number, group), []).append(run)
        return list(families.values())

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
        by_number = {scenario.record.number: scenario for scenario in scenarios}
        tried = scenarios
        while tried:
            largest = [tried[place] for place in _largest_places(tried)]
            missed = {
                one.specimen.number for one, is_felt in zip(largest, felt_places(largest), strict=True) if not is_felt
            }
            tried = self._redrawn(sorted(n for n in missed if self._tries.get(n, 0) < FAULT_TRIES - 1))
            by_number.update({scenario.record.number: scenario for scenario in tried})
        return list(by_number.values())


def made_from(scenarios: list[Scenario]) -> MadeRecords:
    """Records of scenarios as they are; nothing is drawn again."""
    with simulation_errors():
        runs = runs_of(scenarios)
        integrate_all(open_integrations(runs), timeline(common_settings(scenarios)))
        return made_of(runs)


def made_of(runs: list[Run], other_levels: Callable[[Scenario], Iterable[Scenario]] = lambda _: ()) -> MadeRecords:
    """Records of scenarios that have been integrated; ``other_levels`` as for :func:`gen.measurement.measure.measure`."""
    response, scenarios = response_of(runs), [run.scenario for run in runs]
    options = {"motions": response.motions, "other_levels": other_levels}
    return MadeRecords(response, measure(response.acceleration, scenarios, response.twins, **options))


def pick(rows: list[tuple[MadeRecords, int]]) -> MadeRecords:
    """Records from some places of others, without their twins."""
    response, measured = rows[0][0].response, rows[0][0].measured
    failures = {
        new: made.response.failures[place] for new, (made, place) in enumerate(rows) if place in made.response.failures
    }
    columns = [
        {name: _column([getattr(getattr(made, of), name)[place] for made, place in rows]) for name in _columns(one)}
        for of, one in (("response", response), ("measured", measured))
    ]
    return MadeRecords(replace(response, failures=failures, twins=[], **columns[0]), replace(measured, **columns[1]))


def _column(rows: list[Any]) -> NDArray[Any] | list[Any]:
    return np.stack(rows) if isinstance(rows[0], np.ndarray | np.generic) else rows


def _columns(of: Response | Measured) -> list[str]:
    """Fields that have one row for each record."""
    return [field.name for field in fields(of) if field.name not in ("failures", "twins", "counts_per_unit")]


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
        if scenario.specimen.fault != "healthy"
        and (place + 1 == len(scenarios) or scenarios[place + 1].record.rung <= scenario.record.rung)
    ]
