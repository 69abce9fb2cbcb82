"""Spalls from narrow to wide: where the ball strikes, how smoothly it enters, and what no longer grows with the severity.

.. [1] N. Sawalhi, R. B. Randall, "Vibration response of spalled rolling element bearings: Observations, simulations and signal processing
   techniques to track the spall size", Mech. Syst. Signal Process. 25 (2011) 846-870.
"""

import math

import numpy as np
import pytest

from gen.physics.catalogue import CATALOGUE
from gen.scenarios import draw_scenarios
from gen.simulation.inputs import bare_inputs
from gen.simulation.motion import draw_motion
from tests.reference_machine import reference_recipe
from tests.spall_passages import contact_speed, contributions, passage, unloading_drop, unloads


def scenario_of(width_mm, load_n, **fault):
    return draw_scenarios(
        reference_recipe({"kind": "outer", "width_mm": width_mm} | fault, 1, operation={"load_n": load_n})
    )[0]


def rms(width_mm, rpm=1797):
    """Root mean square of what a spall on the outer race adds, at 300 N [m s-2]."""
    return np.sqrt(np.mean(contributions("outer", width_mm, 2, 0.5, shaft_rpm=rpm) ** 2))


def test_the_contact_travels_at_the_speed_of_the_formula_of_sawalhi_and_randall():
    bearing, rate = CATALOGUE["6205"], 29.95
    pitch, ball = bearing.pitch_diameter, bearing.ball_diameter
    assert contact_speed(bearing, rate) == pytest.approx(math.pi * rate * (pitch**2 - ball**2) / (2 * pitch))


@pytest.mark.parametrize("rpm", [600, 1797])
def test_a_ball_that_bridges_a_spall_strikes_after_half_its_width(rpm):
    """[1], the correction by two of the distance between entry and impact."""
    assert passage("outer", 0.5, rpm, seconds=0.5).exit == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("kind", ["outer", "inner"])
@pytest.mark.parametrize("width_mm", [3.0, 6.0])
def test_a_ball_that_a_wide_spall_unloads_strikes_shortly_before_its_trailing_edge(kind, width_mm):
    found = passage(kind, width_mm, 1797)
    leaving, apart = found.expected
    assert found.exit == pytest.approx(leaving, abs=0.02)
    assert found.apart == pytest.approx(apart, abs=0.025)
    assert found.peaks > 1


def test_a_geometric_spall_is_entered_smoothly_and_the_formulas_of_the_literature_are_not():
    smooth, *sharp = (
        passage("outer", 3.0, 1797, profile, seconds=0.5)
        for profile in ("geometric", "raised_cosine", "half_sine", "rectangular")
    )
    assert smooth.entry_fast < 0.01
    assert all(found.entry_fast > 0.1 for found in sharp)


def test_the_level_grows_steeply_until_a_spall_unloads_the_ball_and_little_after_that():
    assert rms(0.3) > 15 * rms(0.1)
    assert unloads(scenario_of(0.3, 300)) is False
    assert unloads(scenario_of(1.0, 300))
    assert 0.5 < rms(3.0) / rms(1.0) < 2


def test_a_deeper_spall_changes_nothing_once_the_ball_is_unloaded():
    shallow, deep = (contributions("outer", 3.0, 1, 0.2, depth) for depth in (50, 280))
    np.testing.assert_array_equal(shallow, deep)
    assert np.abs(shallow - contributions("outer", 3.0, 1, 0.2, 5)).max() > 1


def test_a_heavier_load_needs_a_wider_spall():
    needed = [
        unloading_drop(
            bare_inputs([draw_motion(scenario)])[0].machine, scenario.bearing, scenario.machine["load_angle"]
        )
        for scenario in (scenario_of(1.0, load) for load in (100, 300, 1000, 2000))
    ]
    assert np.all(np.diff(needed) > 0)
    assert unloads(scenario_of(1.0, 300, angle_deg=180)) is None


def test_beyond_saturation_the_level_depends_on_the_time_from_entry_to_exit():
    """Entry and exit excite the contact mode in or out of step: twice the speed moves a minimum to twice the width."""
    for rpm, widths in {900: (0.75, 1.2, 1.75), 1797: (1.25, 2.1, 3.0), 3594: (2.1, 4.0, 5.0)}.items():
        before, minimum, after = (rms(width, rpm) for width in widths)
        assert minimum < 0.8 * min(before, after)
