"""Draw bearings: that of a rig, and its deviations as built."""

import functools
import math
from collections.abc import Callable
from dataclasses import replace

from gen.drawing import Drawn, Draws, Known, known_of
from gen.physics.bearing import Bearing, free_contact_angle
from gen.recipe import FREE_ANGLE, CatalogueBearing, Recipe
from gen.scenarios.model import Rig
from gen.support.errors import RecipeError

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


def known_of_rig(recipe: Recipe, rig: Rig) -> dict[str, float]:
    """Quantities of a rig that those of its specimens and records can be a share of [SI]."""
    dimensions = {"pitch_diameter_mm": rig.bearing.pitch_diameter, "ball_diameter_mm": rig.bearing.ball_diameter}
    return {**known_of(recipe.machine, rig.machine), **dimensions}
