"""Search for constants of the system of the seed paper with which more of its statements hold.

``python -m benchmarks.paper_search --seed 1`` varies the constants that the paper does not give, within physical bounds, by differential
evolution. It minimises the distance of the value of every fitted statement from its accepted range (the other statements were measured
later). With ``--hertz`` the contact stiffness follows from the geometry, the load is the weight of the rotor, and there is no spring across
the bearing. The result is a fit to the same statements that judge it: it shows that they can hold together, and nothing else.

``python -m benchmarks.paper_search --perturb`` does not search: it changes every constant of each known preset by up to 5 percent, 200
times, and prints how many of the fitted statements still hold.
"""

import argparse
import math
import sys

import numpy as np
from scipy.optimize import differential_evolution

from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import load_deflection_factor
from raceway.studies.paper import PRESETS, Preset, run_many
from raceway.studies.statements import Finding, findings

LOGARITHMIC = {
    "housing_mass": (3, 25), "ring_stiffness": (1e3, 1e6), "ring_damping": (50, 3000), "support_stiffness_x": (4e6, 6e7),
    "support_stiffness_y": (1e7, 8e7), "support_damping_x": (200, 1.2e4), "support_damping_y": (200, 1.2e4),
    "load_deflection_factor": (4e9, 1.2e10), "load": (30, 200), "unbalance": (1e-8, 1e-4),
}  # fmt: skip
LINEAR = {"half_clearance": (-12e-6, 1e-6), "load_angle": (-60, 60), "shaft_rate": (44.5, 51)}
NAMES = (*LOGARITHMIC, *LINEAR)
HERTZ = {
    "load_deflection_factor": load_deflection_factor(CATALOGUE["6205-paper"]),
    "load": 5.5 * 9.81,
    "ring_stiffness": 0.0,
}
CHANGE, DRAWS = 0.05, 200


def preset(x: np.ndarray, fixed: dict[str, float]) -> Preset:
    """Preset at a point of the unit cube; constants in ``fixed`` keep their values."""
    value: dict[str, float] = {
        name: math.exp(math.log(low) + u * math.log(high / low))
        for u, (name, (low, high)) in zip(x, LOGARITHMIC.items(), strict=False)
    }
    value |= {
        name: low + u * (high - low)
        for u, (name, (low, high)) in zip(x[len(LOGARITHMIC) :], LINEAR.items(), strict=True)
    }
    value |= fixed
    load, angle = value.pop("load"), math.radians(value.pop("load_angle"))
    return Preset(**value, load_x=load * math.cos(angle), load_y=load * math.sin(angle))


def missed(found: list[Finding]) -> float:
    """Sum over the fitted statements of their distances from the accepted range, at most 1 each."""
    return sum(_miss(f.value, *f.accept) for f in found if f.fitted)


def _miss(value: float, low: float, high: float) -> float:
    if low <= value <= high:
        return 0.0
    if not math.isfinite(value):
        return 1.0
    edge = low if value < low else high
    scale = high - low if math.isfinite(high - low) else max(abs(low), 1.0)
    return 0.3 + 0.7 * min(abs(value - edge) / scale, 1.0)


def holding(known: Preset, seed: int, draws: int = DRAWS) -> np.ndarray:
    """Number of fitted statements that hold with every constant of a preset changed by up to ``CHANGE``, shape (draw,)."""
    factors = np.random.default_rng(seed).uniform(1 - CHANGE, 1 + CHANGE, (draws, len(known)))
    made = run_many([Preset(*(np.array(known) * factor).tolist()) for factor in factors])
    return np.array([sum(f.holds for f in findings("perturbed", each) if f.fitted) for each in made])


def main() -> None:
    """Search and print the best preset, or perturb the known presets and print the numbers of statements that hold."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--generations", type=int, default=150)
    parser.add_argument("--population", type=int, default=128)
    parser.add_argument("--hertz", action="store_true")
    parser.add_argument("--perturb", action="store_true")
    options = parser.parse_args()
    if options.perturb:
        for name, known in PRESETS.items():
            held = holding(known, options.seed)
            print(f"{name}: {held.min()} to {held.max()}, mean {held.mean():.1f}", flush=True)
        return
    fixed = HERTZ if options.hertz else {}

    def cost(points: np.ndarray) -> np.ndarray:
        made = run_many([preset(x, fixed) for x in points.T])
        return np.array([missed(findings("search", each)) for each in made])

    def report(intermediate_result) -> None:
        best = [f for f in findings("search", run_many([preset(intermediate_result.x, fixed)])[0]) if f.fitted]
        failing = ", ".join(f"{f.id}={f.value:.4g}" for f in best if not f.holds)
        print(
            f"{intermediate_result.fun:.3f}: {sum(f.holds for f in best)} of {len(best)}; not {failing}",
            file=sys.stderr,
            flush=True,
        )

    found = differential_evolution(
        cost, [(0, 1)] * len(NAMES), vectorized=True, updating="deferred", popsize=1, rng=options.seed,
        init=np.random.default_rng(options.seed).random((options.population, len(NAMES))), maxiter=options.generations,
        tol=0, polish=False, mutation=(0.4, 0.9), recombination=0.8, callback=report,
    )  # fmt: skip
    print(preset(found.x, fixed))


if __name__ == "__main__":
    main()
