"""Draw scenarios: a recipe becomes that of a rig, then that of a specimen, then that of a record, section by section.

A rig is one machine with its path, background and sensor; it has healthy and faulty specimens, and each specimen has several records. Every
number depends on the seed, the number of its rig, specimen or record, and its name. Only the numbers of ``faults`` depend on the fault: a
record with its fault and the same record without it differ in the fault alone.
"""

import functools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gen.corpus import SPLITS
from gen.drawing import Combination, Draws, Section, Wholes, quantities, stream, weighted_index
from gen.mechanisms.mechanism import plugins_of
from gen.physics.axial import least_axial_load
from gen.physics.bearing import free_contact_angle
from gen.physics.rating import static_rating
from gen.recipe import (
    FREE_ANGLE,
    LEAST_AXIAL_LOAD,
    STATIC_RATING,
    Fault,
    OriginSection,
    Recipe,
    corpus_identity,
    ranges,
)
from gen.recipe.sections import CorpusSection, TruthSection
from gen.scenarios.classes import fault_of_each_specimen, possible_entries
from gen.scenarios.lives import Aged, at_snapshot, draw_life
from gen.scenarios.points import points_of
from gen.scenarios.scenario import Scenario, as_built, check_bearing, scenario_of, sound
from gen.support.errors import RecipeError
from gen.support.units import split_unit

_OF_PLUGIN = "correct draw() of its class"
_OF_RIG = ("recording", "bearing", "machine", "machine_conditions", "contact", "path", "background", "sensor_faults")


Specimen = tuple[Any, Wholes, tuple[Fault, ...], list[Aged] | None]
"""Recipe of a specimen, quantities that its records can have shares of, its fault at each rung, and the snapshots of its life."""

_ONE = CorpusSection(rigs=1, specimens_per_rig=1, records_per_specimen=1)
_OF_FILES = {key: Recipe.model_fields[key].default for key in ("storage", "records", "life")}


def draw_scenarios(
    recipe: Recipe, first: int = 0, stop: int | None = None, *, fault_tries: Mapping[int, int] | None = None
) -> list[Scenario]:
    """Draw the scenarios of the records ``first`` to ``stop`` (exclusive) of a corpus, at most up to its last.

    The scenario of a record does not depend on the range. A life that has ended has none. ``fault_tries`` gives, by the number of a
    specimen, how many faults are drawn and left before the one that it has; 0 for specimens that are not in it.

    Raises
    ------
    RecipeError
        If it is no recipe that has been read, it has none of these records, a drawn bearing cannot exist, or a drawn spall does not fit it.
    """
    if not isinstance(recipe, Recipe):
        raise RecipeError(
            f"recipe: {type(recipe).__name__} given; give one that gen.make_recipe or gen.read_recipe gave."
        )
    numbers = range(first, recipe.n_records if stop is None else min(stop, recipe.n_records))
    if first < 0 or not numbers:
        raise RecipeError(
            f"{recipe.name}: has no records {first} to {numbers.stop if stop is None else stop} (exclusive); it has "
            f"{recipe.n_records}, numbered from 0."
        )
    # a recipe of one record has nothing left to draw
    if recipe.origin is not None:
        return [scenario_of(recipe)]
    first_specimen, last_specimen = recipe.specimen_of(numbers[0]), recipe.specimen_of(numbers[-1])
    first_rig, last_rig = recipe.rig_of(first_specimen), recipe.rig_of(last_specimen)
    # machines, then bearings, then records: each level draws with what is known of those above it
    rigs = {
        number: _draw_rig(recipe, _draws(recipe, "rig", number, number, point))
        for number, point in points_of(recipe, "rig", first_rig, last_rig + 1).items()
    }
    specimens = {}
    for number, point in points_of(recipe, "specimen", first_specimen, last_specimen + 1).items():
        draws = _draws(recipe, "specimen", number, number, point)
        fault_try = (fault_tries or {}).get(number, 0)
        specimens[number] = _draw_specimen(recipe, *rigs[recipe.rig_of(number)], draws, fault_try)
    scenarios = list(_draw_records(recipe, specimens, numbers))
    if plugins_of(recipe):
        _check_drawn(scenarios, ("background", "machine_conditions", "sensor_faults"), _OF_PLUGIN)
    if recipe.life is not None:
        _check_drawn(scenarios, ("specimen", "operation", "level"), "lower the wear or the histories of life")
    return scenarios


def _check_drawn(scenarios: list[Scenario], keys: Sequence[str], advice: str) -> None:
    """RecipeError if a plug-in or a life made a value that its key does not allow: replay would refuse the record."""
    checked: set[int] = set()  # records share the mechanisms of their rig and specimen
    for scenario in scenarios:
        for key in keys:
            section = getattr(scenario.recipe, key)
            if id(section) not in checked:
                checked.add(id(section))
                section.check_drawn(f"record {scenario.origin.record}: {key}.", advice)


