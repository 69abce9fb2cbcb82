"""Hypothesis strategies for bearings, machines, motions and spalls within the ranges of a recipe; records have nine balls by default."""

from dataclasses import replace

import numpy as np
from hypothesis import strategies as st

from gen.physics.bearing import Bearing
from gen.physics.catalogue import CATALOGUE
from gen.physics.extent import BALL_ORDERS, HIGHEST_ORDER, LOWEST_ORDER
from gen.physics.hertz import LINE_EXPONENT
from gen.physics.kernel.drop import PROFILES as EVERY_PROFILE
from gen.physics.kernel.layout import n_process_terms
from gen.physics.kernel_input import ROUND, KernelInput, Spall, Turning, Waviness
from gen.physics.rotor import Machine, sensor_springs

PROFILES = ("geometric", "half_sine", "raised_cosine", "rectangular")
N_ORDERS = HIGHEST_ORDER - LOWEST_ORDER + 1

SPRING, DAMPER = sensor_springs(0.2, 3000.0, 0.03)
RIG = Machine(
    load_deflection_factor=9.26e9, contact_damping=0.0, contact_cosine=1.0, half_clearance=5e-6,
    ball_radius=CATALOGUE["6205"].ball_diameter / 2, shaft_mass=5.5, housing_mass=3.0, sensor_mass=0.2, ring_damping=1000.0,
    shaft_damping=200.0, shaft_stiffness=0.0, ring_stiffness_x=0.0, ring_stiffness_y=0.0, support_stiffness_x=6e7,
    support_stiffness_y=5e7, support_damping_x=2250.0, support_damping_y=2000.0, sensor_stiffness_x=SPRING,
    sensor_stiffness_y=SPRING, sensor_damping=DAMPER, load_x=20.0, load_y=-300.0,
)  # fmt: skip

seeds = st.integers(0, 2**32 - 1)
angles = st.floats(-np.pi, np.pi)
NINE = st.just(9)
widths = st.floats(0.15e-3, 2e-3)
depths = st.floats(2e-6, 3e-4)


@st.composite
def bearings(draw):
    """A bearing whose balls leave room for a cage."""
    n_balls = draw(st.integers(5, 24))
    pitch = draw(st.floats(0.01, 0.5))
    share = draw(st.floats(0.05, min(0.45, 0.85 * np.pi / n_balls)))
    return Bearing(
        "drawn",
        n_balls,
        pitch,
        share * pitch,
        draw(st.floats(-0.6, 0.6)),
        draw(st.floats(0.51, 0.56)),
        draw(st.floats(0.51, 0.56)),
    )


@st.composite
def machines(draw, *, half_clearance=None, contact_damping=None):
    """A machine of a few kilograms with a 6205 and a load in any direction."""
    shaft, housing, sensor = draw(st.floats(1, 10)), draw(st.floats(1, 15)), draw(st.floats(0.05, 0.5))
    spring, damper = sensor_springs(sensor, draw(st.floats(1200, 4500)), draw(st.floats(0.01, 0.06)))
    stiffness, load, direction = draw(st.floats(1.5e7, 3e8)), draw(st.floats(50, 3000)), draw(angles)
    ratio = draw(st.floats(0.7, 1.5))
    return Machine(
        load_deflection_factor=draw(st.floats(8e9, 1.05e10)),
        contact_damping=draw(st.floats(10, 600)) if contact_damping is None else contact_damping,
        contact_cosine=draw(st.floats(0.9, 1)),
        half_clearance=draw(st.floats(-6e-6, 10e-6)) if half_clearance is None else half_clearance,
        ball_radius=CATALOGUE["6205"].ball_diameter / 2,
        shaft_mass=shaft,
        housing_mass=housing,
        sensor_mass=sensor,
        ring_damping=draw(st.floats(0, 2500)),
        shaft_damping=draw(st.floats(0, 500)),
        shaft_stiffness=draw(st.floats(0, 1e6)),
        ring_stiffness_x=draw(st.floats(0, 1e6)),
        ring_stiffness_y=draw(st.floats(0, 1e6)),
        support_stiffness_x=stiffness,
        support_stiffness_y=stiffness * ratio,
        support_damping_x=draw(st.floats(100, 4000)),
        support_damping_y=draw(st.floats(100, 4000)),
        sensor_stiffness_x=spring,
        sensor_stiffness_y=spring * ratio,
        sensor_damping=damper,
        load_x=load * np.cos(direction),
        load_y=load * np.sin(direction),
    )


@st.composite
def spalls(draw, sites=("inner", "outer", "ball")):
    """A spall on one of ``sites``, narrower than the space between two balls."""
    return Spall(draw(st.sampled_from(sites)), draw(widths), draw(depths), draw(angles), draw(st.integers(0, 8)))


@st.composite
def steady_turnings(draw):
    """Motion at a constant rate, from any angles."""
    return Turning(
        draw(st.floats(10, 60)),
        unbalance=draw(st.floats(0, 1e-4)),
        shaft_angle=draw(angles),
        cage_angle=draw(angles),
        spin_angle=draw(angles),
    )


@st.composite
def wandering_turnings(draw):
    """Motion with all random processes."""
    return draw(steady_turnings())._replace(
        speed_rms=draw(st.floats(0, 0.01)),
        mean_slip=draw(st.floats(-0.01, 0.02)),
        slip_rms=draw(st.floats(0, 0.02)),
        spin_rms=draw(st.floats(0, 0.05)),
        jitter_rms=draw(st.floats(1e-3, 2e-2)),
        axis_offset=draw(st.floats(-0.2, 0.2)),
        axis_rms=draw(st.floats(0, 0.3)),
        axis_limit=draw(st.floats(0.05, 0.3)),
    )


