"""Laws of roll-off, centroid and tonality."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from features.signal.colour import centroid, roll_off, tonality
from features.signal.spectra import psd

law = settings(max_examples=20)
FREQUENCIES = np.arange(1001) * 4.0


@law
@given(st.floats(0.05, 0.95), st.floats(1e-6, 1e6))
def test_a_flat_density_rolls_off_at_the_share_of_its_width_whatever_its_gain(share, gain):
    flat = np.full((1, 1001), gain)
    assert roll_off(flat, FREQUENCIES, share)[0] == pytest.approx(share * 4004 - 2, abs=4)
    assert centroid(flat, FREQUENCIES)[0] == pytest.approx(2000)


@pytest.mark.parametrize("measure", [centroid, tonality, lambda density, f: roll_off(density, f, 0.85)])
def test_a_record_has_the_same_value_in_every_batch(measure):
    density = np.random.default_rng(0).random((37, 1001))
    alone = [measure(row[None], FREQUENCIES)[0] for row in density]
    np.testing.assert_array_equal(measure(density, FREQUENCIES), alone)


@law
@given(st.integers(0, 2**32 - 1), st.floats(0.2, 5.0))
def test_tonality_is_the_share_of_tones_in_the_energy(seed, amplitude):
    fs, n = 8000.0, 8000
    noise = np.random.default_rng(seed).standard_normal(n)
    tone = amplitude * np.sin(2 * np.pi * 1230.0 * np.arange(n) / fs)
    frequencies, density = psd((noise + tone)[None], fs, 1.0)
    share = amplitude**2 / 2 / (amplitude**2 / 2 + 1)
    assert tonality(density, frequencies)[0] == pytest.approx(share, abs=0.06)
