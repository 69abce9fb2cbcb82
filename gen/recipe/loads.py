"""Refuse recipes whose smallest load is above the limit of their strongest bearing."""

import math
from dataclasses import replace

from gen.physics.bearing import Bearing
from gen.physics.rating import LEAST_SAFETY, equivalent_load, static_rating
from gen.recipe.machine import CatalogueBearing, GeometryBearing, SpecimenSection
from gen.recipe.operation import OperationSection, ProfileSection, Steps, Table
from gen.support.units import percent_to_share, to_si


def load_problem(
    bearing: CatalogueBearing | GeometryBearing, specimen: SpecimenSection, operation: OperationSection, place: str
) -> str | None:
    """Error sentence if every load that can be drawn is too high for every bearing that can be drawn, else None.

    ``place`` is the path of ``operation`` in the recipe.
    """
    strongest = max(_strongest(bearing), key=static_rating)
    limit = static_rating(strongest) / LEAST_SAFETY
    # the steepest contact angle takes the largest axial load
    steepest = max(
        abs(of_drawing + more) for of_drawing in _angles(bearing) for more in specimen.contact_angle_deg.support()
    )
    radial = operation.load_n.support()[0] * _least_peak(operation.load_profile)
    axial = operation.axial_load_n.support()[0]
    for key, load in (("load_n", radial), ("axial_load_n", equivalent_load(radial, axial, to_si(steepest, "deg")))):
        if load > limit:
            return (
                f"{place}.{key}: gives an equivalent static load of at least {load:.4g} N, and {limit:.4g} N, {1 / LEAST_SAFETY:g} times "
                f"the static rating of bearing {strongest.designation}, is the limit; lower the load or use a larger bearing."
            )
    return None


def _angles(bearing: CatalogueBearing | GeometryBearing) -> list[float]:
    """Contact angles on the drawings [deg], or the ends of their range."""
    if isinstance(bearing, CatalogueBearing):
        return [math.degrees(bearing.bearing(name).contact_angle) for name in bearing.designations]
    return [*bearing.contact_angle_deg.support()]


def _strongest(bearing: CatalogueBearing | GeometryBearing) -> list[Bearing]:
    """Candidates for the bearing with the highest static rating that can be drawn."""
    if isinstance(bearing, CatalogueBearing):
        return [bearing.bearing(name) for name in bearing.designations]
    fewest, most = (round(end) for end in bearing.n_balls.support())
    pitch, given = to_si(bearing.pitch_diameter_mm.support()[1], "mm"), bearing.ball_diameter_mm
    largest = given.own_support()[1] * pitch if given.share_of is not None else to_si(given.support()[1], "mm")
    low, high = bearing.contact_angle_deg.support()
    angle = to_si(0.0 if low <= 0 <= high else min(abs(low), abs(high)), "deg")
    shortest, longest = (to_si(end, "mm") for end in bearing.roller_length_mm.support())
    candidates: list[Bearing] = []
    for count in range(fewest, most + 1):
        balls = Bearing(bearing.designation, count, pitch, bearing.fitting_ball(count, pitch, largest), angle)
        candidates += [balls] if shortest == 0 else []
        candidates += [replace(balls, rolling_element="roller", roller_length=longest)] if longest > 0 else []
    return candidates


def _least_peak(profile: ProfileSection | None) -> float:
    """Smallest peak that a profile can have [1]."""
    if profile is None:
        return 1.0
    if isinstance(profile, Steps):
        return percent_to_share(max(profile.levels_percent))
    if isinstance(profile, Table):
        return percent_to_share(max(profile.percent))
    return percent_to_share(max(profile.from_percent.support()[0], profile.to_percent.support()[0]))
