"""Truth of a record: values known by construction, computed once and stored as its labels."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from gen.corpus.fault_classes import CLASSES
from gen.physics.bearing import FaultOrders
from gen.physics.inputs import KernelInput
from gen.physics.profile import mean_share, share_at
from gen.scenarios import Scenario
from gen.simulation.damage import largest_drop_over
from gen.simulation.hits import loaded_hits
from gen.simulation.motion import Motion, mean_motion
from gen.simulation.timeline import Timeline

_NO_SPALL: dict[str, Any] = {"width": 0.0, "depth": 0.0, "angle": math.nan, "largest_drop": 0.0, "width_share": 0.0}


class Truth(NamedTuple):
    """Values of one record; each has the name of the variable in the corpus that it becomes."""

    shaft_rate: float
    """Mean of the speed profile, with the drawn error of the label [Hz]."""
    load: float
    """Mean of the load profile [N]."""
    true_shaft_rate: float
    """Mean over the record, speed wander included [Hz]."""
    first_shaft_rate: float
    """At the start and at the end of the record, without wander [Hz]."""
    last_shaft_rate: float
    true_ftf: float
    """Mean fault orders, slip included [1]."""
    true_bpfo: float
    true_bpfi: float
    true_bsf: float
    operating_clearance: float
    """Diametral, after thermal expansion, oil film and axial load; NaN if no such machine is possible [m]."""
    width: float
    """Of the widest spall, 0 without a spall [m]."""
    depth: float
    angle: float
    """On the outer race from the x axis, NaN without a spall [rad]."""
    largest_drop: float
    """Of a rigid ball over it [m]."""
    width_share: float
    """Its width over the distance from ball to ball, or over the circumference of a ball [1]."""
    loaded_hits: int = -1
    """Expected number of passages of loaded balls over all spalls, -1 if it was not asked for [1]."""

    def without_fault(self) -> "Truth":
        """The same without damage."""
        return self._replace(**_NO_SPALL, loaded_hits=0)

    @property
    def orders(self) -> FaultOrders:
        """Mean fault orders, slip included [1]."""
        return FaultOrders(self.true_ftf, self.true_bpfo, self.true_bpfi, self.true_bsf)


def with_loaded_hits(truths: Sequence[Truth], inputs: Sequence[KernelInput | None], timeline: Timeline) -> list[Truth]:
    """Truths with the hits of loaded balls; 0 for a record without spalls or of which no machine is possible."""
    completed = []
    for truth, given in zip(truths, inputs, strict=True):
        turns = truth.true_shaft_rate * timeline.duration
        hits = 0 if given is None else loaded_hits(given, truth.orders, turns)
        completed.append(truth._replace(loaded_hits=hits))
    return completed


def lines_of_faults(scenario: Scenario, orders: FaultOrders) -> tuple[float, ...]:
    """Orders at which the faults of a record repeat; none for a worn race, which hits nothing [1]."""
    hitting = [*(spall.site for spall in scenario.specimen.spalls), *scenario.specimen.damage]
    lines = dict.fromkeys(CLASSES[one].lines[0] for one in hitting if one in CLASSES)
    return tuple(line.multiple * getattr(orders, line.base) for line in lines)


def truth_of(motion: Motion, timeline: Timeline, given: KernelInput | None) -> Truth:
    """Truth of a record; ``given`` is its kernel input, None if no such machine is possible."""
    record, duration = motion.scenario.record, timeline.duration
    nominal, (true_rate, orders) = record.conditions.shaft_rate, mean_motion(motion, timeline)
    ends = [1.0, 1.0] if record.speed_profile is None else share_at(record.speed_profile, np.array([0.0, duration]))
    return Truth(
        shaft_rate=nominal * mean_share(record.speed_profile, duration) * (1 + record.conditions.label_error),
        load=record.conditions.load * mean_share(record.load_profile, duration),
        true_shaft_rate=true_rate,
        first_shaft_rate=nominal * ends[0],
        last_shaft_rate=nominal * ends[1],
        **{f"true_{name}": order for name, order in orders._asdict().items()},
        operating_clearance=math.nan if given is None else 2 * given.machine.half_clearance,
        **widest_spall(motion.scenario),
    )


def widest_spall(scenario: Scenario) -> dict[str, Any]:
    """Size and place of the widest spall of a scenario, by field of :class:`Truth`."""
    spalls, bearing = scenario.specimen.spalls, scenario.specimen.bearing
    if not spalls:
        return _NO_SPALL
    number = max(range(len(spalls)), key=lambda place: spalls[place].width)
    widest = spalls[number]
    circumference = 2 * math.pi * bearing.radius(widest.site)
    return {
        "width": widest.width,
        "depth": widest.depth,
        "angle": widest.angle + (scenario.rig.machine["load_angle"] if widest.site == "outer" else 0.0),
        "largest_drop": largest_drop_over(scenario, number),
        "width_share": widest.width / (circumference if widest.site == "ball" else circumference / bearing.n_balls),
    }
