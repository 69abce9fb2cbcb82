"""Laws of machines that are not well: where their lines and bursts are, how strong, and that bearings do not choose them."""

import math
from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.mechanisms.background.machine_condition import Bursts, MachineCondition, bursts_of, lines_of
from gen.mechanisms.background.machine_conditions import MACHINE_CONDITIONS
from gen.recipe import read_recipe
from gen.scenarios import draw_scenarios
from tests.measuring import drawn, lines

TURNS, N = 40, 24_000
STEADY = 2 * np.pi * TURNS / N * np.arange(N)


def kind_of(scenario):
    conditions = scenario.recipe.machine_conditions
    return "sound" if conditions is None else conditions.entries[0].kind


def condition(levels, order=1.0):
    return drawn(MachineCondition, kind="rub", order=order, **lines(levels))


@given(st.sampled_from([0.5, 1.0, 1.5]), st.lists(st.floats(-60, 0), min_size=1, max_size=60))
def test_the_lines_are_at_the_multiples_of_the_order_with_their_levels(order, levels):
    found = lines_of(condition(levels, order), STEADY, np.random.default_rng(0))
    spectrum = np.sqrt(2) / N * np.abs(np.fft.rfft(found))
    places = np.round(order * TURNS * np.arange(1, len(levels) + 1)).astype(int)
    np.testing.assert_allclose(spectrum[places], 10 ** (np.array(levels) / 20), rtol=1e-3, atol=1e-5)
    assert np.delete(spectrum, places).max() < 1e-3


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0])
def test_bursts_come_at_their_order_with_their_rms(order):
    bursts, rng = drawn(Bursts, order=order, level_db=-10, length_deg=20), np.random.default_rng(0)
    squares = np.mean([bursts_of(bursts, STEADY, 1.0, rng) ** 2 for _ in range(300)], axis=0)
    assert np.sqrt(squares.mean()) == pytest.approx(10 ** (-10 / 20), rel=0.02)
    found = np.abs(np.fft.rfft(squares))[1:]
    assert 1 + np.argmax(found) == order * TURNS
    loud = squares > squares.max() / 2
    bell = 2 * math.acos(1 - math.log(2) / 2 * math.radians(20) ** 2) / (2 * math.pi)
    assert loud.mean() == pytest.approx(bell, rel=0.2)


def test_the_condition_belongs_to_the_machine_and_not_to_the_class_of_its_bearing(recipe_with):
    entries = [
        {"kind": "unbalance", "weight": 3, "count": 1},
        {"kind": "rub", "count": 5, "level_db": "uniform(-30, 0)", "strongest": 2},
    ]
    recipe = recipe_with({"corpus.rigs": 150, "machine_conditions": {"probability": 0.5, "entries": entries}})
    scenarios = draw_scenarios(recipe)
    of_rig = {scenario.origin.rig: scenario.recipe.machine_conditions for scenario in scenarios}
    assert all(scenario.recipe.machine_conditions == of_rig[scenario.origin.rig] for scenario in scenarios)
    kinds = Counter({scenario.origin.rig: kind_of(scenario) for scenario in scenarios}.values())
    for kind, share in (("sound", 0.5), ("unbalance", 0.375), ("rub", 0.125)):
        assert kinds[kind] == pytest.approx(share * 150, abs=4 * math.sqrt(150 * share * (1 - share)))
    rubbing = [found.entries[0] for found in of_rig.values() if found is not None and found.entries[0].kind == "rub"]
    assert {np.argmax(one.level_db) for one in rubbing} == {1}


def test_no_line_aliases_in_a_record_whose_speed_rises():
    """A line at half the sample rate or above would come back as one of no order of the shaft."""
    turns = np.cumsum(np.linspace(20.0, 60.0, N)) / 12_000
    found = lines_of(condition([0] * 300), 2 * np.pi * turns, np.random.default_rng(0))
    phases = 2 * np.pi * np.random.default_rng(0).random(300)
    # 99 lines at 60 Hz lie below 6 kHz
    kept = sum(np.cos(2 * np.pi * order * turns + phases[order - 1]) for order in range(1, 100))
    np.testing.assert_allclose(found, np.sqrt(2) * kept, atol=1e-3 * np.abs(kept).max())


def test_domain_randomised_has_machines_of_every_condition():
    scenarios = draw_scenarios(read_recipe("domain_randomised"))
    assert {kind_of(scenario) for scenario in scenarios} == set(MACHINE_CONDITIONS.values()) - {"other", "unknown"}
