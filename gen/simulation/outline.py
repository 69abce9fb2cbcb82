"""What a record asks of the computer, without building it: the shape of its kernel and its steps per sample.

Both follow from the machine and from whether there are spalls, waviness and a schedule; of the schedule only the highest speed and the
highest load matter. So an outline has plain spalls, waves of no height and a schedule of one knot, which holds the two.
"""

import math

import numpy as np
from numpy.typing import NDArray

from gen.physics.kernel.batch import Record
from gen.physics.profile import Profile, share_at
from gen.recipe import Recipe
from gen.scenarios import Scenario
from gen.simulation.damage import is_wavy, plain_spalls
from gen.simulation.machine import bare_record, is_scheduled, knot_times, load_wander, n_knots, wander_terms
from gen.simulation.simulate import failures_named

FloatArray = NDArray[np.float64]

SAMPLES_PER_TURN = 16  # of the shaft, at which a wandering load is looked at first
MOST_APART = 1024  # knots between two such samples


def outlined_record(scenario: Scenario, recipe: Recipe) -> Record:
    """Record of which kernel shape and steps per sample are those of :func:`gen.simulation.simulate.kernel_record`, and nothing else.

    Raises
    ------
    SimulationError
        If no such machine can stand, with the number of the record: the same as of the whole record.
    """
    with failures_named(scenario):
        bare = bare_record(scenario, recipe)
    highest = [[_speed_peak(scenario, recipe), _load_peak(scenario, recipe)]] if is_scheduled(scenario) else []
    return bare._replace(
        spalls=plain_spalls(scenario),
        waves=np.zeros(int(is_wavy(scenario))),
        schedule=np.array(highest).reshape(-1, 2),
    )


def _speed_peak(scenario: Scenario, recipe: Recipe) -> float:
    """Highest factor of the speed over the knots of the schedule [1]."""
    profile = scenario.record.speed_profile
    return 1.0 if profile is None else _peak(profile, recipe, later=0.5 / recipe.recording.sample_rate_hz)


def _load_peak(scenario: Scenario, recipe: Recipe) -> float:
    """Highest factor of the load over the knots of the schedule [1].

    A load that wanders is sampled some times per turn of the shaft, and then at all knots between those samples that may have the peak
    between them.
    """
    profile = scenario.record.load_profile
    if scenario.record.conditions["load_wander"] == 0:
        return 1.0 if profile is None else _peak(profile, recipe, later=0.0)
    count, (amplitude, rates, phases) = n_knots(recipe), wander_terms(scenario)
    apart = int(recipe.recording.sample_rate_hz / (SAMPLES_PER_TURN * scenario.record.conditions["shaft"]))
    apart = max(1, min(apart, MOST_APART, count // 2))
    knots = np.arange(0, count + apart, apart)  # the last is beyond the end, so that every knot is between two
    times = knot_times(recipe, knots)
    wander, shares = load_wander(scenario, times), _shares(profile, times)
    # a sum of cosines rises above the larger of two samples by at most spacing^2 / 8 of its largest second derivative
    beyond = amplitude * float(np.sum(rates**2)) * (apart / recipe.recording.sample_rate_hz) ** 2 / 8
    most = (np.maximum(wander[1:], wander[:-1]) + beyond) * _largest_between(profile, times, shares)
    places = np.flatnonzero(most >= (wander * shares)[knots < count].max())
    near = np.unique(knots[places][:, None] + np.arange(apart + 1))
    times = knot_times(recipe, near[near < count])
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


def _peak(profile: Profile, recipe: Recipe, later: float) -> float:
    """Largest share of a profile at the knots and ``later`` [s]: at either end, or beside a point, for it is monotonic between."""
    first, fs = knot_times(recipe, np.zeros(1, int))[0] + later, recipe.recording.sample_rate_hz
    before = np.floor((np.asarray(profile.times) - first) * fs)
    beside = (before[:, None] + np.array([-1, 0, 1, 2])).ravel()
    knots = np.unique(np.clip([0, *beside, math.inf], 0, n_knots(recipe) - 1)).astype(int)
    return float(share_at(profile, knot_times(recipe, knots) + later).max())
