"""How long a corpus takes: 20 s for each kernel that is not compiled yet, then records at the rate of this machine.

Work is counted in steps of one rolling element. One worker makes 46 to 130 million of them in a second for the shipped recipes, with
measurement and writing, so that a forecast is right within a factor of two. The last longer run on a machine leaves its rate beside the
compiled kernels.
"""

import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np

from gen.generation.step_checks import CHECKED_SHARE
from gen.recipe import Recipe
from gen.scenarios import Scenario, draw_scenarios, first_records, settings_of
from gen.simulation.batches import Group, group_of
from gen.simulation.inputs import kernel_inputs
from gen.simulation.kernels import cache_folder
from gen.simulation.motion import draw_motion
from gen.simulation.simulate import integrations
from gen.simulation.steps import steps_per_sample
from gen.simulation.timeline import timeline

KERNEL_S = 20
START_S = 2.0  # start of the process, libraries, kernels from the cache, index and data card
TYPICAL_RATE = 75e6  # steps of a rolling element per second and worker
LEAST_S = 5.0  # of a run that leaves its rate
ROLLER = 1.6  # steps of a ball that take as long as one of a roller
CONTIGUOUS = 48  # records whose integrations without a fault are counted; those of a ladder share one
SAMPLE = 16
AT_ONCE = 8  # records: a schedule of a minute takes 10 MB


def groups_of(scenarios: Sequence[Scenario], recipe: Recipe) -> Iterator[Group | str]:
    """Kernel and steps of each record, or a sentence where no machine is possible.

    Raises
    ------
    SimulationError
        If a record needs more steps than the recipe has.
    """
    axis = timeline(settings_of(recipe))
    for first in range(0, len(scenarios), AT_ONCE):
        some = scenarios[first : first + AT_ONCE]
        inputs, failures = kernel_inputs([draw_motion(scenario) for scenario in some], axis)
        for place, (given, scenario) in enumerate(zip(inputs, some, strict=True)):
            if given is None:
                yield failures[place]
            else:
                yield group_of(given, steps_per_sample(given, scenario.record, scenario.settings))


def some_of(count: int, most: int) -> list[int]:
    """At most ``most`` of ``count`` numbers in order; by chance, since evenly spaced ones might meet the same cell of every grid."""
    return sorted(np.random.default_rng(0).permutation(count)[:most].tolist())


def expected_work(recipe: Recipe) -> float:
    """Work of a corpus by a few records spread over it; of a recipe with no possible machine among them, 1 for each record."""
    numbers = some_of(recipe.n_records, SAMPLE)
    some = [scenario for number in numbers for scenario in draw_scenarios(recipe, number, number + 1)]
    groups = [found for found in groups_of(some, recipe) if isinstance(found, Group)]
    return work_of(recipe, groups) * len(some) / len(numbers) if groups else float(recipe.n_records)


def work_of(recipe: Recipe, groups: Sequence[Group]) -> float:
    """Steps of a rolling element that a corpus takes, from the groups of a sample of its records."""
    some = draw_scenarios(recipe, 0, min(CONTIGUOUS, recipe.n_records))
    scale = recipe.n_records * integrations(some) / len(some) / len(groups)
    checked = len(first_records(recipe)) + CHECKED_SHARE * recipe.n_records
    work = (len(groups) * scale + 2 * checked) * sum(map(_cost, groups)) / len(groups)
    return timeline(settings_of(recipe)).integrated * work


def _cost(group: Group) -> float:
    return group.steps * len(group.shape.balls) * (ROLLER if group.shape.roller else 1.0)


def seconds_of(work: float) -> float:
    """Time of one worker at the rate of the last run on this machine, or at a typical one [s]."""
    left = math.nan
    with suppress(OSError, ValueError):  # no run has left one, or the file is damaged
        left = float(_file().read_text(encoding="utf-8"))
    return work / (left if 0 < left < math.inf else TYPICAL_RATE)


def leave_rate(work: float, seconds: float) -> None:
    """Keep the rate of a run, given the time that all its workers took together [s]."""
    if seconds >= LEAST_S:
        with suppress(OSError):
            _file().write_text(f"{work / seconds:.3g}\n", encoding="utf-8")


def _file() -> Path:
    folder = cache_folder()
    if folder is None:
        raise FileNotFoundError
    return folder / "rate.txt"


def forecast_in_words(kernels: int, records_per_second: float) -> str:
    """How long kernels and records take.

    >>> forecast_in_words(2, 151.3), forecast_in_words(0, 0.212)
    ('about 20 s for each of 2 kernels, then about 150 records/s', 'about 0.21 records/s')
    """
    each = {0: "", 1: f"about {KERNEL_S} s for one kernel, then "}.get(
        kernels, f"about {KERNEL_S} s for each of {kernels} kernels, then "
    )
    return f"{each}about {float(f'{records_per_second:.2g}'):,g} records/s"
