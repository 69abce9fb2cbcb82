"""The kernel compared with general tools: NumPy over a batch, and ``solve_ivp`` of SciPy.

Both integrate the records of the seed recipe with one right-hand side, which covers the seed model only.
"""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.kernel import SEED, UNIT, kernel_rate, step_seconds
from benchmarks.pairs import Line, cpu_seconds, interleaved, row
from benchmarks.seed import N_BALLS, SPACING, FloatArray, Seed, seed_of, seed_records
from gen.recipe import read_recipe

PLACE = SPACING * np.arange(N_BALLS)
COS, SIN = np.cos(PLACE), np.sin(PLACE)
NUMPY_RECORDS = 1024
ATOL = np.repeat([5e-12, 5e-9], 4)  # a millionth of the rms of displacements [m] and rates [m/s]


def rows(
    pairs: int = 3, *, recipe: Path | str = SEED, records: int = 64, steps: int = 400, sampled_s: float = 0.1
) -> Iterator[Line]:
    """Lines of the table; rivals take ``steps`` steps, ``solve_ivp`` simulates ``sampled_s`` seconds."""
    dt, factor = step_seconds(recipe)
    seed, state = spalled(recipe, records)
    measures = {
        "ours": kernel_rate(recipe, records),
        "ivp": lambda: sampled_s / cpu_seconds(adaptive, seed, state, sampled_s, dt * factor),
        "numpy": _numpy_speed(seed, state, dt, steps),
    }
    measured = interleaved(pairs, **measures)
    simulated = [speed * dt for speed in measured["ours"]]
    ivp = "solve_ivp, RK45, rtol 1e-6, one record"
    yield row("kernel solve_ivp", "seed model, at the same sample times", "record-s/s", simulated, ivp, measured["ivp"])
    batch = f"NumPy RK4, batch of {NUMPY_RECORDS} records"
    yield row("kernel numpy", "seed model, one core", UNIT, measured["ours"], batch, measured["numpy"])


def slope(t: float, q: FloatArray, seed: Seed) -> FloatArray:
    """Rates and accelerations of records, of the shape of ``q``: (8,) or (8, record)."""
    x1, y1, x2, y2, u1, v1, u2, v2 = q
    cage, shaft = seed.cage_angle + seed.cage_rate * t, seed.shaft_angle + seed.omega * t
    c, s = np.cos(cage), np.sin(cage)
    dx, dy = x1 - x2, y1 - y2
    along, across = dx * c + dy * s, dy * c - dx * s  # in the frame of the cage, in which the balls stand still
    place, cos, sin = (values.reshape(-1, *[1] * x1.ndim) for values in (PLACE, COS, SIN))
    passed = shaft + seed.spall_angle - cage - place
    offset = abs(passed - 2 * np.pi * np.rint(passed / (2 * np.pi)))
    gap = seed.half_clearance + np.where(offset < seed.half_span, seed.depth, 0.0)
    squeeze = np.maximum(cos * along + sin * across - gap, 0.0)
    force = seed.load_deflection_factor * squeeze * np.sqrt(squeeze)
    fx, fy = (force * cos).sum(axis=0), (force * sin).sum(axis=0)
    jx = fx * c - fy * s + seed.ring_damping * (u1 - u2)
    jy = fx * s + fy * c + seed.ring_damping * (v1 - v2)
    return np.array([
        u1, v1, u2, v2,
        (seed.load_x + seed.unbalance * np.cos(shaft) - jx) / seed.shaft_mass,
        (seed.load_y + seed.unbalance * np.sin(shaft) - jy) / seed.shaft_mass,
        (jx - seed.support_damping_x * u2 - seed.support_stiffness_x * x2) / seed.housing_mass,
        (jy - seed.support_damping_y * v2 - seed.support_stiffness_y * y2) / seed.housing_mass,
    ])  # fmt: skip


def step(t: float, q: FloatArray, dt: float, seed: Seed) -> tuple[FloatArray, FloatArray]:
    """State after a classical Runge-Kutta step, and the slope before it."""
    k1 = slope(t, q, seed)
    k2 = slope(t + dt / 2, q + dt / 2 * k1, seed)
    k3 = slope(t + dt / 2, q + dt / 2 * k2, seed)
    k4 = slope(t + dt, q + dt * k3, seed)
    return q + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4), k1


def numpy_march(seed: Seed, state: FloatArray, dt: float, steps: int) -> FloatArray:
    """Accelerations x1 y1 x2 y2 of a batch at the start of each step, shape (step, 4, record) [m s-2]."""
    states, q = np.empty((steps, 4, state.shape[1])), state
    for number in range(steps):
        q, before = step(number * dt, q, dt, seed)
        states[number] = before[4:]
    return states


def adaptive(seed: Seed, state: FloatArray, duration: float, sample: float) -> FloatArray:
    """Accelerations of the first record at its samples, shape (4, sample) [m s-2]."""
    lane = Seed(*(float(values[0]) for values in seed))
    times = sample * np.arange(round(duration / sample))
    solution = solve_ivp(lambda t, q: slope(t, q, lane), (0, duration), state[:, 0], t_eval=times, rtol=1e-6, atol=ATOL)
    return np.stack([slope(t, q, lane)[4:] for t, q in zip(times, solution.y.T, strict=True)], axis=1)


def spalled(recipe: Path | str, records: int) -> tuple[Seed, FloatArray]:
    groups = seed_records(read_recipe(recipe), records)
    return seed_of(groups[max(groups)])


def _tiled(seed: Seed, state: FloatArray, records: int) -> tuple[Seed, FloatArray]:
    places = np.arange(records) % state.shape[1]
    return Seed(*(values[places] for values in seed)), state[:, places]


def _numpy_speed(seed: Seed, state: FloatArray, dt: float, steps: int) -> Callable[[], float]:
    batch = _tiled(seed, state, NUMPY_RECORDS)
    return lambda: steps * NUMPY_RECORDS / cpu_seconds(numpy_march, *batch, dt, steps)
