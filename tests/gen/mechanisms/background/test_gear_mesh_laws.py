"""Laws of a gear mesh: where its lines and sidebands are, how high, and that it turns with the shaft."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.fft import irfft

from gen.measurement.rig import rig_filters
from gen.mechanisms.background.gear_mesh import GearMesh
from gen.scenarios import draw_scenarios

FS, RATE, N = 12_000.0, 25.0, 24_000  # two seconds: 50 turns of the shaft
BIN = N / FS  # bins per Hz
STEADY = 2 * np.pi * RATE / FS * np.arange(N)


def gear_with(**changes):
    lines = tuple({"level": level, "phase": phase} for level, phase in ((1.0, 0.3), (0.5, 1.0), (0.25, 2.0)))
    given = {
        "teeth": 20, "mate_teeth": 40, "lines": lines, "shaft_modulation": 0.0, "mate_modulation": 0.0, "phase_modulation": 0.0,
        "high_point": 0.0, "lead_point": 0.0,
    }  # fmt: skip
    return given | changes


def amplitude(signal, order):
    """Amplitude of the line at an order of the shaft; the record has whole numbers of its periods."""
    return 2 / N * abs(np.fft.rfft(signal)[round(order * RATE * BIN)])


def mesh(gear, angles=STEADY, seed=0):
    return GearMesh.vibrations(gear, angles, FS, np.random.default_rng(seed))[0]


def test_the_lines_of_a_true_gear_are_at_multiples_of_its_teeth_and_nowhere_else():
    found = mesh(gear_with())
    spectrum = 2 / N * np.abs(np.fft.rfft(found))
    for multiple, level in ((1, 1.0), (2, 0.5), (3, 0.25)):
        assert spectrum[round(20 * multiple * RATE * BIN)] == pytest.approx(math.sqrt(2) * level)
    assert np.count_nonzero(spectrum > 1e-9) == 3


@given(st.integers(0, 2**32 - 1))
def test_the_mesh_is_a_function_of_the_true_angle_of_the_shaft(seed):
    """On a shaft of changing speed, compared with the equation in plain cosines."""
    rng = np.random.default_rng(seed)
    gear = gear_with(
        shaft_modulation=rng.random(), mate_modulation=rng.random(), phase_modulation=rng.random(),
        high_point=6 * rng.random(), lead_point=6 * rng.random(), mate_teeth=int(rng.integers(10, 90)),
    )  # fmt: skip
    angles = 5 * rng.random() + np.cumsum(2 * np.pi / FS * (RATE + 10 * np.sin(np.linspace(0, 6, N) + rng.random())))
    start = 2 * math.pi * np.random.default_rng(3).random()
    turned = gear["teeth"] * angles + gear["phase_modulation"] * np.cos(angles - gear["lead_point"])
    lines = enumerate(gear["lines"], start=1)
    expected = sum(math.sqrt(2) * line["level"] * np.cos(k * turned + line["phase"]) for k, line in lines)
    expected *= (
        1
        + gear["shaft_modulation"] * np.cos(angles - gear["high_point"])
        + gear["mate_modulation"] * np.cos(angles * gear["teeth"] / gear["mate_teeth"] + start)
    )
    np.testing.assert_allclose(mesh(gear, angles, seed=3), expected, atol=1e-8)


def test_only_the_mate_stands_differently_in_another_record():
    assert np.array_equal(mesh(gear_with(shaft_modulation=0.5), seed=1), mesh(gear_with(shaft_modulation=0.5), seed=2))
    one, other = (mesh(gear_with(mate_modulation=0.5), seed=seed) for seed in (1, 2))
    assert not np.allclose(one, other)
    assert amplitude(one, 20.5) == pytest.approx(amplitude(other, 20.5))


def test_no_multiple_of_the_mesh_aliases():
    """160 teeth at 25 Hz mesh at 4 kHz; 8 and 12 kHz are beyond half the sample rate."""
    spectrum = 2 / N * np.abs(np.fft.rfft(mesh(gear_with(teeth=160))))
    assert np.flatnonzero(spectrum > 1e-9).tolist() == [round(4000 * BIN)]
    assert not mesh(gear_with(teeth=480)).any()


def test_a_multiple_ends_where_a_run_up_takes_it_past_half_the_sample_rate():
    rate = np.linspace(10, 120, N)
    found = mesh(gear_with(teeth=60, lines=({"level": 1.0, "phase": 0.0},)), np.cumsum(2 * np.pi / FS * rate))
    assert np.abs(found[60 * rate > 6001]).max() == 0.0
    low = found[60 * rate < 4700]
    assert math.sqrt(np.mean(low**2)) == pytest.approx(1.0, rel=0.01)


def in_channels(recipe_with, paths, gear):
    rig = draw_scenarios(recipe_with({}), 0, 1)[0].rig
    filters = replace(rig_filters(rig, N, FS, 0), paths=paths)
    return irfft(filters.source_in_channels(mesh(gear)), filters.n)


def test_a_mesh_passes_through_the_path_of_each_channel_and_keeps_its_rms(recipe_with):
    """500 Hz in one channel and 1000 Hz in the other: only their paths part the lines of the mesh."""
    frequency = np.fft.rfftfreq(N, 1 / FS)
    paths = np.stack([frequency < 750, 2.0 * ((frequency > 750) & (frequency < 1250))]).astype(np.complex64)
    gear = gear_with(shaft_modulation=0.5)
    found = in_channels(recipe_with, paths, gear)
    assert (found.dtype, found.shape) == (np.float32, (2, N))
    assert np.mean(found.astype(float) ** 2) == pytest.approx(np.mean(mesh(gear) ** 2), rel=1e-5)
    assert amplitude(found[1], 40) / amplitude(found[0], 20) == pytest.approx(2 * 0.5, rel=1e-4)
    assert amplitude(found[1], 41) / amplitude(found[1], 40) == pytest.approx(0.25, rel=1e-4)
    assert max(amplitude(found[0], 40), amplitude(found[1], 20), amplitude(found[1], 60)) < 1e-5


def test_a_path_that_suppresses_the_mesh_leaves_silence(recipe_with):
    assert not in_channels(recipe_with, np.zeros((2, N // 2 + 1)), gear_with()).any()
