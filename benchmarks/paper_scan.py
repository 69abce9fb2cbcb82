"""Look for the one constant that makes a statement of the seed paper hold.

``python -m benchmarks.paper_scan`` varies one constant of each preset at a time, and prints for every statement that does not hold the
ranges of values with which it does, widest first. The experiments in raceway/studies/experiments.py were chosen from this list. It takes
about two minutes.
"""

import numpy as np

from raceway.studies.experiments import UNITS, changed, constant
from raceway.studies.paper import PRESETS, Preset, run, run_many
from raceway.studies.statements import findings

FACTORS = np.geomspace(0.1, 10, 121)
SPANS = {
    "half_clearance": np.linspace(-20e-6, 5e-6, 126),
    "ring_stiffness": np.geomspace(1e3, 1e8, 101),
    "unbalance": np.geomspace(1e-8, 1e-3, 101),
    "load_angle": np.linspace(-180, 177, 120),
    "shaft_rate": np.linspace(20, 100, 161),
}
"""Values of the constants that are not varied from a tenth to ten times their value."""

Ranges = list[tuple[float, float, int]]


def ranges(preset: Preset, name: str, values: np.ndarray) -> dict[str, Ranges]:
    """First value, last value and number of neighbouring values with which each statement holds, the most values first."""
    made = run_many([changed(preset, {name: float(value)}) for value in values])
    found = [findings("scan", each) for each in made]
    return {same[0].id: _neighbours(values, np.array([f.holds for f in same])) for same in zip(*found, strict=True)}


def _neighbours(values: np.ndarray, holds: np.ndarray) -> Ranges:
    places = np.flatnonzero(holds)
    groups = np.split(places, np.flatnonzero(np.diff(places) > 1) + 1) if len(places) else []
    return sorted(((float(values[g[0]]), float(values[g[-1]]), len(g)) for g in groups), key=lambda group: -group[2])


def main() -> None:
    """Print the ranges of every constant for every statement that does not hold."""
    for name, preset in PRESETS.items():
        failing = [f for f in findings(name, run(preset)) if not f.holds]
        names = [each for each in UNITS if each not in ("load_x", "load_y")]
        found = {each: ranges(preset, each, SPANS.get(each, constant(preset, each) * FACTORS)) for each in names}
        for failed in failing:
            print(f"{name} {failed.id}, {failed.finding}: {failed.value:.4g}")
            for each in names:
                shown = [f"{low:.4g} to {high:.4g} ({count})" for low, high, count in found[each][failed.id][:4]]
                print(f"  {each}, now {constant(preset, each):.4g} {UNITS[each]}: {', '.join(shown) or 'no value'}")


if __name__ == "__main__":
    main()
