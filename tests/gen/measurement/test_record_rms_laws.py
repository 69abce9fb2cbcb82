"""Laws of the level of a stored record: its rms, over all channels and samples, is the drawn one.

Bearing and background are correlated where both have lines of the shaft, so gains that ignore it miss the drawn rms by several per cent.
"""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

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
    turns = np.outer(
        [scenario.conditions["shaft_rate"] for scenario in scenarios],
        timeline(recipe).response_times(),
    )
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
