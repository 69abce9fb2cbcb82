"""Height of fault lines in the squared envelope spectra of a reference machine, over many seeds of every fault.

``python -m benchmarks.visibility`` prints a table: the median over the seeds of the height of each line over its surroundings [dB], and
the lowest, or the highest where no line is expected. The machine is a 6205 at 1797 rpm and 300 N with a sensor resonance of 3 kHz.
"""

import argparse
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, hilbert, sosfiltfilt

from gen.measurement.measure import measure
from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE
from gen.recipe import Recipe
from gen.scenarios import draw_scenarios
from gen.simulation.simulate import simulate

FS, SECONDS, RESONANCE = 12_000, 4.0, 3000.0
TURNING = "uniform(0, 360)"
DEEP = 280

ROWS = {
    "healthy": {"kind": "healthy"},
    "inner 0.18": {"kind": "inner", "width_mm": 0.178, "angle_deg": TURNING},
    "inner 0.36": {"kind": "inner", "width_mm": 0.356, "angle_deg": TURNING},
    "inner 0.53": {"kind": "inner", "width_mm": 0.533, "angle_deg": TURNING},
    "outer 0.18": {"kind": "outer", "width_mm": 0.178},
    "outer 0.36": {"kind": "outer", "width_mm": 0.356},
    "outer 0.53": {"kind": "outer", "width_mm": 0.533},
    "outer 0.53 at 3 o'clock": {"kind": "outer", "width_mm": 0.533, "angle_deg": 90},
    "outer 0.53 at 12 o'clock": {"kind": "outer", "width_mm": 0.533, "angle_deg": 180},
    "ball 0.18": {"kind": "ball", "width_mm": 0.178, "angle_deg": TURNING},
    "ball 0.36": {"kind": "ball", "width_mm": 0.356, "angle_deg": TURNING},
    "ball 0.53": {"kind": "ball", "width_mm": 0.533, "angle_deg": TURNING},
    "ball 0.53, wander 0.1 rad": {"kind": "ball", "width_mm": 0.533, "angle_deg": TURNING, "axis_wander_deg": 5.73},
    "inner + outer 0.53": {
        "kind": "compound",
        "parts": [{"kind": "inner", "width_mm": 0.533, "angle_deg": TURNING}, {"kind": "outer", "width_mm": 0.533}],
    },
    "outer 6 mm, 15 um deep": {"kind": "outer", "width_mm": 6, "depth_um": 15},
    "cage, pitch error 4 deg": {"kind": "cage", "pitch_error_deg": 4, "knock_n": 0},
    "cage, with a knock of 30 N": {"kind": "cage", "pitch_error_deg": 4, "knock_n": 30},
}  # fmt: skip

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
STATED = {
    "inner": ("fr", "BPFI", "BPFI-fr", "BPFI+fr"),
    "outer": ("BPFO",),
    "ball": ("FTF", "2BSF", "2BSF-FTF"),
    "ball 0.53, wander 0.1 rad": ("2BSF", "2BSF-FTF"),
    "inner + outer 0.53": ("BPFO", "BPFI", "BPFI-fr", "BPFI+fr"),
    "cage, with a knock of 30 N": ("FTF",),
}
UNSEEN = ("healthy", "outer 0.53 at 3 o'clock", "outer 0.53 at 12 o'clock", "cage, pitch error 4 deg")


FloatArray = NDArray[np.float64]


def reference_recipe(fault: dict[str, Any], n_seeds: int, **changes: Any) -> Recipe:
    """Recipe of ``n_seeds`` specimens with one fault, some of its sections changed."""
    recipe = {
        "name": "visibility", "title": "Visibility", "seed": 9,
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
    signals = measure(simulate(scenarios).acceleration, scenarios).signal[:, 0]
    return signals.astype(float), scenarios[0].record.conditions.shaft_rate


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


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=32)
    options = parser.parse_args()
    print("| fault |", " | ".join(LINES), "|")
    print("|---|" + "---:|" * len(LINES))
    for name, fault in ROWS.items():
        found = visibilities(fault, options.seeds).values()
        extreme = np.max if name in UNSEEN else np.min
        print(f"| {name} |", " | ".join(f"{np.median(x):.0f} ({extreme(x):.0f})" for x in found), "|", flush=True)


if __name__ == "__main__":
    main()
