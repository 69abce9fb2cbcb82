"""Laws of the estimates: a background that a recipe made is found again."""

import numpy as np
import pytest

from gen.drawing import plain
from gen.mechanisms.background.noise import Noise, noise_spectrum
from raceway.imitating.estimates import background_keys
from tests.measuring import FLOAT, FS, background_of, quiet

RATE = 25.0


def estimates_of(recipe_with, **sources):
    """Estimates from forty records of a machine with three resonances and some sources, and its keys."""
    modes = {"count": 3, "frequency_hz": [700, 2100, 3900], "damping_percent": [4, 2, 6], "gain_db": [0, 6, 3]}
    keys = quiet(slope=0.5, floor_db=-30, modes=modes | {"sign": 1}, **sources)
    changes = {"operation.shaft_rpm": 60 * RATE, "recording.duration_s": 0.5, "faults": [{"kind": "healthy"}]}
    recipe = recipe_with(FLOAT | changes | {"corpus.rigs": 5, "recording.settle_s": 0.1} | keys)
    signals, _ = background_of(recipe, 40)
    return background_keys(signals[:, 0], FS, RATE), plain(recipe.background)


@pytest.fixture(scope="module")
def estimated(recipe_with):
    tones = {"count": 2, "frequency_hz": [1502, 3100], "level_db": [-6, -15]}
    return estimates_of(recipe_with, tones=tones)


def test_the_noise_has_the_density_of_the_recording(estimated):
    keys, own = estimated
    frequency = np.arange(100, 4800, 10.0)
    levels = [
        20 * np.log10(noise_spectrum(Noise.model_validate({key: of[key] for key in names}).as_drawn(), frequency))
        for of in (keys, own)
        for names in [("slope", "floor_db", "modes")]
    ]
    error = levels[0] - levels[1]
    assert np.sqrt(np.mean((error - error.mean()) ** 2)) < 1.0


def test_lines_keep_their_frequencies_and_levels(estimated):
    tones, own = (keys["tones"] for keys in estimated)
    assert tones["frequency_hz"] == pytest.approx(own["frequency_hz"], abs=1)
    assert tones["level_db"] == pytest.approx(own["level_db"], abs=1)


def test_the_modulation_by_the_shaft_keeps_its_depth(recipe_with):
    keys, own = estimates_of(recipe_with, modulation={"first": 0.3, "second": 0.1})
    assert keys["modulation"] == pytest.approx(own["modulation"], abs=0.03)
