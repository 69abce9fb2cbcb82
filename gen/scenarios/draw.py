"""Draw scenarios: rigs, specimens and records.

A rig is one machine with its path, background and sensor; it has healthy and faulty specimens, and each specimen has several records.
Every rig, specimen, record and purpose has its own random stream, which depends on their numbers and not on the order of work. Only the
fault stream depends on the fault: a record with its fault and the same record without it differ in the fault alone.
"""

import functools
import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from gen.corpus import SPLITS
from gen.drawing import Draws, Known, known_of, weighted_index
from gen.mechanisms.background.section import draw_background, draw_later, draw_locked
from gen.mechanisms.chain.measuring_chain import draw_for_rig
from gen.mechanisms.faults.bearing_fault import draw_damage
from gen.recipe import Fault, Recipe, operations
from gen.scenarios.bearings import draw_as_built, draw_bearing, known_of_rig
from gen.scenarios.classes import fault_of_each_specimen, possible_entries
from gen.scenarios.model import Pickup, Purpose, Rig, Scenario, Specimen, stream
from gen.scenarios.operating import Operating, operating_of
from gen.scenarios.points import points_of
from gen.scenarios.records import SpecimenSource, draw_records, source_of
from gen.support.errors import RecipeError


def draw_scenarios(
    recipe: Recipe, first: int = 0, stop: int | None = None, *, fault_tries: Mapping[int, int] | None = None
) -> list[Scenario]:
    """Draw the scenarios of the records ``first`` to ``stop`` (exclusive) of a corpus, at most up to its last.

    The scenario of a record does not depend on the range. A life that has ended has none. ``fault_tries`` gives, by the number of a
    specimen, how many faults are drawn and left before the one that it has; 0 for specimens that are not in it.

    Raises
    ------
    RecipeError
        If the recipe has none of these records, a drawn bearing cannot exist, or a drawn spall does not fit it.
    """
    numbers = range(first, recipe.n_records if stop is None else min(stop, recipe.n_records))
    if first < 0 or not numbers:
        raise RecipeError(
            f"{recipe.name}: has no records {first} to {numbers.stop if stop is None else stop} (exclusive); it has "
            f"{recipe.n_records}, numbered from 0."
        )
    tries = fault_tries or {}
    first_specimen, last_specimen = recipe.specimen_of(numbers[0]), recipe.specimen_of(numbers[-1])
    first_rig, last_rig = recipe.rig_of(first_specimen), recipe.rig_of(last_specimen)
    rig_draws = {
        number: Draws(stream(recipe.seed, number, 0, 0, Purpose.RIG), number, f"rig {number}", point)
        for number, point in points_of(recipe, Purpose.RIG, first_rig, last_rig + 1).items()
    }
    rigs = {number: _draw_rig(recipe, number, draws) for number, draws in rig_draws.items()}
    known = {number: known_of_rig(recipe, rig) for number, rig in rigs.items()}
    classes = {number: fault_of_each_specimen(recipe, number) for number in rigs}
    sources: dict[int, SpecimenSource] = {}
    operating: dict[int, Operating] = {}
    for number, point in points_of(recipe, Purpose.SPECIMEN, first_specimen, last_specimen + 1).items():
        rig = recipe.rig_of(number)
        draws = Draws(stream(recipe.seed, rig, number, 0, Purpose.SPECIMEN), number, f"specimen {number}", point)
        specimen = _draw_specimen(recipe, rigs[rig], known[rig], number, draws, classes[rig], tries.get(number, 0))
        if specimen.entry not in operating:
            operating[specimen.entry] = operating_of(recipe, specimen.entry)
        sources[number] = source_of(
            recipe, rigs[rig], known[rig], specimen, operating[specimen.entry], rig_draws[rig], draws
        )
    return list(draw_records(recipe, sources, numbers))


