"""Laws of the step check: some records are integrated again with half the step, and all are checked against their stiffest contacts."""

import numpy as np
import pytest

from gen.corpus import FAULTS, open_corpus, read_manifest, validate_corpus
from gen.generation.corpus import generate
from gen.generation.step_checks import CHECKED_PARTS, checked_places, step_errors
from gen.generation.undetected import made_from
from gen.measurement.measure import Measured
from gen.physics.kernel.compiling import LANES
from gen.physics.rotor import highest_angular_frequency
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import simulate
from gen.simulation.steps import COARSEST_STEP, FINE_STEP
from gen.support.errors import SimulationError
from tests.lanes import march_lanes
from tests.reference import contact_stiffness, contacts
from tests.reference_motion import slow_motion
from tests.responses import input_of

FS = 12_000.0
# the races of the second rig are so rough that ball forces far exceed the load from which the step is chosen
ROUGH = {
    "recording.oversampling": 1,
    "recording.sample_rate_hz": 24000,
    "machine.shaft_mass_kg": 2,
    "specimen.diametral_clearance_um": 5,
    "specimen.waviness_nm": "grid(10, 10, 10, 10, 10000, 10000, 10000, 10000, 10, 10, 10, 10)",
    "operation.load_n": 20,
}


def step_errors_of(recipe, numbers):
    outcomes = made_from(draw_scenarios(recipe, numbers.start, numbers.stop))
    return step_errors(recipe, numbers, [outcome for outcome in outcomes if isinstance(outcome, Measured)])


@pytest.fixture(scope="module")
def checked(recipe_with):
    """The small recipe, its scenarios, their runs and step errors."""
    recipe = recipe_with()
    scenarios = draw_scenarios(recipe)
    runs = simulate(scenarios)
    return recipe, scenarios, runs, step_errors_of(recipe, range(recipe.n_records))


def test_the_first_record_of_every_class_is_tried_at_half_the_step(checked):
    _, scenarios, _, errors = checked
    faults = [scenario.fault for scenario in scenarios]
    assert errors.shape == (len(scenarios),)
    assert np.isfinite(errors[[faults.index(fault) for fault in FAULTS if fault in faults]]).all()


def test_at_half_the_step_ordinary_records_change_by_less_than_a_hundredth(checked):
    """40 dB below the bearing, where the noise of the machines of the shipped recipes is at least 15 dB higher."""
    errors = checked[3]
    tried = errors[np.isfinite(errors)]
    assert (tried > 0).all()
    assert tried.max() < 1e-2


def checked_records(recipe, faults):
    """Numbers of the records whose step is checked, if all share their kernel, by the number of their part."""
    checked = {}
    for part in range(recipe.n_parts):
        numbers = recipe.records_of_part(part)
        places = checked_places(recipe, numbers, faults[numbers.start : numbers.stop], ["one"] * len(numbers))
        checked[part] = [numbers[place] for place in places]
    return checked


LAYOUTS = {
    "every class in part 0": {"storage.records_per_part": 64, "corpus.records_per_specimen": 1},
    "one class in a part": {"storage.records_per_part": 4, "corpus.records_per_specimen": 40},
    "one record in a part": {"storage.records_per_part": 1, "corpus.records_per_specimen": 3},
    "parts across specimens": {"storage.records_per_part": 5, "corpus.records_per_specimen": 7},
    "fewer classes on a rig than there are": {"corpus.specimens_per_rig": 2, "corpus.records_per_specimen": 3},
}


