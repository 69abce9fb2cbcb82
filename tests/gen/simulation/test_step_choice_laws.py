"""Laws of the choice of the step: which contact stiffness it assumes before the run."""

import math
from collections import defaultdict

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.physics.bearing import orders
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import runs_of
from gen.simulation.steps import (
    ENOUGH,
    FINE_STEP,
    FOLLOWED_STEP,
    PASSAGE_STEPS,
    fastest_rate,
    largest_pull,
    passage_rate,
    steps_per_sample,
)
from tests.responses import input_of


@pytest.fixture
def drawn(recipe_with):
    """A scenario and its record, without a spall and a mode that is faster than that of the contacts."""
    (scenario,) = draw_scenarios(recipe_with(), 0, 1)
    record = input_of(scenario)
    machine = record.machine._replace(sensor_mass=0.0, half_clearance=1e-6, contact_damping=0.0)
    return scenario, record._replace(machine=machine, spalls=())


def sampled(scenario, rate):
    """The scenario at another sample rate."""
    return scenario.edited(recording=scenario.recipe.recording.model_copy(update={"sample_rate_hz": rate}))


def stiffness_of_three_balls(record):
    """Hertz stiffness of three balls, each under three times the heaviest static ball load 5 W / Z of Stribeck [N/m]."""
    machine = record.machine
    load = math.hypot(machine.load_x, machine.load_y) + largest_pull(record)
    ball_load = 3 * 5 * load / record.bearing.n_balls
    return 3 * 1.5 * machine.load_deflection_factor ** (2 / 3) * ball_load ** (1 / 3)


@pytest.mark.parametrize(("share", "steps"), [(1.005, 4), (0.995, 6)])
def test_the_step_resolves_the_mode_of_that_stiffness_and_is_no_finer(drawn, share, steps):
    """Four steps per sample are enough up to a sample rate where the mode turns by ``FINE_STEP`` in a step; a little lower, six are."""
    scenario, record = drawn
    machine = record.machine
    square = (stiffness_of_three_balls(record) + max(machine.ring_stiffness_x, machine.ring_stiffness_y)) * (
        1 / machine.shaft_mass + 1 / machine.housing_mass
    )
    square += machine.shaft_stiffness / machine.shaft_mass
    square += max(machine.support_stiffness_x, machine.support_stiffness_y) / machine.housing_mass
    rate = share * math.sqrt(square) / (4 * FINE_STEP)
    assert steps_per_sample(record, sampled(scenario, rate)) == steps


@pytest.mark.parametrize(("mode", "steps"), [(0.49, ENOUGH), (0.71, ENOUGH), (0.73, 8), (0.95, 8)])
def test_a_mode_above_half_the_sample_rate_is_followed_and_not_resolved(drawn, mode, steps):
    """The anti-alias filter removes it; ``mode`` is its frequency over the sample rate, and 0.75 / 2 pi of it a step."""
    scenario, record = drawn
    rate = fastest_rate(record) / (2 * math.pi * mode)
    assert steps_per_sample(record, sampled(scenario, rate)) == steps
    assert 2 * math.pi * mode / steps < FOLLOWED_STEP


@pytest.mark.parametrize("width", [0.3, 1.0])
def test_a_ball_rolls_over_the_narrowest_spall_in_some_steps(recipe_with, width):
    """At the mean speed of the contacts of its damaged race: a ball rolls, so that it is the same on both races and on the ball."""
    fast = {"operation.shaft_rpm": 30_000, "recording.sample_rate_hz": 12_000}
    spalls = [{"kind": site, "width_mm": width} for site in ("inner", "outer", "ball")]
    recipe = recipe_with(fast | {"faults": spalls})
    for scenario in draw_scenarios(recipe, 0, 3):
        record, bearing = input_of(scenario), scenario.drawing
        of = orders(bearing)
        speed = {
            "outer": of.ftf * bearing.outer_radius,
            "inner": (1 - of.ftf) * bearing.inner_radius,
            "ball": of.bsf * bearing.ball_diameter / 2,
        }[scenario.fault]
        rate = 2 * math.pi * record.turning.shaft_rate * speed / (1e-3 * width)
        assert passage_rate(record) == pytest.approx(rate, rel=0.05)
        steps = steps_per_sample(record, scenario)
        assert steps * 12_000 >= PASSAGE_STEPS * passage_rate(record)


rungs = st.lists(st.floats(0.02, 1), min_size=1, max_size=4, unique=True).map(sorted)


@settings(max_examples=8)
@given(rungs, st.booleans(), st.floats(600, 40_000), st.integers(0, 2**31))
def test_the_records_of_a_group_have_one_step_together_and_alone(recipe_with, shares, before_damage, rpm, seed):
    """So they differ in their fault alone; a replay simulates one of them without the others."""
    shares = [0, *shares] if before_damage or len(shares) == 1 else shares
    faults = [{"kind": kind, "width_mm": "loguniform(0.1, 3)"} for kind in ("inner", "outer", "ball")]
    changes = {"seed": seed, "corpus.rungs": shares, "operation.shaft_rpm": rpm, "recording.sample_rate_hz": 12_000}
    recipe = recipe_with(changes | {"faults": [{"kind": "healthy", "weight": 4}, *faults]})
    steps = defaultdict(set)
    scenarios = draw_scenarios(recipe, 0, 12 * len(shares))
    for scenario, run in zip(scenarios, runs_of(scenarios), strict=True):
        (alone,) = runs_of([scenario])
        steps[scenario.origin.pair] |= {integration.steps for integration in (*run.integrations, *alone.integrations)}
    steps.pop(-1, None)
    assert steps
    assert all(len(of_group) == 1 for of_group in steps.values())
