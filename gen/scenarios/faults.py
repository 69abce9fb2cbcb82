"""Draw the damage of a specimen."""

from dataclasses import replace

from gen.drawing import Draws, Known
from gen.physics.bearing import Bearing, ball_spacing
from gen.recipe import BALL_SPACING, Fault
from gen.recipe.faults import BallFault, CageFault, CompoundFault, DistributedFault, Healthy, RaceFault
from gen.scenarios.model import Spall, Specimen, Wear
from gen.support.errors import RecipeError
from gen.support.units import to_si

_WIDEST = {"inner": 5.0, "outer": 5.0, "ball": 1.4}  # largest width of a spall over the radius of its surface


def draw_damage(draws: Draws, entry: Fault, specimen: Specimen, known: Known) -> Specimen:
    """Specimen with the fault of one ``faults`` entry of the recipe; ``known`` are the quantities of rig and specimen."""
    if isinstance(entry, Healthy):
        return specimen
    if isinstance(entry, DistributedFault):
        return replace(specimen, wear=Wear(entry.site, draws.section(entry, known)["waviness"], entry.order))
    for part in entry.parts if isinstance(entry, CompoundFault) else (entry,):
        specimen = _with_part(draws, part, specimen, known)
    return specimen


def _with_part(draws: Draws, part: RaceFault | BallFault | CageFault, specimen: Specimen, known: Known) -> Specimen:
    if isinstance(part, CageFault):
        return replace(specimen, cage=draws.section(part, known))
    if isinstance(part, RaceFault):
        known = {**known, BALL_SPACING: ball_spacing(specimen.bearing, part.kind)}
    spalls = specimen.spalls + _draw_spalls(draws, part, specimen.bearing, specimen.number, known)
    if isinstance(part, RaceFault):
        return replace(specimen, spalls=spalls)
    axis = draws.section(part, known)
    axis = {name: axis[name] for name in ("track", "axis_offset", "axis_wander")}
    if part.axis_jumps is not None:
        jumps = draws.section(part.axis_jumps)
        axis |= {"jumps": jumps["probability"], "spread": jumps["spread"]}
    return replace(specimen, spalls=spalls, axis=axis)


def _draw_spalls(
    draws: Draws, entry: RaceFault | BallFault, bearing: Bearing, specimen: int, known: Known
) -> tuple[Spall, ...]:
    carrier = int(draws.u() * bearing.n_balls)
    trace = tuple(to_si(depth, "um") for depth in entry.trace_um or ())
    spalls = []
    for _ in range(round(draws.value(entry.n_spalls))):
        drawn = draws.section(entry, known, ("width_mm", "depth_um", "angle_deg", "roughness_um"))
        edge = {} if entry.jagged_edge is None else draws.section(entry.jagged_edge)
        spalls.append(
            Spall(
                site=entry.kind,
                width=drawn["width"],
                depth=max(trace, default=drawn["depth"]),
                angle=drawn["angle"],
                ball=carrier,
                profile=entry.profile,
                trace=trace,
                roughness=drawn["roughness"],
                scatter=edge.get("scatter", 0.0),
            )
        )
        check_fits(spalls[-1], bearing, specimen)
    return tuple(spalls)


def check_fits(spall: Spall, bearing: Bearing, specimen: int) -> None:
    """Refuse a spall that is too wide for its race or ball."""
    radius = bearing.radius(spall.site)
    widest = _WIDEST[spall.site] * radius
    if spall.width > widest:
        raise RecipeError(
            f"specimen {specimen}: a spall of {spall.width * 1e3:g} mm does not fit the {spall.site} radius of {radius * 1e3:.3g} mm; "
            f"keep width_mm below {widest * 1e3:.3g}."
        )
