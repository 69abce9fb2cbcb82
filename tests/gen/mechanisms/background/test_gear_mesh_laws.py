"""Laws of a gear mesh: where its lines and sidebands are, how high, and that it turns with the shaft."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.measurement.rig import rig_filters
from gen.mechanisms.background.gear_mesh import GearMesh
from gen.scenarios import draw_scenarios
from gen.simulation.timeline import LEAD_S
from tests.measuring import drawn, lines

FS, RATE, N = 12_000.0, 25.0, 24_000  # two seconds: 50 turns of the shaft
BIN = N / FS  # bins per Hz
STEADY = 2 * np.pi * RATE / FS * np.arange(N)


def gear_with(**changes):
    """A gear of 20 teeth with lines of 0, -6 and -12 dB, and a modulation that only ``changes`` give it."""
    return drawn(GearMesh, **({"teeth": 20, "mate_teeth": 40} | lines([0, -6, -12]) | changes))


def amplitude(signal, order):
    """Amplitude of the line at an order of the shaft; the record has whole numbers of its periods."""
    return 2 / N * abs(np.fft.rfft(signal)[round(order * RATE * BIN)])


def mesh(gear, angles=STEADY, rig=0, record=0):
    return gear.vibrations(angles, FS, lambda level="record": np.random.default_rng(rig if level == "rig" else record))[
        0
    ]


@given(st.integers(0, 2**32 - 1))
def test_the_mesh_is_a_function_of_the_true_angle_of_the_shaft(seed):
    """On a shaft of changing speed, compared with the equation in plain cosines; the phases belong to the rig."""
    rng = np.random.default_rng(seed)
    shaft, mate, phase, mate_teeth = rng.random(), rng.random(), 180 * rng.random(), int(rng.integers(10, 90))
    gear = gear_with(shaft_modulation=shaft, mate_modulation=mate, phase_deg=phase, mate_teeth=mate_teeth)
    angles = 5 * rng.random() + np.cumsum(2 * np.pi / FS * (RATE + 10 * np.sin(np.linspace(0, 6, N) + rng.random())))
    high_point, lead_point, *phases = 2 * math.pi * np.random.default_rng(4).random(5)
    start = 2 * math.pi * np.random.default_rng(3).random()
    turned = 20 * angles + math.radians(phase) * np.cos(angles - lead_point)
    levels = 10 ** (np.array([0, -6, -12]) / 20)
    expected = sum(
        math.sqrt(2) * level * np.cos(k * turned + at)
        for k, (level, at) in enumerate(zip(levels, phases, strict=True), 1)
    )
    expected *= 1 + shaft * np.cos(angles - high_point) + mate * np.cos(angles * 20 / mate_teeth + start)
    np.testing.assert_allclose(mesh(gear, angles, rig=4, record=3), expected, atol=1e-8)


def test_no_multiple_of_the_mesh_aliases():
    """160 teeth at 25 Hz mesh at 4 kHz; 8 and 12 kHz are beyond half the sample rate."""
    spectrum = 2 / N * np.abs(np.fft.rfft(mesh(gear_with(teeth=160))))
    assert np.flatnonzero(spectrum > 1e-9).tolist() == [round(4000 * BIN)]
    assert not mesh(gear_with(teeth=480)).any()


def test_a_multiple_ends_where_a_run_up_takes_it_past_half_the_sample_rate():
    rate = np.linspace(10, 120, N)
    found = mesh(gear_with(teeth=60, **lines([0])), np.cumsum(2 * np.pi / FS * rate))
    assert np.abs(found[60 * rate > 6001]).max() == 0.0
    low = found[60 * rate < 4700]
    assert math.sqrt(np.mean(low**2)) == pytest.approx(1.0, rel=0.01)


def in_channels(recipe_with, paths, gear):
    """Signals of a mesh behind some paths, shape (channel, time)."""
    filters = rig_filters(draw_scenarios(recipe_with({"recording.duration_s": N / FS - LEAD_S}), 0, 1)[0])
    return np.fft.irfft(replace(filters, paths=paths).source_in_channels(mesh(gear)), N)


def test_a_mesh_passes_through_the_path_of_each_channel_and_keeps_its_rms(recipe_with):
    """500 Hz in one channel and 1000 Hz in the other: only their paths part the lines of the mesh."""
    frequency = np.fft.rfftfreq(N, 1 / FS)
    paths = np.stack([frequency < 750, 2.0 * ((frequency > 750) & (frequency < 1250))]).astype(np.complex64)
    gear = gear_with(shaft_modulation=0.5)
    found = in_channels(recipe_with, paths, gear)
    assert found.shape == (2, N)
    assert np.mean(found**2) == pytest.approx(np.mean(mesh(gear) ** 2), rel=1e-5)
    assert amplitude(found[1], 40) / amplitude(found[0], 20) == pytest.approx(2 * 10 ** (-6 / 20), rel=1e-4)
    assert amplitude(found[1], 41) / amplitude(found[1], 40) == pytest.approx(0.25, rel=1e-4)
    assert max(amplitude(found[0], 40), amplitude(found[1], 20), amplitude(found[1], 60)) < 1e-5


TOOTH = {"probability": 1, "drop": 0.6, "phase_deg": 40, "strikes_db": 0}


def demodulated(signal):
    """Amplitude and phase of the mesh as McFadden finds them: its line with the sidebands up to half the mesh rate, at 0 Hz."""
    spectrum, line = np.fft.fft(signal), round(20 * RATE * BIN)
    band = np.zeros(N, complex)
    band[np.arange(-(line // 2), line // 2)] = spectrum[line - line // 2 : line + line // 2]
    return np.fft.ifft(band)


@pytest.mark.parametrize("on_mate", [0, 1])
def test_a_damaged_tooth_changes_amplitude_and_phase_once_per_turn_of_its_gear(on_mate):
    gear = gear_with(**lines([0]), tooth_fault=TOOTH | {"on_mate": on_mate})
    start = 2 * math.pi * np.random.default_rng(0).random()
    turned, teeth = (STEADY / 2 + start, 40) if on_mate else (STEADY, 20)
    contact = np.exp((np.cos(turned) - 1) / (math.pi / teeth) ** 2)
    expected = (1 - 0.6 * contact) * np.exp(-1j * math.radians(40) * contact)
    carried = (expected * np.exp(20j * STEADY)).real * math.sqrt(2)
    found = demodulated(mesh(gear))
    phase = found.mean() / abs(found.mean())
    whole = demodulated(carried)
    np.testing.assert_allclose(found / phase, whole / (whole.mean() / abs(whole.mean())), atol=1e-3)
    assert 1 - np.abs(whole).min() / np.median(np.abs(whole)) > 0.3


@pytest.mark.parametrize(("on_mate", "turns"), [(0, 50), (1, 25)])
def test_a_damaged_tooth_strikes_once_per_turn_of_its_gear_at_its_level(on_mate, turns):
    strikes = np.zeros(N)
    gear = gear_with(tooth_fault=TOOTH | {"on_mate": on_mate})
    gear.add_impulses(strikes, STEADY, FS, lambda **_: np.random.default_rng(0))
    (times,) = np.nonzero(strikes)
    assert abs(len(times) - turns) <= 1
    assert np.ptp(np.diff(times)) <= 1
    assert strikes[times].mean() == pytest.approx(10 ** (TOOTH["strikes_db"] / 20), rel=0.1)


def test_the_label_names_the_gear_and_not_the_bearing():
    (label,) = (label for label in GearMesh.labels if label.name == "tooth_fault")
    gears = [gear_with(), *(gear_with(tooth_fault=TOOTH | {"on_mate": mate}) for mate in (0, 1))]
    assert [label.flags[code] for code in label.column(gears)] == ["none", "gear", "mate"]
