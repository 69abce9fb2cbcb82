"""Order of the Runge-Kutta steps: four if the force is smooth within a step, less if it is not.

If the force has only ``p`` continuous derivatives at an event, the step over it has an error of the step size to the power ``p + 2`` in the
rate [1]_; if the force rises from zero as the power 3/2 of time, the power is 5/2. The place of an event within its step is random, and
so is its error at one step size: orders are slopes of medians over as many random starts as there are lanes. From 96 kHz on the errors of
events are larger than those of the smooth motion.

.. [1] E. Hairer, S. P. Norsett, G. Wanner, *Solving Ordinary Differential Equations I*, 2nd ed., Springer, 1993, section II.6.
"""

import numpy as np
import pytest

from gen.physics.kernel.compiling import LANES
from gen.physics.kernel_input import Spall, Turning
from tests.lanes import march_lanes
from tests.strategies import RIG, record

KNOT = 1 / 12_000
N_KNOTS = 240  # 20 ms
STEPS = [2, 4, 8, 16, 32]  # per knot: 24 to 384 kHz
EXACT = 256
# Half the clearance [m], the profile of the spalls, and the order in theory. With preload the contacts are never lost, so that
# spalls are the only events.
CASES = {
    "smooth": (-12e-6, None, 4.0),
    "make and break": (5e-6, None, 2.5),
    "geometric": (-12e-6, "geometric", 2.0),
    "half sine": (-12e-6, "half_sine", 2.0),
    "raised cosine": (-12e-6, "raised_cosine", 3.0),
    "rectangular": (-12e-6, "rectangular", 1.0),
}


def errors(case, seed=0):
    """Largest error of a position at any knot, shape (step size, start) [m]."""
    half_clearance, profile, _ = CASES[case]
    rng = np.random.default_rng(seed)
    some = []
    for _ in range(LANES):
        shaft, cage, inner = rng.uniform(-np.pi, np.pi, 3)
        motion = Turning(rng.uniform(25, 35), unbalance=2.75e-5, shaft_angle=shaft, cage_angle=cage)
        spalls = [Spall("inner", 0.53e-3, 5e-6, inner, 0, profile), Spall("outer", 0.36e-3, 5e-6, -1.5, 0, profile)]
        some.append(record(RIG._replace(half_clearance=half_clearance), motion, spalls if profile else ()))
    marches = ([trip.states[:, :6] for trip in march_lanes(some, N_KNOTS, n, KNOT)] for n in [EXACT, *STEPS])
    exact, *coarse = map(np.array, marches)
    return np.array([np.abs(trips - exact).max(axis=(1, 2)) for trips in coarse])


def order(errors_found, steps):
    """Slope of the median error over the step, for ``found`` of the shape (step size, start)."""
    return -np.polyfit(np.log(steps), np.log(np.median(errors_found, axis=1)), 1)[0]


@pytest.mark.parametrize("case", CASES)
def test_the_error_falls_with_the_order_that_the_events_of_a_trajectory_leave(case):
    fine = slice(2, None)  # 96 to 384 kHz; medians of 32 starts scatter by 0.1
    assert order(errors(case)[fine], STEPS[fine]) == pytest.approx(CASES[case][2], abs=0.25)
