"""Loads that no bearing of a recipe can carry: even the smallest draw is beyond the static rating of the largest bearing."""

import math
from dataclasses import replace

from gen.physics.bearing import Bearing
from gen.physics.rating import LEAST_SAFETY, equivalent_load, static_rating
from gen.recipe.machine import CatalogueBearing, GeometryBearing, Specimen
from gen.recipe.operation import Operation, Profile, Steps, Table


def load_problem(bearing: CatalogueBearing | GeometryBearing, specimen: Specimen, operation: Operation) -> str | None:
    """Sentence that names the key, if every load that can be drawn is too high for every bearing that can be drawn."""
    strongest = max(_strongest(bearing), key=static_rating)
    limit = static_rating(strongest) / LEAST_SAFETY
    # the steepest contact angle takes the largest axial load
    steepest = max(
        abs(of_drawing + more) for of_drawing in _angles(bearing) for more in specimen.contact_angle_deg.support()
    )
    radial = operation.load_n.support()[0] * _least_peak(operation.load_profile)
    axial = operation.axial_load_n.support()[0]
    for key, load in (("load_n", radial), ("axial_load_n", equivalent_load(radial, axial, math.radians(steepest)))):
        if load > limit:
            return (
                f"operation.{key}: gives an equivalent static load of at least {load:.4g} N, and {limit:.4g} N, {1 / LEAST_SAFETY:g} times "
                f"the static rating of bearing {strongest.designation}, is the limit; lower the load or take a larger bearing."
            )
    return None


def _angles(bearing: CatalogueBearing | GeometryBearing) -> list[float]:
    """Contact angles on the drawings [deg], or the ends of their range."""
    if isinstance(bearing, CatalogueBearing):
        return [math.degrees(bearing.bearing(name).contact_angle) for name in bearing.designations]
    return [*bearing.contact_angle_deg.support()]


def _strongest(bearing: CatalogueBearing | GeometryBearing) -> list[Bearing]:
    """Bearings of which one has the highest static rating that can be drawn."""
    if isinstance(bearing, CatalogueBearing):
        return [bearing.bearing(name) for name in bearing.designations]
    fewest, most = (round(end) for end in bearing.n_balls.support())
    pitch, share = bearing.pitch_mm.support()[1] * 1e-3, bearing.ball_share.support()[1]
    low, high = bearing.contact_angle_deg.support()
    angle = math.radians(0.0 if low <= 0 <= high else min(abs(low), abs(high)))
    shortest, longest = (end * 1e-3 for end in bearing.roller_length_mm.support())
    found: list[Bearing] = []
    for count in range(fewest, most + 1):
        balls = Bearing(bearing.designation, count, pitch, bearing.largest_ball(count, pitch, share), angle)
        found += [balls] if shortest == 0 else []
        found += [replace(balls, rolling_element="roller", roller_length=longest)] if longest > 0 else []
    return found


def _least_peak(profile: Profile | None) -> float:
    """Smallest peak that a profile can have [1]."""
    if profile is None:
        return 1.0
    if isinstance(profile, Steps):
        return max(profile.levels_percent) / 100
    if isinstance(profile, Table):
        return max(profile.percent) / 100
    return max(profile.from_percent.support()[0], profile.to_percent.support()[0]) / 100
