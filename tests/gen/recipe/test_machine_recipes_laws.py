"""Laws of machines that recipe keys set: bent, misaligned, loose, with distant sensors, springs, dampers and oils."""

import numpy as np
import pytest

from gen.recipe.keys import recipe_keys
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import simulate
from gen.simulation.timeline import timeline
from gen.support.units import split_unit
from tests.measuring import measure
from tests.responses import input_of

FS = 12_000.0
RATE, MASS = 30.0, 10.0  # of the shaft [Hz], of shaft and housing [kg]
# a steady machine: a support as stiff as in no resonance, oil, a load that hardly wanders
STEADY = {
    "corpus": {"rigs": 1, "specimens_per_rig": 2, "records_per_specimen": 1},
    "recording.duration_s": 1.0,
    "recording.settle_s": 0.3,
    "recording.channels": [{"name": "housing", "body": "housing", "angle_deg": 0}],
    "machine.shaft_mass_kg": 5,
    "machine.housing_mass_kg": 5,
    "machine.support_frequency_hz": 400,
    "machine.balance_mm_s": 0,
    "machine.looseness_um": 1e-4,
    "contact.lubricant": {},
    "specimen.waviness_nm": 1e-3,
    "specimen.ball_waviness_nm": 1e-3,
    "specimen.diametral_clearance_um": -4,
    "operation.shaft_rpm": 60 * RATE,
    "operation.load_n": 300,
    "operation.load_wander_percent": 1e-3,
    "operation.speed_wander_percent": 0,
    "operation.slip_percent": 0,
    "operation.jitter_deg": 1e-3,
    "faults": [{"kind": "healthy"}],
}


@pytest.fixture
def signal_of(recipe_with):
    """Acceleration of the housing along x of the first record of the steady machine with some values replaced [m s-2]."""

    def first_record(changes):
        recipe = recipe_with(STEADY | changes)
        (run,) = simulate(draw_scenarios(recipe, 0, 1))
        assert run.failure is None
        return run.acceleration[0, timeline(recipe).lead :]

    return first_record


def line(signal, order):
    """Amplitude of a line at an order of the shaft, over whole turns [m s-2]."""
    turn = 2 * np.pi * order * RATE * np.arange(len(signal)) / FS
    return 2 * abs(np.mean(signal * np.exp(-1j * turn)))


def shaken(force, order):
    """Amplitude of the housing's acceleration by a force on its support, shaft and housing as one body [m s-2]."""
    omega, resonance = 2 * np.pi * order * RATE, 2 * np.pi * 400
    return force * omega**2 / (MASS * (resonance**2 - omega**2))


@pytest.mark.parametrize(("key", "order"), [("machine.bow_n", 1), ("machine.misalignment_n", 2)])
def test_a_bent_or_misaligned_shaft_shakes_the_housing_at_its_own_order(signal_of, key, order):
    """At 100 N, by the compliance of the support; ring and bearing between shaft and housing add a few percent."""
    straight, crooked = signal_of({}), signal_of({key: 100})
    assert line(crooked, order) == pytest.approx(shaken(100, order), rel=0.05)
    for other in (1, 2):
        assert line(straight, other) < 0.02 * line(crooked, order)
    assert line(crooked, 3 - order) < 0.05 * line(crooked, order)


def test_a_loose_housing_rattles_at_orders_that_a_fast_one_has_not(signal_of):
    bent = {"machine.bow_n": 500, "operation.load_n": 100}
    fast, loose = signal_of(bent), signal_of(bent | {"machine.looseness_um": 5})
    assert loose.std() > 2 * fast.std()
    assert line(loose, 2) + line(loose, 3) > 5 * (line(fast, 2) + line(fast, 3))


def test_a_channel_with_a_path_of_its_own_hears_by_that_path(recipe_with):
    """The bodies of all four channels move equally; without a background only their paths differ."""
    modes = {"count": 1, "frequency_hz": 1000, "damping_percent": 3}
    paths = [None, {"direct": 0.25}, {"direct": 0.25, "modes": modes}, {"direct": 2.0}]
    recipe = recipe_with(
        {
            "recording.channels": [{"name": f"c{n}", "path": path} for n, path in enumerate(paths)],
            "recording.converter": {"kind": "float32"},
            "path": {"direct": 0.5},
            "level": {"kind": "physical", "background_m_s2": 0},
        }
    )
    scenarios = draw_scenarios(recipe, 0, 2)
    moved = np.random.default_rng(1).normal(size=(2, 1, timeline(recipe).lead + recipe.n_samples))
    measured = measure(np.repeat(moved, 4, axis=1), scenarios).signal
    np.testing.assert_allclose(measured[:, 1], 0.5 * measured[:, 0], atol=1e-5)
    np.testing.assert_allclose(measured[:, 3], 4 * measured[:, 0], atol=1e-5)
    assert measured[:, 2].std() > 1.2 * measured[:, 1].std()


def machine_with(recipe_with, changes):
    recipe = recipe_with(changes)
    return input_of(draw_scenarios(recipe, 0, 1)[0]).machine


SPRINGS = [key.key for key in recipe_keys("machine.") if key.key.endswith(("_n_m", "_n_s_m"))]


@pytest.mark.parametrize("key", SPRINGS)
def test_a_spring_or_damper_of_the_recipe_is_that_of_the_machine(recipe_with, key):
    machine, constant = machine_with(recipe_with, {key: 1234.5}), split_unit(key.removeprefix("machine."))[0]
    assert {value for name, value in machine._asdict().items() if name.startswith(constant)} == {1234.5}


def test_the_support_is_stiffer_in_the_vertical_by_its_ratio(recipe_with):
    machine = machine_with(recipe_with, {"machine.support_ratio": 2.5})
    assert machine.support_stiffness_y == pytest.approx(2.5 * machine.support_stiffness_x)


@pytest.mark.parametrize(("key", "low", "high"), [("pressure_viscosity_per_gpa", 10, 30), ("density_kg_m3", 800, 1000)])
def test_an_oil_that_is_more_viscous_under_load_leaves_less_clearance(recipe_with, key, low, high):
    thin, thick = (machine_with(recipe_with, {"contact": {"lubricant": {key: value}}}) for value in (low, high))
    assert thick.half_clearance < thin.half_clearance