def _draws(recipe: Recipe, level: Any, of: int, item: int, point: NDArray[np.float64]) -> Draws:
    """Numbers of a rig, specimen or record; its grids have the combination ``item``."""
    return Draws(
        recipe.seed, level, of, Combination(item), point[::-1].tolist(), channels=len(recipe.recording.channels)
    )


def _draw_rig(recipe: Recipe, draws: Draws) -> tuple[Recipe, Draws]:
    """Recipe of a rig with one record, whose fault is not drawn again, and what its specimens are drawn with."""
    # the recipe of one record has the fault that was drawn last
    undetected = "keep" if recipe.truth.undetected == "redraw" else recipe.truth.undetected
    truth = TruthSection.model_validate({"twins": recipe.truth.twins, "undetected": undetected})
    drawn: dict[str, Any] = {"corpus": _ONE, "truth": truth, **_OF_FILES}
    for key in _OF_RIG:
        section = getattr(recipe, key)
        if section is not None:
            drawn[key] = section.draw(draws.within(key, "rig"))
    machine, bearing = drawn["machine"], drawn["bearing"].drawing()
    # ISO 21940-11 defines the balance grade at the highest speed of the machine
    drawn["machine"] = machine.model_copy(update={"balance_rpm": machine.balance_rpm or _highest_speed(recipe)})
    if (oil := drawn["contact"].lubricant) is not None:
        oil.check(f"rig {draws.of}")
    # quantities of which those of lower levels can be shares
    dimensions = {"pitch_diameter_mm": bearing.pitch_diameter, "ball_diameter_mm": bearing.ball_diameter}
    wholes = {**_wholes(recipe.machine, machine), **dimensions}
    return recipe.model_copy(update=drawn), draws._replace(point=[], wholes=wholes, bearing=bearing)


@functools.lru_cache(maxsize=16)
def _highest_speed(recipe: Recipe) -> float:
    return max(of["shaft_rpm"][1] for place, of in ranges(recipe).items() if place.endswith("operation"))


def _wholes(section: Section, drawn: Section) -> dict[str, float]:
    """Drawn quantities of a section by their keys [SI]."""
    values = drawn.si()
    return {key: values[split_unit(key)[0]] for key in quantities(section)}


def _draw_bearing(rig: Recipe, of_rig: Draws, draws: Draws) -> tuple[Section, Draws]:
    """Section ``specimen`` of a specimen, and what its fault is drawn with."""
    drawing = of_rig.bearing

    def free_angle(value: Any) -> float:
        """Free contact angle with the clearance and the grooves of the specimen [rad]; 0 if its drawing has a contact angle."""
        if drawing.contact_angle != 0:
            return 0.0
        grooved = replace(
            drawing, inner_conformity=value("inner_conformity"), outer_conformity=value("outer_conformity")
        )
        return free_contact_angle(grooved, value("diametral_clearance_um"))

    wholes = {**of_rig.wholes, FREE_ANGLE: free_angle}
    specimen = rig.specimen.draw(draws._replace(wholes=wholes).within("specimen", "specimen"))
    bearing = as_built(drawing, specimen.si())
    check_bearing(bearing, f"specimen {draws.of}")
    return specimen, draws._replace(wholes={**of_rig.wholes, **_wholes(rig.specimen, specimen)}, bearing=bearing)


def _draw_entry(recipe: Recipe, rig: int, draws: Draws, fault_try: int) -> int:
    """Place in ``faults`` of the entry of a specimen."""
    fault = fault_of_each_specimen(recipe, rig)[draws.of % recipe.corpus.specimens_per_rig]
    wanted, entry = possible_entries(recipe, draws.of, fault), 0
    of_faults = draws._replace(point=[]).within("faults", "specimen")
    for attempt in sorted({0, fault_try}):
        u = of_faults._replace(attempt=attempt).u("entry")
        entry = wanted[weighted_index(tuple(recipe.faults[place].weight for place in wanted), u)]
        # a fault that is drawn again leaves operating conditions and levels as they are
        first = recipe.faults[entry]
        faults = ((place, recipe.faults[place]) for place in wanted)
        wanted = [place for place, fault in faults if (fault.operation, fault.level) == (first.operation, first.level)]
    return entry


