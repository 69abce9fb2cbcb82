"""Kernels of a recipe compiled before its first record, several at once where cores are free.

A kernel takes 10 to 20 s to compile, once per machine. A kernel that no record of the sample needs is compiled when the first record
needs it.
"""

from bisect import bisect
from collections.abc import Callable, Iterator
from contextlib import closing
from typing import Any

import numpy as np

from gen.measurement.measure import compile_measuring
from gen.mechanisms.mechanism import mechanisms_of
from gen.physics.inputs import CONSTANT, ROUND, Waviness
from gen.physics.kernel.batch import input_shape
from gen.physics.kernel.layout import Shape
from gen.recipe import Recipe
from gen.scenarios import Scenario, draw_scenarios, first_specimens
from gen.simulation.damage import is_wavy, untabulated_spalls
from gen.simulation.inputs import bare_inputs
from gen.simulation.kernels import cache_folder, is_compiled, load_kernel
from gen.simulation.motion import draw_motion, is_scheduled
from gen.support.executor import cores, run
from gen.support.garbage import keep_garbage

SAMPLE = 48
"""Number of records from the first on, and of others spread over the corpus, whose kernels are compiled."""
MOST_AT_ONCE = 8  # processes; each takes 0.4 GB
_WAVY = Waviness(np.zeros((2, 1), complex), ROUND.balls)
_VARYING = np.ones((1, 2))


def compile_kernels(recipe: Recipe, notice: Callable[[str], None] = lambda _: None) -> None:
    """Compile the kernels of a recipe that this machine does not have yet; ``notice`` is called with a sentence for each."""
    with keep_garbage():
        compile_measuring(draw_scenarios(recipe, 0, 1)[0])
        for guest in (*mechanisms_of(recipe.background), *mechanisms_of(recipe.sensor_faults)):
            guest.compile()
    missing = [shape for shape in needed_shapes(recipe) if not is_compiled(shape)]
    if not missing:
        return
    count = "one kernel" if len(missing) == 1 else f"{len(missing)} kernels"
    notice(f"compiling {count} for this machine, 10 to 20 s each; they are kept for the next time.")
    at_once = 1 if cache_folder() is None else min(cores(), MOST_AT_ONCE, len(missing))
    with closing(run(load_kernel, missing, at_once)) as compiled:
        for number, (shape, _) in enumerate(zip(missing, compiled, strict=True), 1):
            notice(f"kernel {number} of {len(missing)} is compiled: {shape_in_words(shape)}.")


def needed_shapes(recipe: Recipe) -> list[Shape]:
    """Shapes of the kernels that the records of a sample need, in the order of the records."""
    chosen: dict[Any, Scenario] = {}
    for scenario in _sample(recipe):
        # records of one specimen whose conditions are zero or not zero alike have the same kernel
        record = scenario.record
        conditions = tuple(name for name, value in vars(record.conditions).items() if value)
        profiles = (record.speed_profile is None, record.load_profile is None)
        chosen.setdefault((scenario.specimen.number, scenario.specimen.fault, conditions, profiles), scenario)
    scenarios = list(chosen.values())
    if recipe.truth.twins:
        scenarios = [one for scenario in scenarios for one in (scenario, scenario.without_fault())]
    # a record of which no machine is possible is left out when its part is made
    inputs, _ = bare_inputs([draw_motion(scenario) for scenario in scenarios])
    shaped = [
        given._replace(
            spalls=untabulated_spalls(scenario),
            waviness=_WAVY if is_wavy(scenario) else ROUND,
            schedule=_VARYING if is_scheduled(scenario) else CONSTANT,
        )
        for given, scenario in zip(inputs, scenarios, strict=True)
        if given is not None
    ]
    return list(dict.fromkeys(map(input_shape, shaped)))


def _sample(recipe: Recipe) -> Iterator[Scenario]:
    if recipe.life is not None:  # the last snapshot of a life has its spall
        for specimen in first_specimens(recipe).values():
            numbers = recipe.records_of(specimen)
            behind = bisect(numbers, False, key=lambda number: not draw_scenarios(recipe, number, number + 1))
            yield from draw_scenarios(recipe, numbers[behind - 1], numbers[behind - 1] + 1)
    yield from draw_scenarios(recipe, 0, SAMPLE)
    for number in range(SAMPLE, recipe.n_records, -(-recipe.n_records // SAMPLE)):
        yield from draw_scenarios(recipe, number, number + 1)


def shape_in_words(shape: Shape) -> str:
    """Number of balls and channels of a kernel, and its parts.

    >>> from gen.physics.kernel.layout import make_shape
    >>> shape_in_words(make_shape(9, 1, resonator=True, spalled=True))
    '9 balls, 1 channel, resonator, spalled'
    """
    channels = f"{len(shape.channels)} channel{'s' if len(shape.channels) > 1 else ''}"
    parts = [field for field in Shape._fields[2:] if getattr(shape, field)]
    return ", ".join([f"{len(shape.balls)} balls", channels, *parts])
