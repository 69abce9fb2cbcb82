"""Laws of machines that are not well: their lines, motions and bursts, how strong they are, and the label that names them."""

import math
from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.mechanisms.background.bursts import Bursts
from gen.mechanisms.background.machine_conditions import CONDITIONS
from gen.mechanisms.background.rub import Rub
from gen.mechanisms.background.shaft_lines import BentShaft, Misalignment, Unbalance
from gen.physics.catalogue import CATALOGUE
from gen.physics.rating import static_rating
from gen.recipe import read_recipe
from gen.scenarios import draw_scenarios
from gen.scenarios.variables import LABELS
from tests.measuring import FLOAT, background_of, direct, drawn, lines, quiet

TURNS, N, FS = 40, 24_000, 12_000.0
STEADY = 2 * np.pi * TURNS / N * np.arange(N)
RATING = static_rating(CATALOGUE["6205"])
NAMED = next(label for label in LABELS if label.name == "machine_condition")


def named(scenarios):
    return NAMED.column(scenarios)


def vibrations(condition, angles=STEADY, seed=0):
    return condition.vibrations(angles, FS, lambda **_: np.random.default_rng(seed))


def levels_of(moved, places):
    """Rms of lines of a motion, the mean over all directions [1]."""
    forward = np.fft.fft(moved) / len(moved)
    return np.sqrt((np.abs(forward[places]) ** 2 + np.abs(forward[-places]) ** 2) / 2)


@given(st.sampled_from([0.5, 1.0, 1.5]), st.lists(st.floats(-60, 0), min_size=1, max_size=60))
def test_the_lines_are_at_the_multiples_of_the_order_with_their_levels(order, levels):
    (moved,) = vibrations(drawn(BentShaft, order=order, **lines(levels)))
    places = np.round(order * TURNS * np.arange(1, len(levels) + 1)).astype(int)
    np.testing.assert_allclose(levels_of(moved, places), 10 ** (np.array(levels) / 20), rtol=1e-3, atol=1e-5)
    assert np.delete(np.abs(np.fft.fft(moved)) / N, [*places, *-places]).max() < 1e-3


@pytest.mark.parametrize(("condition", "fall"), [(BentShaft, [0, -9, -18]), (Misalignment, [-9, 0, -9])])
def test_lines_fall_by_octaves_from_the_strongest_one(condition, fall):
    (moved,) = vibrations(drawn(condition, slope_db_per_octave=-9, **lines([0, 0, 0, 0])))
    levels = levels_of(moved, TURNS * np.array([1, 2, 4]))
    np.testing.assert_allclose(20 * np.log10(levels), fall, atol=0.01)


@given(st.integers(0, 1000))
def test_the_machine_moves_on_an_ellipse_at_each_line(seed):
    """Never on a straight line: the shorter axis is a ninth of the longer one or more."""
    (moved,) = vibrations(drawn(Unbalance, **lines([0])), seed=seed)
    distance = np.abs(moved)
    assert distance.min() > 0.1 * distance.max()


def test_an_unbalance_grows_with_the_square_of_the_speed():
    unbalance = drawn(Unbalance, at_rpm=1200, **lines([0]))
    for rate, factor in ((10.0, 0.25), (20.0, 1.0), (40.0, 4.0)):
        (moved,) = vibrations(unbalance, 2 * np.pi * rate / FS * np.arange(N))
        assert np.sqrt(np.mean(np.abs(moved) ** 2) / 2) == pytest.approx(factor, rel=1e-3)


def test_channels_at_right_angles_see_the_motion_out_of_phase(recipe_with):
    channels = [{"name": name, "angle_deg": angle} for name, angle in (("x", 0), ("y", 90))]
    unbalance = {"probability": 1, "count": 1, "level_db": 40, "growth": 0}
    whole_turns = {"recording.duration_s": 1.0, "operation.shaft_rpm": 1800, "operation.speed_wander_percent": 0}
    machine = {"recording.channels": channels, "machine_conditions.unbalance": unbalance}
    recipe = recipe_with(FLOAT | direct() | whole_turns | machine | quiet())
    ((x, y),), _ = background_of(recipe)
    phase = np.angle(np.vdot(np.fft.rfft(x), np.fft.rfft(y)))
    assert abs(math.sin(phase)) > 0.2
    assert np.mean([x.std() ** 2, y.std() ** 2]) == pytest.approx(1e4, rel=0.01)


