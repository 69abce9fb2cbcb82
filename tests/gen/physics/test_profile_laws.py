"""Laws of a profile: it passes through its points, is constant beyond them, and has a continuous acceleration if it is smooth."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.physics.profile import Profile, mean_share, share_at

both = pytest.mark.parametrize("smooth", [False, True], ids=["straight", "smooth"])
shares = st.floats(0.01, 10)


@st.composite
def points(draw, least=1):
    """Times and shares of a profile, its times a tenth of a second apart or more."""
    gaps = draw(st.lists(st.floats(0.1, 5), min_size=least - 1, max_size=6))
    times = draw(st.floats(-2, 5)) + np.concatenate([[0.0], np.cumsum(gaps)])
    return tuple(times.tolist()), tuple(draw(shares) for _ in times)


def integral(profile, start, end):
    """Area under a profile from its points: the smooth step is odd about its middle, so a whole one has the area of a line."""
    inside = [time for time in profile.times if start < time < end]
    fine = [np.linspace(low, high, 2001) for low, high in pairwise([start, *inside, end])]
    return sum(float(np.trapezoid(share_at(profile, times), times)) for times in fine)


@both
@given(points())
def test_a_profile_goes_through_its_points(smooth, given_points):
    times, shares_there = given_points
    np.testing.assert_allclose(share_at(Profile(times, shares_there, smooth), np.array(times)), shares_there, rtol=1e-9)


@both
@given(points(), st.floats(0, 100))
def test_a_profile_is_constant_before_its_first_point_and_after_its_last(smooth, given_points, beyond):
    times, shares_there = given_points
    ends = share_at(Profile(times, shares_there, smooth), np.array([times[0] - beyond, times[-1] + beyond]))
    np.testing.assert_allclose(ends, [shares_there[0], shares_there[-1]], rtol=0, atol=1e-15 * max(shares_there))


@both
@given(points(least=2))
def test_a_profile_stays_between_neighbouring_points_and_turns_nowhere_else(smooth, given_points):
    profile = Profile(given_points[0], given_points[1], smooth)
    for (start, end), (low, high) in zip(pairwise(profile.times), pairwise(profile.shares), strict=True):
        steps = np.diff(share_at(profile, np.linspace(start, end, 101)))
        assert (steps * np.sign(high - low) >= -1e-12).all()


@given(points(least=2))
def test_a_smooth_profile_has_continuous_first_and_second_derivatives(given_points):
    """No third derivative beyond that of its polynomials, 60 times rise over time cubed, so no corner and no jump of the acceleration."""
    profile = Profile(given_points[0], given_points[1], smooth=True)
    rises, gaps = np.abs(np.diff(profile.shares)), np.diff(profile.times)
    steepest, step = float((60 * rises / gaps**3).max()), 1e-3
    times = np.arange(profile.times[0] - 0.1, profile.times[-1] + 0.1, step)
    third = np.diff(share_at(profile, times), 3) / step**3
    rounding = 1e-14 * max(profile.shares) * (1 + np.abs(profile.times).max()) / step**3  # of shares and times
    assert np.abs(third).max() <= 1.01 * steepest + rounding


@both
@given(points(), st.floats(0.5, 5))
def test_the_mean_share_is_the_integral_over_the_record(smooth, given_points, duration):
    profile = Profile(given_points[0], given_points[1], smooth)
    assert mean_share(profile, duration) == pytest.approx(integral(profile, 0, duration) / duration, rel=1e-4)
