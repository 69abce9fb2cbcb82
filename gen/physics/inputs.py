"""The nouns that the kernel takes: one bearing on one machine in one record.

A :class:`KernelInput` is a :class:`~gen.physics.rotor.Machine` with its :class:`Turning`, its spalls, its waviness and its schedule, all in
SI units.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.physics.bearing import Bearing
from gen.physics.rotor import Machine

FloatArray = NDArray[np.float64]


class SpallInput(NamedTuple):
    """One spall."""

    site: str
    """``inner``, ``outer`` or ``ball``."""
    width: float
    """Along the rolling direction [m]."""
    depth: float
    """[m]."""
    angle: float
    """On a race from the x axis, on a ball from its first contact [rad]."""
    ball: int = 0
    """Number of the ball that carries it, if ``site`` is ``ball``."""
    profile: str = "geometric"
    table: tuple[tuple[float, ...], ...] = ()
    """Drops from edge to edge, evenly spaced [m], if ``profile`` is ``table``: on the race, or for a ball on either race."""


class Turning(NamedTuple):
    """How shaft, cage and balls of one record turn, and the forces that turn with them."""

    shaft_rate: float
    """[Hz]."""
    speed_rms: float = 0.0
    """Rms of the relative wander of the speed [1]."""
    mean_slip: float = 0.0
    """Of the cage, as a share of its rolling speed [1]."""
    slip_rms: float = 0.0
    spin_rms: float = 0.0
    """Rms of the relative wander of the ball spin [1]."""
    jitter_rms: float = 0.0
    """Rms of the angle of a ball from its place in the cage [rad]."""
    axis_offset: float = 0.0
    """Mean tilt of the spin axis, its rms, and the tilt beyond which a ball spall misses the track [rad]."""
    axis_rms: float = 0.0
    axis_limit: float = 0.0
    unbalance: float = 0.0
    """Mass times eccentricity [kg m]."""
    shaft_angle: float = 0.0
    """Angles at the start [rad]."""
    cage_angle: float = 0.0
    spin_angle: float = 0.0
    bow: float = 0.0
    """Force of a bent shaft in its bearings: it turns with the shaft and does not depend on the speed [N]."""
    twice_x: float = 0.0
    twice_y: float = 0.0
    """Force of misalignment along a fixed direction at twice the shaft rate [N]."""
    knock: float = 0.0
    knock_angle: float = 0.0
    """Knock of the cage on the housing [N], once per turn of the cage, when its first pocket is at this angle [rad]."""
    knock_seed: int = 0
    """Whole number that determines the scatter of the knocks."""
    late_ball: int = -1
    """Number of the ball that is out of its place in the cage, -1 for none."""
    late_by: float = 0.0
    """Angle by which it is [rad]."""


class Waviness(NamedTuple):
    """Fourier amplitudes of a wavy bearing, phases included; empty arrays where a surface is round."""

    races: NDArray[np.complex128]
    """Orders LOWEST_ORDER to HIGHEST_ORDER of the inner and the outer race, shape (race, order) or (2, 0) [m]."""
    balls: NDArray[np.complex128]
    """Even orders from 2 on of every ball, both contacts together, shape (order, ball) or (0, 0) [m]."""


ROUND = Waviness(np.empty((2, 0), complex), np.empty((0, 0), complex))
CONSTANT = np.empty((0, 2))
"""Schedule of a record whose speed and load do not change."""


class KernelInput(NamedTuple):
    """Everything the kernel needs of one record."""

    bearing: Bearing
    machine: Machine
    turning: Turning
    spalls: tuple[SpallInput, ...]
    frequencies: FloatArray
    """Frequencies of the cosine terms of all processes, shape (term,) [Hz]; see :func:`gen.physics.kernel.layout.n_process_terms`."""
    phases: FloatArray
    """Their phases, shape (term,) [rad]."""
    pickups: FloatArray
    """Weights of the six accelerations in each channel, shape (channel, coordinate) [1]."""
    waviness: Waviness = ROUND
    schedule: FloatArray = CONSTANT
    """Factors of shaft rate (over the knot) and load (at its start), shape (knot, 2); (0, 2) if both are constant."""
    displacement: bool = False
    """Whether the channels give displacements [m] instead of accelerations [m s-2]."""


def is_wavy(waviness: Waviness) -> bool:
    """Whether a race or a ball is wavy."""
    return waviness.races.size > 0 or waviness.balls.size > 0


def spall_span(bearing: Bearing, spall: SpallInput) -> tuple[float, float]:
    """Half the angle that a spall spans [rad], and the radius on which it is measured [m]."""
    radius = bearing.radius(spall.site)
    return 0.5 * spall.width / radius, radius


def farthest_jitter(turning: Turning, n_terms: int) -> float:
    """Largest angle of a ball from its place in the cage: all ``n_terms`` cosines of its jitter at their peaks [rad]."""
    return turning.jitter_rms * math.sqrt(2 * n_terms) + abs(turning.late_by)
