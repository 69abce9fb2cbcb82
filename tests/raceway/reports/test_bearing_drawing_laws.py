"""Laws of the drawn bearing: forces that carry the load, and a ball that rolls without slip."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE
from raceway import plot_bearing
from raceway.reports.bearing_drawing import forces_at, path_of_point

DRAWN = {name: CATALOGUE[name] for name in ("6205", "6314", "QJ212", "NU206")}


def balls_of(bearing):
    return 2 * np.pi * np.arange(bearing.n_balls) / bearing.n_balls


@given(st.sampled_from([*DRAWN]), st.floats(1, 1e5), st.floats(-50e-6, 100e-6))
@example("NU206", 1.0, 0.0)
def test_the_balls_carry_the_load_and_no_ball_pulls(name, load, clearance):
    bearing = DRAWN[name]
    forces = forces_at(balls_of(bearing), bearing, load, clearance)
    assert (forces >= 0).all()
    assert forces @ np.cos(balls_of(bearing)) == pytest.approx(load, rel=1e-6)


def test_without_clearance_the_heaviest_ball_carries_the_share_of_stribeck():
    bearing = DRAWN["6205"]
    heaviest = forces_at(np.zeros(1), bearing, 500.0, 0.0)[0]
    assert heaviest == pytest.approx(4.37 * 500 / bearing.n_balls, rel=0.03)  # Harris, Rolling Bearing Analysis, ch. 7


def test_clearance_narrows_the_load_zone():
    around = np.linspace(-np.pi, np.pi, 721)
    loaded = [int((forces_at(around, DRAWN["6205"], 500.0, 1e-6 * um) > 0).sum()) for um in (-10, 0, 10, 40)]
    assert loaded == sorted(loaded, reverse=True)
    assert len(set(loaded)) == 4


@pytest.mark.parametrize("name", ["6205", "NU206"])
def test_a_point_on_a_ball_stands_still_on_the_outer_race_and_moves_with_the_inner_one(name):
    bearing = DRAWN[name]
    ratios = orders(bearing)
    path = np.stack(path_of_point(bearing, ratios))
    turns = np.linspace(0, 1 / ratios.ftf, path.shape[1])
    radius, speed = np.hypot(*path), np.hypot(*np.gradient(path, turns, axis=1))
    assert (radius.min(), radius.max()) == pytest.approx((bearing.inner_radius, bearing.outer_radius), rel=1e-4)
    of_inner = 2 * np.pi * bearing.inner_radius
    assert speed[np.argmax(radius[5:-5]) + 5] < 0.02 * of_inner
    assert speed[np.argmin(radius)] == pytest.approx(of_inner, rel=1e-3)


def test_a_bearing_is_drawn_and_one_that_cannot_be_is_refused():
    figure = plot_bearing({"n_balls": 8, "pitch_diameter_mm": 33.5, "ball_diameter_mm": 7.938}, 300)
    assert figure.get_suptitle().startswith("8 balls, 300 N, clearance 0 um: load zone of 1")
    assert figure._repr_png_().startswith(b"\x89PNG")
    assert "A point on a roller (orange)" in plot_bearing("NU206").axes[0].get_title("left")
    for bearing, load, sentence in (
        ("bpfo=3.585,bpfi=5.415,bsf=2.357,ftf=0.398", 500, "only the orders are known; give dimensions"),
        ("6205", 0, "load_n: 0 is no positive number"),
        ("6205", "a", "load_n: a is no positive number"),
        ("62o5", 500, "is not in the catalogue"),
    ):
        with pytest.raises(ValueError, match=sentence):
            plot_bearing(bearing, load)
    with pytest.raises(ValueError, match="clearance_um: a is no finite number"):
        plot_bearing("6205", clearance_um="a")