def _draw_rig(recipe: Recipe, number: int, draws: Draws) -> Rig:
    machine = draws.section(recipe.machine)
    # ISO 21940-11 defines the balance grade at the highest speed of the machine
    highest_rate = max(operation.shaft_rpm.support()[1] for operation in operations(recipe).values()) / 60
    machine["unbalance"] = machine["shaft_mass"] * machine["balance"] / (2 * math.pi * highest_rate)
    known = known_of(recipe.machine, machine)
    resonator = None if recipe.machine.resonator is None else draws.section(recipe.machine.resonator, known)
    bearing = draw_bearing(recipe, draws)
    level = draws.section(recipe.level)
    channels = []
    for channel in recipe.recording.channels:
        body = tuple(channel.body)[weighted_index(tuple(channel.body.values()), draws.u())]
        channels.append(Pickup(body, draws.section(channel)["angle"]))
    path = recipe.path.draw(draws)
    background = draw_background(recipe.background, draws)
    own_paths = tuple(None if c.path is None else c.path.draw(draws) for c in recipe.recording.channels)
    oil = None if recipe.contact.lubricant is None else draws.section(recipe.contact.lubricant)
    if oil is not None and oil["viscosity_100"] >= oil["viscosity_40"]:
        raise RecipeError(
            f"rig {number}: oil of {oil['viscosity_40'] * 1e6:.3g} mm2/s at 40 C has no lower viscosity at 100 C; "
            f"keep viscosity_100_mm2_s below viscosity_40_mm2_s."
        )
    background |= draw_later(recipe.background, draws)
    background |= draw_locked([recipe.background, recipe], functools.partial(stream, recipe.seed, number, 0, 0), number)
    high_pass, offset = draws.value(recipe.recording.high_pass_hz), draws.value(recipe.recording.offset_m_s2)
    return Rig(
        number=number,
        bearing=bearing,
        machine=machine,
        resonator=resonator,
        channels=tuple(channels),
        path=path,
        own_paths=own_paths,
        background=background,
        gain=level.get("gain", 1.0),
        background_rms=level.get("background", 1.0),
        lubricant=oil,
        footprint=recipe.contact.footprint == "hertz",
        sensor_faults=draw_for_rig(
            recipe.sensor_faults,
            stream(recipe.seed, number, 0, 0, Purpose.RIG_SENSOR_FAULTS),
            number,
            len(recipe.recording.channels),
        ),
        high_pass=high_pass,
        offset=offset,
    )


def _draw_specimen(
    recipe: Recipe,
    rig: Rig,
    known: Known,
    number: int,
    draws: Draws,
    classes: list[str],
    fault_try: int,
) -> Specimen:
    bearing, properties = draw_as_built(recipe, rig.bearing, known, draws)
    position = number % recipe.corpus.specimens_per_rig
    fault = classes[position]
    wanted, entry = possible_entries(recipe, number, fault), 0
    for attempt in sorted({0, fault_try}):
        draws = Draws(stream(recipe.seed, rig.number, number, attempt, Purpose.FAULT), number, f"specimen {number}")
        entry = wanted[weighted_index(tuple(recipe.faults[place].weight for place in wanted), draws.u())]
        # a fault that is drawn again leaves the conditions as they are
        first = recipe.faults[entry]
        wanted = [place for place in wanted if _same_conditions(recipe.faults[place], first)]
    split = _draw_split(recipe, rig.number, position)
    known = {**known, **known_of(recipe.specimen, properties)}
    spalls, damage = draw_damage(recipe.faults[entry].components, draws, bearing, known)
    return Specimen(number, bearing, properties, fault, spalls, damage, split, fault_try, entry)


def _same_conditions(one: Fault, other: Fault) -> bool:
    """Whether two entries of ``faults`` have the same operating conditions and levels."""
    return one.operation == other.operation and one.level == other.level


def _draw_split(recipe: Recipe, rig: int, position: int) -> str:
    """Split of a specimen; if rigs are kept together, that of the rig."""
    split, corpus = recipe.corpus.split, recipe.corpus
    if split.by == "rig":
        # the first of two or more rigs is in the test part, if there is one; rigs beyond them are divided in turns of as many
        turn, place = divmod(rig, corpus.rigs)
        u = _ranks(recipe.seed, turn, corpus.rigs)[place] / corpus.rigs if corpus.rigs > 1 else 1.0
    else:
        rank = _ranks(recipe.seed, rig, corpus.specimens_per_rig)[position]
        # the offset by the golden ratio distributes the parts evenly over the rigs
        u = (rank + (rig * 0.6180339887 + 0.5) % 1) / corpus.specimens_per_rig
    train, validation, test = SPLITS
    return test if u < split.test else validation if u < split.test + split.validation else train


@functools.lru_cache(maxsize=4)
def _ranks(seed: int, rig: int, count: int) -> NDArray[np.int64]:
    """Random order of all rigs, or of the specimens of a rig, for the split."""
    return stream(seed, rig, 0, 0, Purpose.SPLIT).permutation(count)
