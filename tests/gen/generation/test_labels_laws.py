"""Laws of labels: the labels of a record equal the values of the recipe, each computed by hand."""

import math

import numpy as np
import pytest

from gen.corpus import FAULTS, SPLITS
from gen.generation.labels import part_dataset
from gen.measurement.measure import measure
from gen.mechanisms.chain.measuring_chain import CHAIN
from gen.recipe import corpus_identity
from gen.scenarios import draw_scenarios, read_scenario
from gen.simulation.timeline import timeline
from tests.measuring import side_by_side
from tests.responses import runs_of

BALL, PITCH, Z = 7.94e-3, 39.04e-3, 9  # 6205
STEADY = {
    "operation.shaft_rpm": 1800, "operation.load_n": 400, "operation.speed_wander_percent": 0, "operation.mean_slip_percent": 0,
    "operation.slip_percent": 0, "operation.spin_wander_percent": 0, "specimen.diametral_clearance_um": 10,
}  # fmt: skip
INNER = {"kind": "inner", "width_mm": 0.4, "angle_deg": 20}
OUTER = {"kind": "outer", "width_mm": 0.8, "angle_deg": 15}
CAGE = {"kind": "cage", "pitch_error_deg": 4, "knock_n": 30}


def labels(recipe, **options):
    """Labels of all records of a recipe whose bodies are at rest; labels do not depend on the motion."""
    scenarios = draw_scenarios(recipe)
    return part_dataset(recipe, measure(runs_of(scenarios)), **options)


@pytest.fixture
def labels_with(recipe_with):
    return lambda changes: labels(recipe_with(STEADY | changes))


def first(records, name):
    return records[name].values[0]


@pytest.mark.parametrize(("percent", "labelled"), [(2, 30.6), (-2, 29.4), (0, 30.0)])
def test_a_tachometer_that_reads_too_high_labels_too_high_a_rate(labels_with, percent, labelled):
    records = labels_with({"operation.label_error_percent": percent})
    assert records["shaft_rate"].values == pytest.approx(labelled)
    assert records["true_shaft_rate"].values == pytest.approx(30.0)
    assert records["first_shaft_rate"].values == pytest.approx(30.0)
    assert records["last_shaft_rate"].values == pytest.approx(30.0)


def test_the_orders_are_nominal_and_the_true_ones_have_the_slip(labels_with):
    records = labels_with({"operation.mean_slip_percent": 1})
    gamma = BALL / PITCH
    ftf, bsf = (1 - gamma) / 2, PITCH / (2 * BALL) * (1 - gamma**2)
    expected = {"ftf": ftf, "bpfo": Z * ftf, "bpfi": Z * (1 - ftf), "bsf": bsf}
    slipping = {"ftf": 0.99 * ftf, "bpfo": Z * 0.99 * ftf, "bpfi": Z * (1 - 0.99 * ftf), "bsf": bsf}
    for name in expected:
        assert records[name].values == pytest.approx(expected[name])
        assert records[f"true_{name}"].values == pytest.approx(slipping[name])


def test_the_contact_angle_of_a_specimen_is_in_the_true_orders_alone(labels_with):
    """The nominal geometry is that of the drawing."""
    straight, slanted = labels_with({}), labels_with({"specimen.contact_angle_deg": 20})
    gamma = BALL * math.cos(math.radians(20)) / PITCH
    assert slanted["bpfo"].values == pytest.approx(first(straight, "bpfo"))
    assert slanted["true_bpfo"].values == pytest.approx(Z * (1 - gamma) / 2)


@pytest.mark.parametrize("site", ["inner", "outer", "ball"])
def test_the_largest_drop_is_that_of_the_depth_where_a_ball_reaches_the_floor(labels_with, site):
    wide = {"kind": site, "width_mm": 3, "depth_um": 5}
    narrow = {"kind": site, "width_mm": 0.1, "depth_um": 5}  # a ball drops into it by a fraction of a micrometre
    assert labels_with({"faults": [wide]})["largest_drop"].values == pytest.approx(5e-6)
    assert 0 < first(labels_with({"faults": [narrow]}), "largest_drop") < 1e-6


def test_several_faults_are_labelled_by_the_widest_spall_and_by_all_parts(labels_with):
    deep = INNER | {"depth_um": 300}
    records = labels_with({"faults": [{"kind": "compound", "parts": [deep, OUTER | {"depth_um": 2}, CAGE]}]})
    assert FAULTS[first(records, "fault")] == "compound"
    assert first(records, "parts") == "inner+outer+cage"
    assert first(records, "n_spalls") == 2
    assert first(records, "width") == pytest.approx(0.8e-3)
    assert first(records, "depth") == pytest.approx(2e-6)
    assert first(records, "largest_drop") == pytest.approx(2e-6)
    assert first(records, "pitch_error") == pytest.approx(math.radians(4))
    assert first(records, "knock") == 30
    assert first(records, "wear") == 0


