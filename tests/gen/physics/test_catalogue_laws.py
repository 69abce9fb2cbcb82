"""Laws of the catalogue: geometry of every bearing that can be assembled."""

import math

import pytest

from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import load_deflection_factor
from tests.cases import for_each

every_bearing = for_each(CATALOGUE.values(), lambda bearing: bearing.designation)
FOR_THE_CAGE = 0.5e-3  # [m], smallest width of a cage bar
NOT_IN_THE_MIDDLE = 0.06  # the pitch circle of a real bearing lies this close to the middle of its section


@every_bearing
def test_a_bearing_stands_under_its_own_name_with_its_source(bearing):
    assert CATALOGUE[bearing.designation] is bearing
    assert bearing.source


@every_bearing
def test_neighbours_leave_room_for_the_bars_of_a_cage(bearing):
    chord = bearing.pitch_diameter * math.sin(math.pi / bearing.n_balls)
    assert chord - bearing.ball_diameter > FOR_THE_CAGE


@every_bearing
def test_the_pitch_circle_lies_midway_between_bore_and_outside_diameter(bearing):
    if bearing.bore is None or bearing.outside_diameter is None:
        return
    middle = (bearing.bore + bearing.outside_diameter) / 2
    assert bearing.pitch_diameter == pytest.approx(middle, rel=NOT_IN_THE_MIDDLE)
    assert bearing.bore < 2 * bearing.inner_radius
    assert 2 * bearing.outer_radius < bearing.outside_diameter


@every_bearing
def test_only_rollers_have_a_length_and_only_an_unknown_length_has_no_stiffness(bearing):
    if bearing.rolling_element == "ball":
        assert bearing.roller_length is None
    if bearing.rolling_element == "roller" and bearing.roller_length is None:
        with pytest.raises(ValueError, match="length of its rollers is not known"):
            load_deflection_factor(bearing)
    else:
        assert load_deflection_factor(bearing) > 1e8
