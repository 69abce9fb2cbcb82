"""Laws of the spectral coherence: planted cyclic frequencies, false alarms as promised, agreement with SciPy."""

import numpy as np
import pytest
from scipy.signal import csd, lfilter

from features.signal import enhanced_envelope_spectrum, spectral_coherence
from tests.resonances import ringing_noise

FS = 20_000.0


def bursts(rng, n, rate):
    """Noise of a resonance at 3 kHz that swells sharply at a rate, in stationary white noise."""
    resonance = np.poly(0.9 * np.exp(2j * np.pi * 3000 / FS * np.array([1, -1]))).real
    swelling = np.exp(1.5 * np.cos(2 * np.pi * rate * np.arange(n) / FS))
    ringing = lfilter([1.0], resonance, rng.standard_normal(n)) * swelling
    return ringing / ringing.std() + rng.standard_normal(n)


@pytest.mark.parametrize("colour", [0.0, 0.9])
def test_stationary_noise_exceeds_the_thresholds_as_often_as_promised(colour):
    x = lfilter([1.0], [1.0, -colour], np.random.default_rng(0).standard_normal((100, 20_000)))
    found = spectral_coherence(x, FS, 300.0)
    beyond = found.cyclic > 4.0  # resolutions
    for probability in (0.05, 0.01, 0.001):
        share = np.mean(found.squared[..., beyond] > found.threshold(probability))
        np.testing.assert_allclose(share, probability, rtol=0.1)
    for band in (None, (2000.0, 4000.0)):
        spectrum = enhanced_envelope_spectrum(found, band)[:, beyond]
        assert 0.007 < np.mean(spectrum > found.envelope_threshold(0.01, band)) < 0.0105


def exceedances(rng, fs, seconds, records, resonance, damping, probabilities=(0.1, 0.01)):
    """Shares of coherences and of means within 300 Hz of a resonance of noise that exceed their thresholds, over the nominal ones."""
    x = ringing_noise(rng, fs, round(seconds * fs), records, [(resonance, damping)])
    found = spectral_coherence(x, fs, 300.0)
    band, beyond = (resonance - 300.0, resonance + 300.0), found.cyclic > 4.0 / seconds
    squared = found.squared[:, found.inside(band)][..., beyond]
    spectrum = enhanced_envelope_spectrum(found, band)[:, beyond]
    return [
        np.mean(values > threshold(probability)) / probability
        for probability in probabilities
        for values, threshold in ((squared, found.threshold), (spectrum, lambda p: found.envelope_threshold(p, band)))
    ]


@pytest.mark.parametrize("damping", [0.002, 0.005, 0.01, 0.02, 0.05])
def test_noise_of_a_resonance_exceeds_the_thresholds_half_to_twice_as_often_as_promised(damping):
    shares = exceedances(np.random.default_rng(4), 12_800.0, 1.0, 50, 2000.0, damping)
    assert 0.5 < min(shares) <= max(shares) < 2  # 0.001 is in tests/thorough


def test_impacts_that_slip_stand_out_of_many_resonances_as_of_white_noise():
    rng, fs, n, rate = np.random.default_rng(5), 12_800.0, 38_400, 87.3
    modes = [(700.0, 0.003), (1500.0, 0.01), (2400.0, 0.002), (3300.0, 0.02), (4200.0, 0.005)]
    places = np.cumsum(fs / rate * (1 + 0.01 * rng.standard_normal((8, round(n / fs * rate)))), axis=-1).astype(int)
    driven = 0.05 * rng.standard_normal((8, n))
    for record, train in zip(driven, places, strict=True):
        record[train[train < n]] += 1.0
    lines = []
    for x in (driven, ringing_noise(rng, fs, n, 8, modes, driven)):
        found = spectral_coherence(x, fs, 300.0)
        near = abs(found.cyclic - rate) < 1
        lines.append(enhanced_envelope_spectrum(found)[:, near].max(axis=-1) / found.envelope_threshold(1e-10))
    assert min(lines[1]) > 1
    np.testing.assert_allclose(lines[1], lines[0], rtol=0.2)  # 15 % lower, and 25 % without whitening


def test_the_enhanced_envelope_spectrum_has_lines_at_the_planted_rate_and_its_harmonics_alone():
    rng, rate = np.random.default_rng(2), 73.4
    found = spectral_coherence(np.stack([bursts(rng, 200_000, rate) for _ in range(3)]), FS, 350.0)
    for band in (None, (2000.0, 4000.0)):
        spectrum = enhanced_envelope_spectrum(found, band)
        harmonic = np.rint(found.cyclic / rate)
        near = abs(found.cyclic - harmonic * rate) < 2 * FS / 200_000  # the main lobe
        assert np.all(spectrum[:, ~near] < found.envelope_threshold(1e-10, band))
        for number in range(1, 4):
            assert np.all(spectrum[:, near & (harmonic == number)].max(axis=-1) > found.envelope_threshold(1e-10, band))


def test_the_coherence_is_that_of_scipy_between_a_record_and_its_shifted_copy():
    rng, n, rate = np.random.default_rng(3), 400_000, 100.0
    x = rng.standard_normal(n) * (1 + 0.6 * np.cos(2 * np.pi * rate * np.arange(n) / FS)) + 0.3
    found = spectral_coherence(x[None], FS, 150.0)
    shifted = (x - x.mean()) * np.exp(-2j * np.pi * rate * np.arange(n) / FS)

    def density(a, b):
        frequencies, values = csd(a, b, FS, nperseg=128, return_onesided=False)
        return values[(frequencies > 0) & (frequencies < 9000)]

    expected = abs(density(x, shifted)) ** 2 / abs(density(x, x) * density(shifted, shifted))
    place = np.argmin(abs(found.cyclic - rate))
    np.testing.assert_allclose(found.squared[0, :, place].mean(), expected.mean(), rtol=0.03)


def test_a_short_record_or_an_empty_band_is_refused():
    with pytest.raises(ValueError, match="at least 30 cycles"):
        spectral_coherence(np.ones((1, 1000)), FS, 100.0)
    found = spectral_coherence(np.random.default_rng(0).standard_normal((1, 20_000)), FS, 100.0)
    with pytest.raises(ValueError, match="wider band"):
        enhanced_envelope_spectrum(found, (10.0, 20.0))
