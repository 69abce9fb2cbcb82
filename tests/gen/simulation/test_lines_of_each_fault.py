"""Every fault has its own lines in the envelope spectrum, at the orders of the kinematics, and a healthy bearing has none.

A line is clear 15 dB above the median of its surroundings and absent below 12 dB: thresholds of the model study, fixed before its first
run. Rates are constant here, so that the width of a line is one over the duration; jitter of a billionth of a degree selects the kernel
of the small recipe.
"""

import numpy as np
import pytest

from features.signal.demodulation import analytic_band, envelope_spectrum
from features.signal.spectra import fourier_coefficients
from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import simulate
from tests.measuring import measure
from tests.responses import accelerations_of

FS = 12_000
CLEAR_DB, ABSENT_DB = 15.0, 12.0
BAND_HZ = 2000, 4000  # around the resonances of the sensor
SURROUNDINGS_HZ = 25.0
STEADY = {
    "recording.converter": {"kind": "float32"},
    "recording.duration_s": 1.0,
    "recording.settle_s": 0.2,
    "corpus.records_per_specimen": 1,
    "specimen.diametral_clearance_um": 10,
    "specimen.waviness_nm": 10,
    "operation.load_n": "loguniform(200, 600)",
    "operation.mean_slip_percent": 0,
    "operation.slip_percent": 0,
    "operation.speed_wander_percent": 0,
    "operation.jitter_deg": 1e-9,
    "operation.spin_wander_percent": 0,
    "faults": [
        {"kind": "healthy"},
        {"kind": "inner", "width_mm": 0.5, "angle_deg": "uniform(0, 360)"},
        {"kind": "outer", "width_mm": 0.5},
        {"kind": "ball", "width_mm": 0.5, "angle_deg": "uniform(0, 360)"},
    ],
    "path": {"direct": 1.0},
    "background": {"slope": 0.5},
}
ORDERS = orders(CATALOGUE["6205"])
LINES = {"inner": ORDERS.bpfi, "outer": ORDERS.bpfo, "ball": 2 * ORDERS.bsf}


class Envelope:
    """Envelope spectrum of one record."""

    def __init__(self, signal, rate):
        coefficients = fourier_coefficients(signal[None].astype(float), FS, FS / 2)
        self.duration, self.rate = len(signal) / FS, rate
        low, high = (round(edge * self.duration) for edge in BAND_HZ)
        band = analytic_band(coefficients, low, high)
        self.frequencies, spectra = envelope_spectrum(band, band.shape[1] / self.duration)
        self.spectrum = spectra[0]

    def near(self, order, reach):
        """Bins within ``reach`` [Hz] of an order."""
        return np.abs(self.frequencies - order * self.rate) <= reach

    def line_db(self, order):
        """Height of a line over its surroundings, looked for within one bin of an order."""
        peak = self.spectrum[self.near(order, 1 / self.duration)].max()
        return 20 * np.log10(peak / np.median(self.spectrum[self.near(order, SURROUNDINGS_HZ)]))

    def strongest(self, order, reach=0.05):
        """Order of the strongest line within a share ``reach`` of an order."""
        window = self.near(order, reach * order * self.rate)
        return self.frequencies[window][np.argmax(self.spectrum[window])] / self.rate


def envelopes(recipe):
    """Fault and envelope spectrum of every record of a recipe."""
    scenarios = draw_scenarios(recipe)
    signals = measure(accelerations_of(simulate(scenarios)), scenarios).signal[:, 0]
    return [
        (scenario.fault, Envelope(signal, scenario.conditions["shaft_rate"]))
        for scenario, signal in zip(scenarios, signals, strict=True)
    ]


@pytest.fixture(scope="module")
def drawn(recipe_with):
    """Of eight machines; 32 of each row in ``tests/thorough/test_visibility_literature.py``."""
    return envelopes(recipe_with(STEADY | {"seed": 1, "corpus.rigs": 8}))


def of(drawn, fault):
    chosen = [envelope for kind, envelope in drawn if kind == fault]
    assert len(chosen) == 8
    return chosen


@pytest.mark.parametrize("fault", LINES)
def test_a_spall_shows_its_line_and_two_harmonics_within_one_bin_of_theory(drawn, fault):
    for envelope in of(drawn, fault):
        for harmonic in (1, 2, 3):
            assert envelope.line_db(harmonic * LINES[fault]) > CLEAR_DB
        bin_of_orders = 1 / envelope.duration / envelope.rate
        assert abs(envelope.strongest(LINES[fault]) - LINES[fault]) <= bin_of_orders


def test_a_sound_bearing_shows_no_line_of_any_fault(drawn):
    heights = np.array([envelope.line_db(order) for envelope in of(drawn, "healthy") for order in LINES.values()])
    assert heights.max() < CLEAR_DB
    assert np.mean(heights < ABSENT_DB) > 0.9


def test_an_inner_spall_goes_through_the_load_zone_once_a_turn(drawn):
    for envelope in of(drawn, "inner"):
        assert envelope.line_db(1.0) > CLEAR_DB
        assert envelope.line_db(ORDERS.bpfi - 1) > CLEAR_DB
        assert envelope.line_db(ORDERS.bpfi + 1) > CLEAR_DB


def test_a_ball_spall_goes_through_the_load_zone_once_a_turn_of_the_cage(drawn):
    for envelope in of(drawn, "ball"):
        assert envelope.line_db(ORDERS.ftf) > CLEAR_DB
        assert envelope.line_db(2 * ORDERS.bsf - ORDERS.ftf) > CLEAR_DB
        assert envelope.line_db(2 * ORDERS.bsf + ORDERS.ftf) > CLEAR_DB


def test_one_percent_of_slip_moves_the_lines_of_the_races_as_the_cage_lags(recipe_with):
    slipping = {"operation.mean_slip_percent": 1, "recording.duration_s": 4.0, "corpus.rigs": 1}
    races = [{"kind": "inner", "width_mm": 0.5}, {"kind": "outer", "width_mm": 0.5}]
    moved = dict(envelopes(recipe_with(STEADY | slipping | {"faults": races})))
    assert moved["outer"].strongest(ORDERS.bpfo) / ORDERS.bpfo == pytest.approx(0.990, rel=2e-3)
    assert moved["inner"].strongest(ORDERS.bpfi) / ORDERS.bpfi == pytest.approx(1.0065, rel=2e-3)
