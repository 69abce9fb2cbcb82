"""Angle of the shaft at every sample of a response: the time integral of its speed, as the kernel turns it.

The speed is the drawn rate, times the speed profile, times the speed wander. Bearing, unbalance, and everything of the machine that is
locked to the shaft turn by this one angle.
"""

import math

import numpy as np
from numpy.typing import NDArray

from gen.physics.kernel.layout import SPEED_TERMS
from gen.physics.kernel.turning import STRIDE
from gen.physics.profile import share_at
from gen.scenarios import Scenario
from gen.simulation.motion import Start, cosine_sum, start_of
from gen.simulation.timeline import Timeline

FloatArray = NDArray[np.float64]


def shaft_angles(scenario: Scenario, timeline: Timeline) -> FloatArray:
    """Angle of the shaft of a record from the lead ahead of it on, shape (time,) [rad].

    With a constant nominal speed it is ``angle + omega (t + s integral(eta))``, with the rms ``s`` of the wander and its cosine sum
    ``eta``. With a speed profile the product of profile and wander is summed from sample to sample, at the middle of each, as in the
    kernel.
    """
    start, record = start_of(scenario, SPEED_TERMS), scenario.record
    omega, wander = 2 * math.pi * record.conditions.shaft_rate, record.conditions.speed_wander
    if record.speed_profile is None:
        nodes = np.arange(timeline.dropped, timeline.dropped + timeline.returned + STRIDE, STRIDE) / timeline.fs
        turned = omega * (nodes + (wander * _integrated_wander(start, nodes) if wander > 0 else 0.0))
        angles = _between(turned)[: timeline.returned]
        angles += start.shaft
        return angles
    middles = (np.arange(timeline.dropped + timeline.returned - 1) + 0.5) / timeline.fs
    speed = share_at(record.speed_profile, middles - timeline.settle / timeline.fs)
    if wander > 0:
        speed *= 1 + wander * _wander(start, middles)
    turned = np.concatenate([[0.0], np.cumsum(speed)]) * (omega / timeline.fs)
    return start.shaft + turned[timeline.dropped :]


def _between(nodes: FloatArray) -> FloatArray:
    """Values on straight lines between nodes that are ``STRIDE`` samples apart, without the last node.

    The error is below 1e-5 rad for a wander of 1 % at 50 Hz, and the nodes take an eighth of the cosines.
    """
    slopes = np.diff(nodes) / STRIDE
    between = slopes[:, None] * np.arange(STRIDE)
    between += nodes[:-1, None]
    return between.ravel()


def _wander(start: Start, times: NDArray[np.floating]) -> FloatArray:
    """Speed wander of unit rms at evenly spaced ``times`` since the kernel started [s], shape (time,) [1]."""
    rates, phases = _speed_terms(start)
    return math.sqrt(2 / SPEED_TERMS) * cosine_sum(times, rates, phases)


def _integrated_wander(start: Start, times: NDArray[np.floating]) -> FloatArray:
    """Integral of the speed wander of unit rms from the start of the kernel to ``times``, shape (time,) [s]."""
    rates, phases = _speed_terms(start)
    sines = cosine_sum(times, rates, phases - math.pi / 2, 1 / rates)
    return math.sqrt(2 / SPEED_TERMS) * (sines - float(np.sum(np.sin(phases) / rates)))


def _speed_terms(start: Start) -> tuple[FloatArray, FloatArray]:
    """Rates [rad/s] and phases [rad] of the cosine terms of the speed wander, shape (term,)."""
    return 2 * np.pi * start.frequencies, start.phases
