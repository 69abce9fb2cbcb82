"""Laws of the kernel input: heat, oil, bearings and profiles of a recipe act on it, and labels agree with it."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.generation.labels import part_dataset
from gen.measurement.measure import measure
from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import LINE_EXPONENT, POINT_EXPONENT, load_deflection_factor
from gen.physics.kernel.batch import input_shape
from gen.scenarios import draw_scenarios
from gen.simulation.motion import cosine_sum
from tests.reference_motion import turned
from tests.responses import input_of, means_of, runs_of

FS = 12_000.0
OIL = {"contact.lubricant": {}}
RUN_UP = {"kind": "run_up", "from_percent": 40, "to_percent": 130, "start_s": 0.02, "lasting_s": 0.06}
STEPS = {"kind": "steps", "levels_percent": [50, 100, 30], "step_s": 0.01}
TABLE = {"kind": "table", "times_s": [0, 0.05, 0.1], "percent": [100, 60, 80]}
RAMP = {"kind": "ramp", "from_percent": 80, "to_percent": 120}
MEANS = [(RAMP, 1.0), (TABLE, 0.75), (STEPS, 0.6), (RUN_UP, 0.2 * 0.4 + 0.6 * 0.85 + 0.2 * 1.3)]
means = pytest.mark.parametrize(("profile", "mean"), MEANS, ids=[profile["kind"] for profile, _ in MEANS])


@pytest.fixture
def record_of(recipe_with):
    """Kernel input of the first record of the small recipe with some values replaced."""

    def first_record(changes):
        recipe = recipe_with(changes)
        return input_of(draw_scenarios(recipe, 0, 1)[0])

    return first_record


def labels(recipe):
    """Labels of a corpus whose bodies are at rest; labels do not depend on the motion."""
    scenarios = draw_scenarios(recipe)
    return part_dataset(recipe, measure(runs_of(scenarios)))


def test_an_oil_film_takes_up_clearance_yields_and_damps(record_of):
    dry, oiled = record_of({}).machine, record_of(OIL).machine
    assert 1e-8 < dry.half_clearance - oiled.half_clearance < 3e-6
    assert 0.5 * dry.load_deflection_factor < oiled.load_deflection_factor < dry.load_deflection_factor
    assert dry.contact_damping == 0 < oiled.contact_damping
    more = record_of(OIL | {"machine.contact_damping_n_s_m": 50}).machine
    assert more.contact_damping == pytest.approx(oiled.contact_damping + 50)


def test_an_axial_load_takes_up_clearance_and_leaves_the_rest_of_the_machine(record_of):
    slanted = {"specimen.contact_angle_deg": 10, "operation.load_n": 300}
    free, pressed = (record_of(slanted | {"operation.axial_load_n": load}).machine for load in (0, 400))
    assert pressed.half_clearance < min(free.half_clearance, 0)
    assert pressed._replace(half_clearance=free.half_clearance) == free
    assert free.contact_cosine == pytest.approx(math.cos(math.radians(10)))


def test_a_bearing_of_ones_own_reaches_the_kernel(record_of):
    mine = {"n_balls": 11, "pitch_diameter_mm": 50, "ball_diameter_mm": 9, "contact_angle_deg": 15}
    catalogue = {"kind": "catalogue", "designations": ["mine"], "entries": {"mine": mine}}
    record = record_of({"bearing": catalogue})
    assert record.bearing.n_balls == 11
    assert (record.bearing.pitch_diameter, record.bearing.ball_diameter) == pytest.approx((0.05, 0.009))
    assert record.machine.ball_radius == pytest.approx(0.0045)
    assert record.machine.contact_cosine == pytest.approx(math.cos(math.radians(15)))
    assert record.machine.contact_exponent == POINT_EXPONENT
    assert input_shape(record).balls == 11


NU206 = {"n_balls": 13, "pitch_diameter_mm": 46.5, "ball_diameter_mm": 9, "roller_length_mm": 10}
ROLLERS = {
    "catalogue": {"kind": "catalogue", "designations": ["NU206"]},
    "own": {"kind": "catalogue", "designations": ["mine"], "entries": {"mine": NU206}},
    "geometry": {"kind": "geometry", **NU206},
}


@pytest.mark.parametrize("kind", ROLLERS)
def test_rollers_push_back_by_the_power_ten_ninths(record_of, kind):
    record = record_of({"bearing": ROLLERS[kind]})
    machine, shape = record.machine, input_shape(record)
    assert machine.contact_exponent == LINE_EXPONENT
    assert machine.load_deflection_factor == pytest.approx(load_deflection_factor(CATALOGUE["NU206"]), rel=1e-9)
    assert shape.roller
    assert shape.balls == 13


@pytest.mark.parametrize("site", ["inner", "outer", "ball"])
@pytest.mark.parametrize("footprint", ["point", "hertz"])
def test_outer_spalls_alone_count_from_the_load_in_the_kernel_and_in_the_labels(recipe_with, site, footprint):
    changes = {
        "faults": [{"kind": site, "width_mm": 0.5, "angle_deg": 10}],
        "machine.load_angle_deg": -60,
        "contact.footprint": footprint,
    }
    recipe = recipe_with(changes)
    expected = math.radians(-50 if site == "outer" else 10)
    assert input_of(draw_scenarios(recipe, 0, 1)[0]).spalls[0].angle == pytest.approx(expected)
    assert labels(recipe)["angle"].values == pytest.approx(expected)


@means
def test_labels_of_load_and_shaft_rate_follow_the_mean_of_their_profile(recipe_with, profile, mean):
    steady = {"operation.shaft_rpm": 1800, "operation.load_n": 400}
    records = labels(recipe_with(steady | {"operation.speed_profile": profile, "operation.load_profile": profile}))
    assert records["shaft_rate"].values == pytest.approx(30 * mean, rel=1e-4)
    assert records["load"].values == pytest.approx(400 * mean, rel=1e-4)


@means
def test_the_true_rates_are_those_of_the_angles_really_turned(recipe_with, profile, mean):
    """Wander during a run-up: the mean of a product is not the product of the means."""
    changes = {"operation.speed_wander_percent": 1, "operation.slip_percent": 2, "operation.shaft_rpm": 1800}
    walk = {"spacing_percent": 1}
    recipe = recipe_with(changes | {"operation.speed_profile": profile, "operation.slip_walk": walk})
    start, n = round(recipe.recording.settle_s * FS), recipe.n_samples
    for scenario in draw_scenarios(recipe, 0, 3):
        rate, orders = means_of(scenario)
        angles = turned(input_of(scenario), 1 / FS, start + n)[0]
        shaft, cage, _ = (angles[-1] - angles[start]) / (2 * np.pi)
        assert shaft * FS / n == pytest.approx(rate, rel=2e-5)
        assert rate == pytest.approx(30 * mean, rel=0.05)
        assert cage / shaft == pytest.approx(orders.ftf, rel=2e-4)


def test_a_profile_starts_with_the_record_and_not_with_its_settling(record_of):
    record = record_of({"operation.load_profile": STEPS, "operation.speed_profile": RUN_UP})
    start = round(0.06 * FS)
    assert (record.schedule[: start + 1, 1] == 0.5).all()
    assert record.schedule[start + round(0.05 * FS), 1] == 1.0
    assert record.schedule[-1] == pytest.approx([1.3, 0.3])
    assert (np.diff(record.schedule[:, 0]) >= 0).all()
    assert record.schedule[start + round(0.05 * FS), 0] == pytest.approx(0.85, abs=0.01)


@given(st.integers(2, 3000), st.integers(0, 12), st.floats(-1, 60), st.floats(1e-5, 1e-3), st.integers(0, 2**32 - 1))
def test_a_sum_of_cosines_is_the_sum_of_its_cosines(n, terms, start, step, seed):
    rng = np.random.default_rng(seed)
    times, rates, phases = start + step * np.arange(n), rng.uniform(0, 1000, terms), rng.uniform(0, 7, terms)
    expected = np.cos(np.outer(times, rates) + phases).sum(axis=1)
    rounding = 4 * np.finfo(float).eps * (1000 * np.abs(times).max() + 7)  # of the argument of a cosine
    np.testing.assert_allclose(cosine_sum(times, rates, phases), expected, rtol=0, atol=(1 + terms) * rounding)


def test_waviness_that_would_fold_down_is_left_out(record_of):
    smooth = {"specimen.waviness_nm": 20, "specimen.ball_waviness_nm": 2, "operation.shaft_rpm": 6000}
    whole, cut = (record_of(smooth | {"recording.sample_rate_hz": fs}).waviness.races for fs in (48_000, 6_000))
    kept = cut != 0
    assert (whole != 0).all()
    assert 0.2 < kept.mean() < 0.9
    np.testing.assert_array_equal(cut[kept], whole[kept])
