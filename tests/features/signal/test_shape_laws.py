"""Laws of the shape of an envelope, against the definitions of its values."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from features.signal.demodulation import fine_amplitudes, weight_by_hann
from features.signal.shape import envelope_shape


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
