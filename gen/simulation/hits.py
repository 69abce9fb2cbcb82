"""How often balls under load pass the spalls of a record, from statics and mean rates.

A ball presses on its races only within the load zone, where the rings approach each other by more than half the clearance. A spall of the
outer race outside the zone is never felt; a spall of the inner race or of a ball passes the zone once per turn.
"""

import math
from collections.abc import Sequence

from gen.physics.bearing import FaultOrders
from gen.physics.kernel_input import KernelInput, Spall
from gen.scenarios import Scenario
from gen.simulation.inputs import bare_inputs, resting
from gen.simulation.motion import draw_motion


def load_zone(kernel_input: KernelInput) -> tuple[float, float]:
    """Part of the circumference where balls are loaded while the shaft rests, of a record that starts from static rest.

    Direction of its middle, and half of its width: pi if all balls are loaded, 0 if none is [rad].
    """
    machine, (x1, y1, x2, y2) = kernel_input.machine, kernel_input.start
    approach = math.hypot(x1 - x2, y1 - y2) * machine.contact_cosine
    share = machine.half_clearance / max(approach, 1e-15)
    return math.atan2(y1 - y2, x1 - x2), math.acos(min(max(share, -1.0), 1.0))


def loaded_hits(kernel_input: KernelInput, orders: FaultOrders, turns: float) -> int:
    """Expected number of passages of loaded balls over all spalls in ``turns`` of the shaft, rounded [1].

    ``orders`` are the mean fault orders of the record. The tilt of the spin axis of a damaged ball does not count.
    """
    passages, (_, half) = 0.0, load_zone(kernel_input)
    for spall in kernel_input.spalls:
        if spall.site == "outer":
            passages += orders.bpfo * turns if _is_loaded(spall, kernel_input) else 0.0
        else:
            passages += (orders.bpfi if spall.site == "inner" else 2 * orders.bsf) * turns * half / math.pi
    return round(passages)


def felt_places(scenarios: Sequence[Scenario]) -> list[bool]:
    """False for each record whose only faults are spalls of the outer race that no loaded ball meets."""
    outer = [
        place for place, scenario in enumerate(scenarios) if scenario.spalls and scenario.damaged_parts == ["outer"]
    ]
    felt = [True] * len(scenarios)
    inputs = resting(bare_inputs([draw_motion(scenarios[place]) for place in outer]))
    for place, kernel_input in zip(outer, inputs, strict=True):
        if isinstance(kernel_input, KernelInput):  # otherwise no such machine is possible; the simulation says so
            felt[place] = any(_is_loaded(spall, kernel_input) for spall in scenarios[place].spalls)
    return felt


def _is_loaded(spall: Spall, kernel_input: KernelInput) -> bool:
    """Whether a spall of the outer race lies in the load zone with a part of its width."""
    direction, half = load_zone(kernel_input)
    away = abs(math.remainder(spall.angle - direction, 2 * math.pi))
    return away - spall.width / (2 * kernel_input.bearing.outer_radius) < half
