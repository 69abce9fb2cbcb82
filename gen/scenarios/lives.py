"""Draw the life of a specimen, and put its records into it: each is a snapshot in which the damage is frozen."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.drawing import Drawn, Draws, Purpose, stream
from gen.life.ageing import STEPS, Life, ageing, history, log_normal
from gen.life.fatigue import HIGHEST_RATIO, life_share
from gen.life.growth import Growth
from gen.mechanisms.faults.race_spalls import widest_spall
from gen.recipe import Recipe
from gen.scenarios.model import Conditions, Rig, Scenario, Snapshot, Specimen
from gen.support.errors import RecipeError
from gen.support.units import to_si

FloatArray = NDArray[np.float64]
_TRIES = 1000


class SpecimenLife(NamedTuple):
    """Life of one specimen and its test."""

    life: Life
    ages: FloatArray
    """At the snapshots, shape (snapshot,) [s]."""
    failure: float
    """Age at which the spall has its greatest length [s]."""
    failed: bool
    """Whether that is before the end of the test."""
    load_ratio: float
    """Load over the dynamic rating, without its history [1]."""
    load: FloatArray
    """Factors of load and speed, and rise of the temperature [K], at the snapshots."""
    speed: FloatArray
    warmer: FloatArray
    drawn: Drawn


def draw_life(recipe: Recipe, rig: Rig, specimen: Specimen, conditions: Conditions) -> SpecimenLife:
    """Life of a specimen under its ``conditions`` without histories.

    Raises
    ------
    RecipeError
        If the load is above the dynamic rating, or hardly any bearing is alive when the snapshots begin.
    """
    assert recipe.life is not None  # noqa: S101
    rng, *rngs = stream(recipe.seed, rig.number, specimen.number, 0, Purpose.LIFE).spawn(5)
    draws = Draws(rng, specimen.number, f"specimen {specimen.number}")
    drawn, element = draws.section(recipe.life), rig.bearing.rolling_element
    slots, cadence = recipe.corpus.records_per_specimen, to_si(recipe.life.cadence_h, "h")
    ratio = conditions.load / (rig.bearing.dynamic_rating or 1.0)
    if ratio > 1 and not recipe.life.accelerated:
        raise RecipeError(
            f"{draws.item}: its load is {ratio:.3g} times the dynamic rating; lower operation.load_n, or say life.accelerated: true."
        )
    step = drawn["history"] / STEPS
    count = 2 + int((drawn["entry"] + slots * cadence) / step)
    load, speed, warmer, noise = (history(rng, count) for rng in rngs)
    load, speed = log_normal(load, drawn["load_history"]), log_normal(speed, drawn["speed_history"])
    law = Growth(*(drawn[name] for name in ("growth", "growth_exponent", "critical", "acceleration")))
    sums = ageing(
        step,
        conditions.shaft_rate * speed,
        ratio * load,
        log_normal(noise, drawn["growth_noise"]),
        element=element,
        factor=drawn["a_iso"],
        load_exponent=drawn["load_exponent"],
    )
    (spall,) = specimen.spalls
    first = spall.width * float(np.exp(drawn["first_length_scatter"] * rng.standard_normal()))
    last = min(to_si(recipe.life.end.length_mm, "mm"), widest_spall(spall.site, rig.bearing))
    for _ in range(_TRIES):
        life = Life(sums, law, life_share(draws.u(), element), min(first, last))
        failure = life.age_at(last)
        if failure > drawn["entry"]:
            break
    else:
        raise RecipeError(f"{draws.item}: hardly any bearing lives until life.entry_h; lower it, or the load.")
    damaged = life.age_at(to_si(recipe.life.damaged_from_mm, "mm"))
    ages = drawn["entry"] + cadence * np.arange(slots + 1)
    if recipe.life.damaged_cadence_h is not None:
        dense = int(np.searchsorted(ages, damaged))
        ages[dense:] = ages[min(dense, slots)] + to_si(recipe.life.damaged_cadence_h, "h") * np.arange(
            slots + 1 - dense
        )
    end = min(ages[-1], max(drawn["withdrawal"], drawn["entry"]))
    ages = ages[:-1][ages[:-1] <= min(failure, end)]
    load, speed, warmer = (
        np.interp(ages, sums.age, each) for each in (load, speed, drawn["temperature_history"] * warmer)
    )
    return SpecimenLife(life, ages, failure, failure <= end, ratio, load, speed, warmer, drawn)


def at_snapshot(scenario: Scenario, lived: SpecimenLife, number: int) -> Scenario:
    """A record as the snapshot ``number`` of the life of its specimen."""
    specimen, conditions, age = scenario.specimen, scenario.record.conditions, float(lived.ages[number])
    turns = float(lived.life.ageing.at("turns", age))
    worn = {
        name: specimen.properties[name] + lived.drawn[of] * turns * lived.load_ratio
        for name, of in (("diametral_clearance", "clearance"), ("waviness", "waviness"))
    }
    length, (spall,) = float(lived.life.length_at(age)), specimen.spalls
    depth = spall.depth * length / max(lived.drawn["full_depth"], length) if length else 0.0
    snapshot = Snapshot(
        age=age,
        rul=lived.failure - age,
        rul_revolutions=float(lived.life.ageing.at("turns", lived.failure)) - turns,
        event=int(lived.failed),
        initiation_time=lived.life.initiation,
        spall_length=length,
        spall_depth=depth,
        stage=int(length > 0) + int(length > lived.life.law.critical),
        overloaded=int(lived.load_ratio * lived.load[number] > HIGHEST_RATIO),
    )
    specimen = replace(specimen, properties=specimen.properties | worn)
    specimen = (
        replace(specimen, spalls=(replace(spall, width=length, depth=depth),)) if length else specimen.at_severity(0)
    )
    conditions = replace(
        conditions,
        load=conditions.load * float(lived.load[number]),
        shaft_rate=conditions.shaft_rate * float(lived.speed[number]),
        temperature=conditions.temperature + float(lived.warmer[number]),
    )
    return replace(scenario, specimen=specimen, record=replace(scenario.record, conditions=conditions, life=snapshot))
