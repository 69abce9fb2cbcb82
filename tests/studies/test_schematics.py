"""Figures 1 and 2 of the seed paper: they show the numbers of the presets, and the geometry of the bearing and of its crack."""

import numpy as np
import pytest
from matplotlib.colors import to_rgba

from raceway.reports.pictures import VERMILION
from studies.ophel2025.schematics import draw_crack


def cracks(axes) -> np.ndarray:
    """Outline of the crack, shape (axis, point)."""
    (line,) = [
        line for line in axes.lines if to_rgba(line.get_color()) == to_rgba(VERMILION) and line.get_linewidth() == 2
    ]
    return np.array(line.get_data())


def test_the_crack_is_drawn_where_it_is_as_wide_and_as_deep_as_it_is():
    for axes, position in zip(draw_crack().axes, (15, 90), strict=True):
        x, y = cracks(axes)
        radii, angles = np.hypot(x, y), np.degrees(np.arctan2(y, x)) - position
        assert (radii.min(), radii.max()) == pytest.approx((14.5, 15.5))
        assert np.abs(angles).max() == pytest.approx(10, abs=0.3)
        assert np.abs(angles[radii < 15]).max() == pytest.approx(10, abs=0.3)
