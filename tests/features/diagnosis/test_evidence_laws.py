"""Evidence is what stands in the signal: noise has none, a line that is added appears with its order and level, a notch removes it."""

import numpy as np
import pytest
from scipy.signal import lfilter

from features.diagnosis.diagnose import _bearing_warning
from features.diagnosis.evidence import LEAST_LEVEL, Line, _near_shaft, find_evidence, strange_series
from features.diagnosis.spectrum import BandSpectrum, band_spectra
from features.indicators import Orders

FS, RATE = 12_000.0, 29.5
ORDERS = Orders(0.3983, 3.5848, 5.4152, 2.3567)
FUNDAMENTALS = {"inner": 5.4152, "outer": 3.5848, "ball": 4.7134}


def noise(kind, duration, rng):
    e = rng.standard_normal(round(FS * duration))
    t = np.arange(e.size) / FS
    resonance = [1.0, -2 * 0.96 * np.cos(2 * np.pi * 2500 / FS), 0.96**2]
    if kind == "coloured":
        return lfilter([1.0], resonance, e) + 0.1 * rng.standard_normal(e.size)
    if kind == "impulses":
        force = np.where(rng.random(e.size) < 40 / FS, 30 * rng.standard_normal(e.size), 0.0)
        return lfilter([1.0], resonance, force) + e
    if kind == "modulated by the shaft":
        return e * (1 + 0.5 * np.cos(2 * np.pi * RATE * t) + 0.3 * np.cos(2 * np.pi * 2 * RATE * t))
    return e


def modulated(order, depth, duration, rng):
    """Noise whose amplitude is modulated at an order of the shaft."""
    e = noise("white", duration, rng)
    return e * (1 + depth * np.cos(2 * np.pi * order * RATE * np.arange(e.size) / FS))


def evidence(x, orders=ORDERS):
    return find_evidence(band_spectra(x, FS, RATE), RATE, orders)


@pytest.mark.parametrize(
    ("kind", "duration"), [("white", 0.5), ("coloured", 3.0), ("impulses", 0.5), ("modulated by the shaft", 0.5)]
)
def test_noise_has_no_evidence_in_99_of_100_recordings(kind, duration):
    rng = np.random.default_rng(1)
    found = [bool(evidence(noise(kind, duration, rng))) for _ in range(100)]
    assert sum(found) <= 1


@pytest.mark.parametrize("fault", FUNDAMENTALS)
def test_a_line_that_is_added_appears_at_its_order(fault):
    order = 1.006 * FUNDAMENTALS[fault]
    lines = evidence(modulated(order, 0.6, 5.0, np.random.default_rng(2)))
    assert lines[0].fault == fault
    assert lines[0].harmonic == 1
    assert lines[0].order == pytest.approx(order, abs=0.02)
    assert lines[0].frequency == pytest.approx(order * RATE, abs=0.5)
    assert {line.fault for line in lines} == {fault}


def test_the_level_of_a_line_rises_by_6_db_with_twice_its_depth():
    """Depths at which the line is far above the floor, and the noise of the envelope hardly changes with it."""
    levels = {}
    for depth in (0.2, 0.4):
        found = [evidence(modulated(3.5848, depth, 10.0, np.random.default_rng(seed)))[0].level for seed in range(6)]
        levels[depth] = np.mean(found)
    assert levels[0.4] - levels[0.2] == pytest.approx(20 * np.log10(2), abs=0.7)


def test_a_multiple_of_the_shaft_rate_is_no_evidence():
    near_integer = Orders(0.3815, 3.002, 4.999, 1.99)
    lines = evidence(modulated(3.0, 0.6, 3.0, np.random.default_rng(3)), near_integer)
    assert lines == []


def test_a_notch_at_the_line_removes_the_evidence():
    """The modulation is undone: the same noise, divided by it, has no line any more."""
    x = modulated(5.4152, 0.6, 5.0, np.random.default_rng(4))
    assert evidence(x)
    undone = x / (1 + 0.6 * np.cos(2 * np.pi * 5.4152 * RATE * np.arange(x.size) / FS))
    assert evidence(undone) == []


def test_a_line_at_another_speed_is_no_evidence():
    x = modulated(5.4152 * 1.04, 0.6, 5.0, np.random.default_rng(5))
    assert evidence(x) == []


