"""Laws of the fault classes: their labels, their healthy twins and their shares; and of a corpus with every mechanism."""

import math

import numpy as np
import pytest

from gen.corpus import FAULTS, open_corpus
from gen.generation.corpus import generate
from gen.generation.replaying import replay
from gen.physics.catalogue import CATALOGUE
from gen.recipe import read_recipe
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import simulate
from tests.recipes import EVERYTHING
from tests.responses import accelerations_of, input_of

BEARING = CATALOGUE["6205"]
KNOWN = ("fault", "parts", "n_spalls", "wear", "pitch_error", "knock", "width_share")


@pytest.fixture(scope="module")
def recipe_file(write_recipe, tmp_path_factory):
    return write_recipe(tmp_path_factory.mktemp("recipe") / "everything.yaml", EVERYTHING)


@pytest.fixture(scope="module")
def whole(recipe_file, tmp_path_factory):
    """A corpus of 32 records in two parts, with every mechanism."""
    return generate(recipe_file, tmp_path_factory.mktemp("everything") / "corpus")


@pytest.fixture(scope="module")
def drawn(recipe_file):
    return draw_scenarios(read_recipe(recipe_file))


def kind_of(scenario):
    """Class of the fault, or the site of the wear."""
    (fault,) = scenario.recipe.faults
    return f"worn {fault.site}" if fault.kind == "distributed" else scenario.fault


# parts, number of spalls, wear [m], pitch error [rad], knock [N], width of the widest spall [m] and what passes it [m]
LABELS = {
    "healthy": ("", 0, 0, 0, 0, 0, 1),
    "inner": ("inner", 1, 0, 0, 0, 0.5e-3, 2 * math.pi * BEARING.inner_radius / 9),
    "outer": ("outer", 2, 0, 0, 0, 3e-3, 2 * math.pi * BEARING.outer_radius / 9),
    "ball": ("ball", 1, 0, 0, 0, 0.5e-3, math.pi * BEARING.ball_diameter),
    "cage": ("cage", 0, 0, math.radians(3), 20, 0, 1),
    "worn inner": ("inner", 0, 0.3e-6, 0, 0, 0, 1),
    "worn outer": ("outer", 0, 0.3e-6, 0, 0, 0, 1),
    "compound": ("inner+outer+cage", 2, 0, math.radians(3), 30, 0.8e-3, 2 * math.pi * BEARING.outer_radius / 9),
}


def test_every_class_is_labelled_by_what_is_damaged_and_how_much(whole, drawn):
    assert whole.failures == ()
    assert {kind_of(scenario) for scenario in drawn} == set(LABELS)
    with open_corpus(whole.path) as corpus:
        columns = {name: corpus[name].values for name in (*KNOWN, "width", "largest_drop", "angle")}
    for place, scenario in enumerate(drawn):
        kind = kind_of(scenario)
        parts, n_spalls, wear, pitch_error, knock, width, passed = LABELS[kind]
        label = {name: values[place] for name, values in columns.items()}
        assert (FAULTS[label["fault"]], label["parts"], label["n_spalls"]) == (kind.split()[-1], parts, n_spalls)
        assert (label["wear"], label["pitch_error"], label["knock"]) == pytest.approx((wear, pitch_error, knock))
        assert label["width"] == pytest.approx(width)
        assert label["width_share"] == pytest.approx(width / passed, rel=0.01)  # less slanted than the specimen
        assert math.isnan(label["angle"]) == (n_spalls == 0)
        assert (label["largest_drop"] > 0) == (n_spalls > 0)


def assert_same_waviness(waviness, other):
    np.testing.assert_array_equal(waviness.races, other.races)
    np.testing.assert_array_equal(waviness.balls, other.balls)


def test_a_twin_without_the_fault_is_what_healthy_bearings_alone_would_be(write_recipe, drawn, tmp_path):
    """Machine, motion, waves and all, bit for bit."""
    healthy = read_recipe(write_recipe(tmp_path / "h.yaml", EVERYTHING | {"faults": [{"kind": "healthy"}]}))
    for scenario, sound in zip(drawn, draw_scenarios(healthy), strict=True):
        twin = input_of(scenario.without_fault())
        expected = input_of(sound)
        assert twin.machine == expected.machine
        assert twin.turning == expected.turning
        assert twin.spalls == ()
        assert_same_waviness(twin.waviness, expected.waviness)
        for field in ("frequencies", "phases", "pickups", "schedule"):
            np.testing.assert_array_equal(getattr(twin, field), getattr(expected, field))


def test_a_broken_cage_displaces_one_ball_and_knocks_and_wear_is_on_its_race_alone(drawn):
    for scenario in drawn:
        damaged, twin = (input_of(other) for other in (scenario, scenario.without_fault()))
        if "cage" in scenario.damaged_parts:
            assert damaged.turning.late_by == pytest.approx(math.radians(3))
            assert damaged.turning.late_ball == 0
            assert damaged.turning.knock > 0 == twin.turning.knock
        grown = damaged.waviness.races - twin.waviness.races
        rms = np.sqrt(np.sum(np.abs(grown) ** 2, axis=1) / 2)
        expected = [0.3e-6 * (kind_of(scenario) == f"worn {site}") for site in ("inner", "outer")]
        assert rms == pytest.approx(expected, rel=1e-9, abs=1e-18)
        if kind_of(scenario) == "worn inner":
            assert np.flatnonzero(np.abs(grown[0]) > 1e-12).tolist() == [8]  # orders start at 2


def test_wear_counts_as_its_site_and_shares_the_class_by_weight(recipe_with):
    faults = [{"kind": "inner", "width_mm": 0.5}, {"kind": "distributed", "site": "inner", "weight": 3}]
    recipe = recipe_with({"corpus.rigs": 80, "corpus.records_per_specimen": 1, "faults": faults})
    scenarios = draw_scenarios(recipe)
    worn = [scenario for scenario in scenarios if kind_of(scenario) == "worn inner"]
    assert {scenario.fault for scenario in scenarios} == {"inner"}
    assert all(not scenario.spalls for scenario in worn)
    assert len(worn) / len(scenarios) == pytest.approx(3 / 4, abs=0.08)  # 3 sigma of 320 coins


def test_records_of_every_class_replay_bit_for_bit(whole, drawn):
    numbers = {kind_of(scenario): scenario.origin.record for scenario in drawn}
    for number in numbers.values():
        assert replay(whole.path, number).identical


def test_the_fault_alone_tells_a_record_from_its_twin(drawn):
    some = list({kind_of(scenario): scenario for scenario in drawn}.values())
    damaged, sound = (
        accelerations_of(simulate(batch)) for batch in (some, [scenario.without_fault() for scenario in some])
    )
    for scenario, own, other in zip(some, damaged, sound, strict=True):
        assert np.array_equal(own, other) == (scenario.fault == "healthy")
