"""The catalogue compared with published fault frequencies and load ratings.

.. [1] The Timken Company, *Ball Bearing Housed Unit Catalog*, p. A-13, table A-9.
.. [2] Case Western Reserve University Bearing Data Center, bearing information.
.. [3] C. Schnur et al., Data 10 (2025) 77, doi:10.3390/data10050077, table 1.
.. [4] Y. Hou et al., Data in Brief 63 (2025) 112187, doi:10.1016/j.dib.2025.112187, lines at 20 Hz.
.. [5] MAFAULDA, Machinery Fault Database, COPPE/UFRJ.
.. [6] I. Gutierrez, N. Simon, 2026, doi:10.17632/sp3fbf8d9y.1, multipliers of the maker.
.. [7] G. Forbes, Curtin University, 2012, read-me of measurements on an MB ER-16K.
.. [8] ISO 76:2006, factor f0 of deep groove ball bearings; ISO 281:2007, factor fc after Lundberg and Palmgren.
.. [9] EWA Sensors, case "Bearing fault", https://ewasensors.com/cases/bearing-fault, quoting the data sheet of an SKF 6308.
.. [10] T. A. Harris, *Rolling Bearing Analysis*, 4th ed., Wiley, 2001, ch. 2, free contact angle.
"""

import math

import pytest

from gen.physics.bearing import free_contact_angle, orders
from gen.physics.catalogue import CATALOGUE, PRINTED_OTHERWISE
from tests.cases import for_each

TIMKEN = {  # FTF, BSF, BPFO, BPFI [1], the sizes whose row agrees
    "6004": (0.398, 2.339, 3.578, 5.422),
    "6006": (0.417, 2.933, 4.588, 6.412),
    "6203": (0.382, 1.994, 3.053, 4.947),
    "6204": (0.382, 1.992, 3.052, 4.948),
    "6206": (0.396, 2.311, 3.568, 5.432),
    "6207": (0.396, 2.303, 3.565, 5.435),
    "6209": (0.402, 2.461, 3.621, 5.379),
    "6210": (0.409, 2.665, 4.093, 5.907),
    "6211": (0.408, 2.620, 4.078, 5.922),
    "6212": (0.407, 2.584, 4.066, 5.934),
    "6213": (0.410, 2.685, 4.099, 5.901),
    "6214": (0.410, 2.702, 4.104, 5.896),
    "6303": (0.364, 1.696, 2.545, 4.455),
    "6304": (0.368, 1.757, 2.574, 4.426),
    "6307": (0.376, 1.888, 3.006, 4.994),
    "6309": (0.380, 1.955, 3.037, 4.963),
    "6310": (0.381, 1.981, 3.047, 4.953),
    "6311": (0.382, 2.002, 3.057, 4.943),
    "6312": (0.383, 2.020, 3.064, 4.936),
    "6314": (0.385, 2.050, 3.076, 4.924),
    "6315": (0.385, 2.062, 3.081, 4.919),
    "6316": (0.386, 2.073, 3.086, 4.914),
}

OTHERWISE = {  # FTF, BSF, BPFO, BPFI [1], and how far BPFO is from that of the row [%]
    "6205": (0.397, 2.328, 3.574, 5.426, -0.3),
    "6208": (0.394, 2.256, 3.547, 5.453, -1.5),
    "6305": (0.367, 2.328, 3.574, 5.426, 17.1),
    "6306": (0.368, 1.757, 2.574, 4.426, -16.1),
    "6308": (0.378, 1.925, 3.023, 4.977, -1.6),
    "UER204": (0.382, 1.992, 3.052, 4.948, -1.0),
}
SIZES = {"ER-16K": "6205", "6205-paper": "6205", "6203-paderborn": "6203"}  # further rows of a size of the table

# designation, FTF, BSF, BPFO, BPFI and how many of the last digit they may be off
PUBLISHED = (
    ("6205", 0.39828, 4.7135 / 2, 3.5848, 5.4152, 1e-4),  # [2]
    ("6205-paper", 0.3974, 2.3349, 3.5769, 5.4231, 1e-4),  # of the rounded geometry of the seed paper
    ("6203", 0.3817, 3.9874 / 2, 3.0530, 4.9469, 2e-4),  # [2]
    ("NU206", 0.40, 2.49, 5.24, 7.76, 5e-3),  # [3]
    ("NU205", None, None, 104.65 / 20, 155.35 / 20, 2e-3),  # [4]
    ("MAFAULDA", 0.375, 1.871, 2.998, 5.002, 1e-3),  # [5]
    ("ER-12K", None, 1.992, 3.048, 4.950, 5e-3),  # [6], printed with three digits per rpm
    ("ER-16K", 0.3969, 2.32, 3.572, 5.428, 5e-3),  # [7]
    ("6308", None, 4.078 / 2, None, None, 5e-4),  # [9], the orders of SKF
)


def test_a_6205_with_10_um_has_a_free_contact_angle_of_10_degrees():
    """The formula of [10] by hand: A = 0.04 * 7.94 mm = 0.3176 mm, and arccos(1 - 10 um / 2 A) = 10.18 degrees."""
    assert math.degrees(free_contact_angle(CATALOGUE["6205"], 10e-6)) == pytest.approx(10.18, abs=0.01)


RATED = [bearing for bearing in CATALOGUE.values() if bearing.static_rating and bearing.rolling_element == "ball"]
rated = for_each(RATED, lambda bearing: bearing.designation)


@for_each(TIMKEN)
def test_the_orders_are_the_frequency_coefficients_of_the_maker(designation):
    """Three printed digits, and a ball rounded to a commercial size moves the spin by 0.001."""
    computed = orders(CATALOGUE[designation])
    assert (computed.ftf, computed.bsf, computed.bpfo, computed.bpfi) == pytest.approx(TIMKEN[designation], abs=1.6e-3)


def test_every_row_of_a_size_of_the_table_that_differs_by_more_than_its_rounding_is_listed():
    printed = {name: row[2:4] for name, row in (TIMKEN | OTHERWISE).items()}
    printed |= {name: printed[size] for name, size in SIZES.items()}
    differing = {
        name
        for name, passages in printed.items()
        if passages != pytest.approx((orders(CATALOGUE[name]).bpfo, orders(CATALOGUE[name]).bpfi), rel=2e-3)
    }
    assert differing == set(PRINTED_OTHERWISE) == set(OTHERWISE)


@for_each(PUBLISHED)
def test_the_orders_are_those_published_with_the_recordings(row):
    designation, *published, digits = row
    computed = orders(CATALOGUE[designation])
    for name, value in zip(("ftf", "bsf", "bpfo", "bpfi"), published, strict=True):
        if value is not None:
            assert getattr(computed, name) == pytest.approx(value, abs=digits), name


@rated
def test_the_dynamic_rating_is_that_of_these_balls(bearing):
    """Makers round up for better steel; the newest ratings here are 6 percent above the standard."""
    gamma, conformity = bearing.gamma, bearing.inner_conformity
    races = (1 + (1.04 * ((1 - gamma) / (1 + gamma)) ** 1.72) ** (10 / 3)) ** -0.3
    shape = gamma**0.3 * (1 - gamma) ** 1.39 / (1 + gamma) ** (1 / 3) * (2 * conformity / (2 * conformity - 1)) ** 0.41
    expected = 1.3 * 37.91 * races * shape * bearing.n_balls ** (2 / 3) * (1e3 * bearing.ball_diameter) ** 1.8
    assert bearing.dynamic_rating == pytest.approx(expected, rel=0.07)