@pytest.mark.parametrize("layout", LAYOUTS.values(), ids=LAYOUTS)
def test_every_class_and_a_batch_of_every_eighth_part_are_tried_whatever_the_layout(recipe_with, layout):
    recipe = recipe_with({"corpus.rigs": 60, "records": 397} | layout)
    faults = [scenario.fault for scenario in draw_scenarios(recipe)]
    checked = checked_records(recipe, faults)
    assert len(set(faults)) == len(recipe.faults)
    assert {faults[number] for numbers in checked.values() for number in numbers} == set(faults)
    for part, numbers in checked.items():
        full = min(LANES, len(recipe.records_of_part(part)))
        batch = 0 if part % CHECKED_PARTS else full
        assert batch <= len(numbers) <= batch + len(set(faults))
    some = recipe_with({"corpus.rigs": 60, "records": 200} | layout)
    fewer, whole = checked_records(some, faults), range(200 // recipe.storage.records_per_part)
    assert [fewer[part] for part in whole] == [checked[part] for part in whole]


def test_a_batch_is_checked_where_its_turn_comes_and_of_records_that_share_a_kernel_alone(recipe_with):
    recipe = recipe_with({"corpus.rigs": 500, "storage.records_per_part": 100})

    def places(numbers, groups):
        return [*checked_places(recipe, numbers, ["inner"] * len(groups), groups)]

    # no class has its first record from here on: all have it on the first rig
    assert places(range(800, 900), ["one"] * 100) == [*range(LANES)]
    assert places(range(800, 900), ["one", "other", "one"]) == [0, 2]
    assert places(range(800, 900), []) == []
    assert places(range(700, 800), ["one"] * 100) == []


def test_a_class_whose_first_record_failed_is_tried_at_the_next(recipe_with):
    recipe = recipe_with({"storage.records_per_part": 24})
    scenarios = draw_scenarios(recipe)
    faults = [scenario.fault for scenario in scenarios]
    failed = faults.index("inner")
    places = [place for place in range(len(scenarios)) if place != failed]
    tried = checked_places(recipe, range(24), [faults[place] for place in places], places)
    assert faults.index("inner", failed + 1) in [places[place] for place in tried]


def test_chosen_steps_follow_the_stiffest_contacts_and_no_finer_than_they_need(checked):
    assert all(FINE_STEP / 8 < run.step_phase < FINE_STEP for run in checked[2])


def test_the_step_phase_is_that_of_the_stiffest_contacts_of_the_record(checked):
    """Contact stiffness is evaluated at every knot; it changes little between two knots."""
    recipe, scenarios, runs, _ = checked
    record, run = input_of(scenarios[3]), runs[3]
    n_knots = round(recipe.recording.settle_s * FS) + recipe.n_samples
    (trip,) = march_lanes([record], n_knots, run.oversampling, 1 / FS)
    slow = slow_motion(record, 1 / FS, n_knots)
    squeezes = (contacts(record, slow, at, 0.0, trip.states[at]).squeeze for at in range(n_knots))
    stiffest = max(contact_stiffness(record.machine, squeeze) for squeeze in squeezes)
    phase = float(highest_angular_frequency(record.machine, stiffest)) / (FS * run.oversampling)
    assert phase * (1 - 1e-9) <= run.step_phase < 1.02 * phase


def test_records_whose_contacts_outgrow_the_step_are_left_out_with_a_sentence(write_recipe, tmp_path):
    recipe = write_recipe(tmp_path / "r.yaml", ROUGH)
    generated = generate(recipe, tmp_path / "c")
    assert (generated.records, generated.parts) == (16, 2)
    assert [sentence.partition(":")[0] for sentence in generated.failures] == [
        f"record {number}" for number in range(8, 16)
    ]
    grown = "its contacts became stiffer than 1 steps per sample can follow; set recording.oversampling to "
    for sentence in generated.failures:
        assert grown in sentence
        assert int(sentence.rstrip(".").split()[-1]) > 1 / FINE_STEP
    assert read_manifest(generated.path).failures == generated.failures
    assert validate_corpus(generated.path) == []
    with open_corpus(generated.path) as corpus:
        assert corpus["recording"].values.tolist() == [*range(8), *range(16, 24)]
        assert (corpus["step_phase"].values < COARSEST_STEP).all()
    again = generate(recipe, tmp_path / "c")
    assert (again.records, again.kept, again.failures) == (16, 2, generated.failures)


def test_as_many_steps_as_the_sentence_asks_for_are_enough(recipe_with):
    recipe = recipe_with(ROUGH)
    coarse = simulate(draw_scenarios(recipe, 8, 10))
    asked = [int(run.failure.rstrip(".").split()[-1]) for run in coarse]
    finer = recipe_with(ROUGH | {"recording.oversampling": max(asked)})
    for run in simulate(draw_scenarios(finer, 8, 10)):
        assert run.failure is None
        assert run.step_phase < 1.1 * FINE_STEP


def test_a_shaft_that_turns_too_far_between_two_samples_is_refused(recipe_with):
    recipe = recipe_with({"operation.shaft_rpm": 9000, "recording.sample_rate_hz": 1000})
    with pytest.raises(SimulationError, match=r"^record 0: its shaft turns 54 degrees per sample; raise .* to 1347\.$"):
        simulate(draw_scenarios(recipe, 0, 1))
