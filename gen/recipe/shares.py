"""Quantities that are a share of another quantity: which can be named where, and the range of their product.

A quantity can be a share of one that is drawn before it or together with it: of its own section, or of a section of a level above
(rig, then specimen, then record). Both must be of the same kind of unit. Every share keeps its own random number; the product is taken
when all numbers are drawn, so that to make one quantity a share moves no other.
"""

import difflib
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from gen.drawing import Section, Support, interval, is_within, quantities
from gen.mechanisms.faults.bearing_fault import BALL_SPACING, RACES
from gen.recipe.machine import CatalogueBearing
from gen.recipe.operation import OperationSection
from gen.recipe.sections import Sections
from gen.support.units import UNITS, unit_suffix

BEARING_QUANTITIES = ("pitch_diameter_mm", "ball_diameter_mm")
"""Dimensions of the bearing of the rig, for sections below it."""
FREE_ANGLE = "free_contact_angle_deg"
STATIC_RATING, LEAST_AXIAL_LOAD = "static_rating_n", "least_axial_load_n"
_DEPENDS_ON = {LEAST_AXIAL_LOAD: "load_n"}  # quantity of the same section
_COUNTS = ("n_balls", "n_spalls")
_HAVE_SHARES = "bearing, machine, machine.resonator, contact.lubricant, specimen, operation and faults"
# units that measure the same; every other unit is of a kind of its own, and a quantity without a unit is a ratio
_KINDS = {"mm": "length", "um": "length", "nm": "length", "rpm": "rate", "hz": "rate", "percent": "ratio", "": "ratio"}
_WITHOUT_SHARES = ("db", "celsius")


class _Scope(NamedTuple):
    """A section with quantities that can be shares, and what they can name beside its own."""

    place: str
    section: Section
    above: Mapping[str, Support | None]
    """Range of every quantity of the levels above, in the unit of its key; None if it is not known before it is drawn."""


def share_problem(recipe: Sections) -> str | None:
    """Error sentence about the first share that cannot be, else None; gives every share of the recipe the range of its product."""
    problem = _misplaced(recipe, {id(scope.section) for scope in _scopes(recipe)})
    for scope in _scopes(recipe):
        problem = problem or _scope_problem(recipe, scope)
        if problem is None:
            _set_products(scope, quantities(scope.section))
    for number, entry in enumerate(recipe.faults):
        if entry.operation is not None:
            changed = _Scope(f"faults[{number}].operation", recipe.operation_of(number), _above_records(recipe))
            problem = problem or _scope_problem(recipe, changed)
    return problem


def operations(recipe: Sections) -> dict[str, OperationSection]:
    """Operating conditions by their place in the recipe, of all records and of every fault with changes of its own.

    Their shares have the range of their product.
    """
    by_place = {"operation": recipe.operation}
    for number, entry in enumerate(recipe.faults):
        if entry.operation is not None:
            scope = _Scope("operation", recipe.operation_of(number), _above_records(recipe))
            shares = {key: quantities(scope.section)[key].model_copy() for key in _products(scope)}
            _set_products(scope, shares)
            by_place[f"faults[{number}].operation"] = recipe.operation_of(number).model_copy(update=shares)
    return by_place


def _set_products(scope: _Scope, shares: Mapping[str, Any]) -> None:
    for key, product in _products(scope).items():
        bounds = _bounds(scope.section, key)
        shares[key].set_product(product, (bounds["low"], bounds["high"]))


def _bounds(section: Section, key: str) -> Any:
    return type(section).model_fields[key].json_schema_extra


def _scopes(recipe: Sections) -> Iterator[_Scope]:
    """Sections with shares, in the order of drawing; the ranges of one are read after the one before it has its products."""
    yield _Scope("machine", recipe.machine, {})
    machine = _supports(recipe.machine)
    if recipe.machine.resonator is not None:
        yield _Scope("machine.resonator", recipe.machine.resonator, machine)
    yield _Scope("bearing", recipe.bearing, {})
    if recipe.contact.lubricant is not None:
        yield _Scope("contact.lubricant", recipe.contact.lubricant, {})
    rig = {**machine, **_bearing_supports(recipe)}
    yield _Scope("specimen", recipe.specimen, {**rig, FREE_ANGLE: None})
    for number, entry in enumerate(recipe.faults):
        for place, part in enumerate(entry.components):
            at = f"faults[{number}]" if part is entry else f"faults[{number}].parts[{place}]"
            spacing = {BALL_SPACING: None} if part.part in RACES else {}
            yield _Scope(at, part, {**rig, **_supports(recipe.specimen), **spacing})
    yield _Scope("operation", recipe.operation, _above_records(recipe))


def _numbered(place: str, sections: tuple[Any, ...]) -> list[tuple[str, Any]]:
    return [(f"{place}[{number}]", section) for number, section in enumerate(sections)]


def _above_records(recipe: Sections) -> dict[str, Support | None]:
    loads = {STATIC_RATING: None, LEAST_AXIAL_LOAD: None}
    return {**_supports(recipe.machine), **_bearing_supports(recipe), **_supports(recipe.specimen), **loads}


def _supports(section: Section) -> dict[str, Support | None]:
    """Range of every quantity of a section; None for a share whose product is not known."""
    return {key: quantity.known_support() for key, quantity in quantities(section).items()}


