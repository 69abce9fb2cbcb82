"""Draw bearings: that of a rig, its deviations as built, and the one at the other end of the shaft.

The other bearing has random streams of its own, so that it moves no other drawn value and does not depend on the class of a record.
"""

import functools
import math
from collections.abc import Callable
from dataclasses import replace

from gen.drawing import Drawn, Draws, Known, known_of, weighted_index
from gen.mechanisms.faults.bearing_fault import draw_damage
from gen.physics.bearing import Bearing, free_contact_angle
from gen.recipe import FREE_ANGLE, CatalogueBearing, Recipe, fault_class
from gen.recipe.machine import named_bearing
from gen.scenarios.model import OTHER_STREAMS, OtherBearing, Purpose, Rig, Specimen, stream
from gen.support.errors import RecipeError
from gen.support.units import decibel_to_ratio

STEEPEST_CONTACT = math.radians(45)


def draw_bearing(recipe: Recipe, draws: Draws) -> Bearing:
    """Bearing of a rig, as on its drawing."""
    chosen = recipe.bearing
    if isinstance(chosen, CatalogueBearing):
        return chosen.bearing(chosen.designations[int(draws.u() * len(chosen.designations))])
    drawn = draws.section(chosen)
    n_balls = round(drawn["n_balls"])
    rollers = drawn["roller_length"]
    return Bearing(
        designation=chosen.designation,
        n_balls=n_balls,
        pitch_diameter=drawn["pitch_diameter"],
        ball_diameter=chosen.fitting_ball(n_balls, drawn["pitch_diameter"], drawn["ball_diameter"]),
        contact_angle=drawn["contact_angle"],
        rolling_element="roller" if rollers > 0 else "ball",
        roller_length=rollers or None,
    )


def draw_as_built(recipe: Recipe, drawing: Bearing, known: Known, draws: Draws) -> tuple[Bearing, Drawn]:
    """Bearing of a specimen and its drawn properties; ``known`` are the quantities of its rig.

    Raises
    ------
    RecipeError
        If its contact angle is too large.
    """
    properties = draws.section(recipe.specimen, {**known, FREE_ANGLE: functools.partial(_free_angle, drawing)})
    bearing = replace(
        drawing,
        contact_angle=drawing.contact_angle + properties["contact_angle"],
        inner_conformity=properties["inner_conformity"],
        outer_conformity=properties["outer_conformity"],
    )
    if abs(bearing.contact_angle) > STEEPEST_CONTACT:
        raise RecipeError(
            f"{draws.item}: a contact angle of {math.degrees(bearing.contact_angle):.3g} degrees is too large for a radial bearing; "
            f"keep the angles of bearing and specimen together below {math.degrees(STEEPEST_CONTACT):.0f}."
        )
    return bearing, properties


def _free_angle(bearing: Bearing, value: Callable[[str], float]) -> float:
    """Free contact angle of a bearing with the clearance and the grooves of a specimen [rad]; 0 if its drawing has a contact angle."""
    if bearing.contact_angle != 0:
        return 0.0
    inner, outer = value("inner_conformity"), value("outer_conformity")
    grooved = replace(bearing, inner_conformity=inner, outer_conformity=outer)
    return free_contact_angle(grooved, value("diametral_clearance_um"))


def draw_other_bearing(recipe: Recipe, rig: Rig, specimen: Specimen, fault: str) -> OtherBearing | None:
    """The bearing at the other end of the shaft, with its fault class, during the records of a specimen; None if the recipe has none.

    Raises
    ------
    RecipeError
        If its contact angle is too large, or a drawn spall does not fit it.
    """
    wanted = recipe.other_bearing
    if wanted is None:
        return None

    def draws(of: int, purpose: Purpose) -> Draws:
        rng = stream(recipe.seed, rig.number, of, 0, purpose)
        return Draws(rng, rig.number, f"other bearing of specimen {specimen.number}")

    own = OTHER_STREAMS + specimen.number
    mount = draws(0, Purpose.OTHER_BEARING).section(wanted)
    drawing = rig.bearing if wanted.bearing is None else named_bearing(wanted.bearing, recipe.own_bearings)
    known = known_of_rig(recipe, replace(rig, bearing=drawing))
    bearing, properties = draw_as_built(recipe, drawing, known, draws(own, Purpose.SPECIMEN))
    other = Specimen(specimen.number, bearing, properties, "healthy", (), {}, specimen.split)
    if fault != "healthy":
        of_fault = draws(own, Purpose.FAULT)
        faults = [place for place, entry in enumerate(recipe.faults) if fault_class(entry) == fault]
        entry = faults[weighted_index(tuple(recipe.faults[place].weight for place in faults), of_fault.u())]
        known = {**known, **known_of(recipe.specimen, properties)}
        spalls, damage = draw_damage(recipe.faults[entry].components, of_fault, bearing, known)
        other = replace(other, fault=fault, entry=entry, spalls=spalls, damage=damage)
    return OtherBearing(drawing, other, mount["load"], decibel_to_ratio(-mount["attenuation"]))


def known_of_rig(recipe: Recipe, rig: Rig) -> dict[str, float]:
    """Quantities of a rig that those of its specimens and records can be a share of [SI]."""
    dimensions = {"pitch_diameter_mm": rig.bearing.pitch_diameter, "ball_diameter_mm": rig.bearing.ball_diameter}
    return {**known_of(recipe.machine, rig.machine), **dimensions}
