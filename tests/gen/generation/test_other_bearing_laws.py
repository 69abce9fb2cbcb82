"""Laws of a shaft with two bearings: the vibration of the other one is in the record, and its fault is labelled."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

import gen
from features.signal import band_envelope_spectrum
from gen.corpus import open_corpus, stored_columns, validate_corpus
from gen.generation.undetected import made_from
from gen.physics.kernel.layout import SPEED_TERMS
from gen.recipe import read_recipe
from gen.scenarios import check_scenario, draw_scenarios, read_scenario, scenario_texts
from gen.simulation.simulate import integrations, motion_of, open_integrations, runs_of, simulate
from gen.support.errors import RecipeError

# as many balls as a 6205, and so its kernels, with other orders
OWN = {"n_balls": 9, "pitch_diameter_mm": 60, "ball_diameter_mm": 9}
BEARINGS = {"kind": "catalogue", "designations": ["6205"], "entries": {"drive_end": OWN}}
TWO = {
    "bearing": BEARINGS,
    "other_bearing": {
        "bearing": "drive_end",
        "load_percent": "uniform(50, 100)",
        "attenuation_db": "uniform(3, 12)",
        "fault_probability": 0.5,
    },
}


@pytest.fixture(scope="module")
def scenarios(recipe_with):
    return draw_scenarios(recipe_with(TWO))


@pytest.fixture(scope="module")
def response(scenarios):
    return simulate(scenarios)


def alone(scenarios):
    return [replace(scenario, other=None) for scenario in scenarios]


def test_the_other_bearing_moves_no_other_drawn_value(recipe_with, scenarios):
    without = draw_scenarios(recipe_with({"bearing": BEARINGS}))
    corpus = without[0].settings.corpus  # the identity of a corpus is the hash of its recipe
    found = [replace(one, settings=replace(one.settings, corpus=corpus)) for one in alone(scenarios)]
    assert found == without
    assert all("other" not in text.partition('"record"')[2] for text in scenario_texts(without))


def test_a_scenario_with_two_bearings_is_stored_and_read_and_checked(scenarios):
    for scenario, text in zip(scenarios, scenario_texts(scenarios), strict=True):
        assert read_scenario(text) == scenario
        check_scenario(scenario)
    spalled = next(one for one in scenarios if one.other.specimen.spalls)
    mislabelled = replace(spalled.other, specimen=replace(spalled.other.specimen, fault="healthy"))
    with pytest.raises(RecipeError, match="the damage of the specimen is"):
        check_scenario(replace(spalled, other=mislabelled))


def test_every_fault_of_one_bearing_is_beside_every_fault_of_the_other_in_the_shipped_recipe():
    recipe = read_recipe("gearbox")
    drawn = draw_scenarios(recipe)[:: recipe.corpus.records_per_specimen]
    pairs = Counter((one.specimen.fault, one.other.specimen.fault) for one in drawn)
    kinds = ("healthy", "inner", "outer", "ball")
    product = {(own, other): 24 * (0.6 if other == "healthy" else 0.4 / 3) for own in kinds for other in kinds}
    assert pairs == pytest.approx(product, abs=1)


def test_both_bearings_turn_with_one_shaft_and_each_with_its_own_cage(response):
    for run, first in zip(response.others, response.inputs, strict=True):
        other = run.given
        assert other.turning.shaft_angle == first.turning.shaft_angle
        assert other.turning.cage_angle != first.turning.cage_angle
        for ours, theirs in ((first.frequencies, other.frequencies), (first.phases, other.phases)):
            np.testing.assert_array_equal(ours[:SPEED_TERMS], theirs[:SPEED_TERMS])
            assert not np.isin(ours[SPEED_TERMS:], theirs[SPEED_TERMS:]).any()
    for ours, theirs in zip(response.truth, response.other_truth, strict=True):
        assert ours.true_shaft_rate == theirs.true_shaft_rate
        assert theirs.true_bpfo == pytest.approx(4.5 * (1 - 9 / 60), rel=0.02)


def own_twins(response):
    """Records without the fault of the bearing at this end."""
    return [twin for twin in response.twins if not twin.of_other]


def test_a_response_is_the_sum_of_both_bearings(scenarios, response):
    first, other = simulate(alone(scenarios)), response.others
    gains = np.array([scenario.other.gain for scenario in scenarios], np.float32)[:, None, None]
    added = gains * np.stack([motion_of(run) for run in other])
    np.testing.assert_array_equal(response.acceleration, first.acceleration + added)
    for twin, alone_twin in zip(own_twins(response), own_twins(first), strict=True):
        np.testing.assert_array_equal(twin.acceleration, alone_twin.acceleration + added[twin.place])


def test_what_a_fault_adds_does_not_depend_on_the_other_bearing(scenarios, response):
    first = simulate(alone(scenarios))
    added, alone_added = (
        np.stack([one.acceleration[twin.place] - twin.acceleration for twin in own_twins(one)])
        for one in (response, first)
    )
    np.testing.assert_allclose(added, alone_added, atol=1e-5 * np.abs(response.acceleration).max())


def test_an_other_bearing_that_no_sensor_gets_changes_no_bit(scenarios):
    silent = [replace(one, other=replace(one.other, gain=0.0)) for one in scenarios]
    with_other, without = made_from(silent).measured, made_from(alone(scenarios)).measured
    np.testing.assert_array_equal(with_other.signal, without.signal)
    np.testing.assert_array_equal(with_other.detectable, without.detectable)
    faulty = [one.other.specimen.fault != "healthy" for one in scenarios]
    assert np.isneginf(with_other.other_fault_snr[faulty]).all()
    assert np.isnan(with_other.other_fault_snr[np.invert(faulty)]).all()
    assert not with_other.other_detectable.any()


def test_the_lines_of_a_faulty_other_bearing_are_in_the_record_of_a_healthy_one():
    recipe = gen.make_recipe(
        ["healthy", gen.outer(width_mm=1)],
        1,
        duration_s=1,
        sample_rate_hz=12000,
        slip_percent=0.01,
        bearing=BEARINGS,
        level={"kind": "physical", "background_m_s2": 0.05},
        other_bearing={"bearing": "drive_end", "attenuation_db": 10, "fault_probability": 0.999},
    )
    scenario = next(one for one in draw_scenarios(recipe) if one.specimen.fault == "healthy")
    assert scenario.other.specimen.fault == "outer"
    found = gen.simulate([scenario]).isel(record=0)
    frequencies, (spectrum,) = band_envelope_spectrum(found.acceleration.values, 12000.0, (2000, 4000))

    def line(order):
        away = np.abs(frequencies - float(order * found.true_shaft_rate))
        return spectrum[away <= 1].max() / np.median(spectrum[away <= 25])

    assert line(found.true_other_bpfo) > 30
    assert line(found.true_bpfo) < 10
    assert (found.fault_name, found.other_fault, found.other_detectable) == ("healthy", 2, 1)
    assert found.other_fault_snr > 0


def test_the_records_of_a_group_share_the_other_bearing(recipe_with):
    faults = [{"kind": "healthy"}, {"kind": "outer", "width_mm": 1}]
    recipe = recipe_with(TWO | {"corpus.rungs": [0, 0.5, 1], "faults": faults})
    some = draw_scenarios(recipe)
    runs = runs_of(some)
    assert integrations(some) == len(open_integrations(runs))
    pairs = {run.scenario.record.pair for run in runs} - {-1}
    assert pairs
    for pair in pairs:
        assert len({id(run.other) for run in runs if run.scenario.record.pair == pair}) == 1


def test_a_corpus_has_the_same_bytes_with_any_number_of_workers_and_is_replayed(write_recipe, tmp_path):
    changes = TWO | {
        "truth.undetected": "redraw",
        "level": {"kind": "snr", "healthy_db": 0, "faulty_db": "uniform(-10, 15)"},
    }
    recipe = write_recipe(tmp_path / "two.yaml", changes)
    one = gen.generate(recipe, tmp_path / "one", workers=1).path
    two = gen.generate(recipe, tmp_path / "two", workers=2).path
    for file in sorted(path.relative_to(one) for path in one.rglob("*.nc")):
        assert (one / file).read_bytes() == (two / file).read_bytes(), file
    assert validate_corpus(one) == []
    columns = stored_columns(one / "index.nc")
    errors = columns["step_error"][np.isfinite(columns["step_error"])]
    assert len(errors) > 0
    assert (errors < 0.02).all()
    faulty = np.flatnonzero(columns["other_fault"] > 0)
    assert set(columns["other_detectable"][faulty]) <= {0, 1}
    for record in (0, int(faulty[0])):
        assert gen.replay(one, record).identical
    with open_corpus(one) as corpus:
        assert set(corpus["other_bearing"].values) == {"drive_end"}


@pytest.mark.parametrize(
    ("other", "sentence"),
    [
        ({"attenuation_db": 10, "bearing": "6299"}, "other_bearing.bearing: '6299' is neither in the catalogue nor in"),
        ({"bearing": "6205"}, "other_bearing.attenuation_db: is missing"),
    ],
)
def test_a_wrong_other_bearing_is_refused_in_one_sentence(other, sentence):
    with pytest.raises(RecipeError, match=sentence):
        gen.make_recipe(gen.outer(width_mm=1), other_bearing=other)


def test_an_other_bearing_cannot_have_a_fault_if_there_is_none():
    with pytest.raises(RecipeError, match="faults has no fault"):
        gen.make_recipe("healthy", other_bearing={"attenuation_db": 10, "fault_probability": 0.5})


def test_designations_of_makers_and_numbers_name_the_other_bearing():
    for name in (6206, "SKF 6206-2RS1/C3"):
        recipe = gen.make_recipe("healthy", other_bearing={"attenuation_db": 10, "bearing": name})
        assert draw_scenarios(recipe)[0].other.bearing.designation == "6206"
