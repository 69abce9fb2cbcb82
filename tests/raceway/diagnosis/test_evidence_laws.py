"""Evidence is what stands in the signal: noise has none, a line that is added appears with its order and level, a notch removes it."""

import numpy as np
import pytest
from scipy.signal import lfilter

from features.table.indicators import Orders
from raceway.diagnosis.evidence import find_evidence
from raceway.diagnosis.spectrum import band_spectra

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


def modulated(depths, duration, seed, side=None):
    """Noise whose amplitude is modulated at orders of the shaft, each with its depth, which a ``side`` modulates in turn."""
    e = noise("white", duration, np.random.default_rng(seed))
    turns = 2 * np.pi * RATE * np.arange(e.size) / FS
    swell = 1 if side is None else 1 + 0.8 * np.cos(side * turns)
    return e * (1 + swell * sum(depth * np.cos(order * turns) for order, depth in depths.items()))


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
    lines = evidence(modulated({order: 0.6}, 5.0, 2))
    assert lines[0].fault == fault
    assert lines[0].harmonic == 1
    assert lines[0].order == pytest.approx(order, abs=0.02)
    assert lines[0].frequency == pytest.approx(order * RATE, abs=0.5)
    assert {line.fault for line in lines} == {fault}


def test_the_level_of_a_line_rises_by_6_db_with_twice_its_depth():
    """Depths at which the line is far above the floor, and the noise of the envelope hardly changes with it."""
    levels = {}
    for depth in (0.2, 0.4):
        found = [evidence(modulated({3.5848: depth}, 10.0, seed))[0].level for seed in range(6)]
        levels[depth] = np.mean(found)
    assert levels[0.4] - levels[0.2] == pytest.approx(20 * np.log10(2), abs=0.7)


def test_a_multiple_of_the_shaft_rate_is_no_evidence():
    near_integer = Orders(0.3815, 3.002, 4.999, 1.99)
    lines = evidence(modulated({3.0: 0.6}, 3.0, 3), near_integer)
    assert lines == []


@pytest.mark.parametrize("order", [3.035, 3.046, 3.06, 3.09])
def test_a_line_beside_a_multiple_of_the_shaft_rate_is_told_at_its_peak(order):
    spectra = band_spectra(modulated({order: 0.6}, 5.0, 11), FS, RATE)
    (line,) = find_evidence(spectra, RATE, Orders(0.3815, 3.05, 4.95, 1.99))
    (spectrum,) = (one for one in spectra if one.band == line.band)
    near = spectrum.ratio[slice(*spectrum.bins(line.frequency, spectrum.width))]
    assert line.order == pytest.approx(order, abs=0.005)
    assert line.level == pytest.approx(10 * np.log10(near.max()))


def test_sidebands_belong_to_the_family_of_their_line():
    names = [line.name for line in evidence(modulated({5.4152: 0.6}, 5.0, 6, side=1.0))]
    assert names[0] == "BPFI"
    assert {"BPFI - shaft", "BPFI + shaft"} <= set(names)
    assert all("BPFI" in name for name in names)


def test_lines_of_balls_have_sidebands_at_the_rate_of_the_cage_or_are_told_to_have_those_of_the_shaft():
    for side, rate in {"ftf": 0.3983, "shaft": 1.0}.items():
        lines = evidence(modulated({4.7134: 0.6}, 5.0, 6, side=rate))
        assert {line.fault for line in lines} == {"ball"}
        assert {line.side for line in lines} == {"", side}


def test_a_second_harmonic_alone_is_told_as_such_and_a_sideband_needs_its_harmonic():
    # 2 BPFI, and BPFI + shaft without BPFI
    lines = evidence(modulated({2 * 5.4152: 0.5, 6.4152: 0.5}, 5.0, 8))
    assert lines[0].order == pytest.approx(2 * 5.4152, abs=0.02)
    assert (lines[0].name, lines[0].harmonic) == ("2 BPFI", 2)
    assert {line.harmonic for line in lines} == {2}


def test_a_line_with_a_higher_one_at_half_its_frequency_is_a_harmonic_of_another_part():
    assert evidence(modulated({5.4152: 0.4, 2.7076: 0.6}, 5.0, 10)) == []


def test_a_family_10_db_below_the_strongest_is_not_told():
    weak, strong = {4.7134: 0.12}, {5.4152: 0.7}
    assert {line.fault for line in evidence(modulated(weak, 5.0, 9))} == {"ball"}
    assert {line.fault for line in evidence(modulated(weak | strong, 5.0, 9))} == {"inner"}
