"""The systems of the seed paper: Ophel et al., inner-race crack in a coupled shaft-bearing system.

The paper does not give most of its constants, so three parameter sets were found by differential evolution. ``paper`` is the first one.
``paper-hertz`` has the contact stiffness of the geometry, and a load close to the weight of the rotor. ``paper-refit`` has exactly that
stiffness and that weight, and no spring across the bearing: more statements
hold, and its load pulls shaft and housing in the direction of the figures. The unit of the paper's figures is read as millimetre
(errata.md, E15); displacements are in micrometres here.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.signal import get_window

from gen.physics.bearing import Bearing
from gen.physics.catalogue import CATALOGUE
from gen.physics.kernel.batch import input_shape, lay_out
from gen.physics.kernel.compiling import LANES
from gen.physics.kernel.decimate import decimation
from gen.physics.kernel.integrate import integrate
from gen.physics.kernel.layout import n_process_terms
from gen.physics.kernel_input import KernelInput, Spall, Turning
from gen.physics.rotor import Machine

FloatArray = NDArray[np.floating]

FS = 40_000  # Hz, and the step of the integration; 320 kHz changes no value by 0.4 %
SECONDS = 1.0
SHAFT_MASS = 5.5  # kg, the rotor
CHANNELS = ("x1", "y1", "x2", "y2")
CRACK = Spall("inner", 2 * math.radians(10) * 15.5e-3, 1e-3, math.radians(15), profile="rectangular")
FIGURES = {
    "figure3": ("Figure 3. Healthy: displacements", "healthy", False),
    "figure4": ("Figure 4. Cracked inner race: displacements", "cracked", False),
    "figure5": ("Figure 5. Healthy: power spectra", "healthy", True),
    "figure6": ("Figure 6. Cracked inner race: power spectra", "cracked", True),
}
"""Figures of the paper: title, state of the bearing, and whether spectra are shown."""


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
        housing_mass=11.048645198649645,
        ring_stiffness=56334.797439665985,
        ring_damping=382.79964568752894,
        support_stiffness_x=21986400.020285923,
        support_stiffness_y=35027652.04624106,
        support_damping_x=3223.9169780972675,
        support_damping_y=1869.8437448937823,
        load_deflection_factor=4915351358.039509,
        half_clearance=-7.706471349433184e-06,
        load_x=99.57492683939076,
        load_y=-25.331799862143072,
        unbalance=5.9048766239125884e-08,
        shaft_rate=44.65571094406354,
    ),
    "paper-hertz": Preset(
        housing_mass=11.940489787243106,
        ring_stiffness=1000.0,
        ring_damping=381.2243104923242,
        support_stiffness_x=11684188.140637236,
        support_stiffness_y=34731318.32009893,
        support_damping_x=1007.8663482557035,
        support_damping_y=5648.144625327418,
        load_deflection_factor=9291800000.0,
        half_clearance=-7.116667803620017e-06,
        load_x=50.53774378183503,
        load_y=-18.911920472496043,
        unbalance=1.5034348054805507e-07,
        shaft_rate=44.79141019175874,
    ),
    "paper-refit": Preset(
        housing_mass=12.585841598743272,
        ring_stiffness=0.0,
        ring_damping=107.4925391902823,
        support_stiffness_x=9048106.579079853,
        support_stiffness_y=41155054.257526346,
        support_damping_x=1835.8882906640108,
        support_damping_y=4904.5205139101445,
        load_deflection_factor=9293786104.82248,
        half_clearance=-8.208390098028653e-06,
        load_x=45.62703692480762,
        load_y=28.797838919999588,
        unbalance=3.8880376266939444e-08,
        shaft_rate=46.05216100212395,
    ),
}


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
    still, pickups = np.zeros(n_process_terms(bearing.n_balls)), np.eye(6)[:4]
    histories: dict[int, list[FloatArray]] = {0: [], 1: []}
    for cracked, spalls in enumerate(((), (CRACK,))):
        records = [
            KernelInput(
                bearing=bearing,
                machine=_machine(preset, bearing),
                turning=Turning(preset.shaft_rate, unbalance=preset.unbalance),
                spalls=spalls,
                frequencies=still,
                phases=still,
                pickups=pickups,
                displacement=True,
            )
            for preset in presets
        ]
        shape = input_shape(records[0])
        for first in range(0, len(records), LANES):
            some = records[first : first + LANES]
            lanes = lay_out(some, shape, 1 / fs)
            integrated = integrate(shape, lanes, 1 / fs, 1, decimation(1), 0, round(SECONDS * fs))
            response = integrated.response[:, :: fs // FS].transpose(2, 0, 1)[: len(some)]
            histories[cracked] += list(
                1e6 * np.ascontiguousarray(response, dtype=float)
            )  # sums over float32 would be off
    return [
        Run(healthy, cracked, preset.shaft_rate)
        for healthy, cracked, preset in zip(histories[0], histories[1], presets, strict=True)
    ]


def _machine(preset: Preset, bearing: Bearing) -> Machine:
    return Machine(
        load_deflection_factor=preset.load_deflection_factor,
        contact_damping=0.0,
        contact_cosine=1.0,
        half_clearance=preset.half_clearance,
        ball_radius=bearing.ball_diameter / 2,
        shaft_mass=SHAFT_MASS,
        housing_mass=preset.housing_mass,
        sensor_mass=0.0,
        ring_damping=preset.ring_damping,
        shaft_damping=0.0,
        shaft_stiffness=0.0,
        ring_stiffness_x=preset.ring_stiffness,
        ring_stiffness_y=preset.ring_stiffness,
        support_stiffness_x=preset.support_stiffness_x,
        support_stiffness_y=preset.support_stiffness_y,
        support_damping_x=preset.support_damping_x,
        support_damping_y=preset.support_damping_y,
        sensor_stiffness_x=0.0,
        sensor_stiffness_y=0.0,
        sensor_damping=0.0,
        load_x=preset.load_x,
        load_y=preset.load_y,
    )


def power_spectrum(x: FloatArray, window: str = "boxcar") -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and one-sided power spectrum of the mean-removed signal, shape (..., frequency) [um2]; equations 12 and 13."""
    taper = get_window(window, x.shape[-1])
    spectrum = np.abs(np.fft.rfft((x - x.mean(axis=-1, keepdims=True)) * taper)) ** 2 / taper.sum() ** 2
    return np.fft.rfftfreq(x.shape[-1], 1 / FS), 2 * spectrum