def race_waves(seed, rms):
    """Amplitudes of the waviness of both races, all orders alike, shape (race, order) [m]."""
    phases = np.random.default_rng(seed).uniform(0, 2 * np.pi, (2, N_ORDERS))
    return rms * np.sqrt(2 / N_ORDERS) * np.exp(1j * phases)


def record(machine, turning, some_spalls=(), *, seed=0, waviness=0.0, n_balls=9):
    """A 6205 in ``machine``, its processes drawn from ``seed``; uneven if it has jitter or waviness."""
    angle = float(np.arccos(machine.contact_cosine))
    bearing = replace(CATALOGUE["6205"], contact_angle=angle, n_balls=n_balls)
    rng = np.random.default_rng(seed)
    return KernelInput(
        bearing=bearing,
        machine=machine,
        turning=turning,
        spalls=tuple(some_spalls),
        frequencies=rng.uniform(0.3, 60, n_process_terms(bearing.n_balls)),
        phases=rng.uniform(0, 2 * np.pi, n_process_terms(bearing.n_balls)),
        pickups=np.eye(6),
        waviness=Waviness(race_waves(seed, waviness), ROUND.balls) if waviness else ROUND,
    )


@st.composite
def steady_records(draw, *, balls=NINE):
    """A healthy record of even balls at a constant rate, without contact damping."""
    return record(draw(machines(contact_damping=0.0)), draw(steady_turnings()), n_balls=draw(balls))


@st.composite
def wandering_records(draw, *, balls=NINE):
    """A record with many mechanisms: two to four spalls, damped contacts, wander, jitter, waviness."""
    n_balls = draw(balls)
    some = [one._replace(ball=one.ball % n_balls) for one in draw(st.lists(spalls(), min_size=2, max_size=4))]
    seed, rms = draw(seeds), draw(st.floats(1e-9, 1e-7))
    return record(draw(machines()), draw(wandering_turnings()), some, seed=seed, waviness=rms, n_balls=n_balls)


@st.composite
def extended_records(draw):
    """A record with one spall on the inner race wide enough for two balls, and perhaps a second spall."""
    wide = Spall("inner", draw(st.floats(11.5e-3, 18e-3)), draw(st.floats(3e-6, 50e-6)), draw(angles))
    other = draw(st.lists(spalls(), max_size=1))
    return draw(wandering_records())._replace(spalls=(wide, *other))


@st.composite
def profiled_spalls(draw):
    """A spall of any profile; tables have 9 points, all of which are also points of the finer table of the kernel."""
    some, profile = draw(spalls()), draw(st.sampled_from(EVERY_PROFILE))
    races = 2 if some.site == "ball" else 1
    tables = st.lists(st.tuples(*[depths] * 9), min_size=races, max_size=races)
    return some._replace(
        profile=profile,
        table=tuple(draw(tables)) if profile == "table" else (),
        scatter=draw(st.sampled_from((0.0, 0.3))),
        seed=draw(st.integers(0, 2**52 - 1)),
    )


@st.composite
def troubled_turnings(draw, n_balls):
    """Motion with all processes, a broken cage, and a bent and misaligned shaft; the cage knocks soon after the start."""
    turning = draw(wandering_turnings())
    return turning._replace(
        bow=draw(st.floats(0, 200)),
        twice_x=draw(st.floats(-200, 200)),
        twice_y=draw(st.floats(-200, 200)),
        knock=draw(st.floats(1, 100)),
        knock_angle=turning.cage_angle + draw(st.floats(-0.02, 0.05)),
        late_ball=draw(st.integers(0, n_balls - 1)),
        late_by=draw(st.floats(-0.08, 0.08)),
        walk=draw(st.floats(0, 0.02)),
        walk_seed=draw(st.integers(0, 2**52 - 1)),
        axis_jumps=draw(st.sampled_from((0.0, 0.5))),
        axis_spread=draw(st.floats(0, 0.2)),
        axis_seed=draw(st.integers(0, 2**52 - 1)),
    )


def ball_waves(seed, rms, n_balls=9):
    """Amplitudes of the waviness of balls over both contacts, shape (order, ball) [m]."""
    size = 2, BALL_ORDERS, n_balls
    real, imaginary = np.random.default_rng(seed).normal(scale=rms / np.sqrt(BALL_ORDERS), size=size)
    return real + 1j * imaginary


@st.composite
def troubled_records(draw, *, balls=NINE):
    """A record with every mechanism of a recipe: also rollers, a support with play, and schedules of shaft rate and load."""
    n_balls, seed, rms = draw(balls), draw(seeds), draw(st.floats(1e-9, 1e-7))
    some = [one._replace(ball=one.ball % n_balls) for one in draw(st.lists(profiled_spalls(), min_size=2, max_size=4))]
    machine = draw(machines())._replace(looseness=draw(st.floats(1e-8, 5e-6)))
    machine = machine._replace(load_deflection_factor=draw(st.floats(1e8, 1e9)), contact_exponent=LINE_EXPONENT)
    there = record(machine, draw(troubled_turnings(n_balls)), some, seed=seed, waviness=rms, n_balls=n_balls)
    schedule = np.random.default_rng(seed).uniform(0.7, 1.3, (draw(st.integers(1, 10)), 2))
    return there._replace(
        bearing=replace(there.bearing, roller_length=8e-3),
        waviness=there.waviness._replace(balls=ball_waves(seed, rms, n_balls)),
        schedule=schedule,
    )
