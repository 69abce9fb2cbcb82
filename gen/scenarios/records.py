"""Draw the records of a specimen: operating conditions, level, profiles of speed and load, and rungs of severity."""

import functools
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.drawing import Combination, Draws, Known, known_of
from gen.mechanisms.chain.measuring_chain import draw_for_record
from gen.physics.axial import least_axial_load
from gen.physics.profile import Profile
from gen.physics.rating import static_rating
from gen.recipe import LEAST_AXIAL_LOAD, STATIC_RATING, Fault, ProfileSection, Recipe, fault_class
from gen.scenarios.lives import SpecimenLife, at_snapshot, draw_life
from gen.scenarios.model import Operation, Purpose, Rig, Scenario, Specimen, stream
from gen.scenarios.operating import CommonNumbers, Level, Operating, common_numbers, draw_conditions
from gen.scenarios.points import points_of
from gen.scenarios.settings import settings_of
from gen.support.units import percent_to_share


class SpecimenSource(NamedTuple):
    """Origin of the records of one specimen: its rig, itself at every rung, and the distributions of its conditions."""

    rig: Rig
    rungs: tuple[Specimen, ...]
    """The specimen at every rung; the specimen alone if its records are in no groups."""
    operating: Operating
    commons: dict[Level, CommonNumbers]
    """Numbers of rig and specimen, for the levels at which some operating quantity is drawn."""
    known: Known
    """Quantities of rig and specimen."""
    life: SpecimenLife | None = None
    """None in recipes without a life."""


def source_of(
    recipe: Recipe, rig: Rig, known: Known, specimen: Specimen, operating: Operating, of_rig: Draws, of_specimen: Draws
) -> SpecimenSource:
    """Origin of the records of a specimen; its operating grids go on with the combinations of ``of_rig`` and ``of_specimen``.

    ``known`` are the quantities of its rig.
    """
    rungs = recipe.corpus.rungs if recipe.corpus.rungs is not None and specimen.fault != "healthy" else (1.0,)
    commons: dict[Level, CommonNumbers] = {}
    if "rig" in operating.levels.values():
        rng = stream(recipe.seed, rig.number, 0, 0, Purpose.RIG_OPERATION)
        commons["rig"] = common_numbers(recipe, rng, of_rig.combination.number)
    if "specimen" in operating.levels.values():
        rng = stream(recipe.seed, rig.number, specimen.number, 0, Purpose.SPECIMEN_OPERATION)
        commons["specimen"] = common_numbers(recipe, rng, of_specimen.combination.number)
    known = {
        **known,
        **known_of(recipe.specimen, specimen.properties),
        STATIC_RATING: lambda _: static_rating(rig.bearing),
        LEAST_AXIAL_LOAD: lambda value: least_axial_load(value("load_n"), specimen.bearing.contact_angle),
    }
    life = None
    if recipe.life is not None:
        common = Draws(stream(recipe.seed, 0, 0, 0, Purpose.LIFE), 0, f"specimen {specimen.number}", np.full(64, 0.5))
        life = draw_life(recipe, rig, specimen, draw_conditions(operating, common, commons, known))
    return SpecimenSource(
        rig, tuple(specimen.at_severity(share) for share in rungs), operating, commons, known, life=life
    )


def record_points(recipe: Recipe, numbers: range) -> dict[int, NDArray[np.float64]]:
    """Quasi-random points of the groups of ``n_rungs`` records that hold some records, by number.

    A faulty specimen has one point for a group. A healthy one has one for each record: those after the first of a group come after the
    points of all groups, so that the conditions of faulty specimens and of healthy ones cover their ranges alike.
    """
    rungs = recipe.corpus.n_rungs
    points: dict[int, NDArray[np.float64]] = {}
    first, last = numbers[0] // rungs * rungs, numbers[-1] // rungs * rungs
    for place in range(rungs):
        points |= points_of(recipe, Purpose.RECORD, recipe.item_of(first + place), recipe.item_of(last + place) + 1)
    return points


def draw_records(recipe: Recipe, sources: Mapping[int, SpecimenSource], numbers: range) -> Iterator[Scenario]:
    """Draw records of some specimens; a life that has ended has no records at the numbers that are left of its specimen."""
    points = record_points(recipe, numbers)
    for number in numbers:
        specimen = recipe.specimen_of(number)
        source, place = sources[specimen], number - recipe.records_of(specimen).start
        if source.life is None:
            yield draw_record(recipe, source, number, points)
        elif place < len(source.life.ages):
            yield at_snapshot(draw_record(recipe, source, number, points), source.life, place)