def test_the_temperature_is_labelled_where_there_is_oil(labels_with):
    oiled = {"contact.lubricant": {}, "operation.temperature_celsius": 55}
    assert labels_with(oiled)["temperature"].values == pytest.approx(55)
    assert np.isnan(labels_with({})["temperature"].values).all()


def test_both_clearances_are_diametral(labels_with):
    """A hotter inner ring reduces the operating clearance, and not the clearance as built."""
    cold, warm = labels_with({}), labels_with({"operation.inner_ring_hotter_k": 10})
    for records in (cold, warm):
        assert records["diametral_clearance"].values == pytest.approx(10e-6)
    assert cold["operating_clearance"].values == pytest.approx(10e-6)
    outer = (PITCH + BALL) / 2
    assert warm["operating_clearance"].values == pytest.approx(10e-6 - 2 * 10 * 12.5e-6 * outer)


def test_what_the_run_found_stands_beside_its_record(recipe_with):
    recipe = recipe_with({"records": 4})
    errors = np.array([np.nan, 1e-4, 2e-4, np.nan])
    records = labels(recipe, step_error=errors)
    assert records["oversampling"].values.tolist() == [2, 3, 4, 5]
    assert (np.diff(records["step_phase"].values) < 0).all()
    np.testing.assert_array_equal(records["step_error"].values, errors)
    assert np.isnan(labels(recipe)["step_error"].values).all()


def test_signal_ratio_and_clipped_samples_are_those_that_were_measured(recipe_with):
    recipe = recipe_with({"records": 3, "recording.converter": {"kind": "adc", "full_scale_m_s2": 2.0}})
    scenarios, n = draw_scenarios(recipe), timeline(recipe).lead + recipe.n_samples
    hiss = 4 * np.random.default_rng(0).standard_normal((3, 1, n)).astype(np.float32)
    records = measure(runs_of(scenarios, hiss))
    measured, dataset = side_by_side(records), part_dataset(recipe, records)
    np.testing.assert_array_equal(dataset["snr"].values, measured.snr)
    np.testing.assert_array_equal(dataset["clipped"].values, measured.clipped)
    np.testing.assert_array_equal(dataset["acceleration"].values, measured.signal)
    assert measured.clipped.all()
    assert dataset["acceleration"].attrs["scale_factor"] == pytest.approx(2.0 / 32767)


def test_a_record_knows_its_place(recipe_with):
    recipe = recipe_with({"machine.load_angle_deg": "uniform(-100, -80)"})
    scenarios, records = draw_scenarios(recipe), labels(recipe)
    assert records["recording"].values.tolist() == list(range(24))
    assert records["specimen"].values.tolist() == [number // 2 for number in range(24)]
    assert records["rig"].values.tolist() == [number // 8 for number in range(24)]
    assert records["source"].values.tolist() == [f"small/{number}" for number in range(24)]
    assert records["bearing"].values.tolist() == ["6205"] * 24
    assert [SPLITS[code] for code in records["split"].values] == [scenario.origin.split for scenario in scenarios]
    assert [FAULTS[code] for code in records["fault"].values] == [scenario.fault for scenario in scenarios]
    for scenario, text in zip(scenarios, records["draws"].values, strict=True):
        assert read_scenario(text) == scenario


def test_a_record_has_the_identity_that_its_numbers_have_in_every_corpus_of_the_same_draws(recipe_with):
    records = labels(recipe_with({}))
    corpora = {text.partition("/")[0] for text in records["identity"].values}
    assert corpora == {
        corpus_identity(recipe_with({"storage.records_per_part": 5, "title": "Another title", "records": 9}))
    }
    assert corpora != {corpus_identity(recipe_with({"seed": 8}))}
    numbers = [tuple(map(int, text.split("/")[1:])) for text in records["identity"].values]
    wanted = [records[name].values.tolist() for name in ("rig", "specimen", "recording", "pair")]
    assert numbers == list(zip(*wanted, strict=True))


def test_every_label_of_the_measuring_chain_is_a_variable_and_0_without_faults(labels_with):
    records = labels_with({})
    assert all((records[label.name].values == 0).all() for mechanism in CHAIN for label in mechanism.labels)
