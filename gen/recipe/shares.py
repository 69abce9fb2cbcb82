"""Quantities that are a share of another quantity: which can be named where, and the range of their product.

A quantity can be a share of one that is drawn before it or together with it: of its own section, or of a section of a level above
(rig, then specimen, then record). Both must be of the same kind of unit. Every share keeps its own random number; the product is taken
when all numbers are drawn, so that to make one quantity a share moves no other.
"""

import difflib
import re
from collections.abc import Iterator, Mapping

from gen.drawing import Section, Support, bounds_of, interval, is_within, quantities, sections_with_places
from gen.mechanisms.faults.bearing_fault import BALL_SPACING, RACES
from gen.recipe.machine import CatalogueBearing
from gen.recipe.sections import Sections
from gen.support.units import UNITS, split_unit, unit_suffix

BEARING_QUANTITIES = ("pitch_diameter_mm", "ball_diameter_mm")
"""Dimensions of the bearing of the rig, for sections below it."""
FREE_ANGLE = "free_contact_angle_deg"
STATIC_RATING, LEAST_AXIAL_LOAD = "static_rating_n", "least_axial_load_n"
Ranges = Mapping[str, Support | None]
"""Range of quantities by key, in the unit of the key; None if it is known only when the quantity is drawn."""
_DEPENDS_ON = {LEAST_AXIAL_LOAD: "load_n"}  # quantity of the same section
_COUNTS = ("n_balls", "n_spalls")
_HAVE_SHARES = "bearing, machine, machine.resonator, contact.lubricant, specimen, operation and faults"
_PLACES = {*_HAVE_SHARES.replace(" and ", ", ").split(", "), "faults.parts", "faults.operation"}
# units that measure the same; every other unit is of a kind of its own, and a quantity without a unit is a ratio
_KINDS = {"mm": "length", "um": "length", "nm": "length", "rpm": "rate", "hz": "rate", "percent": "ratio", "": "ratio"}
_WITHOUT_SHARES = ("db", "celsius")


def ranges(recipe: Sections) -> dict[str, dict[str, Support]]:
    """Range of every quantity, by its key and the place of its section; its bounds for a share that is known only when it is drawn.

    The places are those of the sections that can have shares.
    """
    return {
        place: {
            key: (bounds_of(type(section))[key]["low"], bounds_of(type(section))[key]["high"]) if ends is None else ends
            for key, ends in _ranges(section, above).items()
        }
        for place, section, above in _scopes(recipe)
    }


def share_problems(recipe: Sections) -> Iterator[str]:
    """Sentences about shares that cannot be; those after the first may be wrong."""
    # where there are shares at all
    for place, section in sections_with_places(recipe):
        kind = re.sub(r"\[\d+\]", "", place)
        for key, quantity in quantities(section).items():
            if quantity.share_of is not None and kind not in _PLACES:
                yield f"{place}.{key}: there are shares in {_HAVE_SHARES} alone; give the quantity a range of its own."
            if quantity.per is not None and not kind.endswith("operation"):
                yield f"{place}.{key}: per can be chosen for quantities of operation alone; leave it out."
    # what they name, and the range that follows
    for place, section, above in _scopes(recipe):
        own = quantities(section)
        for key, quantity in own.items():
            if quantity.share_of is not None:
                yield from (f"{place}.{key}: {problem}" for problem in _name_problems(recipe, section, above, key))
        for key, ends in _ranges(section, above).items():
            bounds = bounds_of(type(section))[key]
            for end in ends or ():
                if own[key].share_of is not None and not is_within(end, bounds, rounding=1e-12):
                    yield f"{place}.{key}: as a share of {own[key].share_of} it can be {end:g}, which is not in {interval(bounds)}."


