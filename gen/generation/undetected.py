"""Records drawn, simulated and measured. What becomes of a fault that cannot be seen is decided here.

A fault that no loaded ball meets is drawn again before anything is simulated. After the measurement, a record whose fault cannot be seen
gets other levels; if that does not help, its specimen gets another fault. Everything else of rig, specimen and record stays, so the
operating conditions of a class do not depend on what can be seen in them. All records of a specimen are judged together, also those of
another part, so that every part finds the same fault.
"""

from collections.abc import Iterable, Mapping, Sequence

from gen.measurement.lives import with_ends
from gen.measurement.measure import Measured, measure
from gen.recipe import Recipe
from gen.scenarios import Scenario, draw_scenarios, further_ratios
from gen.simulation.hits import felt_places
from gen.simulation.simulate import Run, integrate_runs, runs_of, simulate
from gen.support.errors import SimulationError

LEVEL_TRIES = 8  # draws of the level of a record whose fault cannot be seen
FAULT_TRIES = 12  # faults drawn for a specimen until one can be seen in all of its records

Made = Measured | str
"""A record, or a sentence that says why it is left out; empty for one behind the end of a life."""


def make_records(recipe: Recipe, numbers: range) -> list[Made]:
    """Make the records with the given numbers, in their order; a life that has ended has no further records.

    Raises
    ------
    SimulationError
        If there are none, since every life has ended before them.
    """
    drawing, final = Drawing(recipe), dict[int, Made]()
    runs = drawing.first(numbers)
    while runs:
        integrate_runs(runs)
        records, again = drawing.judge(runs)
        for run, record in zip(runs, records, strict=True):
            if run.scenario.origin.record in numbers:
                final[run.scenario.origin.record] = record
        runs = again  # whose records replace those with the fault before
    if not final:
        raise SimulationError(f"records {numbers.start}-{numbers.stop - 1}: every life has ended before them.")
    return [final[number] for number in numbers if number in final]


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

    def judge(self, runs: list[Run]) -> tuple[list[Made], list[Run]]:
        """Records of integrated runs, and the runs of specimens whose fault is drawn again."""
        scenarios, snr = [run.scenario for run in runs], self.recipe.level.kind == "snr"
        largest, ratios = _largest_places(scenarios), dict[int, Sequence[float]]()
        if self._redraws and snr:  # further tries of the level of records with a fault
            faulty = [scenarios[place] for place in largest]
            ratios = {one.origin.record: further_ratios(self.recipe, one, LEVEL_TRIES - 1) for one in faulty}
        records = made_of(runs, ratios)
        if self.recipe.life is not None:
            records = with_ends(runs, records, self.recipe.life.end)
        if not self._redraws:
            return records, []
        judged = [(place, record) for place in largest if isinstance(record := records[place], Measured)]
        unseen = [place for place, record in judged if not record.detectable]
        specimens = {scenarios[place].origin.specimen for place in unseen}
        again = sorted(number for number in specimens if self._tries.get(number, 0) < FAULT_TRIES - 1)
        for place in unseen:
            scenario = scenarios[place]
            if scenario.origin.specimen not in again:
                records[place] = (
                    f"record {scenario.origin.record}: none of {FAULT_TRIES} drawn faults of class {scenario.fault} can be seen in it; "
                    f"{'raise level.faulty_db' if snr else 'lower level.background_m_s2'}, or choose truth.undetected: keep."
                )
        if not again:
            return records, []
        usable = (run for run, record in zip(runs, records, strict=True) if isinstance(record, Measured))
        known = {run.scenario.origin.record: run for run in usable}
        return records, runs_of(self._with_hits(self._redrawn(again)), known)

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

        Of a group, the largest severity alone counts, as in :meth:`judge`.
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


def made_from(scenarios: list[Scenario]) -> list[Made]:
    """Records of scenarios as they are; nothing is drawn again."""
    return made_of(simulate(scenarios))


def made_of(runs: list[Run], ratios: Mapping[int, Sequence[float]] = {}) -> list[Made]:
    """Records of scenarios that have been integrated; ``ratios`` as for :func:`gen.measurement.measure.measure`."""
    failures = [run.failure for run in runs]
    measured = iter(measure([run for run, failure in zip(runs, failures, strict=True) if failure is None], ratios))
    return [next(measured) if failure is None else failure for failure in failures]


def _largest_places(scenarios: list[Scenario]) -> list[int]:
    """Places of the records with a fault; of a group, that of the largest severity alone."""
    return [
        place
        for place, scenario in enumerate(scenarios)
        if scenario.fault != "healthy"
        and (place + 1 == len(scenarios) or scenarios[place + 1].origin.rung <= scenario.origin.rung)
    ]
