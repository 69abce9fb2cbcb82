"""Defects of the printed equations of the seed paper, listed in studies/ophel2025/errata.md.

Stability is examined in one direction of the system, with the contact as a spring between the rings.

.. [1] Ophel, Tchomeni, Alugongo, Sozinando, "An Analysis of Hertzian Contact and Inner Race Crack-Induced Vibrations in a Coupled
   Shaft-Bearing System", equations (5)-(11).
"""

from typing import NamedTuple

import numpy as np
import pytest

from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import load_deflection_factor

PAPER = CATALOGUE["6205-paper"]


class Parameters(NamedTuple):
    """Each a number or an array, shape (draw,)."""

    shaft_mass: float | np.ndarray  # [kg]
    housing_mass: float | np.ndarray
    ring_stiffness: float | np.ndarray  # k1 [N/m]
    contact_stiffness: float | np.ndarray
    support_stiffness: float | np.ndarray  # k2
    ring_damping: float | np.ndarray  # c1 [N s/m]
    support_damping: float | np.ndarray  # c2


PLAUSIBLE = Parameters(5.5, 5.0, 1e6, 1e8, 4e7, 300.0, 1000.0)
LOWEST = Parameters(2.0, 2.0, 1e6, 5e6, 1e6, 50.0, 50.0)
HIGHEST = Parameters(9.0, 9.0, 3e8, 3e8, 3e8, 2000.0, 2000.0)

PRINTED: frozenset[str] = frozenset()
REPAIRED = frozenset({"E1", "E2", "E3", "E4"})


def state_matrix(p, repairs):
    """Matrix A of z' = A z with z = (x1, x2, x1', x2'), shape (..., 4, 4), with the ``repairs`` of errata.md."""
    first = p.ring_stiffness + p.contact_stiffness
    support = p.support_stiffness if "E1" in repairs else -p.support_stiffness
    reaction = (
        first if "E3" in repairs else p.contact_stiffness
    )  # the printed contact force has its reaction, that of k1 has none
    shaft_row = (p.ring_damping, -p.ring_damping if "E4" in repairs else 0 * p.ring_damping)
    both = p.ring_damping + p.support_damping
    housing_row = (-p.ring_damping, both) if "E2" in repairs else (both + p.ring_damping, 0 * both)
    stiffness = ((first, -first), (-reaction, reaction + support if "E3" in repairs else p.contact_stiffness + support))
    matrix = np.zeros((*np.shape(p.shaft_mass), 4, 4))
    matrix[..., 0, 2] = matrix[..., 1, 3] = 1
    for row, mass in enumerate((p.shaft_mass, p.housing_mass)):
        for column in range(2):
            matrix[..., 2 + row, column] = -stiffness[row][column] / mass
            matrix[..., 2 + row, 2 + column] = -(shaft_row, housing_row)[row][column] / mass
    return matrix


def share_unstable(repairs, draws=5000):
    """Share of log-uniform parameter sets with a growing eigenvalue."""
    unit = np.random.default_rng(20250).random((len(LOWEST), draws))
    drawn = Parameters(*(low * (high / low) ** row for low, high, row in zip(LOWEST, HIGHEST, unit, strict=True)))
    growth = np.linalg.eigvals(state_matrix(drawn, repairs)).real.max(axis=-1)
    return np.mean(growth > 1e-6)


@pytest.mark.parametrize(
    ("repairs", "at_least", "at_most"),
    [
        (PRINTED, 1.0, 1.0),
        ({"E1"}, 0.95, 0.985),
        ({"E1", "E2"}, 0.01, 0.025),
        (REPAIRED - {"E4"}, 0.0, 0.0),
        (REPAIRED, 0.0, 0.0),
    ],
    ids=lambda value: "+".join(sorted(value)) or "printed" if isinstance(value, set | frozenset) else None,
)
def test_each_repair_takes_its_share_of_the_instability(repairs, at_least, at_most):
    """The shares in the middle depend on the ranges; that all, most, few and none are unstable does not."""
    assert at_least <= share_unstable(repairs) <= at_most


def test_the_missing_reaction_of_k1_takes_its_force_from_the_support():
    """Static: if k1 is a large part of the joint stiffness, the support carries less than the weight."""
    weight = 54.0
    joined = PLAUSIBLE._replace(ring_stiffness=5e7)
    for repairs, carried in (({"E1", "E2"}, joined.contact_stiffness / 1.5e8), (REPAIRED, 1.0)):
        rest = -np.linalg.solve(state_matrix(joined, repairs), [0, 0, weight / joined.shaft_mass, 0])
        assert joined.support_stiffness * rest[1] == pytest.approx(carried * weight, rel=1e-9)


def test_the_printed_stiffness_is_a_force_and_a_billionth_of_the_contact():
    """Dimensions as powers of kg, m and s; beta is not defined in the paper, 0 to 5 spans what a contact ellipse has."""
    density, gravity, radius, modulus = (
        np.array([1, -3, 0]),
        np.array([0, 1, -2]),
        np.array([0, 1, 0]),
        np.array([1, -1, -2]),
    )
    printed = density + gravity + 3 * radius - modulus + modulus  # [rho g r^3 / E * G]
    assert list(printed) == [1, 1, -2], "newtons"
    assert list(printed) != [1, -0.5, -2], "not newtons per metre to the power 3/2"
    e, nu, ball = PAPER.youngs_modulus, PAPER.poisson_ratio, PAPER.ball_diameter / 2
    shear, kappa = e / (2 * (1 + nu)), 3 - 4 * nu

    def value(beta):
        return 4 * (1 - nu**2) * 7850 * 9.81 * ball**3 / e * 2 * np.pi * shear * (1 + 4 * beta**2) / (kappa + 1)

    assert value(0) == pytest.approx(0.0155, rel=0.02)
    assert value(5) == pytest.approx(1.56, rel=0.02)
    assert load_deflection_factor(PAPER) / value(5) > 1e9


def test_the_printed_defect_window_is_half_as_wide_and_beside_the_defect():
    width, position = np.radians(20), np.radians(15)
    angles = np.linspace(-np.pi, np.pi, 720_000, endpoint=False)  # of a ball, in the frame of the shaft
    wrapped = (angles - position + np.pi) % (2 * np.pi) - np.pi
    printed = (wrapped % (2 * np.pi)) < width / 2  # (10), with the sign of the position taken from (11)
    meant = np.abs(wrapped) < width / 2
    assert np.degrees(2 * np.pi * printed.mean()) == pytest.approx(10, abs=0.02)
    assert np.degrees(2 * np.pi * meant.mean()) == pytest.approx(20, abs=0.02)
    assert np.degrees(angles[printed].mean()) == pytest.approx(15 + 5, abs=0.01)
    assert np.degrees(angles[meant].mean()) == pytest.approx(15, abs=0.01)


def test_balls_that_turn_with_the_shaft_never_meet_a_defect_of_the_inner_race():
    """Balls pass the spall at BPFI only if they turn with the cage."""
    rate, duration = 50.0, 10.0
    turns = rate * duration
    places = (np.arange(PAPER.n_balls) + 0.5) / PAPER.n_balls

    def passages(ball_turns):
        return np.abs(np.floor(places + ball_turns - turns) - np.floor(places)).sum()

    assert passages(turns) == 0, "with the only speed that the paper gives"
    assert passages(orders(PAPER).ftf * turns) / duration == pytest.approx(orders(PAPER).bpfi * rate, rel=1e-3)
    assert orders(PAPER).bpfi * rate == pytest.approx(271.15, abs=0.01)
