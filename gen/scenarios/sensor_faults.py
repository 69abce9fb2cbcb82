"""Draw the faults of the measuring chain, the gear and the condition of a machine.

Every fault has a random stream of its own, so a section that is added to a recipe or removed from it moves no other drawn value.
"""

import math
from collections.abc import Sequence

import numpy as np

from gen.drawing.distributions import weighted_index
from gen.drawing.draws import Drawn, Draws
from gen.drawing.section import Section
from gen.recipe import Recipe
from gen.scenarios.model import Purpose, stream
from gen.scenarios.sensing import ConditionSignal, Gear, RecordSensorFaults, RigSensorFaults
from gen.support.units import decibel_to_ratio, to_si


def draw_rig_sensor_faults(recipe: Recipe, rig: int) -> RigSensorFaults | None:
    """Sensor faults that last as long as a rig; None if the recipe has none of them."""
    wanted = recipe.sensor_faults
    sections = wanted.loose_mount, wanted.saturation, wanted.mains_hum
    if sections == (None, None, None):
        return None
    mounts, amplifier, mains = _streams(recipe, rig, 0, 0, Purpose.RIG_SENSOR_FAULTS, len(sections))
    hum = _if_present(wanted.mains_hum, mains, rig)
    if hum is not None:
        del hum["deviation"]  # drawn per record
    of_channels = mounts.spawn(len(recipe.recording.channels))
    return RigSensorFaults(
        loose_mounts=tuple(_if_present(wanted.loose_mount, rng, rig) for rng in of_channels),
        saturation=_if_present(wanted.saturation, amplifier, rig),
        mains_hum=hum,
    )


def draw_record_sensor_faults(recipe: Recipe, rig: int, specimen: int, record: int) -> RecordSensorFaults | None:
    """Sensor faults of one record; None if the recipe has none of them."""
    wanted = recipe.sensor_faults
    sections = wanted.drift, wanted.dropped_samples, wanted.gain_steps, wanted.emi_bursts, wanted.mains_hum
    if sections == (None,) * len(sections):
        return None
    drift, gaps, gains, bursts, mains = _streams(
        recipe, rig, specimen, record, Purpose.RECORD_SENSOR_FAULTS, len(sections)
    )
    deviation = 0.0
    if wanted.mains_hum is not None:
        draws = Draws(mains, np.empty(0), record, f"record {record}")
        deviation = to_si(draws.value(wanted.mains_hum.deviation_percent), "percent")
    return RecordSensorFaults(
        drift=_if_present(wanted.drift, drift, record),
        dropped_samples=_if_present(wanted.dropped_samples, gaps, record),
        gain_steps=_draw_gain_steps(recipe, gains, record),
        emi_bursts=_if_present(wanted.emi_bursts, bursts, record),
        mains_deviation=deviation,
    )


def draw_gear(recipe: Recipe, rig: int) -> Gear | None:
    """Gear on the shaft of a rig; None if it has none."""
    wanted = recipe.background.gear_mesh
    if wanted is None:
        return None
    draws = Draws(stream(recipe.seed, rig, 0, 0, Purpose.GEAR), np.empty(0), rig, f"rig {rig}")
    if not draws.is_present(wanted):
        return None
    drawn = draws.section(wanted)
    levels = [drawn["level"], *(draws.value(wanted.level_db) for _ in range(round(drawn["count"]) - 1))]
    return Gear(
        teeth=round(drawn["teeth"]),
        mate_teeth=round(drawn["mate_teeth"]),
        lines=tuple({"level": decibel_to_ratio(level), "phase": _angle(draws)} for level in levels),
        shaft_modulation=drawn["shaft_modulation"],
        mate_modulation=drawn["mate_modulation"],
        phase_modulation=drawn["phase"],
        high_point=_angle(draws),
        lead_point=_angle(draws),
    )


def draw_machine_condition(recipe: Recipe, rig: int) -> ConditionSignal | None:
    """Condition of the machine of a rig; None if it is sound."""
    wanted = recipe.machine_conditions
    if wanted is None:
        return None
    draws = Draws(stream(recipe.seed, rig, 0, 0, Purpose.MACHINE_CONDITION), np.empty(0), rig, f"rig {rig}")
    if not draws.is_present(wanted):
        return None
    entry = wanted.entries[weighted_index(tuple(entry.weight for entry in wanted.entries), draws.u())]
    drawn = draws.section(entry)
    levels = [decibel_to_ratio(draws.value(entry.level_db)) for _ in range(round(drawn["count"]))]
    if levels and entry.strongest is not None:
        place, largest = min(entry.strongest, len(levels)) - 1, int(np.argmax(levels))
        levels[place], levels[largest] = levels[largest], levels[place]
    lines = [{"level": level, "phase": _angle(draws)} for level in levels]
    bursts = None
    if entry.bursts is not None:
        of_bursts = draws.section(entry.bursts)
        bursts = of_bursts | {"level": decibel_to_ratio(of_bursts["level"]), "start": _angle(draws)}
    return ConditionSignal(entry.kind, drawn["order"], tuple(lines), bursts)


def _angle(draws: Draws) -> float:
    return 2 * math.pi * draws.u()


def _draw_gain_steps(recipe: Recipe, rng: np.random.Generator, record: int) -> tuple[Drawn, ...]:
    wanted = recipe.sensor_faults.gain_steps
    draws = Draws(rng, np.empty(0), record, f"record {record}")
    if wanted is None or not draws.is_present(wanted):
        return ()
    steps = [
        {"share": draws.u(), "gain": decibel_to_ratio(draws.value(wanted.step_db))}
        for _ in range(round(draws.value(wanted.count)))
    ]
    return tuple(sorted(steps, key=lambda step: step["share"]))


def _if_present(section: Section | None, rng: np.random.Generator, number: int) -> Drawn | None:
    """Values of a section with the probability that it gives; None otherwise."""
    draws = Draws(rng, np.empty(0), number, "sensor_faults")
    return draws.section(section) if section is not None and draws.is_present(section) else None


def _streams(
    recipe: Recipe, rig: int, specimen: int, record: int, purpose: Purpose, count: int
) -> Sequence[np.random.Generator]:
    return stream(recipe.seed, rig, specimen, record, purpose).spawn(count)
