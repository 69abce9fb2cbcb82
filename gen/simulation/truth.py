"""Truth of a record: what the simulation knows of it by construction, and the variables of the corpus that follow from it."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from gen.corpus.fault_classes import CLASSES
from gen.corpus.schema import Variable
from gen.corpus.simulated import with_values
from gen.physics.bearing import FaultOrders
from gen.physics.inputs import KernelInput, Spall
from gen.physics.profile import mean_share, share_at
from gen.scenarios import Scenario
from gen.simulation.damage import largest_drop_over
from gen.simulation.hits import loaded_hits
from gen.simulation.motion import Motion, mean_motion
from gen.simulation.timeline import Timeline, timeline


class Truth(NamedTuple):
    """What the simulation knows of one record."""

    scenario: Scenario
    given: KernelInput | None
    """None if no such machine is possible."""
    mean_rate: float
    """Mean shaft rate over the record, speed wander included [Hz]."""
    orders: FaultOrders
    """Mean over the record, slip included [1]."""


def truth_of(motion: Motion, axis: Timeline, given: KernelInput | None) -> Truth:
    """Truth of a record; ``given`` is its kernel input, None if no such machine is possible."""
    return Truth(motion.scenario, given, *mean_motion(motion, axis))


def lines_of_faults(truth: Truth) -> tuple[float, ...]:
    """Orders at which the faults of a record repeat; none for a worn race, which hits nothing [1]."""
    parts = truth.scenario.components
    lines = dict.fromkeys(CLASSES[part.kind].lines[0] for part in parts if part.kind in CLASSES)
    return tuple(line.multiple * getattr(truth.orders, line.base) for line in lines)


def _duration(truth: Truth) -> float:
    return timeline(truth.scenario.recipe).duration


def _shaft_rate(truth: Truth) -> float:
    """Mean of the speed profile, with the drawn error of the label [Hz]."""
    conditions = truth.scenario.conditions
    mean = conditions["shaft_rate"] * mean_share(truth.scenario.speed_profile, _duration(truth))
    return mean * (1 + conditions["label_error"])


def _shaft_rate_at(truth: Truth, time: float) -> float:
    profile = truth.scenario.speed_profile
    share = 1.0 if profile is None else share_at(profile, np.array([time]))[0]
    return truth.scenario.conditions["shaft_rate"] * share


def _load(truth: Truth) -> float:
    """Mean of the load profile [N]."""
    return truth.scenario.conditions["load"] * mean_share(truth.scenario.load_profile, _duration(truth))


def _of_widest(value: Callable[[Scenario, Spall], float], without: float = 0.0) -> Callable[[Truth], float]:
    """Function of a truth that gives a value of the widest spall, or ``without`` a spall another one."""

    def of_truth(truth: Truth) -> float:
        widest = max(truth.scenario.spalls, key=lambda spall: spall.width, default=None)
        return without if widest is None else value(truth.scenario, widest)

    return of_truth


def _largest_drop(scenario: Scenario, spall: Spall) -> float:
    return largest_drop_over(scenario, scenario.spalls.index(spall))


def _width_share(scenario: Scenario, spall: Spall) -> float:
    bearing = scenario.bearing
    circumference = 2 * math.pi * bearing.radius(spall.site)
    return spall.width / (circumference if spall.site == "ball" else circumference / bearing.n_balls)


def _loaded_hits(truth: Truth) -> int:
    if not truth.scenario.recipe.truth.twins:
        return -1
    if truth.given is None or not truth.scenario.spalls:
        return 0
    return loaded_hits(truth.given, truth.orders, truth.mean_rate * _duration(truth))


LABELS = (
    *with_values(
        shaft_rate=_shaft_rate,
        load=_load,
        width=_of_widest(lambda _, spall: spall.width),
        depth=_of_widest(lambda _, spall: spall.depth),
        angle=_of_widest(lambda _, spall: spall.angle, math.nan),
        true_shaft_rate=lambda truth: truth.mean_rate,
        first_shaft_rate=lambda truth: _shaft_rate_at(truth, 0.0),
        last_shaft_rate=lambda truth: _shaft_rate_at(truth, _duration(truth)),
    ),
    Variable("largest_drop", "f8", "m", "label", "largest drop of a rigid ball over the widest spall, 0 without a spall",
        _of_widest(_largest_drop)),
    Variable("width_share", "f8", "1", "label", "width of the widest spall over that from ball to ball, or round a ball; 0 without",
        _of_widest(_width_share)),
    Variable("true_ftf", "f8", "1", "latent", "mean fundamental train frequency in shaft orders, slip included",
        lambda truth: truth.orders.ftf),
    Variable("true_bpfo", "f8", "1", "latent", "mean ball pass frequency of the outer race in shaft orders, slip included",
        lambda truth: truth.orders.bpfo),
    Variable("true_bpfi", "f8", "1", "latent", "mean ball pass frequency of the inner race in shaft orders, slip included",
        lambda truth: truth.orders.bpfi),
    Variable("true_bsf", "f8", "1", "latent", "mean ball spin frequency in shaft orders", lambda truth: truth.orders.bsf),
    Variable("operating_clearance", "f8", "m", "latent", "diametral clearance in operation: warm, oiled, under axial load",
        lambda truth: None if truth.given is None else 2 * truth.given.machine.half_clearance),
    Variable("loaded_hits", "i4", "1", "latent", "expected number of passages of loaded balls over spalls, -1 if not known",
        _loaded_hits),
)  # fmt: skip
"""Each is computed from a :class:`Truth`."""
