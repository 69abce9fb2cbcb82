"""Laws of the equations of motion and of the step that advances them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.physics.kernel.compiling import LANES
from gen.physics.kernel_input import Spall, Turning
from tests.lanes import march_lanes
from tests.strategies import RIG, machines, record, steady_turnings, wandering_records

law = settings(max_examples=10)
KNOT = 1 / 12_000
STANDING = Turning(0.0)
UNDAMPED = RIG._replace(
    ring_damping=0.0, shaft_damping=0.0, support_damping_x=0.0, support_damping_y=0.0, sensor_damping=0.0
)
MASSES = np.repeat([RIG.shaft_mass, RIG.housing_mass, RIG.sensor_mass], 2)


def accelerations(some, start):
    """Accelerations of a record in the state ``start`` at its beginning, shape (coordinate,) [m s-2]."""
    return march_lanes([some], 1, 1, KNOT, start)[0].accelerations[0]


def displaced(*, along, by, clearance):
    """State in which the shaft lies in the direction ``along``, ``by`` deeper than the clearance."""
    start = np.zeros(12)
    start[:2] = (clearance + by) * np.cos(along), (clearance + by) * np.sin(along)
    return start


def energy(states):
    """Energy of the undamped rig with its cage at 0, shape (knot,) [J]."""
    shaft, housing, sensor = states[:, 0:2], states[:, 2:4], states[:, 4:6]
    turns = 2 * np.pi * np.arange(9) / 9
    relative = shaft - housing
    squeeze = relative[:, :1] * np.cos(turns) + relative[:, 1:] * np.sin(turns) - UNDAMPED.half_clearance
    contact = UNDAMPED.load_deflection_factor * np.maximum(squeeze, 0) ** 2.5 / 2.5
    support = np.array([UNDAMPED.support_stiffness_x, UNDAMPED.support_stiffness_y])
    springs = support @ (housing**2).T / 2 + RIG.sensor_stiffness_x * np.sum((housing - sensor) ** 2, axis=1) / 2
    load = states[:, 0] * UNDAMPED.load_x + states[:, 1] * UNDAMPED.load_y
    return states[:, 6:] ** 2 @ MASSES / 2 + contact.sum(axis=1) + springs - load


def energy_drift(n_steps):
    start = np.zeros(12)
    start[1] = 8e-6  # 0.1 s: the shaft falls, hits the race and vibrates
    energies = energy(march_lanes([record(UNDAMPED, STANDING)], 1200, n_steps, KNOT, start)[0].states)
    return np.abs(energies - energies[0]).max() / abs(energies[0])


def test_without_damping_and_rotation_the_energy_stays_and_the_more_so_the_finer_the_step():
    assert energy_drift(16) < 1e-4
    assert energy_drift(32) < energy_drift(16) < energy_drift(8)


@law
@given(st.integers(0, 8), st.floats(1e-8, 1.5e-6))
def test_the_force_of_a_ball_grows_with_the_power_three_halves_of_its_deflection(ball, deflection):
    lone = record(RIG._replace(load_x=0.0, load_y=0.0), STANDING)  # 5 um of clearance: the next ball is not reached
    along = 2 * np.pi * ball / 9
    start = displaced(along=along, by=deflection, clearance=RIG.half_clearance)
    force = -RIG.shaft_mass * accelerations(lone, start)[:2]
    expected = RIG.load_deflection_factor * deflection**1.5
    np.testing.assert_allclose(force, expected * np.array([np.cos(along), np.sin(along)]), rtol=1e-7, atol=1e-9)


def test_a_shaft_let_go_comes_to_rest_where_the_static_balance_says():
    standing = record(RIG, STANDING)
    let_go = march_lanes([standing], 6000, 8, KNOT, np.zeros(12))[0]  # 0.5 s
    at_rest = march_lanes([standing], 0, 1, KNOT)[0].states[0]
    np.testing.assert_allclose(let_go.states[-1], at_rest, rtol=0, atol=1e-12)


@law
@given(st.lists(wandering_records(), min_size=2, max_size=5), st.permutations(range(LANES)))
def test_a_record_does_not_depend_on_its_lane_or_its_neighbours(drawn, order):
    batch = [drawn[place % len(drawn)] for place in order]
    alone = march_lanes(drawn[:1], 20, 4, KNOT)[0]
    for lane, trip in enumerate(march_lanes(batch, 20, 4, KNOT)):
        if order[lane] % len(drawn) == 0:
            np.testing.assert_array_equal(trip.accelerations, alone.accelerations)
            np.testing.assert_array_equal(trip.states, alone.states)


@law
@given(machines(contact_damping=0.0), steady_turnings(), st.integers(0, 2**32 - 1))
def test_the_bearing_moves_momentum_but_makes_none(machine, motion, seed):
    still = motion._replace(unbalance=0.0)
    start = np.random.default_rng(seed).normal(size=12) * np.repeat([1e-5, 1e-2], 6)
    masses = np.repeat([machine.shaft_mass, machine.housing_mass, machine.sensor_mass], 2)
    forces = masses * accelerations(record(machine, still), start)
    total = forces.reshape(3, 2).sum(axis=0)
    ground = np.array([machine.support_stiffness_x, machine.support_stiffness_y]) * start[2:4]
    ground += np.array([machine.support_damping_x, machine.support_damping_y]) * start[8:10]
    ground += machine.shaft_stiffness * start[:2] + machine.shaft_damping * start[6:8]
    load = np.array([machine.load_x, machine.load_y])
    np.testing.assert_allclose(total, load - ground, rtol=0, atol=1e-12 * np.abs(forces).max())


@law
@given(st.floats(0, 0.5), st.floats(1e-8, 1e-6))
def test_a_damped_contact_never_pulls(speed, deflection):
    damped = record(
        RIG._replace(load_x=0.0, load_y=0.0, contact_damping=600.0, ring_damping=0.0, shaft_damping=0.0),
        Turning(0.0, jitter_rms=1e-9),
        [Spall("outer", 2e-4, 1e-4, 2.0), Spall("outer", 2e-4, 1e-4, 2.0)],
    )
    start = displaced(along=0.0, by=deflection, clearance=RIG.half_clearance)
    start[6] = -speed  # away from the ball
    force = -RIG.shaft_mass * accelerations(damped, start)[0]
    elastic = RIG.load_deflection_factor * deflection**1.5
    assert force == pytest.approx(max(elastic - 600.0 * speed, 0.0), rel=1e-6, abs=1e-9)
