"""Laws of the shape of an envelope, against the definitions of its values."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from features.signal.demodulation import fine_amplitudes, weight_by_hann
from features.signal.shape import envelope_shape, highest_spectral_kurtosis
from features.signal.spectra import fourier_coefficients

law = settings(deadline=None, max_examples=25)


@law
@given(st.integers(0, 2**32 - 1), st.integers(400, 5000), st.floats(9.0, 60.0))
def test_the_shape_of_an_envelope_follows_its_definitions(seed, n, shaft_rate):
    rate = 2000.0
    power = np.random.default_rng(seed).exponential(size=(2, n)) * (1 + 0.5 * np.sin(np.arange(n) * 20 / rate))
    weighted = weight_by_hann(np.sqrt(power))
    spectrum = fine_amplitudes(weighted, 2 * n + 1)
    slow = np.arange(2 * n + 1) * rate / (4 * n) < 0.8 * shaft_rate
    span = round(0.5 * rate / shaft_rate)
    starts = range(0, n - span + 1, span // 4)
    means = np.stack([power[:, start : start + span].mean(axis=1) for start in starts])
    expected = (
        np.log(np.mean(power**2, axis=1) / np.mean(power, axis=1) ** 2),
        means.std(axis=0) / power.mean(axis=1),
        np.sum(spectrum[:, slow] ** 2, axis=1) / np.sum(spectrum**2, axis=1),
    )
    low = spectrum[:, : np.count_nonzero(slow) + 1]
    found = envelope_shape(power, weighted, low, rate, np.full(2, shaft_rate))
    np.testing.assert_allclose(found[:, :2], np.stack(expected[:2], axis=1), rtol=1e-6)
    np.testing.assert_allclose(found[:, 2], expected[2], rtol=0.01)


@law
@given(st.integers(0, 2**32 - 1), st.floats(1e-3, 1e3))
def test_the_spectral_kurtosis_finds_impulses_hidden_in_louder_noise_of_another_band(seed, gain):
    fs, n = 10_000.0, 10_000
    rng = np.random.default_rng(seed)
    low = np.cumsum(rng.standard_normal(n))  # louder below 1 kHz than the impulses are
    pulses = np.zeros(n)
    pulses[500::1000] = 40.0
    noise, hidden = (
        highest_spectral_kurtosis(fourier_coefficients(gain * x[None], fs, 5000.0), (4, 8))[0]
        for x in (rng.standard_normal(n), low + pulses)
    )
    assert -0.2 < noise < 1.0
    assert hidden > 5.0


def test_the_spectral_kurtosis_of_a_tone_is_minus_one():
    x = np.sin(2 * np.pi * 1000.0 * np.arange(10_000) / 10_000.0)[None]
    around = fourier_coefficients(x, 10_000.0, 5000.0)[:, 900:1101]
    np.testing.assert_allclose(highest_spectral_kurtosis(around, (1,)), -1.0, atol=0.05)
