"""Mechanisms that make simulated faults more like real ones have the effects that docs/model.md states; shipped recipes."""

import functools
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.stats import kurtosis

from gen import generate, open_corpus
from gen.recipe import read_recipe, shipped_recipes
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import simulate
from raceway.console.corpus_counts import clipped_records
from tests.gen.measurement.test_record_rms_laws import check
from tests.reference_machine import (
    FS,
    LINES,
    SECONDS,
    TURNING,
    FloatArray,
    recorded,
    reference_recipe,
    squared_envelope_spectrum,
)
from tests.responses import accelerations_of

BALL = {"kind": "ball", "width_mm": 0.533, "angle_deg": TURNING}
INNER = {"kind": "inner", "width_mm": 0.533, "angle_deg": TURNING}
OUTER = {"kind": "outer", "width_mm": 0.533}
SEEDS = 8


def marks(fault: dict[str, Any], changes: dict[str, Any], n_seeds: int) -> dict[str, float]:
    """Marks of one case, medians over the seeds."""
    signals, rate = recorded(reference_recipe(fault, n_seeds, **changes))
    spectrum = squared_envelope_spectrum(signals)
    slow = np.arange(spectrum.shape[1]) / SECONDS < 0.8 * rate
    return {
        "kurtosis": float(np.median(kurtosis(signals, axis=1, fisher=False))),
        "BPFO +/- fr [dB]": _beside(spectrum, LINES["BPFO"] * rate, rate),
        "BPFI +/- fr [dB]": _beside(spectrum, LINES["BPFI"] * rate, rate),
        "share below 0.8 fr [%]": 100
        * float(np.median((spectrum[:, slow] ** 2).sum(axis=1) / (spectrum**2).sum(axis=1))),
    }


def _beside(spectrum: FloatArray, line: float, rate: float) -> float:
    """Mean of the two lines one shaft rate beside a line, relative to that line [dB]."""
    peaks = [_peak(spectrum, line + side * rate) for side in (-1, 0, 1)]
    return float(np.median(20 * np.log10((peaks[0] + peaks[2]) / (2 * peaks[1]))))


def _peak(spectrum: FloatArray, line: float) -> FloatArray:
    place, reach = round(line * SECONDS), round(0.01 * line * SECONDS)
    return spectrum[:, place - reach : place + reach + 1].max(axis=1)


plain = functools.cache(lambda name: marks({"ball": BALL, "inner": INNER, "outer": OUTER}[name], {}, SEEDS))


def test_a_load_that_turns_with_a_bent_shaft_puts_sidebands_beside_the_line_of_an_outer_fault():
    bent = marks(OUTER, {"machine": {"bow_n": 100}}, SEEDS)
    assert bent["BPFO +/- fr [dB]"] > plain("outer")["BPFO +/- fr [dB]"] + 15


def test_an_axial_load_makes_the_modulation_of_an_inner_fault_shallower():
    changes = {"specimen": {"contact_angle_deg": 15}, "operation": {"axial_load_n": 600}}
    assert marks(INNER, changes, SEEDS)["BPFI +/- fr [dB]"] < plain("inner")["BPFI +/- fr [dB]"] - 6


def test_a_load_that_wanders_makes_the_envelope_fluctuate_slowly():
    wandering = marks(OUTER, {"operation": {"load_wander_percent": 10}}, SEEDS)
    assert wandering["share below 0.8 fr [%]"] > 10 * plain("outer")["share below 0.8 fr [%]"]


def test_an_axis_that_wanders_makes_the_hits_of_a_ball_rarer_and_the_record_more_impulsive():
    rare = marks(BALL | {"axis_wander_deg": 11.5, "axis_offset_deg": 8}, {}, SEEDS)
    assert rare["kurtosis"] > 1.5 * plain("ball")["kurtosis"]


def test_a_contact_of_finite_width_takes_a_little_from_the_level_of_a_narrow_spall():
    narrow = BALL | {"width_mm": 0.178}
    point, wide = (
        recorded(reference_recipe(narrow, SEEDS, contact={"footprint": footprint}))[0]
        for footprint in ("point", "hertz")
    )
    assert (np.std(wide, axis=1) < 0.98 * np.std(point, axis=1)).all()


def test_an_axis_that_jumps_weakens_the_lines_of_a_ball_and_makes_its_hits_come_and_go():
    jumping = recorded(reference_recipe(BALL | {"axis_jumps": {"probability_percent": 30, "spread_deg": 15}}, SEEDS))[0]
    fixed = recorded(reference_recipe(BALL, SEEDS))[0]

    def levels(signals):
        """Rms of eight windows of half a second, shape (seed, window) [m s-2]."""
        return signals.reshape(len(signals), 8, -1).std(axis=2)

    assert levels(fixed).min() > 0.8 * levels(fixed).max()
    assert (levels(jumping).min(axis=1) < 0.5 * levels(jumping).max(axis=1)).all()


def test_a_jagged_edge_scatters_the_impacts_of_an_outer_fault():
    def scatter(changes):
        """Standard deviation of the logarithm of the peaks of 100 passages, median over the seeds [1]."""
        still = {"operation": {"slip_percent": 0, "jitter_deg": 0, "speed_wander_percent": 0}}
        signals, rate = recorded(reference_recipe(OUTER | changes, SEEDS, **still))
        edges = np.round(np.arange(101) * FS / (LINES["BPFO"] * rate)).astype(int)
        peaks = [np.abs(signals[:, low:high]).max(axis=1) for low, high in pairwise(edges)]
        return np.median(np.log(peaks).std(axis=0))

    smooth, jagged = scatter({}), scatter({"jagged_edge": {"scatter_percent": 40}})
    assert smooth < 0.15 < 0.2 < jagged < 0.45


def test_the_records_for_training_have_the_drawn_rms():
    scenarios = draw_scenarios(read_recipe("domain_randomised"), 0, 24)
    check(accelerations_of(simulate(scenarios)), scenarios)


@pytest.mark.parametrize("name", sorted(shipped_recipes().keys() - {"dirty_sensors"}))
def test_no_sample_of_a_shipped_recipe_is_clipped(tmp_path, name):
    """All but the recipe with faults of the sensors: a peak at the full scale would tell that a bearing is damaged."""
    with open_corpus(generate(name, tmp_path / "corpus").path) as corpus:
        assert clipped_records(corpus) == {}