def _draw_specimen(recipe: Recipe, rig: Recipe, of_rig: Draws, draws: Draws, fault_try: int) -> Specimen:
    """What the records of a specimen have in common, and its fault."""
    entry = _draw_entry(recipe, of_rig.of, draws, fault_try)
    section, built = _draw_bearing(rig, of_rig, draws)
    drawn: dict[str, Any] = {"specimen": section}
    # of one combination of grids for all specimens of a rig
    of_rig = of_rig._replace(grids=replace(of_rig.grids))
    # keys with per=rig, then those with per=specimen; the rest is drawn for each record
    for key, undrawn in (("operation", recipe.operation_of(entry)), ("level", recipe.level_of(entry))):
        drawn[key] = undrawn.draw(of_rig.within(key, "rig")).draw(draws.within(key, "specimen"))
    fault = recipe.faults[entry].draw(built._replace(point=[], attempt=fault_try).within("faults", "specimen"))
    if plugins_of(recipe):
        fault.check_drawn(f"specimen {draws.of}: faults.", _OF_PLUGIN)
    for part in fault.components:
        part.check(built.bearing, f"specimen {draws.of}")
    # conditions of the fault are those of the record by now
    fault = fault.model_copy(update={"weight": 1.0, "operation": None, "level": None})
    drawn["faults"] = (fault,)
    drawn["origin"] = OriginSection.model_construct(
        corpus=corpus_identity(recipe),
        rig=of_rig.of,
        specimen=draws.of,
        record=0,
        entry=entry,
        split=split_of(recipe, draws.of),
        fault_try=fault_try,
    )
    specimen, wholes = rig.model_copy(update=drawn), dict(built.wholes)
    # loads can be shares of what the bearing carries
    wholes[STATIC_RATING] = lambda _: static_rating(of_rig.bearing)
    wholes[LEAST_AXIAL_LOAD] = lambda value: least_axial_load(value("load_n"), built.bearing.contact_angle)
    rungs = (1.0,) if recipe.corpus.rungs is None or not fault.components else recipe.corpus.rungs
    # the same fault at every severity of the ladder
    faults = tuple(fault if share == 1 else sound() if share == 0 else fault.at_severity(share) for share in rungs)
    if recipe.life is None:
        return specimen, wholes, faults, None
    # a life follows from the middle of its conditions, which then vary about it
    middle = _draws(recipe, "record", 0, 0, np.full(64, 0.5))._replace(wholes=wholes)
    conditions = drawn["operation"].draw(middle.within("operation", "record")).si()
    return specimen, wholes, faults, draw_life(recipe, specimen, built.bearing, conditions)


def split_of(recipe: Recipe, specimen: int) -> str:
    """Split of a specimen; if rigs are kept together, that of its rig."""
    split, corpus = recipe.corpus.split, recipe.corpus
    rig, position = recipe.rig_of(specimen), specimen % corpus.specimens_per_rig
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
    return stream(seed, "rig", rig, "corpus.split").permutation(count)


def _draw_records(recipe: Recipe, specimens: Mapping[int, Specimen], numbers: range) -> Iterator[Scenario]:
    """Records of some specimens; a life that has ended has no records at the numbers that are left of its specimen.

    The records of a group have the numbers of its first record, and the combination of grids and the quasi-random point of the group. A
    faulty specimen has one point for a group. A healthy one has one for each record: those after the first of a group come after the
    points of all groups, so that the conditions of faulty specimens and of healthy ones cover their ranges alike.
    """
    # records of a group share the draws of their first one
    rungs, points = recipe.corpus.n_rungs, dict[int, NDArray[np.float64]]()
    first, last = numbers[0] // rungs * rungs, numbers[-1] // rungs * rungs
    for place in range(rungs):
        points |= points_of(recipe, "record", recipe.item_of(first + place), recipe.item_of(last + place) + 1)
    for number in numbers:
        specimen, wholes, faults, life = specimens[recipe.specimen_of(number)]
        group, place = divmod(number, rungs)
        first, placed = number, {}
        if len(faults) > 1:
            # the step that the narrowest spall needs is that of the whole group
            widths = [w for fault in faults for part in fault.components for w in getattr(part, "width_mm", ())]
            first, placed = number - place, {"pair": group, "rung": place, "narrowest_mm": min(widths, default=None)}
        item, origin = recipe.item_of(first), specimen.origin
        draws = _draws(recipe, "record", first, item, points[item])._replace(wholes=wholes)
        drawn: dict[str, Any] = {
            key: getattr(specimen, key).draw(draws.within(key, "record"))
            for key in ("operation", "level", "sensor_faults")
        }
        drawn["faults"] = (faults[place if placed else 0],)
        drawn["origin"] = origin.model_copy(update={"record": number, **placed})
        scenario = Scenario(specimen.model_copy(update=drawn))
        # records of a life are its snapshots, as long as it lasts
        if life is None:
            yield scenario
        elif (snapshot := number - recipe.records_of(origin.specimen).start) < len(life):
            yield at_snapshot(scenario, life[snapshot])


def further_ratios(recipe: Recipe, scenario: Scenario, count: int) -> list[float]:
    """Signal-to-noise ratios of the later tries of a level [dB]; the first one is drawn with the record."""
    level: Any = recipe.level_of(scenario.origin.entry)
    draws = _draws(recipe, "record", scenario.origin.first_record, 0, np.empty(0)).within("level", "record")
    return [level.faulty_db.draw(draws._replace(attempt=1 + attempt).u("faulty_db")) for attempt in range(count)]
