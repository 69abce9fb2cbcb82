"""Bands lie around the lines of a bearing, and metrics tell the lines of a spectrum as they were made."""

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import gen
import raceway
from features.signal import order_spectrum
from features.signal.demodulation import amplitude_spectrum
from features.table.line_bands import fault_bands, fault_metrics

FS, RATE = 4000.0, 25.0
ORDERS = gen.bearing_orders("6205")
MADE = {"line": 0.5, "second": 0.2, "side": 0.1}


def envelope(records=1, noise=0.01):
    """Envelope with BPFI, its second harmonic and an upper shaft sideband, 10 s, shape (record, time)."""
    t = np.arange(round(10 * FS)) / FS
    bpfi = ORDERS.bpfi * RATE * 1.004
    lines = {bpfi: MADE["line"], 2 * bpfi: MADE["second"], bpfi + RATE: MADE["side"]}
    x = sum(level * np.cos(2 * np.pi * f * t) for f, level in lines.items())
    return x * np.arange(1, records + 1)[:, None] + noise * np.random.default_rng(2).standard_normal((records, len(t)))


def diagnose_with(orders):
    return raceway.diagnose(np.zeros(100), FS, orders=orders, model="unread.skops")


def test_bands_are_at_harmonics_and_at_sidebands_of_shaft_and_cage():
    bands = fault_bands(ORDERS, RATE, harmonics=2, sidebands=1, tolerance=0.01).set_index("line")
    assert bands.order["BPFO"] == ORDERS.bpfo
    assert bands.order["2 BPFI - shaft"] == pytest.approx(2 * ORDERS.bpfi - 1)
    assert bands.order["4 BSF + FTF"] == pytest.approx(4 * ORDERS.bsf + ORDERS.ftf)
    assert bands.groupby("fault").size().to_dict() == {"ball": 6, "cage": 2, "inner": 6, "outer": 6}
    np.testing.assert_allclose(bands.high / bands.frequency, 1.01)
    np.testing.assert_allclose(bands[["frequency", "low", "high"]], RATE * bands[["order", "order_low", "order_high"]])
    with pytest.raises(ValueError, match="give a positive rate"):
        fault_bands(ORDERS, 0.0)


@pytest.mark.parametrize(
    "orders", ["6205", ORDERS._asdict(), ORDERS[:3], (0.4, 3.6, 5.4, 0.0), (0.4, 3.6, np.nan, 2.4)]
)
@pytest.mark.parametrize(
    "call", [lambda orders: fault_bands(orders, RATE), lambda orders: diagnose_with({"mine": orders})]
)
def test_orders_that_are_not_four_numbers_are_refused_with_the_call_that_gives_them(call, orders):
    with pytest.raises(ValueError, match=r'four numbers above 0; gen.bearing_orders\("6205"\) gives them'):
        call(orders)


def test_metrics_tell_peak_place_power_and_level_of_lines_that_were_made():
    frequencies, spectrum = amplitude_spectrum(envelope(), FS)
    metrics = fault_metrics(frequencies, spectrum[0], fault_bands(ORDERS, RATE)).set_index("line")
    for line, level in (("BPFI", MADE["line"]), ("2 BPFI", MADE["second"]), ("BPFI + shaft", MADE["side"])):
        assert metrics.peak[line] == pytest.approx(level, rel=0.01)
        assert metrics.power[line] == pytest.approx(level**2 / 2, rel=0.01)
        assert metrics.level[line] > 30
    assert metrics.peak_at["BPFI"] == pytest.approx(1.004 * ORDERS.bpfi * RATE, abs=frequencies[1])
    assert metrics.level[["BPFO", "2 BSF", "2 BPFO"]].max() < 14


def test_metrics_of_several_records_are_a_dataset_with_those_of_each_and_orders_give_the_same():
    x, bands = envelope(3), fault_bands(ORDERS, RATE)
    frequencies, spectrum = amplitude_spectrum(x, FS)
    several = fault_metrics(frequencies, spectrum, bands)
    assert several.peak.dims == ("record", "band")
    alone = fault_metrics(frequencies, spectrum[2], bands)
    np.testing.assert_array_equal(several.level[2], alone.level)
    line = several.sel(band=several.line == "BPFI")
    np.testing.assert_allclose(line.peak[:, 0] / line.peak[0, 0], [1, 2, 3], rtol=0.01)
    orders, by_order = order_spectrum(x, int(FS / RATE))
    again = fault_metrics(orders, by_order[2], bands, unit="order")
    np.testing.assert_allclose(again.peak, alone.peak)
    np.testing.assert_allclose(again.peak_at * RATE, alone.peak_at)


@given(
    seconds=st.floats(0.5, 10),
    place=st.floats(-1, 1),
    amplitude=st.sampled_from([1e-3, 2.0, 50.0]),
    tolerance=st.sampled_from([0.001, 0.02]),
)
def test_the_power_of_a_line_is_half_its_squared_amplitude_whatever_the_length_of_the_record(
    seconds, place, amplitude, tolerance
):
    t = np.arange(round(seconds * FS)) / FS
    bands = fault_bands(ORDERS, RATE, tolerance=tolerance)
    frequency = ORDERS.bpfo * RATE * (1 + place * tolerance)
    frequencies, spectrum = amplitude_spectrum(amplitude * np.sin(2 * np.pi * frequency * t + 1)[None], FS)
    metrics = fault_metrics(frequencies, spectrum[0], bands).set_index("line")
    assert metrics.power["BPFO"] == pytest.approx(amplitude**2 / 2, rel=0.01)


def test_a_band_within_two_resolutions_of_zero_or_below_it_tells_nothing():
    frequencies, spectrum = amplitude_spectrum(envelope()[:, :2000], FS)
    metrics = fault_metrics(frequencies, spectrum[0], fault_bands(ORDERS, 8.0, sidebands=4)).set_index("line")
    assert metrics.power[["FTF", "BPFO - 4 shaft"]].isna().all()  # at 3.2 and -3.3 Hz, with a resolution of 2 Hz
    assert metrics.power["BPFO - 3 shaft"] > 0  # at 4.7 Hz


def test_a_band_beyond_the_spectrum_tells_nothing_and_one_narrower_than_a_bin_tells_that_bin():
    frequencies, spectrum = amplitude_spectrum(envelope()[:, :2000], FS)
    bands = fault_bands(ORDERS, 400.0, tolerance=1e-6)
    metrics = fault_metrics(frequencies, spectrum[0], bands)
    assert metrics.peak[bands.high > FS / 2].isna().all()
    near = np.abs(metrics.peak_at - bands.frequency)[bands.high < FS / 2]
    assert 0 < len(near) < len(bands)
    assert near.max() <= 0.5 * frequencies[1]
