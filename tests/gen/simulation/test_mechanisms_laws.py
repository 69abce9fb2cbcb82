"""Mechanisms that make simulated faults more like real ones have the effects that docs/model.md states."""

import functools

import numpy as np

from benchmarks.mechanisms import BALL, INNER, OUTER, marks
from benchmarks.visibility import recorded, reference_recipe

SEEDS = 8
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