def _bearing_supports(recipe: Sections) -> dict[str, Support | None]:
    bearing = recipe.bearing
    if not isinstance(bearing, CatalogueBearing):
        return {"pitch_diameter_mm": _supports(bearing)["pitch_diameter_mm"], "ball_diameter_mm": None}
    bearings = [bearing.bearing(name) for name in bearing.designations]
    pitches, balls = ([1e3 * getattr(one, key) for one in bearings] for key in ("pitch_diameter", "ball_diameter"))
    return {"pitch_diameter_mm": (min(pitches), max(pitches)), "ball_diameter_mm": (min(balls), max(balls))}


def _misplaced(recipe: Sections, with_shares: set[int]) -> str | None:
    """Error sentence about a share, or a value per rig or specimen, in a section that has none."""
    for place, section in _sections("", recipe):
        operating = isinstance(section, OperationSection) or place.endswith("].operation")
        for key, quantity in quantities(section).items():
            at = f"{place}.{key}"
            if quantity.share_of is not None and id(section) not in with_shares and not operating:
                return f"{at}: there are shares in {_HAVE_SHARES} alone; give the quantity a range of its own."
            if quantity.per is not None and not operating:
                return f"{at}: the level of a draw can be chosen for quantities of operation alone; leave per out."
    return None


def _sections(place: str, section: Section) -> Iterator[tuple[str, Section]]:
    """Every section of a recipe with its place."""
    if place:
        yield place, section
    for key, value in section:
        below = f"{place}.{key}" if place else key
        if isinstance(value, Section):
            yield from _sections(below, value)
        for at, item in _numbered(below, value) if isinstance(value, tuple) else []:
            if isinstance(item, Section):
                yield from _sections(at, item)


def _scope_problem(recipe: Sections, scope: _Scope) -> str | None:
    own = quantities(scope.section)
    for key, quantity in own.items():
        if quantity.share_of is not None:
            problem = _name_problem(recipe, scope, key, quantity.share_of) or _loop(scope, key)
            if problem is not None:
                return problem
    for key, product in _products(scope).items():
        bounds = _bounds(scope.section, key)
        for end in product or ():
            if not is_within(end, bounds) and not _is_rounding(end, bounds):
                return f"{scope.place}.{key}: as a share of {own[key].share_of} it can be {end:g}, which is not in {interval(bounds)}."
    return None


def _is_rounding(end: float, bounds: dict[str, Any]) -> bool:
    return is_within(end * (1 - 1e-12), bounds) or is_within(end * (1 + 1e-12), bounds)


def _name_problem(recipe: Sections, scope: _Scope, key: str, named: str) -> str | None:
    """Error sentence if a quantity cannot be a share of the one that it names, else None."""
    own = quantities(scope.section)
    unit, at = unit_suffix(key), f"{scope.place}.{key}"
    if key in _COUNTS or unit in _WITHOUT_SHARES:
        kind = "count" if key in _COUNTS else f"value in {UNITS[unit].symbol}"
        return f"{at}: a {kind} has no share; give it a range of its own."
    allowed = [
        name for name in (*own, *scope.above) if name not in _COUNTS and name != key and _kind(name) == _kind(key)
    ]
    if named in allowed or named == key:
        return None
    advice = f"allowed are {', '.join(allowed)}" if allowed else "give the quantity a range of its own"
    if named in own or named in scope.above:
        return f"{at}: {named} is of another kind than {key}; {advice}."
    if named in quantities(recipe.operation) or named in quantities(recipe.specimen):
        return f"{at}: {named} is drawn after {key}, not with it or before it; {advice}."
    if named in (FREE_ANGLE, BALL_SPACING, STATIC_RATING, LEAST_AXIAL_LOAD, *BEARING_QUANTITIES):
        return f"{at}: {named} is not known here; {advice}."
    near = difflib.get_close_matches(named, allowed, 1)
    return f"{at}: there is no quantity {named!r}; " + (f"did you mean {near[0]}?" if near else f"{advice}.")


def _kind(key: str) -> str:
    unit = unit_suffix(key)
    return _KINDS.get(unit, unit)


def _loop(scope: _Scope, key: str) -> str | None:
    """Error sentence if a quantity is a share of itself, through others or not, else None."""
    own, chain = quantities(scope.section), [key]
    while (named := _DEPENDS_ON.get(share := own[chain[-1]].share_of, share)) in own:
        if named == key:
            round_trip = ", which is a share of ".join([*chain[1:], key])
            return f"{scope.place}.{key}: {key} is a share of {round_trip}; give one of them a range of its own."
        if named in chain:
            return None  # a loop that the key is not part of
        chain.append(named)
    return None


def _products(scope: _Scope) -> dict[str, Support | None]:
    """Range of every share of a section, in the unit of its key; None if it is not known before it is drawn."""
    own = quantities(scope.section)

    def support(key: str) -> Support | None:
        if key not in own:
            return scope.above[key]
        share, named = own[key].own_support(), own[key].share_of
        if named is None:
            return share
        whole = support(named)
        if whole is None:
            return None
        factor = _factor(named) / _factor(key)
        ends = [part * end * factor for part in share for end in whole]
        return min(ends), max(ends)

    return {key: support(key) for key, quantity in own.items() if quantity.share_of is not None}


def _factor(key: str) -> float:
    unit = unit_suffix(key)
    return UNITS[unit].factor if unit else 1.0
