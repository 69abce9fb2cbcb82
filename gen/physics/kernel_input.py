"""Input of the kernel for one record, in SI units.

A :class:`KernelInput` holds a :class:`~gen.physics.rotor.Machine`, a :class:`Turning`, spalls, waviness and a schedule of speed and load.
"""

import math
from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.physics.bearing import Bearing
from gen.physics.rotor import Machine, as_columns, ball_angles, rest

FloatArray = NDArray[np.float64]


class Spall(NamedTuple):
    """One spall."""

    site: str
    """``inner``, ``outer`` or ``ball``."""
    width: float
    """Along the rolling direction [m]."""
    depth: float
    """[m]."""
    angle: float
    """Angle on a race from the x axis, on a ball from its first contact [rad]."""
    ball: int = 0
    """Number of the damaged ball, if ``site`` is ``ball``."""
    profile: str = "geometric"
    table: tuple[tuple[float, ...], ...] = ()
    """Drops from edge to edge, evenly spaced [m], if ``profile`` is ``table``: one row for a race spall, one per race for a ball spall."""
    scatter: float = 0.0
    """Standard deviation of the logarithm of the drop from passage to passage [1]."""
    seed: int = 0
    """Seed of that scatter."""
    roughness: float = 0.0
    """Rms roughness of the floor, which a ``table`` holds [m]."""
    trace: tuple[float, ...] = ()
    """Depths of a measured surface from edge to edge, evenly spaced, which a ``table`` holds [m]; for the profile ``trace``."""


class Turning(NamedTuple):
    """Rotation of shaft, cage and balls in one record, and the forces that depend on it."""

    shaft_rate: float
    """[Hz]."""
    speed_rms: float = 0.0
    """Rms of the relative random variation of the speed [1]."""
    mean_slip: float = 0.0
    """Mean slip of the cage, as a share of its speed in pure rolling [1]."""
    slip_rms: float = 0.0
    """Rms of the variation of the slip [1]."""
    spin_rms: float = 0.0
    """Rms of the relative random variation of the ball spin [1]."""
    jitter_rms: float = 0.0
    """Rms of the angle between a ball and the centre of its cage pocket [rad]."""
    axis_offset: float = 0.0
    """Mean tilt of the spin axis of the damaged ball [rad]."""
    axis_rms: float = 0.0
    """Rms of the variation of the tilt [rad]."""
    axis_limit: float = 0.0
    """Tilt beyond which the spall misses the track [rad]."""
    unbalance: float = 0.0
    """Mass times eccentricity [kg m]."""
    shaft_angle: float = 0.0
    """Angle of the shaft at the start [rad]."""
    cage_angle: float = 0.0
    """Angle of the cage at the start [rad]."""
    spin_angle: float = 0.0
    """Angle of the ball spin at the start [rad]."""
    bow: float = 0.0
    """Force of a bent shaft on its bearings, which rotates with the shaft and does not depend on the speed [N]."""
    twice_x: float = 0.0
    """Force of misalignment at twice the shaft rate, x component [N]."""
    twice_y: float = 0.0
    """Force of misalignment at twice the shaft rate, y component [N]."""
    knock: float = 0.0
    """Force of the cage on the housing once per turn of the cage [N]."""
    knock_angle: float = 0.0
    """Angle of the first cage pocket at each knock [rad]."""
    knock_seed: int = 0
    """Seed of the random variation of the knocks."""
    late_ball: int = -1
    """Number of the ball that is displaced from the centre of its pocket, -1 for none."""
    late_by: float = 0.0
    """Angle of that displacement [rad]."""
    walk: float = 0.0
    """Standard deviation of the distance between successive balls at a point of the outer race, as a share of its mean [1]; successive
    distances are independent, so the angle of the cage walks at random."""
    walk_seed: int = 0
    axis_jumps: float = 0.0
    """Probability that the spin axis of the damaged ball jumps, once per turn of the cage, where the ball is opposite the load [1]."""
    axis_spread: float = 0.0
    """Standard deviation of tilt and spin angle after a jump [rad]."""
    axis_seed: int = 0


