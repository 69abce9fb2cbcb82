"""Fault orders as published beside real recordings.

.. [1] Case Western Reserve University Bearing Data Center, drive end bearing 6205-2RS: fault frequencies in multiples of the shaft rate.
"""

import pytest

from gen.physics.bearing import orders
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
