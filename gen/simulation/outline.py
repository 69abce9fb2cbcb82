"""Kernel shape and steps per sample of a record, without its full kernel input.

Both follow from the machine and from whether there are spalls, waviness and a schedule. Of the schedule only the highest speed and the
highest load matter. So an outline has spalls without tables, waviness of no height, and a schedule of one knot with these two maxima.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gen.physics.inputs import CONSTANT, ROUND, KernelInput, Waviness
from gen.physics.profile import Profile, share_at
from gen.scenarios import Scenario
from gen.simulation.damage import is_wavy, untabulated_spalls
from gen.simulation.inputs import Failures, bare_inputs, only
from gen.simulation.motion import is_scheduled, load_wander, wander_terms
from gen.simulation.timeline import Timeline

FloatArray = NDArray[np.float64]

SAMPLES_PER_TURN = 16  # of the shaft, for the first samples of a wandering load
MOST_APART = 1024  # knots between two such samples, at most


FLAT = Waviness(np.zeros((2, 1), complex), ROUND.balls)


def outlined_inputs(scenarios: Sequence[Scenario], timeline: Timeline) -> tuple[list[KernelInput | None], Failures]:
    """Kernel inputs with the shape and steps per sample of :func:`gen.simulation.inputs.kernel_inputs`, and nothing else of them.

    None and the same sentence where no machine is possible.
    """
    bare, failures = bare_inputs(scenarios)
    inputs = [
        given
        and given._replace(
            spalls=untabulated_spalls(scenario),
            waviness=FLAT if is_wavy(scenario) else ROUND,
            schedule=_peaks(scenario, timeline) if is_scheduled(scenario) else CONSTANT,
        )
        for given, scenario in zip(bare, scenarios, strict=True)
    ]
    return inputs, failures


def outlined_input(scenario: Scenario, timeline: Timeline) -> KernelInput:
    """Outline of one scenario; SimulationError if no such machine is possible."""
    return only(outlined_inputs([scenario], timeline))


def _peaks(scenario: Scenario, timeline: Timeline) -> FloatArray:
    return np.array([[_speed_peak(scenario, timeline), _load_peak(scenario, timeline)]])


def _speed_peak(scenario: Scenario, timeline: Timeline) -> float:
    """Highest factor of the speed over the knots of the schedule [1]."""
    profile = scenario.record.speed_profile
    return 1.0 if profile is None else _peak(profile, timeline, later=0.5 / timeline.fs)


def _load_peak(scenario: Scenario, timeline: Timeline) -> float:
    """Highest factor of the load over the knots of the schedule [1].

    A wandering load is first sampled ``SAMPLES_PER_TURN`` times per turn of the shaft, and then at every knot wherever the peak may lie
    between two of these samples.
    """
    profile = scenario.record.load_profile
    if scenario.record.conditions.load_wander == 0:
        return 1.0 if profile is None else _peak(profile, timeline, later=0.0)
    count, (amplitude, rates, phases) = timeline.knots, wander_terms(scenario)
    apart = int(timeline.fs / (SAMPLES_PER_TURN * scenario.record.conditions.shaft_rate))
    apart = max(1, min(apart, MOST_APART, count // 2))
    knots = np.arange(0, count + apart, apart)  # the last is beyond the end, so that every knot is between two
    times = timeline.knot_times(knots)
    wander, shares = load_wander(scenario, times), _shares(profile, times)
    # a sum of cosines rises above the larger of two samples by at most spacing^2 / 8 of its largest second derivative
    beyond = amplitude * float(np.sum(rates**2)) * (apart / timeline.fs) ** 2 / 8
    most = (np.maximum(wander[1:], wander[:-1]) + beyond) * _largest_between(profile, times, shares)
    places = np.flatnonzero(most >= (wander * shares)[knots < count].max())
    near = np.unique(knots[places][:, None] + np.arange(apart + 1))
    times = timeline.knot_times(near[near < count])
    wander = np.maximum(1 + amplitude * np.cos(np.outer(times, rates) + phases).sum(axis=1), 0.0)
    return float((wander * _shares(profile, times)).max())


def _shares(profile: Profile | None, times: FloatArray) -> FloatArray:
    return np.ones(len(times)) if profile is None else share_at(profile, times)


def _largest_between(profile: Profile | None, times: FloatArray, shares: FloatArray) -> FloatArray:
    """Largest share of a profile between each two of ``times``, at which it has the ``shares``, shape (time - 1,) [1]."""
    largest = np.maximum(shares[1:], shares[:-1])
    if profile is not None:
        places = np.searchsorted(times, profile.times) - 1
        inside = (places >= 0) & (places < len(largest))
        np.maximum.at(largest, places[inside], np.asarray(profile.shares)[inside])
    return largest


def _peak(profile: Profile, timeline: Timeline, later: float) -> float:
    """Largest share of a profile at the knots, each ``later`` by some [s]: it is at either end or beside a point of the profile [1]."""
    first, fs = timeline.knot_times(np.zeros(1, int))[0] + later, timeline.fs
    before = np.floor((np.asarray(profile.times) - first) * fs)
    beside = (before[:, None] + np.array([-1, 0, 1, 2])).ravel()
    knots = np.unique(np.clip([0, *beside, math.inf], 0, timeline.knots - 1)).astype(int)
    return float(share_at(profile, timeline.knot_times(knots) + later).max())
