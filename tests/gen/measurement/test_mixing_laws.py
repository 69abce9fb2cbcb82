"""The compiled mixing compared with the same equations in NumPy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.measurement.mixing import BLOCK, Lines, mix


def line(parts, angle):
    """A line with the given parts at an angle, shape (time,)."""
    return parts[0] * np.cos(angle) - parts[1] * np.sin(angle)


def mixed(fault, healthy, background, impulses, angles, lines, first, stop):
    """Twin of :func:`gen.measurement.mixing.mix` that returns fault, healthy bearing and background from ``first`` to ``stop``."""
    time, turn = np.arange(first, stop), angles[first:stop]
    gain = np.stack([1 + line(parts[:2], turn) + line(parts[2:], 2 * turn) for parts in lines.modulations])
    machine = np.zeros((len(healthy), len(time)))
    for channel in range(len(healthy)):
        for order, parts in enumerate(lines.harmonics[channel], start=1):
            machine[channel] += line(parts, order * turn) * (lines.growth[first:stop] if lines.growth.size else 1.0)
        for (step, at_first, *once), parts in zip(lines.tones, lines.tone_parts[channel], strict=True):
            machine[channel] += (1 + line(once, turn)) * line(parts, step * time + at_first)
    hits = impulses[:, first:stop] if impulses.size else 0.0
    added = fault[:, first:stop] * gain[1:] if fault.size else 0.0 * gain[1:]
    return added, healthy[:, first:stop] * gain[1:], background[:, first:stop] * gain[0] + machine + hits


@given(
    st.integers(0, 2**32 - 1), st.integers(1, 3), st.integers(0, 3), st.integers(0, 3),
    st.booleans(), st.booleans(), st.booleans(),
)  # fmt: skip
def test_the_compiled_mixing_is_what_the_formulas_say(seed, n_channels, n_harmonics, n_tones, struck, damaged, growing):
    rng = np.random.default_rng(seed)
    n, first = int(rng.integers(BLOCK // 2, 4 * BLOCK)), int(rng.integers(0, 50))
    fault, healthy, background, impulses = rng.standard_normal((4, n_channels, n)).astype(np.float32)
    none = np.empty((0, 0), np.float32)
    impulses, fault = impulses if struck else none, fault if damaged else none
    lines = Lines(
        modulations=rng.standard_normal((1 + n_channels, 4)),
        harmonics=rng.standard_normal((n_channels, n_harmonics, 2)),
        growth=rng.random(n) if growing else np.empty(0),
        tones=rng.random((n_tones, 4)) * [3, 6, 1, 1],
        tone_parts=rng.standard_normal((n_channels, n_tones, 2)),
    )
    angles = rng.uniform(-20, 20) + np.cumsum(rng.random(n))
    expected = mixed(fault, healthy, background, impulses, angles, lines, first, n)
    before = healthy[:, :first].copy()
    products = mix(fault, healthy, background, impulses, angles, lines, first, n)
    for found, wanted in zip((fault, healthy, background), expected, strict=True):
        if found.size:
            np.testing.assert_allclose(found[:, first:], wanted, atol=3e-5)
    np.testing.assert_array_equal(healthy[:, :first], before)
    d, h, b = expected
    assert products == pytest.approx(
        [np.mean(x * y) for x, y in ((d, d), (h, h), (b, b), (d, h), (d, b), (h, b))], abs=2e-4
    )
