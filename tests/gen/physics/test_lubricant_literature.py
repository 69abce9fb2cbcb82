"""Oil and film compared with tables, formulas of other authors and a rule of practice; the values of docs/model.md.

.. [1] G. W. Stachowiak, A. W. Batchelor, *Engineering Tribology*, Elsevier, table 2.3: dynamic viscosity at 30, 60 and 100 C.
.. [2] ASTM D341, a worked example of its equation: a gear oil SAE 140 of 404 and 28 mm2/s has 132.126 mm2/s at 60 C.
.. [3] G. Nijenbanning, C. H. Venner, H. Moes, "Film thickness in elastohydrodynamically lubricated elliptic contacts", Wear 176
   (1994) 217-229.
.. [4] A. N. Grubin, in *Central Scientific Research Institute for Technology and Mechanical Engineering*, book 30, Moscow, 1949.
.. [5] E. Krämer, *Dynamics of Rotors and Foundations*, Springer, 1993: damping of rolling bearings from their stiffness.
"""

import math
from itertools import product

import pytest

from gen.physics.catalogue import CATALOGUE
from gen.physics.hertz import effective_modulus
from gen.physics.lubricant import (
    Film,
    Lubricant,
    dynamic_viscosity,
    film,
    kinematic_viscosity,
    line_film_thickness,
    point_film_thickness,
    point_squeeze_damping,
)
from tests.cases import for_each
from tests.paths import ROOT

STEEL = effective_modulus(207e9, 0.3)
ALPHA = 2e-8
PAGE = (ROOT / "docs" / "model.md").read_text(encoding="utf-8")


def test_the_equation_reproduces_the_worked_example():
    oil = Lubricant(404e-6, 28e-6)
    assert kinematic_viscosity(oil, 60) == pytest.approx(132.126e-6, rel=1e-5)


# radius, ratio of curvatures (14 to 45 in the catalogue), load, and U
@for_each(product([1.5e-3, 5e-3], [2.0, 15.0, 40.0], [30.0, 300.0, 1500.0], [5e-12, 2e-11, 5e-11]))
def test_the_film_of_a_ball_is_that_of_nijenbanning_venner_and_moes(case):
    """Two fits to two sets of computations, at the speeds of bearings: films of 10 nm to 0.3 um.

    Beyond they part, for theirs has no single power of speed: at U = 1e-12 it is 6 to 21 percent lower, at 3e-10 11 to 28 higher.
    """
    radius, ratio, load, U = case
    viscous_speed = U * STEEL * radius
    curvature, both_speeds = 1 / ratio, 2 * viscous_speed
    M = load / (STEEL * radius**2) * (STEEL * radius / both_speeds) ** 0.75
    L = ALPHA * STEEL * (both_speeds / (STEEL * radius)) ** 0.25
    shape = 1 + 0.006 * math.log(curvature) + 0.63 * curvature ** (4 / 7)
    rigid = 145 * (1 + 0.796 * curvature ** (14 / 15)) ** (-15 / 7) / curvature * M**-2
    elastic = 3.18 * shape ** (-14 / 25) * curvature ** (-1 / 15) * M ** (-2 / 15)
    rigid_piezoviscous = 1.29 * (1 + 0.691 * curvature) ** (-2 / 3) * L ** (2 / 3)
    elastic_piezoviscous = 1.48 * shape ** (-7 / 20) * curvature ** (-1 / 24) * M ** (-1 / 12) * L ** (3 / 4)
    s = 1.5 * (1 + math.exp(-1.2 * elastic / elastic_piezoviscous))
    isoviscous = rigid**1.5 + (elastic**-4 + (1.8 * ratio) ** -4) ** (-3 / 8)
    piezoviscous = rigid_piezoviscous**-8 + elastic_piezoviscous**-8
    expected = (isoviscous ** (2 * s / 3) + piezoviscous ** (-s / 8)) ** (1 / s)
    expected *= radius * math.sqrt(both_speeds / (STEEL * radius))
    thickness = point_film_thickness((1 / radius, curvature / radius), STEEL, ALPHA, viscous_speed, load)
    assert thickness == pytest.approx(expected, rel=0.15)


@pytest.mark.parametrize("viscous_speed", [0.005, 0.02, 0.05])  # [N/m]
@pytest.mark.parametrize("per_length", [2e4, 1e5, 3e5])
def test_the_least_film_of_a_roller_is_about_three_quarters_of_the_parallel_one_of_grubin(per_length, viscous_speed):
    radius = 4e-3
    U, G, W = viscous_speed / (STEEL * radius), ALPHA * STEEL, per_length / (STEEL * radius)
    parallel = 1.95 * (U * G) ** (8 / 11) * W ** (-1 / 11) * radius
    thickness = line_film_thickness(1 / radius, STEEL, ALPHA, viscous_speed, per_length)
    assert thickness / parallel == pytest.approx(0.77, abs=0.1)


def test_a_sphere_near_a_plane_is_damped_as_cox_and_brenner_say():
    radius, viscosity, gap = 4e-3, 0.02, 1e-6
    expected = 6 * math.pi * viscosity * radius**2 / gap
    assert point_squeeze_damping((1 / radius, 1 / radius), viscosity, gap) == pytest.approx(expected, rel=1e-12)


def film_of_the_page(celsius: float) -> Film:
    """Film of one ball of a 6205 with VG 68 oil at 30 Hz and 300 N."""
    return film(CATALOGUE["6205"], Lubricant(), celsius, 30.0, 300.0)


def test_the_oil_table_of_the_model_page_is_what_the_formulas_give():
    films = [film_of_the_page(celsius) for celsius in (20, 60, 100)]
    rows = {
        "viscosity [mPa s]": [1e3 * dynamic_viscosity(Lubricant(), celsius) for celsius in (20, 60, 100)],
        "film, both contacts [um]": [1e6 * of_oil.thickness for of_oil in films],
        "damping [N s/m]": [of_oil.damping for of_oil in films],
    }
    for name, values in rows.items():
        assert f"| {name} | {' | '.join(f'{value:.3g}' for value in values)} |" in PAGE
