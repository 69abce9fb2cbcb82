"""Effect of each mechanism on the marks in which simulated and real faults differ.

``python -m benchmarks.mechanisms`` prints a table of medians over the seeds, for the reference machine of :mod:`benchmarks.visibility` with
one change at a time. Marks: rms, kurtosis and skewness of the record; its power from 3.5 to 5 kHz, relative to the whole; lines of the
squared envelope one shaft rate beside BPFO, relative to BPFO; lines beside BPFI, relative to BPFI; share of the power of the envelope,
without its mean, below 0.8 orders.
"""

import argparse
from typing import Any

import numpy as np
from scipy.stats import kurtosis, skew

from benchmarks.visibility import (
    FS,
    LINES,
    SECONDS,
    TURNING,
    FloatArray,
    recorded,
    reference_recipe,
    squared_envelope_spectrum,
)

Changes = dict[str, Any]

BALL = {"kind": "ball", "width_mm": 0.533, "angle_deg": TURNING}
INNER = {"kind": "inner", "width_mm": 0.533, "angle_deg": TURNING}
OUTER = {"kind": "outer", "width_mm": 0.533}
OIL: Changes = {"contact": {"footprint": "hertz", "lubricant": {}}, "operation": {"temperature_celsius": 50}}

CASES: dict[str, tuple[dict[str, Any], Changes]] = {
    "ball, point contact": (BALL, {}),
    "ball, footprint": (BALL, {"contact": {"footprint": "hertz"}}),
    "ball, footprint and oil": (BALL, OIL),
    "ball, axis wanders 0.1 rad": (BALL | {"axis_wander_deg": 5.7}, {}),
    "ball, rare hits": (BALL | {"axis_wander_deg": 11.5, "axis_offset_deg": 8}, {}),
    "ball, axis jumps": (BALL | {"axis_jumps": {"probability_percent": 30, "spread_deg": 15}}, {}),
    "ball 0.18 mm, point contact": (BALL | {"width_mm": 0.178}, {}),
    "ball 0.18 mm, footprint": (BALL | {"width_mm": 0.178}, {"contact": {"footprint": "hertz"}}),
    "outer, balanced": (OUTER, {"machine": {"balance_mm_s": 0}}),
    "outer, G6.3": (OUTER, {"machine": {"balance_mm_s": 6.3}}),
    "outer, bent shaft of 100 N": (OUTER, {"machine": {"bow_n": 100}}),
    "inner, clearance 10 um": (INNER, {}),
    "inner, preload 6 um": (INNER, {"specimen": {"diametral_clearance_um": -6}}),
    "inner, 10 deg and 300 N along the axis": (
        INNER,
        {"specimen": {"contact_angle_deg": 10}, "operation": {"axial_load_n": 300}},
    ),
    "inner, 15 deg and 600 N along the axis": (
        INNER,
        {"specimen": {"contact_angle_deg": 15}, "operation": {"axial_load_n": 600}},
    ),
    "inner, inner ring 15 K hotter": (INNER, {"operation": {"inner_ring_hotter_k": 15}}),
    "outer, steady load": (OUTER, {"operation": {"slip_percent": 0, "jitter_deg": 0}}),
    "outer, load wanders 10 %": (OUTER, {"operation": {"slip_percent": 0, "jitter_deg": 0, "load_wander_percent": 10}}),
    "outer, jagged edge of 40 %": (OUTER | {"jagged_edge": {"scatter_percent": 40}}, {}),
    "outer, mass of the balls": (OUTER, {"contact": {"ball_mass": "steel"}}),
    "outer, shaft and housing of 1 kg": (OUTER, {"machine": {"shaft_mass_kg": 1, "housing_mass_kg": 1}}),
    "inner, shaft and housing of 1 kg": (INNER, {"machine": {"shaft_mass_kg": 1, "housing_mass_kg": 1}}),
    "outer, slip 2 %, jitter 1 deg": (OUTER, {"operation": {"slip_percent": 2, "jitter_deg": 1}}),
}


def marks(fault: dict[str, Any], changes: Changes, n_seeds: int) -> dict[str, float]:
    """Marks of one case, medians over the seeds."""
    signals, rate = recorded(reference_recipe(fault, n_seeds, **changes))
    spectrum = squared_envelope_spectrum(signals)
    slow = np.arange(spectrum.shape[1]) / SECONDS < 0.8 * rate
    return {
        "rms [m/s2]": float(np.median(np.std(signals, axis=1))),
        "kurtosis": float(np.median(kurtosis(signals, axis=1, fisher=False))),
        "skewness": float(np.median(skew(signals, axis=1))),
        "3.5-5 kHz [dB]": float(np.median(_share(signals, 3500, 5000))),
        "BPFO +/- fr [dB]": _beside(spectrum, LINES["BPFO"] * rate, rate),
        "BPFI +/- fr [dB]": _beside(spectrum, LINES["BPFI"] * rate, rate),
        "share below 0.8 fr [%]": 100
        * float(np.median((spectrum[:, slow] ** 2).sum(axis=1) / (spectrum**2).sum(axis=1))),
    }


def _share(signals: FloatArray, low: float, high: float) -> FloatArray:
    """Power between two frequencies relative to the whole, shape (seed,) [dB]."""
    power = np.abs(np.fft.rfft(signals * np.hanning(signals.shape[1]))) ** 2
    frequency = np.fft.rfftfreq(signals.shape[1], 1 / FS)
    return 10 * np.log10(power[:, (frequency >= low) & (frequency < high)].sum(axis=1) / power.sum(axis=1))


def _beside(spectrum: FloatArray, line: float, rate: float) -> float:
    """Mean of the two lines one shaft rate beside a line, relative to that line [dB]."""
    peaks = [_peak(spectrum, line + side * rate) for side in (-1, 0, 1)]
    return float(np.median(20 * np.log10((peaks[0] + peaks[2]) / (2 * peaks[1]))))


def _peak(spectrum: FloatArray, line: float) -> FloatArray:
    place, reach = round(line * SECONDS), round(0.01 * line * SECONDS)
    return spectrum[:, place - reach : place + reach + 1].max(axis=1)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=32)
    options = parser.parse_args()
    header: list[str] = []
    for name, (fault, changes) in CASES.items():
        found = marks(fault, changes, options.seeds)
        if not header:
            header = list(found)
            print("| case |", " | ".join(header), "|\n|---|" + "---:|" * len(header))
        print(f"| {name} |", " | ".join(f"{value:.3g}" for value in found.values()), "|", flush=True)


if __name__ == "__main__":
    main()
