"""Refuse lives that cannot be: loads without a rating, keys that contradict a life, an end that is never reached."""

import math
from collections.abc import Iterator
from typing import Any

from gen.life.ageing import STEPS
from gen.life.fatigue import life_share, rating_life
from gen.life.growth import Growth, drive_between
from gen.mechanisms.faults.race_spalls import Spalls
from gen.physics.bearing import Bearing
from gen.recipe.life import LifeSection
from gen.recipe.machine import CatalogueBearing
from gen.recipe.sections import Sections
from gen.recipe.shares import STATIC_RATING, ranges
from gen.support.rounding import rounded_up
from gen.support.units import to_si

MOST_STEPS = 200_000
"""Of the histories of one life."""
_HOUR = 3600


def life_problems(recipe: Sections) -> Iterator[str]:
    """Sentences about a life that cannot be made."""
    if recipe.life is None:
        return
    yield from _other_keys(recipe, recipe.life)
    yield from _loads(recipe, recipe.life)
    horizon = _horizon(recipe, recipe.life)
    if horizon * STEPS > MOST_STEPS * recipe.life.history_h.support()[0]:
        yield f"life.history_h: is too short for {horizon:g} h of snapshots; use {rounded_up(horizon * STEPS / MOST_STEPS)} or more."


def _other_keys(recipe: Sections, life: LifeSection) -> Iterator[str]:
    corpus, size, converter = recipe.corpus, recipe.corpus.records_per_specimen, recipe.recording.converter
    reach = ranges(recipe)
    knocking = any(getattr(recipe.background, name) is not None for name in ("knocks", "impulses"))
    # a life grows one spall
    for number, fault in enumerate(recipe.faults):
        if not isinstance(fault, Spalls):
            yield f"faults[{number}].kind: {fault.kind} has no life; with life, use inner, outer and ball."
            return
        if fault.n_spalls.support()[1] > 1:
            yield f"faults[{number}].n_spalls: one spall grows in a life; leave n_spalls out."
        if fault.profile == "trace":
            yield f"faults[{number}].profile: a trace would stretch as its spall grows; use another profile."
        if reach[f"faults[{number}]"]["width_mm"][0] >= life.end.length_mm:
            yield f"faults[{number}].width_mm: a spall begins longer than life.end.length_mm; begin with 0.25 or so."
    # keys whose meaning a life takes over, or that would never act
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
        (not knocking and life.knocks_share.support()[0] < 1, "life.knocks_share",
         "it has no effect without knocks; give background.knocks or background.impulses"),
        (converter.kind == "adc" and (life.end.peak_m_s2 or 0) > converter.full_scale_m_s2, "life.end.peak_m_s2",
         "it is above the full scale of the converter and never reached; lower it"),
    ):  # fmt: skip
        if wrong:
            yield f"{place}: does not fit a life: {advice}."


def _loads(recipe: Sections, life: LifeSection) -> Iterator[str]:
    """Sentences about loads, speeds and bearings, and about snapshots that miss the lives that follow from them."""
    reach = ranges(recipe)
    bearing = recipe.bearing
    catalogue = isinstance(bearing, CatalogueBearing)
    bearings = bearing.bearings() if catalogue else [Bearing(bearing.designation, 0, math.nan, math.nan)]
    unrated = [bearing.designation for bearing in bearings if bearing.dynamic_rating is None]
    rated = [(bearing.dynamic_rating or math.nan, bearing.rolling_element) for bearing in bearings]
    for place, operation in recipe.operations().items():
        for key in ("load_n", "shaft_rpm"):
            quantity = getattr(operation, key)
            if quantity.per is None and quantity.support()[0] < quantity.support()[1]:
                yield f"{place}.{key}: varies from snapshot to snapshot; add per=specimen, and life has slow histories."
        if reach[place]["axial_load_n"][1] > 0:
            yield f"{place}.axial_load_n: lives are known under radial loads alone; leave it out."
        for name in unrated:
            yield f"bearing: {name} has no dynamic rating, which a life needs; docs/catalogue.md lists bearings that have one."
        # which bearing it is shows when it is drawn
        if operation.load_n.share_of == STATIC_RATING:
            continue  # known when it is drawn
        (lightest, heaviest), (slowest, fastest) = (reach[place][key] for key in ("load_n", "shaft_rpm"))
        weakest = heaviest / min(rating for rating, _ in rated)
        if weakest > 1 and not life.accelerated:
            yield (
                f"{place}.load_n: reaches {weakest:.3g} times the dynamic rating of the bearing; lower it, or say life.accelerated: true "
                f"for an overload test."
            )
        # half of the lives under the lightest load have ended by then
        latest = (
            max(_median(life, lightest / rating, element) for rating, element in rated) / to_si(slowest, "rpm") / _HOUR
        )
        earliest = (
            min(_hundredth(life, heaviest / rating, element) for rating, element in rated)
            / to_si(fastest, "rpm")
            / _HOUR
        )
        if life.cadence_h > latest:
            yield f"life.cadence_h: {life.cadence_h:g} h is longer than half of the lives, {latest:.3g} h; use a hundredth of it or so."
        # snapshots that end before any spall begins would all be healthy
        watched = min(life.withdrawal_h.support()[1], _horizon(recipe, life))
        if watched < earliest:
            yield (
                f"life: its end is never reached: the snapshots cover {watched:.4g} h, and one bearing of a hundred has a spall after "
                f"{earliest:.4g} h at the earliest; raise the cadence, the number of snapshots or the load."
            )


def _horizon(recipe: Sections, life: LifeSection) -> float:
    """Age behind the last snapshot at the latest [h]."""
    return life.entry_h.support()[1] + recipe.corpus.records_per_specimen * life.cadence_h


def _hundredth(life: LifeSection, ratio: float, element: Any) -> float:
    """Turns after which one bearing of a hundred has a spall, at the least, under a load over the dynamic rating [1]."""
    return rating_life(ratio, element, life.a_iso.support()[0]) * life_share(0.01, element)


def _median(life: LifeSection, ratio: float, element: Any) -> float:
    """Bound of the turns after which half of the bearings fail by the length of their spalls, under a load over the dynamic rating [1]."""
    slowest = to_si(life.growth_mm_per_mrev.support()[0], "mm_per_mrev")
    law = Growth(slowest, life.growth_exponent.support()[0], math.inf, 1.0)
    begun = rating_life(ratio, element, life.a_iso.support()[1]) * life_share(0.5, element)
    grown = drive_between(law, to_si(0.01, "mm"), to_si(life.end.length_mm, "mm"))
    return begun + grown / min(ratio**exponent for exponent in life.load_exponent.support())
