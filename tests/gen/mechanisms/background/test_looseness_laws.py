"""Laws of a machine whose support lifts off the ground: how often it lands, its lines, its level, and its label."""

import numpy as np
import pytest

from gen.mechanisms.background.looseness import Looseness
from gen.mechanisms.mechanism_labels import label_values
from gen.scenarios import draw_scenarios
from tests.measuring import FLOAT, background_of, drawn, quiet

FS, RATE, N = 12_000.0, 25.0, 48_000  # four seconds: 100 turns of the shaft
STEADY = 2 * np.pi * RATE / FS * np.arange(N)
LOOSE = {"probability": 1, "lift": 1.5, "frequency_hz": 400, "level_db": 6}
LIFTED_MOST = 2 * np.pi * np.random.default_rng(0).random()  # angle of the shaft, of the rig


def vibrations(angles, **changes):
    return drawn(Looseness, **(LOOSE | changes)).vibrations(angles, FS, lambda **_: np.random.default_rng(0))


def vibration(**changes):
    (found,) = vibrations(STEADY, **changes)
    return found


def lines(signal, orders):
    """Amplitudes at orders of the shaft over the largest of all lines, once the motion has settled."""
    settled = np.abs(np.fft.rfft(signal[N // 2 :]))
    return settled[np.round(np.asarray(orders) * RATE * N / 2 / FS).astype(int)] / settled.max()


@pytest.mark.parametrize("lift", [1.2, 1.5, 2.0])
def test_a_machine_that_lands_once_a_turn_has_harmonics_and_no_half_orders(lift):
    found = vibration(lift=lift)
    assert lines(found, [1, 2, 3, 4]).min() > 0.1
    assert lines(found, [0.5, 1.5, 2.5]).max() < 1e-3


def test_a_machine_that_flies_for_more_than_a_turn_lands_every_second_turn():
    assert lines(vibration(lift=5.0), [0.5, 1.5, 2.5]).min() > 0.1


def test_a_short_flight_follows_the_weight_and_the_force_of_the_shaft():
    """Until it lands, the acceleration is ``g (lift cos(angle - phase) - 1)``; its level is its rms."""
    lift = 1.1
    found = vibration(lift=lift)
    expected = 9.80665 * (lift * np.cos(STEADY - LIFTED_MOST) - 1)
    aloft = expected > 0.02
    scale = np.median(found[aloft] / expected[aloft])
    np.testing.assert_allclose(found[aloft], scale * expected[aloft], atol=1e-6 * scale)
    assert np.sqrt(np.mean(found**2)) == pytest.approx(10 ** (6 / 20))


def test_a_loose_machine_moves_no_other_draw_and_is_labelled(recipe_with):
    plain = draw_scenarios(recipe_with(), 0, 4)
    loose = draw_scenarios(recipe_with({"machine_conditions.looseness": LOOSE}), 0, 4)
    for one, other in zip(plain, loose, strict=True):
        assert label_values(other.recipe, {})["looseness"] == 1.5
        conditions = other.recipe.machine_conditions.model_copy(update={"looseness": None})
        origin = other.origin.model_copy(update={"corpus": one.origin.corpus})
        assert other.edited(machine_conditions=conditions, origin=origin) == one


def test_it_passes_path_and_chain_at_its_level(recipe_with):
    changes = FLOAT | {"recording.duration_s": 2.0}
    firm, loose = (
        background_of(recipe_with(changes | quiet() | some))[0].std()
        for some in ({}, {"machine_conditions.looseness": LOOSE | {"level_db": 10}})
    )
    assert np.sqrt(loose**2 - firm**2) == pytest.approx(10 ** (10 / 20), rel=0.1)