def test_no_line_aliases_in_a_record_whose_speed_rises():
    """A line at half the sample rate or above would come back as one of no order of the shaft."""
    turns = np.cumsum(np.linspace(20.0, 60.0, N)) / FS
    every, few = drawn(BentShaft, **lines([0] * 300)), drawn(BentShaft, **lines([0] * 99 + [-80] * 201))
    (moved,), (kept,) = (vibrations(condition, 2 * np.pi * turns) for condition in (every, few))
    # 99 lines of 60 Hz lie below 6 kHz
    np.testing.assert_array_equal(moved, kept)
    assert np.mean(np.abs(moved) ** 2) / 2 == pytest.approx(99, rel=0.05)


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0])
def test_bursts_come_at_their_order_with_their_rms(order):
    bursts, rng = drawn(Bursts, order=order, level_db=-10, length_deg=20), np.random.default_rng(0)

    def stream(level="record"):
        return np.random.default_rng(1) if level == "rig" else rng

    squares = np.mean([bursts.vibrations(STEADY, FS, stream)[0] ** 2 for _ in range(300)], axis=0)
    assert np.sqrt(squares.mean()) == pytest.approx(10 ** (-10 / 20), rel=0.02)
    spectrum = np.abs(np.fft.rfft(squares))[1:]
    assert 1 + np.argmax(spectrum) == order * TURNS
    folded = squares.reshape(-1, round(N / TURNS / min(order, 1.0))).mean(axis=0)
    loud = folded > folded.max() / 2
    bell = 2 * math.acos(1 - math.log(2) / 2 * math.radians(20) ** 2) / (2 * math.pi)
    assert loud.mean() == pytest.approx(bell, rel=0.2)


@pytest.mark.parametrize("order", [0.5, 1.0])
def test_a_rub_cuts_the_wave_off_while_it_touches_and_rubs_noise_out_of_it(order):
    wave, noise = vibrations(drawn(Rub, order=order, contact_deg=90, level_db=-6, noise_db=0))
    flat = wave > wave.max() - 1e-9
    assert flat.mean() == pytest.approx(90 / 360, abs=0.01)
    assert wave.std() == pytest.approx(10 ** (-6 / 20))
    assert np.mean(noise[flat] ** 2) > 2 * np.mean(noise**2)
    assert np.argmax(np.abs(np.fft.rfft(wave))) == order * TURNS
    # a part of a turn is as loud as it is in a long record
    part, _ = vibrations(drawn(Rub, order=order, contact_deg=90, level_db=-6, noise_db=0), STEADY[:200])
    np.testing.assert_allclose(part, wave[:200], atol=1e-12)


def test_conditions_belong_to_machines_and_not_to_classes_of_bearings(recipe_with):
    """Each is there with its own probability, so a machine can have several, and the label names all of them."""
    of = {"probability": 0.4, "count": 2, "level_db": "uniform(-30, 0)"}
    scenarios = draw_scenarios(recipe_with({"corpus.rigs": 150, "machine_conditions": {"belt": of, "bent_shaft": of}}))
    of_rig = {scenario.origin.rig: scenario.recipe.machine_conditions for scenario in scenarios}
    assert all(scenario.recipe.machine_conditions == of_rig[scenario.origin.rig] for scenario in scenarios)
    counts = Counter(
        {scenario.origin.rig: name for scenario, name in zip(scenarios, named(scenarios), strict=True)}.values()
    )
    for name, share in (("sound", 0.36), ("belt", 0.24), ("bent_shaft", 0.24), ("bent_shaft+belt", 0.16)):
        assert counts[name] == pytest.approx(share * 150, abs=4 * math.sqrt(150 * share * (1 - share)))


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"machine.bow_n": 0.009}, "sound"),
        ({"machine.bow_n": 0.011}, "bent_shaft"),
        ({"machine.misalignment_n": 0.011}, "misalignment"),
        ({"machine.looseness_um": 1}, "looseness"),
    ],
)
def test_forces_of_the_machine_are_named_from_a_hundredth_of_the_static_rating_on(recipe_with, changes, name):
    rated = {key: value * RATING if key.endswith("_n") else value for key, value in changes.items()}
    assert named(draw_scenarios(recipe_with(rated), 0, 1)) == [name]


@pytest.mark.parametrize(("grade", "name"), [(6.3, "sound"), (6.4, "unbalance")])
@pytest.mark.parametrize("stated", [{}, {"machine.balance_rpm": 300}])
def test_an_unbalance_is_named_by_its_grade_whatever_the_speeds_of_the_records(recipe_with, stated, grade, name):
    speeds = {"operation.shaft_rpm": "uniform(600, 6000)", "machine.balance_mm_s": grade}
    assert set(named(draw_scenarios(recipe_with(speeds | stated)))) == {name}


def test_domain_randomised_has_machines_of_every_condition():
    scenarios = draw_scenarios(read_recipe("domain_randomised"))
    names = {name for text in named(scenarios) for name in text.split("+")}
    assert names == {"sound", *(condition.place for condition in CONDITIONS)}
