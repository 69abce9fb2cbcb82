"""Laws of the machine: its static rest and its highest eigenfrequency."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.physics import rotor
from gen.physics.hertz import LINE_EXPONENT, line_contact_factor, series_factor
from gen.physics.rotor import (
    as_columns,
    ball_forces,
    highest_angular_frequency,
    highest_damping_rate,
    likely_stiffness,
    rest,
)
from tests.strategies import angles, machines

N_BALLS = 9


def ball_angles(cage, n_records=1):
    return np.tile(cage + 2 * np.pi * np.arange(N_BALLS) / N_BALLS, (n_records, 1))


def stiffness(machine, at_rest, places):
    """Stiffness matrix of x1 y1 x2 y2 xr yr about a state, shape (coordinate, coordinate) [N/m]."""
    columns = as_columns([machine])
    _, balls = ball_forces(columns, (at_rest[:2] - at_rest[2:4])[None], places)
    directions = np.stack([np.cos(places[0]), np.sin(places[0])])
    contact = directions * balls[0] @ directions.T + np.diag([machine.ring_stiffness_x, machine.ring_stiffness_y])
    support = np.diag([machine.support_stiffness_x, machine.support_stiffness_y])
    sensor = np.diag([machine.sensor_stiffness_x, machine.sensor_stiffness_y])
    zero = np.zeros((2, 2))
    return np.block([
        [contact + machine.shaft_stiffness * np.eye(2), -contact, zero],
        [-contact, contact + support + sensor, -sensor],
        [zero, -sensor, sensor],
    ])  # fmt: skip


@given(st.lists(machines(), min_size=1, max_size=8), angles)
def test_at_rest_every_force_has_its_counterforce(some, cage):
    machine, places = as_columns(some), ball_angles(cage, len(some))
    q = rest(machine, places)
    force, _ = ball_forces(machine, q[:, :2] - q[:, 2:], places)
    pushed = np.stack([np.sum(force * np.cos(places), axis=1), np.sum(force * np.sin(places), axis=1)], axis=1)
    ring = np.stack([machine.ring_stiffness_x, machine.ring_stiffness_y], axis=1)
    pushed += ring * (q[:, :2] - q[:, 2:])
    load = np.stack([machine.load_x, machine.load_y], axis=1)
    support = np.stack([machine.support_stiffness_x, machine.support_stiffness_y], axis=1)
    weight = np.hypot(*load.T)[:, None]
    on_shaft = load - pushed - np.asarray(machine.shaft_stiffness)[:, None] * q[:, :2]
    np.testing.assert_allclose(on_shaft / weight, 0, atol=1e-8)
    np.testing.assert_allclose((pushed - support * q[:, 2:]) / weight, 0, atol=1e-8)


@given(st.lists(machines(), min_size=2, max_size=9), angles, st.data())
def test_a_machine_rests_alone_where_it_rests_beside_bearings_with_more_balls(some, cage, data):
    counts = data.draw(st.lists(st.integers(4, 20), min_size=len(some), max_size=len(some)))
    together = rest(as_columns(some), rotor.ball_angles(counts, [cage] * len(some)))
    for place, count in enumerate(counts):
        alone = rest(as_columns(some[place : place + 1]), rotor.ball_angles([count], [cage]))
        np.testing.assert_array_equal(alone[0], together[place])


@given(machines(contact_damping=0.0), angles)
def test_no_mode_at_rest_is_faster_than_the_bound_on_all_modes(machine, cage):
    places = ball_angles(cage)
    at_rest = rest(as_columns([machine]), places)[0]
    masses = np.repeat([machine.shaft_mass, machine.housing_mass, machine.sensor_mass], 2)
    squares = np.linalg.eigvals(stiffness(machine, at_rest, places) / masses[:, None]).real
    assert math.sqrt(squares.max()) <= highest_angular_frequency(machine, likely_stiffness(machine, N_BALLS))


@given(machines(half_clearance=0.0), angles, st.floats(0, 10e-6), st.integers(7, 40))
def test_the_rollers_of_a_machine_at_rest_are_together_no_stiffer_than_is_assumed(machine, cage, half_clearance, count):
    contact = line_contact_factor(0.01)
    rollers = machine._replace(
        contact_exponent=LINE_EXPONENT,
        load_deflection_factor=series_factor(contact, contact, LINE_EXPONENT),
        half_clearance=half_clearance,
    )
    columns, places = as_columns([rollers]), rotor.ball_angles([count], [cage])
    q = rest(columns, places)
    _, of_each = ball_forces(columns, q[:, :2] - q[:, 2:], places)
    assert of_each.sum() <= likely_stiffness(rollers, count)


@given(machines(), angles)
def test_no_damping_rate_exceeds_its_bound_nor_is_it_below_a_third_of_it(machine, cage):
    """The bound is the sum of the rates of shaft, housing and sensor; the largest of three is at least a third of their sum."""
    along = np.cos(ball_angles(cage)[0])
    contact = machine.ring_damping + machine.contact_damping * np.sum(along**2)  # all balls loaded, along the x axis
    support, sensor = max(machine.support_damping_x, machine.support_damping_y), machine.sensor_damping
    damping = np.array([
        [contact + machine.shaft_damping, -contact, 0],
        [-contact, contact + support + sensor, -sensor],
        [0, -sensor, sensor],
    ])  # fmt: skip
    masses = np.array([machine.shaft_mass, machine.housing_mass, machine.sensor_mass])
    largest = np.linalg.eigvals(damping / masses[:, None]).real.max()
    bound = highest_damping_rate(machine, N_BALLS)
    assert largest <= bound * (1 + 1e-12)
    assert bound <= 3 * largest * (1 + 1e-12)


@given(machines(), angles, st.floats(0, 1))
def test_a_ball_force_is_the_slope_of_its_energy_and_its_stiffness_the_slope_of_its_force(machine, cage, share):
    columns, places = as_columns([machine]), ball_angles(cage)
    along = np.array([np.cos(cage), np.sin(cage)])
    deep = (machine.half_clearance + (1 + share) * 1e-6) * along / machine.contact_cosine
    step = 1e-10
    before, slope = ball_forces(columns, (deep - step * along)[None], places)
    after, _ = ball_forces(columns, (deep + step * along)[None], places)
    assert (after - before)[0, 0] / (2 * step) == pytest.approx(slope[0, 0], rel=1e-4)
