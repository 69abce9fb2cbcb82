"""Laws of the converter: counts, clipping, and what its rounding means for the signal-to-noise ratio."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.corpus.schema import signal_attributes
from gen.measurement.measure import LARGEST_COUNT
from gen.scenarios import draw_scenarios
from gen.simulation.timeline import timeline
from tests.measuring import FLOAT, direct, measure, physical, quiet, response, silence

PLAIN = direct() | quiet() | physical(0.0)


@given(st.floats(1.0, 1000.0))
def test_the_converter_rounds_to_the_nearest_count_and_clips_at_full_scale(recipe_with, full_scale):
    adc = {"recording.converter": {"kind": "adc", "full_scale_m_s2": full_scale}}
    recipe, exact = recipe_with(adc), recipe_with(FLOAT)
    scenarios = draw_scenarios(recipe, 0, 3)
    moved = response(recipe, 3, lambda time: 40 * np.sin(2 * np.pi * 313 * time))
    counts, truth = measure(moved, scenarios), measure(moved, draw_scenarios(exact, 0, 3))
    assert counts.counts_per_unit == pytest.approx(LARGEST_COUNT / full_scale)
    assert counts.signal.dtype == np.int16
    assert np.abs(counts.signal.astype(int)).max() <= LARGEST_COUNT
    scaled = truth.signal.astype(float) * counts.counts_per_unit
    over = np.abs(scaled) > LARGEST_COUNT + 0.5
    np.testing.assert_array_equal(counts.clipped, over.sum(axis=(1, 2)))
    error = np.abs(counts.signal - scaled)[~over]
    assert error.max(initial=0.0) <= 0.5 + 1e-6 * np.abs(scaled).max()
    np.testing.assert_array_equal(counts.signal[over], np.sign(scaled[over]) * LARGEST_COUNT)


@given(st.floats(1e-6, 1e6))
def test_the_converter_rounds_in_steps_of_exactly_the_stored_scale_factor(recipe_with, full_scale):
    """The factor is in single precision, so it can differ from that of the full scale by 6e-8."""
    recipe = recipe_with(PLAIN | {"recording.converter": {"kind": "adc", "full_scale_m_s2": full_scale}})
    found = measure(silence(recipe, 1), draw_scenarios(recipe, 0, 1))
    scale = signal_attributes(found.counts_per_unit)["scale_factor"]
    assert scale.dtype == np.float32
    assert found.counts_per_unit == 1 / float(scale)
    assert float(scale) == pytest.approx(full_scale / LARGEST_COUNT, rel=6e-8)


def test_without_a_converter_nothing_is_rounded_or_clipped(recipe_with):
    recipe = recipe_with(FLOAT | PLAIN)
    moved = response(recipe, 1, lambda time: 1e5 * np.cos(2 * np.pi * 500 * time))
    measured = measure(moved, draw_scenarios(recipe, 0, 1))
    assert measured.counts_per_unit is None
    assert measured.clipped.tolist() == [0]
    expected = moved[:, :, timeline(recipe).lead :]
    np.testing.assert_allclose(measured.signal, expected, rtol=1e-6, atol=1e-2)


COUNT = 500 / LARGEST_COUNT  # m s-2


def measured_tone(recipe_with, amplitude, background=0.0, changes=PLAIN):
    """Record of a bearing that is a tone of this amplitude [m s-2], whole cycles of it, over a background of this rms [m s-2]."""
    recipe = recipe_with(changes | physical(background))
    moved = response(recipe, 1, lambda time: amplitude * np.cos(2 * np.pi * 500 * time))
    return measure(moved, draw_scenarios(recipe, 0, 1))


def test_a_sample_at_full_scale_is_not_clipped_and_one_count_beyond_it_is(recipe_with):
    recipe = recipe_with(PLAIN)
    moved, start = silence(recipe, 1), timeline(recipe).lead
    at_full_scale = COUNT * np.array([LARGEST_COUNT, -LARGEST_COUNT])
    moved[0, 0, start : start + 2] = at_full_scale
    found = measure(moved, draw_scenarios(recipe, 0, 1))
    assert found.signal[0, 0, :3].tolist() == [LARGEST_COUNT, -LARGEST_COUNT, 0]
    assert found.clipped.tolist() == [0]
    moved[0, 0, start : start + 2] = at_full_scale * (1 + 1 / LARGEST_COUNT)
    found = measure(moved, draw_scenarios(recipe, 0, 1))
    assert found.signal[0, 0, :3].tolist() == [LARGEST_COUNT, -LARGEST_COUNT, 0]
    assert found.clipped.tolist() == [2]


def test_without_a_background_the_bearing_stands_over_the_rounding_of_the_converter(recipe_with):
    """Rounding to counts has an error of 1/sqrt(12) count, which is the only background of such a record."""
    found = measured_tone(recipe_with, 100.0)
    exact = measured_tone(recipe_with, 100.0, changes=FLOAT | PLAIN).signal[0, 0].astype(float)
    error = found.signal[0, 0] * COUNT - exact
    assert found.snr[0] == pytest.approx(20 * np.log10(100 / np.sqrt(2) / (COUNT / np.sqrt(12))), abs=1e-3)
    assert found.snr[0] == pytest.approx(20 * np.log10(np.std(exact) / np.std(error)), abs=1.5)


@pytest.mark.parametrize(
    ("amplitude", "background", "converter"),
    [(0.4 * COUNT, 0.0, {}), (0.0, 0.3, {}), (0.0, 0.0, {}), (100.0, 0.0, FLOAT), (0.0, 0.3, FLOAT), (0.0, 0.0, FLOAT)],
    ids=["below half a count", "no bearing", "silence", "no background", "no bearing in floats", "silence in floats"],
)
def test_the_ratio_is_not_a_number_where_there_is_nothing_to_compare(recipe_with, amplitude, background, converter):
    """A bearing below half a count without background is stored as zeros; it was once labelled with 515 dB."""
    found = measured_tone(recipe_with, amplitude, background, PLAIN | converter)
    assert np.isnan(found.snr[0])
    assert found.signal.any() == (background > 0 or (bool(converter) and amplitude > 0))
