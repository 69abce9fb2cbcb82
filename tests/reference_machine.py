"""Reference machine of the literature tests: a 6205 at 1797 rpm and 300 N with a sensor resonance of 3 kHz."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, hilbert, sosfiltfilt

from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE
from gen.recipe import Recipe
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import simulate
from tests.measuring import measure
from tests.responses import accelerations_of

FS, SECONDS, RESONANCE = 12_000, 4.0, 3000.0
TURNING = "uniform(0, 360)"

_ORDERS = orders(CATALOGUE["6205"])
LINES = {
    "fr": 1.0,
    "FTF": _ORDERS.ftf,
    "BPFO": _ORDERS.bpfo,
    "BPFI": _ORDERS.bpfi,
    "BPFI-fr": _ORDERS.bpfi - 1,
    "BPFI+fr": _ORDERS.bpfi + 1,
    "2BSF": 2 * _ORDERS.bsf,
    "2BSF-FTF": 2 * _ORDERS.bsf - _ORDERS.ftf,
}
FloatArray = NDArray[np.float64]


def reference_recipe(fault: dict[str, Any], n_seeds: int, **changes: Any) -> Recipe:
    """Recipe of ``n_seeds`` specimens with one fault, some of its sections changed."""
    recipe = {
        "name": "visibility", "title": "Visibility", "seed": 1,
        "corpus": {"rigs": 1, "specimens_per_rig": n_seeds, "records_per_specimen": 1, "split": {"test": 0}},
        "recording": {"sample_rate_hz": FS, "duration_s": SECONDS, "settle_s": 0.3, "converter": {"kind": "float32"}},
        "bearing": {"kind": "catalogue", "designations": ["6205"]},
        "specimen": {"diametral_clearance_um": 10, "waviness_nm": 20, "ball_waviness_nm": 2},
        "operation": {"shaft_rpm": 1797, "load_n": 300},
        "faults": [fault],
        "level": {"kind": "physical", "background_m_s2": 0.3},
    }  # fmt: skip
    for section, values in changes.items():
        recipe[section] = {**recipe.get(section, {}), **values}
    return Recipe.model_validate(recipe)


def recorded(recipe: Recipe) -> tuple[FloatArray, float]:
    """Records of a recipe, shape (seed, time) [m s-2], and their shaft rate [Hz]."""
    scenarios = draw_scenarios(recipe)
    signals = measure(accelerations_of(simulate(scenarios)), scenarios).signal[:, 0]
    return signals.astype(float), scenarios[0].conditions["shaft_rate"]


def envelope_power(signals: FloatArray) -> FloatArray:
    """Squared envelope around the sensor resonance, shape of the signals."""
    band = butter(4, [RESONANCE - 1000, RESONANCE + 1000], "bandpass", fs=FS, output="sos")
    return np.abs(hilbert(sosfiltfilt(band, signals))) ** 2


def squared_envelope_spectrum(signals: FloatArray) -> FloatArray:
    """Amplitudes of the lines of the squared envelope, shape (seed, frequency)."""
    power = envelope_power(signals)
    return np.abs(np.fft.rfft((power - power.mean(axis=1, keepdims=True)) * np.hanning(power.shape[1])))


def visibilities(fault: dict[str, Any], n_seeds: int) -> dict[str, FloatArray]:
    """Height of each line over its surroundings, shape (seed,) [dB]."""
    signals, rate = recorded(reference_recipe(fault, n_seeds))
    spectrum = squared_envelope_spectrum(signals)
    return {name: line_height(spectrum, order * rate) for name, order in LINES.items()}


def line_height(spectrum: FloatArray, line: float) -> FloatArray:
    """Largest value near a line over the median within 25 Hz of it, shape (seed,) [dB]."""
    frequency = np.arange(spectrum.shape[1]) / SECONDS
    near = np.abs(frequency - line) <= max(1.0, 0.015 * line)
    around = np.abs(frequency - line) <= 25
    return 20 * np.log10(spectrum[:, near].max(axis=1) / np.median(spectrum[:, around], axis=1))
