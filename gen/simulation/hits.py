"""How often balls under load pass the spalls of a record, from statics and mean rates.

A ball presses on its races only within the load zone, where the rings approach each other by more than half the clearance. A spall of the
outer race outside the zone is never felt; a spall of the inner race or of a ball passes the zone once per turn.
"""

import math
from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gen.physics.bearing import Orders
from gen.physics.inputs import KernelInput
from gen.physics.rotor import as_columns, rest
from gen.scenarios import Scenario
from gen.simulation.damage import untabulated_spalls
from gen.simulation.inputs import bare_input


class LoadZone(NamedTuple):
    """Part of the circumference where balls are loaded while the shaft rests."""

    direction: float
    """Of its middle [rad]."""
    half: float
    """Half of its width: pi if all balls are loaded, 0 if none is [rad]."""


def load_zones(inputs: Sequence[KernelInput]) -> list[LoadZone]:
    """Load zone of each record, without its spalls."""
    places: dict[int, list[int]] = defaultdict(list)
    for place, given in enumerate(inputs):
        places[given.bearing.n_balls].append(place)
    zones: dict[int, LoadZone] = {}
    for n_balls, members in places.items():
        machines = as_columns([inputs[place].machine for place in members])
        cages = np.array([inputs[place].turning.cage_angle for place in members])
        rings = rest(machines, cages[:, None] + 2 * np.pi * np.arange(n_balls) / n_balls)
        for place, (x1, y1, x2, y2) in zip(members, rings.tolist(), strict=True):
            machine = inputs[place].machine
            approach = math.hypot(x1 - x2, y1 - y2) * machine.contact_cosine
            share = machine.half_clearance / max(approach, 1e-15)
            zones[place] = LoadZone(math.atan2(y1 - y2, x1 - x2), math.acos(min(max(share, -1.0), 1.0)))
    return [zones[place] for place in range(len(inputs))]


def loaded_hits(given: KernelInput, zone: LoadZone, orders: Orders, turns: float) -> int:
    """Expected number of passages of loaded balls over all spalls in ``turns`` of the shaft, rounded [1].

    ``orders`` are the mean fault orders of the record. The tilt of the spin axis of a damaged ball does not count.
    """
    passages = 0.0
    for spall in given.spalls:
        if spall.site == "outer":
            passages += orders.bpfo * turns if _reaches(given, spall.angle, spall.width, zone) else 0.0
        else:
            passages += (orders.bpfi if spall.site == "inner" else 2 * orders.bsf) * turns * zone.half / math.pi
    return round(passages)


def felt_places(scenarios: Sequence[Scenario]) -> list[bool]:
    """False for each record whose only faults are spalls of the outer race that no loaded ball meets."""
    places = [place for place, scenario in enumerate(scenarios) if _only_outer_spalls(scenario)]
    felt, inputs = [True] * len(scenarios), {}
    for place in places:
        try:
            inputs[place] = bare_input(scenarios[place])._replace(spalls=untabulated_spalls(scenarios[place]))
        except ValueError:  # no such machine is possible; the simulation says so
            continue
    for (place, given), zone in zip(inputs.items(), load_zones(list(inputs.values())), strict=True):
        felt[place] = any(_reaches(given, spall.angle, spall.width, zone) for spall in given.spalls)
    return felt


def _only_outer_spalls(scenario: Scenario) -> bool:
    specimen = scenario.specimen
    sites = {spall.site for spall in specimen.spalls}
    return sites == {"outer"} and not specimen.cage and specimen.wear is None


def _reaches(given: KernelInput, angle: float, width: float, zone: LoadZone) -> bool:
    """Whether a spall of the outer race lies in the load zone with a part of its width."""
    away = abs(math.remainder(angle - zone.direction, 2 * math.pi))
    return away - width / (2 * given.bearing.outer_radius) < zone.half
