"""Laws of levels: fault over rest, and the rms of a stored record over all channels and samples, are the drawn ones.

Bearing and background are correlated where both have lines of the shaft, so gains that ignore it miss the drawn rms by several per cent.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.measurement.gains import fault_over_rest, gains_of, rms_of
from gen.recipe import Recipe
from gen.scenarios import draw_scenarios
from gen.simulation.timeline import timeline
from tests.conftest import small_with
from tests.measuring import measure

TOLERANCE = 1e-3
LEVEL = {
    "kind": "snr",
    "faulty_db": "uniform(-15, 25)",
    "healthy_db": "uniform(-20, 10)",
    "rms_m_s2": "loguniform(0.2, 50)",
}
LINES = {  # a background of nothing but lines of the shaft, on a noise that is far below them
    "background.harmonics": {"probability": 1, "count": 4, "level_db": 30},
    "background.tones": {"probability": 0, "count": 1, "frequency_hz": 100, "level_db": 0},
    "background.impulses": {"probability": 0, "rate_hz": 1, "level_db": 0},
}
TWO = [{"name": "drive_end", "body": "sensor"}, {"name": "fan_end", "body": "housing", "path": {"direct": 0.2}}]


def stored(measured):
    """Samples in m s-2, shape (record, channel, time)."""
    return measured.signal.astype(float) / (measured.counts_per_unit or 1.0)


def check(acceleration, scenarios):
    """Every record that is not clipped has the drawn rms beside the offset of its sensor, up to the rounding of the converter."""
    measured = measure(acceleration, scenarios)
    offsets = np.array([scenario.recipe.recording.si()["offset"] for scenario in scenarios])[:, None, None]
    found = np.sqrt(np.mean((stored(measured) - offsets) ** 2, axis=(1, 2)))
    drawn = np.array([scenario.recipe.level.si()["rms"] for scenario in scenarios])
    rounding = 0.0 if measured.counts_per_unit is None else 1 / (measured.counts_per_unit * np.sqrt(12))
    kept = (measured.clipped == 0) & np.isfinite(acceleration).all(axis=(1, 2))
    assert kept.any()
    np.testing.assert_array_less(np.abs(found - drawn)[kept], (TOLERANCE * drawn + rounding)[kept])


def lines_of_the_shaft(recipe, scenarios, orders, seed):
    """Bearings that vibrate at multiples of the shaft rate alone, shape (record, channel, time) [m s-2]."""
    rng = np.random.default_rng(seed)
    times = np.arange(timeline(recipe).returned) / recipe.recording.sample_rate_hz
    turns = np.outer([scenario.conditions["shaft_rate"] for scenario in scenarios], times)
    phases = rng.uniform(0, 2 * np.pi, (len(orders), len(scenarios), len(recipe.recording.channels), 1))
    waves = (np.cos(2 * np.pi * n * turns[:, None] + phase) for n, phase in zip(orders, phases, strict=True))
    return sum(waves).astype(np.float32)


@settings(max_examples=10)
@given(
    st.integers(0, 2**32 - 1), st.sets(st.integers(1, 6), min_size=1).map(sorted), st.sampled_from(["adc", "float32"])
)
def test_a_record_has_the_drawn_rms_where_bearing_and_background_have_the_same_lines(seed, orders, kind):
    changes = {"level": LEVEL, "recording.converter": {"kind": kind}, "recording.channels": TWO, "seed": seed % 1000}
    recipe = Recipe.model_validate(small_with(changes | LINES))
    scenarios = draw_scenarios(recipe)
    check(lines_of_the_shaft(recipe, scenarios, orders, seed), scenarios)


def test_a_record_of_noise_has_the_drawn_rms_too():
    """Independent noises correlate by chance, by the more the shorter the record."""
    recipe = Recipe.model_validate(small_with({"level": LEVEL, "recording.converter": {"kind": "float32"}}))
    scenarios = draw_scenarios(recipe)
    shape = len(scenarios), 1, timeline(recipe).returned
    check(np.random.default_rng(0).standard_normal(shape).astype(np.float32), scenarios)


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