def draw_record(
    recipe: Recipe, source: SpecimenSource, number: int, points: Mapping[int, NDArray[np.float64]]
) -> Scenario:
    """Draw one record of a specimen, without its place in a life.

    The records of a group have the streams of its first record, and the combination of grids and the quasi-random point of the group.

    Raises
    ------
    RecipeError
        If a share is outside the range of its key.
    """
    n_rungs = recipe.corpus.n_rungs
    group, place = divmod(number, n_rungs)
    rung = place if len(source.rungs) > 1 else -1
    item = recipe.item_of(number if rung < 0 else group * n_rungs)
    specimen, first = source.rungs[max(rung, 0)], number - max(rung, 0)
    streams = functools.partial(stream, recipe.seed, source.rig.number, specimen.number, first)
    draws = Draws(streams(Purpose.RECORD), item, f"record {number}", points[item])
    conditions = draw_conditions(source.operating, draws, source.commons, source.known)
    entry = recipe.faults[specimen.entry]
    snr, rms = _draw_level(draws, recipe, entry, source.rig.number)
    changes = {} if entry.operation is None else entry.operation.given()
    profiles: list[Profile | None] = []
    for key, purpose in (("speed_profile", Purpose.SPEED_PROFILE), ("load_profile", Purpose.LOAD_PROFILE)):
        profile = _draw_profile(draws, getattr(recipe.operation, key), recipe.recording.duration_s)
        if key in changes:  # from a stream of its own, so that it moves no draw of the other profile
            own = Draws(streams(purpose), item, draws.item)
            profile = _draw_profile(own, changes[key], recipe.recording.duration_s)
        profiles.append(profile)
    if recipe.operation.slip_walk is not None:
        conditions = replace(conditions, slip_walk=draws.section(recipe.operation.slip_walk)["spacing"])
    pair = group if rung >= 0 else -1
    narrowest = min((spall.width for one in source.rungs for spall in one.spalls), default=None)
    speed_profile, load_profile = profiles
    rng = stream(recipe.seed, source.rig.number, specimen.number, first, Purpose.RECORD_SENSOR_FAULTS)
    sensor_faults = draw_for_record(recipe.sensor_faults, rng, first)
    operation = Operation(
        number,
        conditions,
        snr,
        rms,
        speed_profile,
        load_profile,
        sensor_faults=sensor_faults,
        pair=pair,
        rung=rung,
        narrowest_spall=None if rung < 0 else narrowest,
    )
    return Scenario(settings_of(recipe), source.rig, specimen, operation)


def _draw_level(draws: Draws, recipe: Recipe, entry: Fault, rig: int) -> tuple[float | None, float | None]:
    """Signal-to-noise ratio [dB] and rms [m s-2] of a record; None if the level is that of the rig."""
    level = recipe.level
    if level.kind != "snr":
        return None, None
    changes = {} if entry.level is None else entry.level.given()
    u = draws.u()
    if fault_class(entry) == "healthy":  # all healthy bearings of a machine have one ratio
        u = float(stream(recipe.seed, rig, 0, 0, Purpose.LEVEL).random())
    snr = _ratio(recipe, entry).draw(u)
    u = draws.u()
    rms = draws.combination.value(level.rms_m_s2, u)
    if "rms_m_s2" in changes:
        rms = Combination(draws.combination.number).value(changes["rms_m_s2"], u)
    return snr, rms


def _ratio(recipe: Recipe, entry: Fault) -> Any:
    """Distribution of the signal-to-noise ratio of the records with a fault [dB]."""
    key = "healthy_db" if fault_class(entry) == "healthy" else "faulty_db"
    changes = {} if entry.level is None else entry.level.given()
    return changes.get(key, getattr(recipe.level, key))


def further_ratios(recipe: Recipe, scenario: Scenario, count: int) -> list[float]:
    """Signal-to-noise ratios of the later tries of a level [dB]; the first one is drawn with the record."""
    ratio = _ratio(recipe, recipe.faults[scenario.specimen.entry])
    return [ratio.draw(float(u)) for u in scenario.rng(Purpose.LEVEL).random(count)]


def _draw_profile(draws: Draws, profile: ProfileSection | None, duration: float) -> Profile | None:
    if profile is None:
        return None
    if profile.kind == "table":
        return Profile(profile.times_s, tuple(map(percent_to_share, profile.percent)))
    if profile.kind == "steps":
        levels = tuple(map(percent_to_share, profile.levels_percent))
        changes = [duration * change / len(levels) for change in range(1, len(levels))]
        times = [time + side * profile.step_s / 2 for time in changes for side in (-1, 1)]
        shares = [level for pair in pairwise(levels) for level in pair]
        return Profile(tuple(times), tuple(shares), smooth=True)
    drawn = draws.section(profile)
    if profile.kind == "ramp":
        return Profile((0.0, duration), (drawn["from"], drawn["to"]))
    return Profile((drawn["start"], drawn["start"] + drawn["lasting"]), (drawn["from"], drawn["to"]), smooth=True)
