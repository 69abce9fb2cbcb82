"""Laws of the measures."""

import numpy as np
import pytest
from scipy.signal import resample_poly

from features.table.indicators import Orders
from gen.corpus import FAULTS
from raceway.comparing.measures import MEASURES, NAMES, compute_measures, limit_band
from tests.paths import ROOT
from tests.pulses import LINES, ORDERS, pulse_train

FS, DURATION, SHAFT, TOP = 24_000.0, 0.5, 29.0, 5000.0
ONE = Orders(*(np.array([ORDERS[name]]) for name in Orders._fields))


def measures_of(signal, fault, fs=FS):
    x = limit_band(signal[None], fs, 12_000.0, TOP)
    values = compute_measures(x, x.shape[-1] * fs / signal.size, TOP, np.array([SHAFT]), ONE, fault)
    return dict(zip(NAMES, values[0], strict=True))


def signal_of(fault, seed=0, **kinds):
    line = LINES[fault]
    rate = None if line is None else line * SHAFT
    return pulse_train(FS, DURATION, rate, kinds.pop("ringing", 3000.0), np.random.default_rng(seed), **kinds)


@pytest.mark.parametrize("fault", LINES)
def test_a_gain_changes_no_measure(fault):
    signal = signal_of(fault)
    first, second = measures_of(signal, fault), measures_of(1000 * signal, fault)
    assert first == pytest.approx(second, rel=1e-3, nan_ok=True)


@pytest.mark.parametrize("fault", LINES)
def test_the_sample_rate_of_a_recording_hardly_matters_below_the_top(fault):
    signal = signal_of(fault)
    slower = resample_poly(signal, 2, 3)
    first, second = measures_of(signal, fault), measures_of(slower, fault, FS * 2 / 3)
    assert first == pytest.approx(second, rel=0.1, abs=0.1, nan_ok=True)


@pytest.mark.parametrize("fault", FAULTS)
def test_a_class_has_its_measures_and_no_others(fault):
    found = measures_of(signal_of(fault if fault in LINES else "healthy"), fault)
    for measure in MEASURES:
        if not measure.belongs_to(fault):
            assert np.isnan(found[measure.name])
    assert np.isfinite(found["kurtosis"])
    assert all(name in FAULTS for measure in MEASURES for name in measure.classes)


def test_shorter_pulses_are_more_impulsive():
    long, short = (measures_of(signal_of("outer", decay=decay), "outer") for decay in (150.0, 1500.0))
    for name in ("kurtosis", "crest_factor", "spectral_kurtosis"):
        assert short[name] > 1.2 * long[name]


@pytest.mark.parametrize("fault", ["inner", "outer"])
def test_pulses_that_wander_have_a_wider_line(fault):
    widths = [
        np.mean(
            [measures_of(signal_of(fault, seed, noise=0.02, wander=wander), fault)["line_width"] for seed in range(5)]
        )
        for wander in (0.0, 0.01, 0.03)
    ]
    assert widths[0] < 0.05
    assert widths[0] < 0.7 * widths[1] < 0.5 * widths[2]


def modulated(fault, order, depth):
    signal = signal_of(fault, noise=0.02)
    time = np.arange(signal.size) / FS
    return measures_of(signal * (1 + depth * np.cos(2 * np.pi * order * SHAFT * time)), fault)


def test_a_load_that_turns_with_the_shaft_raises_the_shaft_sidebands():
    weak, strong = (modulated("inner", 1.0, depth)["shaft_sidebands"] for depth in (0.2, 0.8))
    assert strong > weak + 6
    assert weak == pytest.approx(20 * np.log10(0.1), abs=3)


def test_a_ball_that_strikes_more_strongly_once_per_turn_of_the_cage_has_cage_lines():
    plain, deep = (modulated("ball", ORDERS["ftf"], depth) for depth in (0.0, 0.8))
    assert deep["cage_line"] > plain["cage_line"] + 10
    assert deep["cage_sidebands"] > plain["cage_sidebands"] + 10


def test_the_page_lists_every_measure_with_its_unit_meaning_and_classes():
    page = (ROOT / "docs" / "comparing.md").read_text(encoding="utf-8")
    for measure in MEASURES:
        classes = f" ({', '.join(measure.classes)})" if measure.classes else ""
        assert f"| `{measure.name}` | {measure.unit} | {measure.meaning}{classes} |" in page
