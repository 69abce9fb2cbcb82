"""The compiled mixing compared with the same equations in NumPy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.measurement.mixing import BLOCK, Lines, mix


def line(amplitude, angle):
    """A line of a complex amplitude at an angle, shape (time,)."""
    return np.real(amplitude * np.exp(1j * angle))


def mixed(signals, others, angles, lines, kept):
    """Twin of :func:`gen.measurement.mixing.mix` that returns the parts of the record, shape (part, channel, time)."""
    time, turn = np.arange(kept.start, kept.stop), angles[kept]
    gain = np.stack([1 + line(once, turn) + line(twice, 2 * turn) for once, twice in lines.modulations])
    growth = lines.growth[kept] if lines.growth.size else 1.0
    n_orders = lines.amplitudes.shape[1] - len(lines.steps)
    machine = others[:, kept].astype(float)
    for channel, amplitudes in enumerate(lines.amplitudes):
        for order, amplitude in enumerate(amplitudes[:n_orders], start=1):
            machine[channel] += line(amplitude, order * turn) * growth
        tones = zip(amplitudes[n_orders:], lines.steps, lines.phases, lines.tone_modulations, strict=True)
        for amplitude, step, phase, depth in tones:
            machine[channel] += (1 + line(depth, turn)) * line(amplitude, step * time + phase)
    return np.stack([signals[0][:, kept] * gain[0] + machine, *(part[:, kept] * gain[1:] for part in signals[1:])])


@given(
    st.integers(0, 2**32 - 1), st.integers(1, 3), st.integers(0, 3), st.integers(0, 3), st.booleans(), st.booleans(),
)  # fmt: skip
def test_the_compiled_mixing_is_what_the_formulas_say(seed, n_channels, n_harmonics, n_tones, damaged, growing):
    rng = np.random.default_rng(seed)
    n, first = int(rng.integers(BLOCK // 2, 4 * BLOCK)), int(rng.integers(0, 50))
    *signals, others = rng.standard_normal((4 if damaged else 3, n_channels, n)).astype(np.float32)
    signals = np.stack(signals)

    def amplitudes(*shape):
        return rng.standard_normal(shape) + 1j * rng.standard_normal(shape)

    lines = Lines(
        modulations=amplitudes(1 + n_channels, 2),
        amplitudes=amplitudes(n_channels, n_harmonics + n_tones),
        growth=rng.random(n) if growing else np.empty(0),
        steps=3 * rng.random(n_tones),
        phases=6 * rng.random(n_tones),
        tone_modulations=amplitudes(n_tones),
    )
    angles = rng.uniform(-20, 20) + np.cumsum(rng.random(n))
    expected, before = mixed(signals, others, angles, lines, slice(first, n)), signals[..., :first].copy()
    products = mix(signals, others, angles, lines, slice(first, n))
    np.testing.assert_allclose(signals[..., first:], expected, atol=3e-5)
    np.testing.assert_array_equal(signals[..., :first], before)
    b, h, d = expected if damaged else (*expected, np.zeros(1))
    assert products == pytest.approx(
        [np.mean(x * y) for x, y in ((b, b), (h, b), (h, h), (d, b), (d, h), (d, d))], abs=2e-4
    )
