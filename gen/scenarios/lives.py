"""Draw the life of a specimen, and put its records into it: each is a snapshot in which the damage is frozen."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.drawing import Combination, Draws, stream
from gen.life.ageing import STEPS, Life, ageing, history, log_normal
from gen.life.fatigue import HIGHEST_RATIO, life_share
from gen.life.growth import Growth
from gen.mechanisms.faults.race_spalls import widest_spall
from gen.physics.bearing import Bearing
from gen.recipe import Recipe, Snapshot
from gen.scenarios.scenario import Scenario, sound
from gen.support.errors import RecipeError
from gen.support.units import UNITS, split_unit, to_si

FloatArray = NDArray[np.float64]
_TRIES = 1000
_HISTORIES = ("first_length", "load", "speed", "temperature", "growth")


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
    drawn: Mapping[str, Any]


def draw_life(recipe: Recipe, specimen: Recipe, bearing: Bearing, conditions: Mapping[str, Any]) -> SpecimenLife:
    """Life of a ``specimen`` under its ``conditions`` without histories; its recipe has a drawn fault.

    Raises
    ------
    RecipeError
        If the load is above the dynamic rating, or hardly any bearing is alive when the snapshots begin.
    """
    assert recipe.life is not None and specimen.origin is not None  # noqa: S101, PT018
    number = specimen.origin.specimen
    first_length, *rngs = (stream(recipe.seed, "specimen", number, f"life.{name}") for name in _HISTORIES)
    draws = Draws(recipe.seed, "specimen", number, Combination(number), [])
    drawn, element = recipe.life.draw(draws.within("life", "specimen")).si(), bearing.rolling_element
    slots, cadence = recipe.corpus.records_per_specimen, to_si(recipe.life.cadence_h, "h")
    ratio = conditions["load"] / (bearing.dynamic_rating or 1.0)
    if ratio > 1 and not recipe.life.accelerated:
        raise RecipeError(
            f"specimen {number}: its load is {ratio:.3g} times the dynamic rating; lower operation.load_n, or say life.accelerated: true."
        )
    step = drawn["history"] / STEPS
    count = 2 + int((drawn["entry"] + slots * cadence) / step)
    load, speed, warmer, noise = (history(rng, count) for rng in rngs)
    load, speed = log_normal(load, drawn["load_history"]), log_normal(speed, drawn["speed_history"])
    law = Growth(*(drawn[name] for name in ("growth", "growth_exponent", "critical", "acceleration")))
    sums = ageing(
        step,
        conditions["shaft_rate"] * speed,
        ratio * load,
        log_normal(noise, drawn["growth_noise"]),
        element=element,
        factor=drawn["a_iso"],
        load_exponent=drawn["load_exponent"],
    )
    fault: Any = specimen.faults[0]
    (width,) = fault.si()["width"]
    first = float(width) * math.exp(drawn["first_length_scatter"] * first_length.standard_normal())
    last = min(to_si(recipe.life.end.length_mm, "mm"), widest_spall(fault.part, bearing))
    for attempt in range(_TRIES):
        life = Life(sums, law, life_share(draws.u(f"life.share.{attempt}"), element), min(first, last))
        failure = life.age_at(last)
        if failure > drawn["entry"]:
            break
    else:
        raise RecipeError(f"specimen {number}: hardly any bearing lives until life.entry_h; lower it, or the load.")
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
    recipe, age = scenario.recipe, float(lived.ages[number])
    turns = float(lived.life.ageing.at("turns", age))
    wear = turns * lived.load_ratio
    clearance, waviness = (lived.drawn[name] * wear for name in ("clearance", "waviness"))
    fault: Any = recipe.faults[0]
    (depth,) = fault.si()["depth"]
    length = float(lived.life.length_at(age))
    depth = float(depth) * length / max(lived.drawn["full_depth"], length) if length else 0.0
    grown = fault.model_copy(
        update={"width_mm": (length / UNITS["mm"].factor,), "depth_um": (depth / UNITS["um"].factor,)}
    )
    (length,), (depth,) = (
        grown.si()[name].tolist() for name in ("width", "depth")
    )  # to the last bit those of the spall
    snapshot = Snapshot.model_construct(
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
    operation: Any = recipe.operation
    return scenario.edited(
        origin=scenario.origin.model_copy(update={"life": snapshot}),
        faults=(grown if length else sound(),),
        specimen=_plus(recipe.specimen, diametral_clearance_um=clearance, waviness_nm=waviness),
        operation=_plus(
            operation.model_copy(
                update={
                    "load_n": operation.load_n * float(lived.load[number]),
                    "shaft_rpm": operation.shaft_rpm * float(lived.speed[number]),
                }
            ),
            temperature_celsius=float(lived.warmer[number]),
        ),
    )


def _plus(section: Any, **values: float) -> Any:
    """A drawn section with some values that are larger by so much [SI]."""
    return section.model_copy(
        update={key: getattr(section, key) + more / split_unit(key)[1] for key, more in values.items()}
    )
