"""The systems of the seed paper: Ophel et al., inner-race crack in a coupled shaft-bearing system.

The paper does not give most of its constants, so three parameter sets were found by search. ``paper`` is the first one.
``paper-hertz`` has the contact stiffness of the geometry, and a load close to the weight of the rotor. ``paper-refit`` has exactly that
stiffness and that weight, and no spring across the bearing (``python -m benchmarks.paper_search --hertz --seed 1``): more statements
hold, and its load pulls shaft and housing in the direction of the figures. The unit of the paper's figures is read as millimetre
(docs/errata.md, E15); displacements are in micrometres here.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.signal import get_window

from gen.physics.bearing import Bearing
from gen.physics.catalogue import CATALOGUE
from gen.physics.kernel.batch import Motion, Record, Spall, lay_out, n_terms, record_shape
from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.decimate import decimation
from gen.physics.kernel.integrate import integrate
from gen.physics.rotor import Machine

FloatArray = NDArray[np.floating]

FS = 40_000  # Hz, and the step of the integration; 320 kHz changes no value by 0.4 %
SECONDS = 1.0
CHANNELS = ("x1", "y1", "x2", "y2")
CRACK = Spall("inner", 2 * math.radians(10) * 15.5e-3, 1e-3, math.radians(15), profile="rectangular")
FIGURES = (
    ("figure3", "Healthy: displacements", "healthy", False),
    ("figure4", "Healthy: power spectra", "healthy", True),
    ("figure5", "Cracked inner race: displacements", "cracked", False),
    ("figure6", "Cracked inner race: power spectra", "cracked", True),
)
_TITLES = ("shaft, x1", "shaft, y1", "housing, x2", "housing, y2")


class Preset(NamedTuple):
    """Constants that the paper does not give, in SI units; it gives the bearing, the rotor of 5.5 kg and the crack."""

    housing_mass: float
    ring_stiffness: float
    ring_damping: float
    support_stiffness_x: float
    support_stiffness_y: float
    support_damping_x: float
    support_damping_y: float
    load_deflection_factor: float
    half_clearance: float
    load_x: float
    load_y: float
    unbalance: float
    shaft_rate: float


PRESETS = {
    "paper": Preset(
        11.048645198649645, 56334.797439665985, 382.79964568752894, 21986400.020285923, 35027652.04624106, 3223.9169780972675,
        1869.8437448937823, 4915351358.039509, -7.706471349433184e-06, 99.57492683939076, -25.331799862143072, 5.9048766239125884e-08,
        44.65571094406354,
    ),
    "paper-hertz": Preset(
        11.940489787243106, 1000.0, 381.2243104923242, 11684188.140637236, 34731318.32009893, 1007.8663482557035, 5648.144625327418,
        9291800000.0, -7.116667803620017e-06, 50.53774378183503, -18.911920472496043, 1.5034348054805507e-07, 44.79141019175874,
    ),
    "paper-refit": Preset(
        12.585841598743272, 0.0, 107.4925391902823, 9048106.579079853, 41155054.257526346, 1835.8882906640108, 4904.5205139101445,
        9293786104.82248, -8.208390098028653e-06, 45.62703692480762, 28.797838919999588, 3.8880376266939444e-08, 46.05216100212395,
    ),
}  # fmt: skip


class Run(NamedTuple):
    """Displacements of shaft and housing, healthy and cracked, from rest at zero; shape (channel, time) [um]."""

    healthy: FloatArray
    cracked: FloatArray
    shaft_rate: float


def run(preset: Preset, fs: int = FS) -> Run:
    """Run the healthy and the cracked system of a preset for ``SECONDS``."""
    return run_many([preset], fs)[0]


def run_many(presets: list[Preset], fs: int = FS) -> list[Run]:
    """Run several presets at once."""
    bearing = CATALOGUE["6205-paper"]
    still, pickups = np.zeros(n_terms(bearing.n_balls)), np.eye(6)[:4]
    found: dict[int, list[FloatArray]] = {0: [], 1: []}
    for cracked, spalls in enumerate(((), (CRACK,))):
        records = [
            Record(
                bearing, _machine(preset, bearing), Motion(preset.shaft_rate, unbalance=preset.unbalance), spalls, still, still,
                pickups, np.empty(0), displacement=True,
            )
            for preset in presets
        ]  # fmt: skip
        shape = record_shape(records[0])
        for first in range(0, len(records), LANES):
            some = records[first : first + LANES]
            lanes = lay_out(some, shape, 1 / fs, at_rest=False)
            made = integrate(shape, lanes, 1 / fs, 1, decimation(1), 0, round(SECONDS * fs))
            found[cracked] += list(made.response[:: fs // FS].transpose(2, 1, 0)[: len(some)] * 1e6)
    return [
        Run(healthy, cracked, preset.shaft_rate)
        for healthy, cracked, preset in zip(found[0], found[1], presets, strict=True)
    ]


def _machine(preset: Preset, bearing: Bearing) -> Machine:
    return Machine(
        preset.load_deflection_factor, 0.0, 1.0, preset.half_clearance, bearing.ball_diameter / 2, 5.5, preset.housing_mass, 0.0,
        preset.ring_damping, 0.0, 0.0, preset.ring_stiffness, preset.ring_stiffness, preset.support_stiffness_x,
        preset.support_stiffness_y, preset.support_damping_x, preset.support_damping_y, 0.0, 0.0, 0.0, preset.load_x, preset.load_y,
    )  # fmt: skip


def power_spectrum(x: FloatArray, window: str = "boxcar") -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and one-sided power spectrum of the mean-removed signal, shape (..., frequency) [um2]; equations 12 and 13."""
    taper = get_window(window, x.shape[-1])
    spectrum = np.abs(np.fft.rfft((x - x.mean(axis=-1, keepdims=True)) * taper)) ** 2 / taper.sum() ** 2
    return np.fft.rfftfreq(x.shape[-1], 1 / FS), 2 * spectrum


def draw_figure(made: Run, state: str, spectral: bool, title: str) -> Any:
    """One figure of the paper: four channels, over time or over frequency."""
    from matplotlib.figure import Figure

    signal = getattr(made, state)
    figure = Figure(figsize=(9, 6), layout="constrained")
    figure.suptitle(title)
    for axes, name, x in zip(figure.subplots(2, 2).flat, _TITLES, signal, strict=True):
        if spectral:
            frequency, power = power_spectrum(x)
            axes.semilogy(frequency[1:1001], power[1:1001], color="black", linewidth=0.7)
            axes.set(xlabel="frequency [Hz]", ylabel="power [µm²]")
        else:
            shown = slice(None, round((0.3 if state == "healthy" else 1.0) * FS))
            axes.plot(np.arange(len(x))[shown] / FS, x[shown], color="black", linewidth=0.7)
            axes.set(xlabel="time [s]", ylabel="displacement [µm]")
        axes.set_title(name, loc="left", fontsize=10)
        axes.spines[["top", "right"]].set_visible(False)
    return figure
