"""Picture of two crossed sensors on one machine: the orbits of the harmonics of the shaft, and the coherence of the noise."""

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.signal import coherence

from features.report.pictures import BLUE, INK, STYLE, VERMILION, WIDTH
from gen.measurement.measure import measure
from gen.recipe import Recipe
from gen.scenarios import draw_scenarios, settings_of
from gen.simulation.shaft import scenario_angles
from gen.simulation.timeline import timeline

FloatArray = NDArray[np.floating]

COHERENCE, ORDERS = 0.3, (1, 2, 3)
CROSSED = {
    "name": "crossed_sensors",
    "title": "Two crossed sensors on one machine",
    "seed": 2,
    "corpus": {"rigs": 1, "specimens_per_rig": 1, "records_per_specimen": 1},
    "recording": {
        "sample_rate_hz": 12000,
        "duration_s": 8,
        "channels": [
            {"name": "horizontal", "body": "housing", "angle_deg": 0},
            {"name": "vertical", "body": "housing", "angle_deg": 90},
        ],
    },
    "bearing": {"kind": "catalogue", "designations": ["6205"]},
    "operation": {"shaft_rpm": 1797, "speed_wander_percent": 1},
    "faults": [{"kind": "healthy"}],
    "background": {"harmonics": {"probability": 1, "count": 3, "level_db": 0}, "coherence": COHERENCE},
    "level": {"kind": "physical", "background_m_s2": 1},
}


def draw_orbits() -> Figure:
    """Mean path of the acceleration at each harmonic in one turn of the shaft, and the coherence of the two channels."""
    recipe = Recipe.model_validate(CROSSED)
    scenarios, axis = draw_scenarios(recipe), timeline(settings_of(recipe))
    silence = np.zeros((1, 2, axis.returned), np.float32)
    measured = measure(silence, scenarios)
    signal = measured.signal[0].astype(float) / (measured.counts_per_unit or 1.0)
    angles = scenario_angles(scenarios[0], axis)[axis.kept]
    with rc_context(STYLE):
        figure = Figure((WIDTH, 0.42 * WIDTH), layout="constrained")
        left, right = figure.subplots(1, 2, width_ratios=(1, 1.5))
        _draw_paths(left, signal, angles)
        frequency, degree = coherence(signal[0], signal[1], axis.fs, nperseg=1024)
        right.plot(frequency, degree, color=INK, linewidth=0.7)
        right.axhline(COHERENCE, color=VERMILION, linewidth=1, label=f"noise as drawn, {COHERENCE}")
        right.set(xlabel="frequency [Hz]", ylabel="coherence of both channels", ylim=(0, 1.02), xlim=(0, axis.fs / 2))
        right.legend(frameon=False)
    return figure


def _draw_paths(axes: Axes, signal: FloatArray, angles: FloatArray) -> None:
    turn = np.linspace(0, 2 * np.pi, 200)
    for order, color in zip(ORDERS, (BLUE, VERMILION, INK), strict=True):
        x, y = 2 * np.mean(signal * np.exp(-1j * order * angles), axis=1)
        path = [(amplitude * np.exp(1j * order * turn)).real for amplitude in (x, y)]
        axes.plot(*path, color=color, label=f"{order}x")
        axes.plot(path[0][0], path[1][0], "o", color=color, markersize=4)
    axes.set(xlabel="horizontal [m/s²]", ylabel="vertical [m/s²]", aspect="equal")
    axes.legend(frameon=False, title="dot: shaft at angle 0", loc="lower center", bbox_to_anchor=(0.5, 1), ncols=3)
