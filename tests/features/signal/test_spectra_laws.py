"""Laws of spectra, of the shape of an envelope, and of roll-off, centroid and tonality."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import uniform_filter1d
from scipy.signal import lfilter, welch

from features.signal.colour import centroid, roll_off, tonality
from features.signal.demodulation import (
    amplitude_spectrum,
    analytic_band,
    fine_amplitudes,
    running_median,
    weight_by_hann,
)
from features.signal.shape import envelope_shape
from features.signal.spectra import (
    band_energies,
    cepstrum,
    fourier_coefficients,
    prediction_filters,
    psd,
    sine_windowed,
    whiten_by_psd,
    whiten_cepstrally,
)

seeds = st.integers(0, 2**32 - 1)


def noise(seed, records=3, n=4096):
    return np.random.default_rng(seed).standard_normal((records, n))


@given(seeds, st.integers(16, 4000), st.integers(8, 4000))
def test_the_psd_is_that_of_welch(seed, n, length):
    x = noise(seed, n=n)
    for ours, expected in zip(psd(x, 1.0, length), welch(x, 1.0, nperseg=min(n, length)), strict=True):
        np.testing.assert_allclose(ours, expected, rtol=1e-9, atol=1e-12)


@given(seeds, st.lists(st.floats(0.0, 600.0), min_size=2, max_size=8, unique=True))
def test_energies_of_adjoining_bands_add_up(seed, edges):
    frequencies = np.linspace(0, 500, 101)
    density = noise(seed, n=101) ** 2
    edges = sorted(edges)
    parts = band_energies(density, frequencies, edges)
    whole = band_energies(density, frequencies, [edges[0], edges[-1]])
    np.testing.assert_allclose(parts.sum(axis=1), whole[:, 0], rtol=1e-9, atol=1e-9)
    assert (parts >= -1e-9).all()
    total = band_energies(density, frequencies, [-1e9, 1e9])[:, 0]
    np.testing.assert_allclose(total, density.sum(axis=1) * frequencies[1])


@given(seeds, st.lists(st.floats(5.0, 60.0), min_size=3, max_size=3))
def test_bands_in_orders_are_bands_at_the_speed_of_each_record(seed, rates):
    frequencies, density = psd(noise(seed), 12_000.0)
    orders = np.array([0.5, 1.5, 7.3, 40.0])
    together = band_energies(density, frequencies, np.multiply.outer(np.array(rates), orders))
    for record, rate in enumerate(rates):
        alone = band_energies(density[record : record + 1], frequencies, rate * orders)
        np.testing.assert_array_equal(together[record], alone[0])


def modulated(depth, frequency, fs, n):
    """Envelope and squared envelope spectra of a tone of amplitude one, modulated by ``depth``; resolution of their grid."""
    t = np.arange(n) / fs
    x = (1 + depth * np.cos(2 * np.pi * frequency * t + 1)) * np.sin(2 * np.pi * 3000.0 * t)
    z = analytic_band(fourier_coefficients(x[None], fs, 5000.0), round(2000 * n / fs), round(4000 * n / fs))
    (frequencies, lines), (_, squared) = (
        amplitude_spectrum(y, z.shape[1] * fs / n) for y in (np.abs(z), np.abs(z) ** 2)
    )
    return lines[0], squared[0], frequencies[1]


FS = st.sampled_from([12_000, 25_600, 48_828])
DEPTHS, LENGTHS = st.floats(0.05, 0.9), st.floats(0.5, 4.0)


@given(DEPTHS, st.integers(80, 1000), FS, LENGTHS)
def test_a_modulation_at_a_frequency_of_the_grid_is_read_as_its_depth(depth, place, fs, seconds):
    n = round(seconds * fs)
    lines, squared, _ = modulated(depth, place * fs / (4 * n), fs, n)
    assert np.argmax(lines) == np.argmax(squared) == place
    assert lines[place] == pytest.approx(depth, rel=1e-3)
    assert squared[place] == pytest.approx(2 * depth, rel=1e-3)


@given(st.floats(0.1, 10.0), st.floats(600.0, 1400.0))
def test_the_modulus_of_an_analytic_band_is_the_amplitude_of_a_tone_in_it(amplitude, tone):
    x = amplitude * np.sin(2 * np.pi * tone * np.arange(12_000) / 12_000)
    z = analytic_band(fourier_coefficients(x[None], 12_000, 5000.0), 500, 1500)
    middle = np.abs(z[0, z.shape[1] // 4 : -z.shape[1] // 4])
    np.testing.assert_allclose(middle, amplitude, rtol=0.01)
    assert middle.mean() == pytest.approx(amplitude, rel=1e-3)


@given(seeds)
def test_cepstral_whitening_keeps_all_phases_and_makes_all_moduli_one(seed):
    coefficients = fourier_coefficients(noise(seed), 12_000.0, 5000.0)
    white = whiten_cepstrally(coefficients)[:, 1:]
    np.testing.assert_allclose(np.abs(white), 1.0)
    np.testing.assert_allclose(np.angle(white), np.angle(coefficients[:, 1:]))


@given(seeds, st.integers(3, 500), st.integers(1, 200))
def test_a_spectrum_is_whitened_by_its_running_mean_mirrored_at_its_ends(seed, bins, width):
    coefficients = noise(seed, n=bins) * np.exp(1j * noise(seed + 1, n=bins))
    mean = uniform_filter1d(np.abs(coefficients) ** 2, width, mode="mirror")
    np.testing.assert_allclose(whiten_by_psd(coefficients, width), coefficients / np.sqrt(mean), rtol=1e-6)


@given(seeds, st.integers(50, 6000), st.sampled_from([np.float32, np.float64]), st.floats(0.0, 1.0))
def test_an_interpolated_spectrum_is_that_of_the_padded_signal(seed, n, precision, part):
    weighted = weight_by_hann(np.abs(noise(seed, n=n)).astype(precision))
    padded = 4 / n * np.abs(np.fft.rfft(weighted, 4 * n))
    bins = max(1, round(part * padded.shape[1]))
    near = 5e-5 * np.sqrt(np.mean(padded**2))
    np.testing.assert_allclose(fine_amplitudes(weighted, bins), padded[:, :bins], rtol=0, atol=near)


@given(st.floats(-5, 5), st.floats(-1, 1), st.floats(8.0, 300.0))
def test_the_running_median_follows_a_straight_line(height, slope, width):
    line = height + slope * np.arange(1000.0)
    median = running_median(line[None], np.array([width]), 800)[0]
    half = int(width) + 1
    np.testing.assert_allclose(median[half:], line[half:800], atol=2 * abs(slope) + 1e-9)


def test_the_cepstrum_of_an_echo_has_half_its_strength_at_its_delay():
    x, delay = np.random.default_rng(4).standard_normal((1, 8192)), 200
    echoed = x + 0.5 * np.roll(x, delay, axis=-1)
    assert np.argmax(np.abs(cepstrum(echoed)[0, 100:4000])) == delay - 100
    np.testing.assert_allclose(cepstrum(echoed)[0, delay] - cepstrum(x)[0, delay], 0.25, rtol=1e-3)


def test_the_prediction_filter_of_an_autoregressive_process_is_its_own():
    own = np.poly(0.97 * np.exp(1j * np.array([0.4, -0.4, 1.3, -1.3]))).real
    x = lfilter([1.0], own, np.random.default_rng(1).standard_normal((2, 100_000)))
    filters = prediction_filters(sine_windowed(x, 131_072), 131_072, 4)
    np.testing.assert_allclose(filters, np.tile(own, (2, 1)), atol=0.02)


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


law = settings(max_examples=10)
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