class Waviness(NamedTuple):
    """Complex Fourier amplitudes of the surfaces; an empty array stands for round surfaces."""

    races: NDArray[np.complex128]
    """Orders LOWEST_ORDER to HIGHEST_ORDER of the inner and the outer race, shape (race, order) or (2, 0) [m]."""
    balls: NDArray[np.complex128]
    """Even orders of every ball from order 2 on, sum of both contacts, shape (order, ball) or (0, 0) [m]."""


ROUND = Waviness(np.empty((2, 0), complex), np.empty((0, 0), complex))
CONSTANT = np.empty((0, 2))
"""Schedule of a record of constant speed and load."""


class KernelInput(NamedTuple):
    """Input of the kernel for one record."""

    bearing: Bearing
    machine: Machine
    turning: Turning
    spalls: tuple[Spall, ...]
    frequencies: FloatArray
    """Frequencies of the cosine terms of all processes, shape (term,) [Hz]; see :func:`gen.physics.kernel.layout.n_process_terms`."""
    phases: FloatArray
    """Phases of the cosine terms, shape (term,) [rad]."""
    pickups: FloatArray
    """Weights of the six accelerations in each channel, shape (channel, coordinate) [1]."""
    waviness: Waviness = ROUND
    schedule: FloatArray = CONSTANT
    """Factors of the shaft rate (mean over the knot) and of the load (at the start of the knot), shape (knot, 2); (0, 2) if constant."""
    displacement: bool = False
    """True for channels of displacement [m], False for channels of acceleration [m s-2]."""
    start: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)
    """x1, y1, x2, y2 at the start of the integration, see :func:`at_rest` [m]."""


def at_rest(inputs: Sequence[KernelInput]) -> list[KernelInput]:
    """The same inputs, which start from static rest; each rests where it rests alone."""
    alike: dict[float, list[int]] = defaultdict(list)
    for place, kernel_input in enumerate(inputs):
        alike[kernel_input.machine.contact_exponent].append(place)
    resting = list(inputs)
    for places in alike.values():
        some = [inputs[place] for place in places]
        balls = ball_angles(
            [kernel_input.bearing.n_balls for kernel_input in some],
            [kernel_input.turning.cage_angle for kernel_input in some],
        )
        for place, start in zip(
            places, rest(as_columns([kernel_input.machine for kernel_input in some]), balls).tolist(), strict=True
        ):
            resting[place] = inputs[place]._replace(start=tuple(start))
    return resting


def is_wavy(waviness: Waviness) -> bool:
    """True if a race or a ball has waviness."""
    return waviness.races.size > 0 or waviness.balls.size > 0


def walk_slip_rms(bearing: Bearing, turning: Turning, held: float) -> float:
    """Rms of a random slip of the cage that is new every ``held`` seconds and gives the random walk of ``turning`` [1].

    While the cage turns by the angle ``b`` between two balls, its angle is to spread by ``walk * b``. If it turns by ``a`` while a slip is
    held, ``b / a`` independent slips spread it by ``rms * a * sqrt(b / a)``.
    """
    apart, turned = 2 * math.pi / bearing.n_balls, math.pi * abs(turning.shaft_rate) * (1 - bearing.gamma) * held
    return turning.walk * math.sqrt(apart / turned) if turning.walk > 0 else 0.0


def spall_span(bearing: Bearing, spall: Spall) -> tuple[float, float]:
    """Half the angle between the edges of a spall [rad], and the radius of the damaged surface [m]."""
    radius = bearing.radius(spall.site)
    return 0.5 * spall.width / radius, radius


def farthest_jitter(turning: Turning, n_terms: int) -> float:
    """Largest possible angle between a ball and the centre of its pocket: sum of the ``n_terms`` cosine amplitudes of the jitter [rad]."""
    return turning.jitter_rms * math.sqrt(2 * n_terms) + abs(turning.late_by)
