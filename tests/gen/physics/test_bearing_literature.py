"""Fault orders as published beside real recordings, and the free contact angle.

.. [1] Case Western Reserve University Bearing Data Center, drive end bearing 6205-2RS: fault frequencies in multiples of the shaft rate.
.. [2] T. A. Harris, *Rolling Bearing Analysis*, 4th ed., Wiley, 2001, ch. 2, free contact angle.
"""

import math

import pytest

from gen.physics.bearing import free_contact_angle, orders
from gen.physics.catalogue import CATALOGUE


def test_the_orders_of_the_6205_are_those_of_its_data_sheet():
    found = orders(CATALOGUE["6205"])
    assert found.bpfi == pytest.approx(5.4152, abs=1e-4)
    assert found.bpfo == pytest.approx(3.5848, abs=1e-4)
    assert found.ftf == pytest.approx(0.39828, abs=1e-4)
    assert 2 * found.bsf == pytest.approx(4.7135, abs=1e-4)


def test_the_rounded_geometry_of_ophel_gives_its_own_orders():
    found = orders(CATALOGUE["6205-paper"])
    assert found == pytest.approx((0.3974, 3.5769, 5.4231, 2.3349), abs=1e-4)


def test_a_6205_with_10_um_has_a_free_contact_angle_of_10_degrees():
    """The formula of Harris [2]_ by hand: A = 0.04 * 7.94 mm = 0.3176 mm, and arccos(1 - 10 um / 2 A) = 10.18 degrees."""
    assert math.degrees(free_contact_angle(CATALOGUE["6205"], 10e-6)) == pytest.approx(10.18, abs=0.01)
