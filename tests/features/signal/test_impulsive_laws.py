"""Laws of the choice of a band, against planted resonances."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from features.signal import comb_bands, kurtogram

FS = 20_000.0


def impacts(rng, n, resonance, rate, decibels, slip=0.01):
    """Impacts that excite a resonance of 200 Hz bandwidth, at a ratio to white noise of unit power."""
    t = np.arange(round(0.05 * FS)) / FS
    response = np.exp(-np.pi * 200 * t) * np.sin(2 * np.pi * resonance * t)
    between = FS / rate * (1 + slip * rng.standard_normal(int(n / FS * rate) + 5))
    places = np.cumsum(between) - rng.uniform(0, between[0])
    train = np.zeros(n)
    train[places[places < n].astype(int)] = 1.0
    ringing = np.convolve(train, response)[:n]
    return 10 ** (decibels / 20) * ringing / ringing.std() + rng.standard_normal(n)


@pytest.mark.parametrize("resonance", [1250.0, 2700.0, 6000.0])
def test_the_kurtogram_picks_the_planted_band(resonance):
    """Fainter impacts, and a plain filter bank beside it: tests/thorough/test_kurtogram_literature.py."""
    rng = np.random.default_rng(int(resonance))
    x = np.stack([impacts(rng, 20_000, resonance, 100.0, -6) for _ in range(100)])
    edges = kurtogram(x.astype(np.float32), FS).best()
    picked = (edges[:, 0] <= resonance) & (resonance <= edges[:, 1]) & (np.diff(edges)[:, 0] < 3400)
    assert picked.sum() >= 95


@given(st.integers(0, 2**32 - 1), st.floats(1e-3, 1e3))
def test_the_kurtogram_finds_impulses_hidden_in_louder_noise_of_another_band(seed, gain):
    rng = np.random.default_rng(seed)
    low = np.cumsum(rng.standard_normal(20_000))  # louder below 1 kHz than the impulses are
    pulses = np.zeros(20_000)
    pulses[500::1000] = 40.0
    noise, hidden = kurtogram(gain * np.stack([rng.standard_normal(20_000), low + pulses]), FS).score.max(axis=-1)
    assert -0.2 < noise < 1.5
    assert hidden > 5.0


def test_the_bands_of_each_level_cover_the_spectrum_once():
    tree = kurtogram(np.random.default_rng(0).standard_normal((1, 4096)), FS)
    assert np.unique(tree.levels).tolist() == [1, 2, 3, 4, 6, 8]
    for level in np.unique(tree.levels):
        edges = tree.edges[tree.levels == level]
        np.testing.assert_allclose(edges[1:, 0], edges[:-1, 1])
        np.testing.assert_allclose(edges[[0, -1], [0, 1]], [0, FS / 2])
    with pytest.raises(ValueError, match="longer records"):
        kurtogram(np.ones((1, 100)), FS)


def test_the_comb_lies_in_the_band_of_its_fault_and_not_in_that_of_another():
    rng = np.random.default_rng(6)
    for _ in range(10):
        outer, inner = impacts(rng, 40_000, 2500.0, 87.0, -8, 0.0), impacts(rng, 40_000, 7000.0, 131.0, -4, 0.0)
        tree = comb_bands(np.stack([outer + inner] * 2), FS, np.array([87.0, 131.0]))
        for (low, high), resonance in zip(tree.best(), (2500.0, 7000.0), strict=True):
            assert low <= resonance <= high
            assert high - low < 4000
