"""The compiled mixing compared with the same equations in NumPy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.measurement.mixing import BLOCK, Lines, mix


def line(amplitude, angle):
    """A line of a complex amplitude at an angle, shape (time,)."""
    return (amplitude * np.exp(1j * angle)).real


def mixed(signals, others, angles, lines, kept):
    """Twin of :func:`gen.measurement.mixing.mix` that returns the signals in the samples ``kept``."""
    time, turn = np.arange(kept.start, kept.stop), angles[kept]
    modulation, *of_paths = (1 + line(once, turn) + line(twice, 2 * turn) for once, twice in lines.modulations)
    background = signals[0][:, kept] * modulation + others[:, kept]
    for channel, amplitudes in enumerate(lines.amplitudes):
        tones = zip(amplitudes, lines.steps, lines.phases, lines.tone_modulations, strict=True)
        for amplitude, step, phase, once in tones:
            background[channel] += (1 + line(once, turn)) * line(amplitude, step * time + phase)
    return np.stack([background, *(signal[:, kept] * np.stack(of_paths) for signal in signals[1:])])


@given(
    st.integers(0, 2**32 - 1), st.integers(1, 3), st.integers(0, 3), st.booleans()
)  # fmt: skip
def test_the_compiled_mixing_is_what_the_formulas_say(seed, n_channels, n_tones, damaged):
    rng = np.random.default_rng(seed)

    def complex_numbers(*shape):
        return rng.standard_normal(shape) + 1j * rng.standard_normal(shape)

    n, first = int(rng.integers(BLOCK // 2, 4 * BLOCK)), int(rng.integers(0, 50))
    signals = rng.standard_normal((2 + damaged, n_channels, n)).astype(np.float32)
    others = rng.standard_normal((n_channels, n)).astype(np.float32)
    lines = Lines(
        modulations=complex_numbers(1 + n_channels, 2),
        amplitudes=complex_numbers(n_channels, n_tones),
        steps=3 * rng.random(n_tones),
        phases=6 * rng.random(n_tones),
        tone_modulations=complex_numbers(n_tones),
    )
    angles, kept = rng.uniform(-20, 20) + np.cumsum(rng.random(n)), slice(first, n)
    expected, before = mixed(signals, others, angles, lines, kept), signals[..., :first].copy()
    products = mix(signals, others, angles, lines, kept)
    np.testing.assert_allclose(signals[..., kept], expected, atol=3e-5)
    np.testing.assert_array_equal(signals[..., :first], before)
    b, h, d = expected if damaged else (*expected, 0 * expected[0])
    pairs = (b, b), (h, b), (h, h), (d, b), (d, h), (d, d)
    assert products == pytest.approx([np.mean(x * y) for x, y in pairs], abs=2e-4)
