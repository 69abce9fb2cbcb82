"""The contact ellipse of a ball compared with a model study and with the pressures that follow from its axes.

Closed forms are those of K. L. Johnson, *Contact Mechanics*, Cambridge University Press, 1985, ch. 4.
"""

import math

import pytest

from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import effective_modulus, ellipticity, footprints, race_curvatures, race_factors

LOAD = 200.0  # of one ball of a 6205 [N]
# half the length and half the width of the ellipse [m], largest pressure [Pa], approach [m]; model study, three figures at most
STUDY = {"inner": (0.77e-3, 0.083e-3, 1.50e9, 3.95e-6), "outer": (0.75e-3, 0.103e-3, 1.25e9, 3.80e-6)}
STEEL = effective_modulus(207e9, 0.3)


@pytest.mark.parametrize("race", [0, 1], ids=STUDY)
def test_the_ellipse_of_a_6205_is_that_of_the_model_study(race):
    bearing = CATALOGUE["6205"]
    long, short, pressure, approach = list(STUDY.values())[race]
    found = footprints(bearing, LOAD)[race]
    length = found * ellipticity(*race_curvatures(bearing)[race])
    assert found == pytest.approx(short, abs=0.51e-6)  # the last figure given; 82.5 um was rounded up
    assert length == pytest.approx(long, abs=0.5e-5)
    assert 1.5 * LOAD / (math.pi * length * found) == pytest.approx(pressure, abs=0.5e7)
    assert (LOAD / race_factors(bearing)[race]) ** (2 / 3) == pytest.approx(approach, abs=0.5e-8)


def test_the_contact_of_a_roller_is_the_strip_of_two_cylinders():
    bearing = CATALOGUE["NU206"]
    assert bearing.roller_length is not None
    for width, radius in zip(footprints(bearing, LOAD), (bearing.inner_radius, -bearing.outer_radius), strict=True):
        together = 1 / (2 / bearing.ball_diameter + 1 / radius)
        strip = math.sqrt(4 * LOAD * together / (math.pi * bearing.roller_length * STEEL / 2))
        assert width == pytest.approx(strip, rel=1e-12)
