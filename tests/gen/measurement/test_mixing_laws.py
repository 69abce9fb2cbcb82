"""The compiled mixing compared with the same equations in NumPy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.measurement.mixing import BLOCK, Lines, ShaftAngle, mix

law = settings(deadline=None, max_examples=25)


def mixed(bearing, background, impulses, angles, lines, first, stop):
    """Twin of :func:`gen.measurement.mixing.mix` that returns what it changes, from ``first`` to ``stop``."""
    time, turn = np.arange(first, stop), angles[first:stop]
    gain = [1 + a * np.cos(turn + p) + b * np.cos(2 * turn + q) for a, b, p, q in lines.modulations]
    line = np.zeros(len(time))
    for order, (level, phase) in enumerate(lines.harmonics, start=1):
        line += level * np.cos(order * turn + phase)
    for step, level, depth, phase, shift in lines.tones:
        line += level * (1 + depth * np.cos(turn + shift)) * np.cos(step * time + phase)
    hits = impulses[:, first:stop] if impulses.size else 0.0
    return bearing[:, first:stop] * np.stack(gain[1:]), background[:, first:stop] * gain[0] + line + hits


@law
@given(st.integers(0, 2**32 - 1), st.integers(1, 3), st.integers(0, 3), st.integers(0, 3), st.booleans(), st.booleans())
def test_the_compiled_mixing_is_what_the_formulas_say(seed, n_channels, n_harmonics, n_tones, struck, on_course):
    rng = np.random.default_rng(seed)
    n, first = int(rng.integers(BLOCK // 2, 4 * BLOCK)), int(rng.integers(0, 50))
    bearing, background, impulses = rng.standard_normal((3, n_channels, n)).astype(np.float32)
    impulses = impulses if struck else np.empty((0, 0), np.float32)
    lines = Lines(
        rng.random((1 + n_channels, 4)) * [1, 1, 6, 6],
        rng.random((n_harmonics, 2)) * [1, 6],
        rng.random((n_tones, 5)) * [3, 1, 1, 6, 6],
    )
    start, step = rng.random(2)
    angles = start + step * np.arange(n) * (np.linspace(0.5, 1.5, n) if on_course else 1.0)
    expected = mixed(bearing, background, impulses, angles, lines, first, n)
    before = bearing[:, :first].copy()
    rms = mix(
        bearing, background, impulses, ShaftAngle(start, step, angles if on_course else np.empty(0)), lines, first, n
    )
    np.testing.assert_allclose(bearing[:, first:], expected[0], atol=1e-5)
    np.testing.assert_allclose(background[:, first:], expected[1], atol=1e-5)
    np.testing.assert_array_equal(bearing[:, :first], before)
    assert rms == pytest.approx([np.sqrt(np.mean(part**2)) for part in expected], rel=1e-5)
