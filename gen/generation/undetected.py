"""Records drawn, simulated and measured. What becomes of a fault that cannot be seen is decided here.

A fault that no loaded ball meets is drawn again before anything is simulated. After the measurement, a record whose fault cannot be seen
gets other levels; if that does not help, its specimen gets another fault. Everything else of rig, specimen and record stays, so the
operating conditions of a class do not depend on what can be seen in them. All records of a specimen are judged together, also those of
another part, so that every part finds the same fault.
"""

from collections.abc import Iterable, Mapping, Sequence

from gen.measurement.ends_of_life import with_ends
from gen.measurement.measure import Measured, measure
from gen.recipe import Recipe
from gen.scenarios import Scenario, draw_scenarios, further_ratios
from gen.simulation.hits import felt_places
from gen.simulation.simulate import Run, integrate_runs, runs_of, simulate

LEVEL_TRIES = 8  # draws of the level of a record whose fault cannot be seen
FAULT_TRIES = 12  # faults drawn for a specimen until one can be seen in all of its records

Made = Measured | str
"""A record, or a sentence that says why it is left out; empty for one behind the end of a life."""


def make_records(recipe: Recipe, numbers: range) -> list[Made]:
    """Make the records with the given numbers, in their order; a life that has ended has no further records."""
    corpus, redraws = recipe.corpus, recipe.truth.undetected == "redraw" and recipe.truth.twins
    # all records of a specimen are judged together, those of a group share a level
    size = corpus.records_of_a_specimen if redraws or recipe.life is not None else corpus.n_rungs
    stop = -(-numbers.stop // size) * size
    # the last specimen is judged whole, though the corpus may end within it: it can grow
    recipe = recipe.model_copy(update={"records": max(stop, recipe.n_records)})
    scenarios = draw_scenarios(recipe, numbers.start // size * size, stop)
    final, integrated = dict[int, Made](), dict[int, Run]()
    while scenarios:
        runs = runs_of(_with_hits(recipe, scenarios) if redraws else scenarios, integrated)
        integrate_runs(runs)
        records = made_of(runs, _further_ratios(recipe, runs) if redraws else {})
        if recipe.life is not None:
            records = with_ends(runs, records, recipe.life.end)
        usable = (run for run, record in zip(runs, records, strict=True) if isinstance(record, Measured))
        integrated = {run.scenario.origin.record: run for run in usable}
        # specimens whose fault cannot be seen get another one, a few times
        unseen = _unseen(runs, records) if redraws else {}
        scenarios = _redrawn(recipe, unseen.values())
        redrawn = {scenario.origin.record for scenario in scenarios}
        advice = "raise level.faulty_db" if recipe.level.kind == "snr" else "lower level.background_m_s2"
        for place, scenario in unseen.items():
            if scenario.origin.record not in redrawn:
                records[place] = (
                    f"record {scenario.origin.record}: none of {FAULT_TRIES} drawn faults of class {scenario.fault} can be seen in it; "
                    f"{advice}, or choose truth.undetected: keep."
                )
        # records with another fault replace those with the fault before
        by_number = {run.scenario.origin.record: record for run, record in zip(runs, records, strict=True)}
        final.update({number: record for number, record in by_number.items() if number in numbers})
    return [final[number] for number in numbers if number in final]


def made_from(scenarios: list[Scenario]) -> list[Made]:
    """Records of scenarios as they are; nothing is drawn again."""
    return made_of(simulate(scenarios))


def made_of(runs: list[Run], ratios: Mapping[int, Sequence[float]] = {}) -> list[Made]:
    """Records of scenarios that have been integrated; ``ratios`` as for :func:`gen.measurement.measure.measure`."""
    failures = [run.failure for run in runs]
    measured = iter(measure([run for run, failure in zip(runs, failures, strict=True) if failure is None], ratios))
    return [next(measured) if failure is None else failure for failure in failures]


def _further_ratios(recipe: Recipe, runs: list[Run]) -> dict[int, Sequence[float]]:
    """Ratios of the further tries of the level of records with a fault, by their number."""
    scenarios, snr = [run.scenario for run in runs], recipe.level.kind == "snr"
    faulty = [scenarios[place] for place in _largest_places(scenarios) if snr]
    return {scenario.origin.record: further_ratios(recipe, scenario, LEVEL_TRIES - 1) for scenario in faulty}


def _with_hits(recipe: Recipe, scenarios: list[Scenario]) -> list[Scenario]:
    """Scenarios of whole specimens, those with another fault whose spalls no loaded ball meets in some record.

    Of a group, the largest severity alone counts, as in :func:`_unseen`.
    """
    by_number, tried = {scenario.origin.record: scenario for scenario in scenarios}, scenarios
    while tried:
        largest = [tried[place] for place in _largest_places(tried)]
        felt = felt_places(largest)
        tried = _redrawn(recipe, [scenario for scenario, is_felt in zip(largest, felt, strict=True) if not is_felt])
        by_number.update({scenario.origin.record: scenario for scenario in tried})
    return list(by_number.values())


def _redrawn(recipe: Recipe, unseen: Iterable[Scenario]) -> list[Scenario]:
    """All records of the specimens of some records, with the next fault, unless the last one has been tried."""
    tries = {
        scenario.origin.specimen: scenario.origin.fault_try + 1
        for scenario in unseen
        if scenario.origin.fault_try < FAULT_TRIES - 1
    }
    ranges = [recipe.records_of(specimen) for specimen in sorted(tries)]
    return [
        scenario for some in ranges for scenario in draw_scenarios(recipe, some.start, some.stop, fault_tries=tries)
    ]


def _unseen(runs: list[Run], records: list[Made]) -> dict[int, Scenario]:
    """Records that were made and whose fault cannot be seen, by place; of a group, that of the largest severity alone is looked at."""
    scenarios = [run.scenario for run in runs]
    judged = [(place, record) for place in _largest_places(scenarios) if isinstance(record := records[place], Measured)]
    return {place: scenarios[place] for place, record in judged if not record.detectable}


def _largest_places(scenarios: list[Scenario]) -> list[int]:
    """Places of the records with a fault; of a group, that of the largest severity alone."""
    rungs = [*(scenario.origin.rung for scenario in scenarios), -1]
    return [at for at, scenario in enumerate(scenarios) if scenario.fault != "healthy" and rungs[at + 1] <= rungs[at]]
