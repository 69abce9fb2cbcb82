"""Refuse lives that cannot be: loads without a rating, keys that contradict a life, an end that is never reached."""

import math

from gen.life.ageing import STEPS
from gen.life.fatigue import life_share, rating_life
from gen.life.growth import Growth, drive_between
from gen.mechanisms.faults.race_spalls import Spalls
from gen.physics.bearing import Bearing
from gen.recipe.life import LifeSection
from gen.recipe.machine import CatalogueBearing
from gen.recipe.operation import OperationSection
from gen.recipe.sections import Sections
from gen.recipe.shares import operations
from gen.support.units import to_si

MOST_STEPS = 200_000
"""Of the histories of one life."""
_HOUR = 3600


def life_problem(recipe: Sections) -> str | None:
    """Error sentence about the life of a recipe, None if it has none or can be made."""
    if recipe.life is None:
        return None
    of_operations = (_operation_problem(recipe, recipe.life, *item) for item in operations(recipe).items())
    return (
        _other_keys_problem(recipe, recipe.life)
        or next(filter(None, of_operations), None)
        or _history_problem(recipe, recipe.life)
    )


def _other_keys_problem(recipe: Sections, life: LifeSection) -> str | None:
    corpus, size, converter = recipe.corpus, recipe.corpus.records_per_specimen, recipe.recording.converter
    for number, fault in enumerate(recipe.faults):
        if not isinstance(fault, Spalls):
            return f"faults[{number}].kind: {fault.kind} has no life; with life, use inner, outer and ball."
        if fault.n_spalls.support()[1] > 1:
            return f"faults[{number}].n_spalls: one spall grows in a life; leave n_spalls out."
        if fault.profile == "trace":
            return f"faults[{number}].profile: a trace would stretch as its spall grows; use another profile."
        if fault.width_mm.support()[0] >= life.end.length_mm:
            return f"faults[{number}].width_mm: a spall begins longer than life.end.length_mm; begin with 0.25 or so."
    for wrong, place, advice in (
        (corpus.rungs is not None, "corpus.rungs", "severities come from the growth; leave rungs out"),
        (recipe.level.kind != "physical", "level.kind", "a drawn level would hide the growth; use kind: physical"),
        (recipe.truth.undetected == "redraw", "truth.undetected", "a life is never drawn again; use keep or healthy"),
        (recipe.storage.records_per_part % size, "storage.records_per_part", f"use a multiple of the {size} snapshots of a life"),
        (recipe.n_records % size, "records", f"use a multiple of the {size} snapshots of a life"),
        ((life.damaged_cadence_h or 0) > life.cadence_h, "life.damaged_cadence_h", "it is longer than cadence_h; use less"),
        (life.damaged_from_mm >= life.end.length_mm, "life.damaged_from_mm", "it is beyond life.end.length_mm; use less"),
        (life.withdrawal_h.support()[1] <= life.entry_h.support()[0], "life.withdrawal_h", "it is before entry_h; use more"),
        (recipe.contact.lubricant is None and life.temperature_history_k.support()[1] > 0, "life.temperature_history_k",
         "it has no effect without oil; give contact.lubricant"),
        (converter.kind == "adc" and (life.end.peak_m_s2 or 0) > converter.full_scale_m_s2, "life.end.peak_m_s2",
         "it is above the full scale of the converter and never reached; lower it"),
    ):  # fmt: skip
        if wrong:
            return f"{place}: does not fit a life: {advice}."
    return None


def _history_problem(recipe: Sections, life: LifeSection) -> str | None:
    horizon = life.entry_h.support()[1] + recipe.corpus.records_per_specimen * life.cadence_h
    if horizon * STEPS > MOST_STEPS * life.history_h.support()[0]:
        return f"life.history_h: is too short for {horizon:g} h of snapshots; use {horizon * STEPS / MOST_STEPS:.3g} or more."
    return None


def _operation_problem(recipe: Sections, life: LifeSection, place: str, operation: OperationSection) -> str | None:
    for key in ("load_n", "shaft_rpm"):
        given = getattr(operation, key)
        if given.per is None and given.own_support()[0] < given.own_support()[1]:
            return f"{place}.{key}: varies from snapshot to snapshot; add per=specimen, and life has slow histories."
    if operation.axial_load_n.support()[1] > 0:
        return f"{place}.axial_load_n: lives are known under radial loads alone; leave it out."
    bearings = _bearings(recipe)
    unrated = next((one.designation for one in bearings if one.dynamic_rating is None), None)
    if unrated is not None:
        return f"bearing: {unrated} has no dynamic rating, which a life needs; docs/catalogue.md lists bearings that have one."
    if operation.load_n.known_support() is None:
        return None
    heaviest = max(operation.load_n.support()[1] / (one.dynamic_rating or 1.0) for one in bearings)
    if heaviest > 1 and not life.accelerated:
        return (
            f"{place}.load_n: reaches {heaviest:.3g} times the dynamic rating of the bearing; lower it, or say life.accelerated: true "
            f"for an overload test."
        )
    latest = max(_longest_median(life, one, operation) for one in bearings) / _HOUR
    earliest = min(_shortest_hundredth(life, one, operation) for one in bearings) / _HOUR
    if life.cadence_h > latest:
        return f"life.cadence_h: {life.cadence_h:g} h is longer than half of the lives, {latest:.3g} h; use a hundredth of it or so."
    watched = min(
        life.withdrawal_h.support()[1],
        life.entry_h.support()[1] + recipe.corpus.records_per_specimen * life.cadence_h,
    )
    if watched < earliest:
        return (
            f"life: its end is never reached: the snapshots cover {watched:.4g} h, and one bearing of a hundred has a spall after "
            f"{earliest:.4g} h at the earliest; raise the cadence, the number of snapshots or the load."
        )
    return None


def _bearings(recipe: Sections) -> list[Bearing]:
    chosen = recipe.bearing
    if isinstance(chosen, CatalogueBearing):
        return [chosen.bearing(name) for name in chosen.designations]
    return [Bearing(chosen.designation, 0, math.nan, math.nan)]


def _shortest_hundredth(life: LifeSection, bearing: Bearing, operation: OperationSection) -> float:
    """Time in which one bearing of a hundred has a spall, at the greatest load and speed [s]."""
    heaviest, element = operation.load_n.support()[1] / (bearing.dynamic_rating or 1.0), bearing.rolling_element
    turns = rating_life(heaviest, element, life.a_iso.support()[0]) * life_share(0.01, element)
    return turns / to_si(operation.shaft_rpm.support()[1], "rpm")


def _longest_median(life: LifeSection, bearing: Bearing, operation: OperationSection) -> float:
    """Bound of the time in which half of the bearings fail by the length of their spalls, at the least load and speed [s]."""
    lightest, element = operation.load_n.support()[0] / (bearing.dynamic_rating or 1.0), bearing.rolling_element
    slowest = to_si(life.growth_mm_per_mrev.support()[0], "mm_per_mrev")
    law = Growth(slowest, life.growth_exponent.support()[0], math.inf, 1.0)
    begun = rating_life(lightest, element, life.a_iso.support()[1]) * life_share(0.5, element)
    grown = drive_between(law, to_si(0.01, "mm"), to_si(life.end.length_mm, "mm"))
    turns = begun + grown / min(lightest**exponent for exponent in life.load_exponent.support())
    return turns / to_si(operation.shaft_rpm.support()[0], "rpm")
