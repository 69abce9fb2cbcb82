"""Severity of a spall against what it adds to a record: what grows with width and load, and what does not.

``python -m benchmarks.severity`` prints two tables. The first is for the reference machine of :mod:`benchmarks.visibility`: rms and
kurtosis of the difference between a record and its twin without the spall, medians over the seeds; a star marks a spall that unloads the
ball. The second is the share of spalls of a recipe that do. A ball is unloaded if it drops further than the rings are pressed together
where the other balls carry the whole load, in static equilibrium: a deeper spall then changes no force any more.
"""

import argparse
import math
from collections import Counter

import numpy as np
from scipy.stats import kurtosis

from benchmarks.visibility import DEEP, TURNING, FloatArray, reference_recipe
from gen.physics.bearing import Bearing
from gen.physics.rotor import Machine, as_columns, ball_forces, rest
from gen.recipe import find_recipe, read_recipe
from gen.scenarios import Scenario, draw_scenarios, settings_of
from gen.simulation.damage import largest_drop_over
from gen.simulation.inputs import bare_inputs, only
from gen.simulation.simulate import simulate
from gen.simulation.timeline import timeline
from gen.support.errors import SimulationError

WIDTHS = (0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0)
LOADS = (100, 300, 1000, 2000)
SECONDS = 2.0


def contributions(
    kind: str, width_mm: float, n_seeds: int, seconds: float = SECONDS, depth_um: float = DEEP, **operation: float
) -> FloatArray:
    """What a spall on the ``inner`` or ``outer`` race adds to the records of the seeds, shape (seed, time) [m s-2]."""
    fault = {"kind": kind, "width_mm": width_mm, "depth_um": depth_um}
    if kind == "inner":
        fault["angle_deg"] = TURNING
    recipe = reference_recipe(fault, n_seeds, operation=operation, recording={"duration_s": seconds})
    scenarios = draw_scenarios(recipe)
    response = simulate(scenarios + [scenario.without_fault() for scenario in scenarios]).acceleration
    damaged, healthy = response[:, 0, timeline(settings_of(recipe)).kept].astype(float).reshape(2, n_seeds, -1)
    return damaged - healthy


def unloading_drop(machine: Machine, bearing: Bearing, angle: float) -> float:
    """Drop at which the ball at ``angle`` [rad] carries nothing, in static equilibrium; NaN if it carries nothing without a spall [m]."""
    of_one = as_columns([machine])
    balls = angle + 2 * np.pi * np.arange(bearing.n_balls)[None] / bearing.n_balls
    without = rest(of_one, balls)
    if ball_forces(of_one, without[:, :2] - without[:, 2:], balls)[0][0, 0] <= 0:
        return math.nan
    pressed = rest(of_one, balls[:, 1:])
    along = (pressed[0, :2] - pressed[0, 2:]) @ (math.cos(angle), math.sin(angle))
    return float(along * machine.contact_cosine - machine.half_clearance)


def unloading_length(kind: str, drop: float, bearing: Bearing) -> float:
    """Distance from the edge of a spall at which a rigid ball has dropped so far [m]."""
    race = bearing.inner_radius if kind == "inner" else -bearing.outer_radius
    return math.sqrt(2 * drop / (1 / bearing.radius("ball") + 1 / race))


def unloads(scenario: Scenario, number: int = 0) -> bool | None:
    """Whether a spall takes all load from a ball; None if no ball carries load where the spall is, or no such machine is possible.

    A spall that turns, on the inner race or on a ball, is taken where the load is largest.
    """
    try:
        machine = only(bare_inputs([scenario])).machine
    except (SimulationError, ValueError):
        return None
    spall = scenario.specimen.spalls[number]
    angle = scenario.rig.machine["load_angle"] + (spall.angle if spall.site == "outer" else 0.0)
    needed = unloading_drop(machine, scenario.specimen.bearing, angle)
    return None if math.isnan(needed) else largest_drop_over(scenario, number) >= needed


def shares(recipe_name: str, n_records: int) -> dict[str, tuple[int, int, int]]:
    """Spalls per site that unload a ball, that do not, and that meet no load, over the first specimens of a recipe."""
    counts: Counter[tuple[str, bool | None]] = Counter()
    for scenario in draw_scenarios(read_recipe(find_recipe(recipe_name)), 0, n_records):
        for number, spall in enumerate(scenario.specimen.spalls):
            counts[spall.site, unloads(scenario, number)] += 1
    sites = sorted({site for site, _ in counts})
    return {site: (counts[site, True], counts[site, False], counts[site, None]) for site in sites}


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--recipe", default="domain_randomised")
    parser.add_argument("--records", type=int, default=2000)
    options = parser.parse_args()
    columns = [(kind, load) for kind in ("outer", "inner") for load in LOADS]
    print("| width [mm] |", " | ".join(f"{kind} {load} N" for kind, load in columns), "|")
    print("|---|" + "---:|" * len(columns))
    for width in WIDTHS:
        cells = [_cell(kind, width, load, options.seeds) for kind, load in columns]
        print(f"| {width:g} |", " | ".join(cells), "|", flush=True)
    print("| unloads from |", " | ".join(f"{1e3 * narrowest(kind, load):.2f} mm" for kind, load in columns), "|\n")
    print(
        f"| spalls of {options.recipe} | number | unload a ball [%] | of those that meet load [%] |\n|---|---:|---:|---:|"
    )
    for site, (yes, no, unmet) in shares(options.recipe, options.records).items():
        print(f"| {site} | {yes + no + unmet} | {100 * yes / (yes + no + unmet):.0f} | {100 * yes / (yes + no):.0f} |")


def narrowest(kind: str, load_n: float) -> float:
    """Width from which on a spall in the direction of the load unloads a ball of the reference machine [m]."""
    scenario = _reference(kind, 1.0, load_n)
    drop = unloading_drop(
        only(bare_inputs([scenario])).machine, scenario.specimen.bearing, scenario.rig.machine["load_angle"]
    )
    return 2 * unloading_length(kind, drop, scenario.specimen.bearing)


def _reference(kind: str, width_mm: float, load_n: float) -> Scenario:
    return draw_scenarios(reference_recipe({"kind": kind, "width_mm": width_mm}, 1, operation={"load_n": load_n}))[0]


def _cell(kind: str, width_mm: float, load_n: float, n_seeds: int) -> str:
    found = contributions(kind, width_mm, n_seeds, load_n=load_n)
    star = "*" if unloads(_reference(kind, width_mm, load_n)) else ""
    rms = np.median(np.sqrt(np.mean(found**2, axis=1)))
    return f"{rms:.3g} ({np.median(kurtosis(found, axis=1, fisher=False)):.0f}){star}"


if __name__ == "__main__":
    main()