def test_sidebands_belong_to_the_family_of_their_line():
    t = np.arange(round(5 * FS)) / FS
    depth = 0.6 * (1 + 0.8 * np.cos(2 * np.pi * RATE * t))
    x = np.random.default_rng(6).standard_normal(t.size) * (1 + depth * np.cos(2 * np.pi * 5.4152 * RATE * t))
    names = [line.name for line in evidence(x)]
    assert names[0] == "BPFI"
    assert {"BPFI - shaft", "BPFI + shaft"} <= set(names)
    assert all("BPFI" in name for name in names)


def test_a_second_harmonic_alone_is_told_as_such_and_a_sideband_needs_its_harmonic():
    t = np.arange(round(5 * FS)) / FS
    at = {2 * 5.4152: 0.5, 6.4152: 0.5}  # 2 BPFI, and BPFI + shaft without BPFI
    depth = sum(depth * np.cos(2 * np.pi * order * RATE * t) for order, depth in at.items())
    lines = evidence(np.random.default_rng(8).standard_normal(t.size) * (1 + depth))
    assert lines[0].order == pytest.approx(2 * 5.4152, abs=0.02)
    assert (lines[0].name, lines[0].harmonic) == ("2 BPFI", 2)
    assert {line.harmonic for line in lines} == {2}


def test_a_family_10_db_below_the_strongest_is_not_told():
    t = np.arange(round(5 * FS)) / FS
    weak, strong = (0.12 * np.cos(2 * np.pi * 4.7134 * RATE * t), 0.7 * np.cos(2 * np.pi * 5.4152 * RATE * t))
    e = np.random.default_rng(9).standard_normal(t.size)
    assert {line.fault for line in evidence(e * (1 + weak))} == {"ball"}
    assert {line.fault for line in evidence(e * (1 + weak + strong))} == {"inner"}


def test_a_series_of_no_part_of_the_bearing_is_told_and_noise_has_none():
    rng = np.random.default_rng(7)
    t = np.arange(round(5 * FS)) / FS
    series = sum(0.3 * np.cos(2 * np.pi * n * 4.21 * RATE * t) for n in (1, 2, 3))
    spectra = band_spectra(rng.standard_normal(t.size) * (1 + series), FS, RATE)
    found = strange_series(spectra, RATE, ORDERS, [])
    assert found is not None
    assert found.order == pytest.approx(4.21, abs=0.02)
    assert found.level >= LEAST_LEVEL
    for _ in range(20):
        assert strange_series(band_spectra(noise("white", 2.0, rng), FS, RATE), RATE, ORDERS, []) is None


def spectrum_with(*frequencies, ratio=100.0, width=0.4):
    """A spectrum of noise with lines, of many segments."""
    bins = np.ones(6000)
    bins[np.rint(np.array(frequencies) / 0.1).astype(int)] = ratio
    return BandSpectrum((1000.0, 3000.0), 0.1, width, bins, 50.0)


SERIES = 4.4152 * RATE * np.arange(1, 4)  # one shaft order below BPFI
BPFI = Line("inner", "BPFI", 1, 5.4152, 5.4152 * RATE, 24.0, (1000.0, 3000.0))


@pytest.mark.parametrize(
    ("frequencies", "lines", "found"),
    [
        (SERIES, [], True),
        (SERIES[:1], [], False),
        (SERIES[[0, 2]], [], False),
        (SERIES, [BPFI], False),
        (100.0 * np.arange(1, 4), [], False),
        (60.0 * np.arange(1, 4), [], False),
    ],
)
def test_a_series_has_three_harmonics_and_is_not_explained_by_mains_or_evidence(frequencies, lines, found):
    assert (strange_series([spectrum_with(*frequencies)], RATE, ORDERS, lines) is not None) == found


@pytest.mark.parametrize(("above", "told"), [(4.0, True), (6.0, False)])
def test_a_series_is_reported_unless_the_evidence_is_5_db_higher(above, told):
    spectra = [spectrum_with(*4.21 * RATE * np.arange(1, 4))]
    line = BPFI._replace(level=20.0 + above)
    assert bool(_bearing_warning(spectra, [line], RATE, ORDERS)) == told


def test_multiples_of_the_shaft_rate_are_left_out_more_widely_the_higher_they_are():
    near = _near_shaft(spectrum_with(), RATE)
    assert near[[round(multiple * RATE * 1.0035 / 0.1) for multiple in (1, 10, 19)]].all()
    assert not near[int(10.2 * RATE / 0.1)]
