"""Refuse recipes whose smallest load is above the limit of their strongest bearing."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

from gen.drawing import Support
from gen.physics.bearing import Bearing
from gen.physics.rating import LEAST_SAFETY, equivalent_load, static_rating
from gen.recipe.machine import CatalogueBearing, GeometryBearing
from gen.recipe.operation import OperationSection, ProfileSection, Steps, Table
from gen.support.rounding import rounded_down
from gen.support.units import percent_to_share, to_si

Reach = Mapping[str, Mapping[str, Support]]
"""Ranges of :func:`gen.recipe.shares.ranges`."""


def load_problems(
    bearing: CatalogueBearing | GeometryBearing, operation: OperationSection, reach: Reach, place: str
) -> Iterator[str]:
    """Sentences if every load that can be drawn is too high for every bearing; ``place`` is the path of ``operation``."""
    strongest = max(_strongest(bearing, reach["bearing"]), key=static_rating)
    limit = static_rating(strongest) / LEAST_SAFETY
    # the steepest contact angle takes the largest axial load
    more = reach["specimen"]["contact_angle_deg"]
    steepest = max(abs(angle + deviation) for angle in contact_angles(bearing) for deviation in more)
    radial = reach[place]["load_n"][0] * _least_peak(operation.load_profile)
    both = equivalent_load(radial, reach[place]["axial_load_n"][0], to_si(steepest, "deg"))
    for key, load in (("load_n", radial), ("axial_load_n", both)):
        if load > limit:
            yield (
                f"{place}.{key}: gives an equivalent static load of at least {load:.4g} N, and {rounded_down(limit)} N, "
                f"{1 / LEAST_SAFETY:g} times the static rating of bearing {strongest.designation}, "
                "is the limit; lower the load or use a larger bearing."
            )


def contact_angles(bearing: CatalogueBearing | GeometryBearing) -> list[float]:
    """Contact angles on the drawings [deg], or the ends of their range."""
    if isinstance(bearing, CatalogueBearing):
        return [math.degrees(drawing.contact_angle) for drawing in bearing.bearings()]
    return [*bearing.contact_angle_deg.support()]


def _strongest(bearing: CatalogueBearing | GeometryBearing, reach: Mapping[str, Support]) -> list[Bearing]:
    """Candidates for the bearing with the highest static rating that can be drawn."""
    if isinstance(bearing, CatalogueBearing):
        return bearing.bearings()
    fewest, most = (round(end) for end in reach["n_balls"])
    pitch, largest = (to_si(reach[key][1], "mm") for key in ("pitch_diameter_mm", "ball_diameter_mm"))
    low, high = reach["contact_angle_deg"]
    # the static rating falls with the contact angle
    angle = to_si(0.0 if low <= 0 <= high else min(abs(low), abs(high)), "deg")
    shortest, longest = (to_si(end, "mm") for end in reach["roller_length_mm"])
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
