"""Laws of the sizes that are seen: intervals that hold the truth, units, scale, and criteria that see all or nothing."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from raceway.visibility.size_curves import FALSE_ALARMS, SHARES, fit_curve, sizes_seen

MIDDLE, SLOPE = 0.2e-3, 6.0
TRUTH = MIDDLE * (SHARES / (1 - SHARES)) ** (1 / SLOPE)


def ladder(seed, faulty=120, healthy=120):
    """Sizes, scores and units of faults that are seen as a known curve has it, with one false alarm in a hundred, and of healthy ones."""
    rng = np.random.default_rng(seed)
    size = np.append(np.exp(rng.uniform(np.log(0.05e-3), np.log(1.5e-3), faulty)), np.zeros(healthy))
    sound = size == 0
    share = 1 / (1 + (MIDDLE / np.where(sound, 1, size)) ** SLOPE)
    seen = (rng.uniform(size=len(size)) < share) & ~sound
    score = rng.uniform(size=len(size)) + np.where(seen, 1, 0)
    return size, score, np.arange(len(size)), sound


def test_the_intervals_hold_the_truth_as_often_as_they_say():
    held = []
    for seed in range(8):
        *_, sizes = sizes_seen(*ladder(seed), seed=0)
        held += [low <= truth <= high for truth, (_, low, high) in zip(TRUTH, sizes, strict=True)]
    # 95 % of 16, less three standard deviations
    assert sum(held) >= 13


def test_copies_of_records_tell_nothing_new():
    once = ladder(1)
    thrice = [np.repeat(column, 3) for column in once]
    *_, sizes = sizes_seen(*once, seed=0)
    *_, of_copies = sizes_seen(*thrice, seed=0)
    # three times as many records would have an interval that is 42 % narrower
    widths = [np.log(high / low) for _, low, high in (*of_copies, *sizes)]
    np.testing.assert_allclose(widths[:2], widths[2:], rtol=0.15)


@given(factor=st.floats(1e-3, 1e3))
def test_sizes_in_another_unit_give_the_same_curve(factor):
    size, score, *_ = ladder(2)
    size, seen = size[size > 0], score[size > 0] > 1
    middle, slope = fit_curve(size, seen, np.ones(len(size)))
    np.testing.assert_allclose(fit_curve(factor * size, seen, np.ones(len(size))), [factor * middle, slope], rtol=1e-6)


def test_no_more_healthy_records_are_seen_than_false_alarms_are_allowed():
    size, score, unit, healthy = ladder(3, healthy=250)
    seen, *_ = sizes_seen(size, score, unit, healthy, seed=0)
    assert seen[healthy].sum() == int(FALSE_ALARMS * 250)


@pytest.mark.parametrize(("score", "expected"), [(2.0, 0.0), (0.0, np.inf)])
def test_a_share_that_is_seen_from_the_smallest_size_on_or_never_is_beyond_the_sizes(score, expected):
    size, scores, unit, healthy = ladder(4)
    *_, sizes = sizes_seen(size, np.where(healthy, scores, score), unit, healthy, seed=0)
    assert (sizes == expected).all()


def test_a_curve_does_not_fall():
    size = np.geomspace(0.1, 1, 50)
    middle, slope = fit_curve(size, size < 0.3, np.ones(50))
    share = 1 / (1 + (middle / size) ** slope)
    assert (np.diff(share) > 0).all()
    assert np.ptp(share) < 0.1