def _scopes(recipe: Sections) -> Iterator[tuple[str, Section, Ranges]]:
    """Sections that can have shares with their places and the quantities of the levels above, in the order of drawing."""
    yield "machine", recipe.machine, {}
    machine = _ranges(recipe.machine, {})
    if recipe.machine.resonator is not None:
        yield "machine.resonator", recipe.machine.resonator, machine
    yield "bearing", recipe.bearing, {}
    if recipe.contact.lubricant is not None:
        yield "contact.lubricant", recipe.contact.lubricant, {}
    # quantities without a range of numbers, such as the free angle, are known when they are drawn
    rig = {**machine, **_bearing_ranges(recipe)}
    yield "specimen", recipe.specimen, {**rig, FREE_ANGLE: None}
    built = {**rig, **_ranges(recipe.specimen, {**rig, FREE_ANGLE: None})}
    for number, entry in enumerate(recipe.faults):
        for place, part in enumerate(entry.components):
            at = f"faults[{number}]" if part is entry else f"faults[{number}].parts[{place}]"
            yield at, part, {**built, BALL_SPACING: None} if part.part in RACES else built
    loads = {**built, STATIC_RATING: None, LEAST_AXIAL_LOAD: None}
    yield from ((place, operation, loads) for place, operation in recipe.operations().items())


def _bearing_ranges(recipe: Sections) -> dict[str, Support | None]:
    bearing = recipe.bearing
    if not isinstance(bearing, CatalogueBearing):
        return {"pitch_diameter_mm": _ranges(bearing, {})["pitch_diameter_mm"], "ball_diameter_mm": None}
    pitches, balls = zip(
        *((1e3 * drawing.pitch_diameter, 1e3 * drawing.ball_diameter) for drawing in bearing.bearings()), strict=True
    )
    return {"pitch_diameter_mm": (min(pitches), max(pitches)), "ball_diameter_mm": (min(balls), max(balls))}


def _ranges(section: Section, above: Ranges) -> dict[str, Support | None]:
    """Range of every quantity of a section."""
    own = quantities(section)

    def ends_of(key: str) -> Support | None:
        if key not in own:
            return above[key]
        share, named = own[key].support(), own[key].share_of
        if named is None:
            return share
        whole, factor = ends_of(named), split_unit(named)[1] / split_unit(key)[1]
        if whole is None:
            return None
        # a factor may be negative, so all products of ends are tried
        ends = [part * end * factor for part in share for end in whole]
        return min(ends), max(ends)

    return {key: ends_of(key) for key in own}


def _name_problems(recipe: Sections, section: Section, above: Ranges, key: str) -> Iterator[str]:
    """Sentences about a quantity that cannot be a share of the one that it names, or that is a share of itself."""
    own, unit = quantities(section), unit_suffix(key)
    named = own[key].share_of
    if key in _COUNTS or unit in _WITHOUT_SHARES:
        yield f"a {'count' if key in _COUNTS else f'value in {UNITS[unit].symbol}'} has no share; give it a range of its own."
    allowed = [name for name in (*own, *above) if name not in _COUNTS and name != key and _kind(name) == _kind(key)]
    if named not in (*allowed, key):
        advice = f"allowed are {', '.join(allowed)}" if allowed else "give the quantity a range of its own"
        near = difflib.get_close_matches(named, allowed, 1)
        if named in own or named in above:
            yield f"{named} is of another kind than {key}; {advice}."
        elif named in quantities(recipe.operation) or named in quantities(recipe.specimen):
            yield f"{named} is drawn after {key}, not with it or before it; {advice}."
        elif named in (FREE_ANGLE, BALL_SPACING, STATIC_RATING, LEAST_AXIAL_LOAD, *BEARING_QUANTITIES):
            yield f"{named} is not known here; {advice}."
        else:
            yield f"there is no quantity {named!r}; " + (f"did you mean {near[0]}?" if near else f"{advice}.")
    # a share of a share of itself would never end
    chain = [key]
    while (named := _DEPENDS_ON.get(share := own[chain[-1]].share_of, share)) in own and named not in chain[1:]:
        if named == key:
            yield f"{key} is a share of {', which is a share of '.join([*chain[1:], key])}; give one of them a range of its own."
            return
        chain.append(named)


def _kind(key: str) -> str:
    unit = unit_suffix(key)
    return _KINDS.get(unit, unit)
