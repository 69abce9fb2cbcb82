"""Laws of the level of a record: the drawn ratio is that of the fault, and the drawn rms that of the whole record."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.measurement.gains import fault_over_rest, gains_of, rms_of


def products_of(fault, healthy, noise):
    return tuple(float(np.mean(a * b)) for a, b in (
        (noise, noise), (healthy, noise), (healthy, healthy), (fault, noise), (fault, healthy), (fault, fault),
    ))  # fmt: skip


@given(st.integers(0, 2**32 - 1), st.floats(-20, 20), st.floats(0.1, 10), st.floats(0.01, 1), st.floats(0.1, 100))
def test_fault_and_record_have_their_drawn_levels_however_the_parts_are_correlated(seed, ratio, rms, quiet, loud):
    rng = np.random.default_rng(seed)
    shared, *parts = rng.standard_normal((4, 300))
    fault, healthy, noise = (part + 0.5 * shared for part in parts)
    healthy, noise = quiet * healthy * 10 ** (-ratio / 20) / 3, loud * noise
    bearing, background = gains_of(products_of(fault, healthy, noise), ratio, rms)
    added, rest = bearing * fault, bearing * healthy + background * noise
    assert 20 * np.log10(np.sqrt(np.mean(added**2)) / np.sqrt(np.mean(rest**2))) == pytest.approx(ratio, abs=1e-6)
    assert np.sqrt(np.mean((added + rest) ** 2)) == pytest.approx(rms, rel=1e-9)


def test_a_fault_that_is_weaker_than_its_bearing_is_not_raised_above_it():
    """No gain lifts a fault above the healthy bearing that it belongs to."""
    products = (4.0, 0.0, 1.0, 0.0, 0.0, 0.01)
    gains = gains_of(products, 3.0, 2.0)
    level, share = fault_over_rest(products, gains, 0.0)
    assert level == pytest.approx(
        10 * np.log10(0.01 / 2)
    )  # the bearing without its fault has the power of the background
    assert share == pytest.approx(0.005 / 1.005)
    assert rms_of(products, gains[0], *gains) == pytest.approx(2.0)


def test_a_fault_that_adds_nothing_has_a_level_of_minus_infinity():
    products = (1.0, 0.0, 1.0, 0.0, 0.0, 0.0)
    assert fault_over_rest(products, gains_of(products, 3.0, 2.0), 0.0) == (-np.inf, 0.0)


def test_a_fault_below_the_rounding_of_the_converter_is_measured_against_it():
    products = (0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    level, _ = fault_over_rest(products, (1e-3, 1e-3), 1e-2)
    assert level == pytest.approx(-20.0)
