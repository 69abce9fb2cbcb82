"""Records of the seed recipe ``ophel2025`` as input of programs that cover its model only.

That model has shaft and housing in x and y, nine balls, unbalance, at most one spall on the inner race, and constant speed.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.physics.bearing import orders
from gen.physics.kernel_input import KernelInput
from gen.physics.rotor import as_columns, rest
from gen.recipe import Recipe
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import runs_of

FloatArray = NDArray[np.float64]

N_BALLS = 9
SPACING = 2 * np.pi / N_BALLS
NO_SPALL, RECTANGULAR, GEOMETRIC = range(3)
_PROFILES = {"rectangular": RECTANGULAR, "geometric": GEOMETRIC}


class Seed(NamedTuple):
    """Constants of records, shape (record,) each, in SI units."""

    load_deflection_factor: FloatArray
    half_clearance: FloatArray
    shaft_mass: FloatArray
    housing_mass: FloatArray
    ring_damping: FloatArray
    support_stiffness_x: FloatArray
    support_stiffness_y: FloatArray
    support_damping_x: FloatArray
    support_damping_y: FloatArray
    load_x: FloatArray
    load_y: FloatArray
    unbalance: FloatArray
    """Force of the unbalance, which turns with the shaft."""
    shaft_angle: FloatArray
    cage_angle: FloatArray
    omega: FloatArray
    cage_rate: FloatArray
    half_span: FloatArray
    """Half the angle that the spall spans, 0 without a spall."""
    spall_angle: FloatArray
    depth: FloatArray
    ball_radius: FloatArray
    inner_radius: FloatArray


def seed_records(recipe: Recipe, wanted: int) -> dict[int, list[KernelInput]]:
    """The first records of a recipe by the profile of their spall."""
    groups: dict[int, list[KernelInput]] = {}
    for run in runs_of(draw_scenarios(recipe, 0, wanted)):
        record = run.kernel_input
        profile = _PROFILES[record.spalls[0].profile] if record.spalls else NO_SPALL
        groups.setdefault(profile, []).append(record)
    return groups


def seed_of(records: list[KernelInput]) -> tuple[Seed, FloatArray]:
    """Constants of records, and their state at static rest: x1 y1 x2 y2 and their rates, shape (8, record) [m, m/s]."""
    machine = as_columns([record.machine for record in records])
    shared = {name: np.asarray(getattr(machine, name)) for name in Seed._fields if hasattr(machine, name)}
    motions = [record.turning for record in records]
    omega = 2 * np.pi * np.array([motion.shaft_rate for motion in motions])
    inner_radius = np.array([record.bearing.inner_radius for record in records])
    width, angle, depth = np.array([_spall(record) for record in records]).T
    cage_angle = np.array([motion.cage_angle for motion in motions])
    state = np.zeros((8, len(records)))
    state[:4] = rest(machine, cage_angle[:, None] + SPACING * np.arange(N_BALLS)).T
    seed = Seed(
        **shared,
        unbalance=np.array([motion.unbalance for motion in motions]) * omega**2,
        shaft_angle=np.array([motion.shaft_angle for motion in motions]),
        cage_angle=cage_angle,
        omega=omega,
        cage_rate=omega * np.array([orders(record.bearing).ftf for record in records]),
        half_span=width / 2 / inner_radius,
        spall_angle=angle,
        depth=depth,
        inner_radius=inner_radius,
    )
    return seed, state


def _spall(record: KernelInput) -> tuple[float, float, float]:
    """Width [m], angle [rad] and depth [m]."""
    if not record.spalls:
        return 0.0, 0.0, 0.0
    (spall,) = record.spalls
    return spall.width, spall.angle, spall.depth
