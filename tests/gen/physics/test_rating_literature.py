"""The static rating from the contact pressure, compared with catalogues of makers and formulas of ISO 76.

.. [1] The Timken Company, *Deep Groove Ball Bearing Catalog*, order no. 10857, 2017, tables 10 and 11; SKF for 6309 and 6310.
.. [2] ISO 76:2006, table 1 (factor f0 of deep groove ball bearings), 5.2 (radial roller bearings), 5.1 and 5.3 (equivalent load).
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from gen.physics.catalogue import CATALOGUE
from gen.physics.rating import computed_rating, equivalent_load, static_rating

RATED = [bearing for bearing in CATALOGUE.values() if bearing.static_rating]


def test_the_computed_ratings_are_those_of_the_catalogues():
    """27 deep groove ball bearings [1]: the mean is 0.999 of the printed rating, from 0.979 (608, printed with two digits) to 1.012."""
    ratio = np.array([computed_rating(bearing) / bearing.static_rating for bearing in RATED])
    assert len(ratio) == 27
    assert ratio.mean() == pytest.approx(1.0, abs=0.003)
    assert np.abs(ratio - 1).max() < 0.022


@pytest.mark.parametrize("share", [0.10, 0.16, 0.22, 0.28])
def test_ball_bearings_follow_the_factor_f0_of_the_standard(share):
    """Between 0.1 and 0.3 the table [2] is ``18.8 - 24 gamma`` to 0.1."""
    bearing = replace(CATALOGUE["6205"], ball_diameter=share * CATALOGUE["6205"].pitch_diameter)
    standard = (18.8 - 24 * share) * bearing.n_balls * (1e3 * bearing.ball_diameter) ** 2
    assert computed_rating(bearing) == pytest.approx(standard, rel=0.015)


@pytest.mark.parametrize("angle", [0.0, 15.0])
def test_roller_bearings_follow_the_formula_of_the_standard(angle):
    """``44 (1 - gamma) Z L D cos(contact_angle)`` with lengths in mm [2]; 44 is rounded from 44.2."""
    bearing = replace(CATALOGUE["NU206"], contact_angle=math.radians(angle))
    standard = 44 * (1 - bearing.gamma) * 13 * 10 * 9 * math.cos(bearing.contact_angle)
    assert computed_rating(bearing) == pytest.approx(standard, rel=0.006)


def test_a_rating_in_the_catalogue_comes_first():
    assert static_rating(CATALOGUE["6205"]) == 7900
    assert static_rating(replace(CATALOGUE["6205"], static_rating=None)) == computed_rating(CATALOGUE["6205"])


@pytest.mark.parametrize(("angle", "factor"), [(20, 0.60), (25, 0.47), (30, 0.38), (35, 0.31), (40, 0.26)])
def test_the_equivalent_load_is_that_of_angular_contact_bearings(angle, factor):
    """``0.22 cot(contact_angle)``, and no less than the radial load alone [2]."""
    alone = equivalent_load(0.0, 1000.0, math.radians(angle))
    assert alone == pytest.approx(1000 * factor, abs=7)
    assert equivalent_load(800.0, 1000.0, math.radians(-angle)) == pytest.approx(max(800, 400 + alone))
    assert equivalent_load(800.0, 0.0, math.radians(angle)) == equivalent_load(800.0, 100.0, math.radians(angle)) == 800
