"""Draw the life of a specimen, and put its records into it: each is a snapshot in which the damage is frozen."""

import math
from collections.abc import Mapping
from statistics import NormalDist
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
from gen.support.units import UNITS, decibel_to_ratio, split_unit, to_si

FloatArray = NDArray[np.floating]
_TRIES = 1000
_HISTORIES = ("first_length", "load", "speed", "temperature", "growth", "background", "knocks")


class Aged(NamedTuple):
    """A specimen at a snapshot of its life."""

    sections: dict[str, Any]
    snapshot: Snapshot
    load: float
    """Factor of the load."""
    speed: float
    """Factor of the speed."""
    warmer: float
    """Rise of the temperature [K]."""
    louder: float
    """Rise of the noise of the machine [dB]."""


def draw_life(recipe: Recipe, specimen: Any, bearing: Bearing, conditions: Mapping[str, Any]) -> list[Aged]:
    """Snapshots of the life of a ``specimen`` under its ``conditions`` without histories; its recipe has a drawn fault.

    Raises
    ------
    RecipeError
        If the load is above the dynamic rating, or hardly any bearing is alive when the snapshots begin.
    """
    section: Any = recipe.life
    number, slots = specimen.origin.specimen, recipe.corpus.records_per_specimen
    first_length, *rngs = (stream(recipe.seed, "specimen", number, f"life.{name}") for name in _HISTORIES)
    draws = Draws(recipe.seed, "specimen", number, Combination(number), [])
    drawn, element = section.draw(draws.within("life", "specimen")).si(), bearing.rolling_element
    # above its whole rating a bearing is in an overload test
    ratio = conditions["load"] / (bearing.dynamic_rating or 1.0)
    if ratio > 1 and not section.accelerated:
        raise RecipeError(
            f"specimen {number}: its load is {ratio:.3g} times the dynamic rating; lower operation.load_n, or say life.accelerated: true."
        )
    # histories are long enough for all snapshots that the recipe asks for
    step = drawn["history"] / STEPS
    count = 2 + int((drawn["entry"] + slots * to_si(section.cadence_h, "h")) / step)
    load, speed, warmer, noise, louder, knocking = (history(rng, count) for rng in rngs)
    load, speed = log_normal(load, drawn["load_history"]), log_normal(speed, drawn["speed_history"])
    # fatigue and growth as functions of the age
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
    (fault,) = specimen.faults
    (width,) = fault.si()["width"]
    # the spall begins at a scattered length, and ends where the recipe or the race does
    first = float(width) * math.exp(drawn["first_length_scatter"] * first_length.standard_normal())
    last = min(to_si(section.end.length_mm, "mm"), widest_spall(fault.part, bearing))
    # a bearing that failed before the watch began is not in the corpus
    for attempt in range(_TRIES):
        life = Life(sums, law, life_share(draws.u(f"life.share.{attempt}"), element), min(first, last))
        failure = life.age_at(last)
        if failure > drawn["entry"]:
            break
    else:
        raise RecipeError(f"specimen {number}: hardly any bearing lives until life.entry_h; lower it, or the load.")
    # snapshots up to the failure or the withdrawal
    ages = _snapshot_ages(section, drawn["entry"], slots, life.age_at(to_si(section.damaged_from_mm, "mm")))
    end = min(ages[-1], max(drawn["withdrawal"], drawn["entry"]))
    ages = ages[:-1][ages[:-1] <= min(failure, end)]
    # conditions at each snapshot, from the slow histories
    warmer, louder = drawn["temperature_history"] * warmer, drawn["background_history"] * louder
    load, speed, warmer, louder, knocking = (
        np.interp(ages, sums.age, each) for each in (load, speed, warmer, louder, knocking)
    )
    louder += drawn["louder_when_new"] * np.exp(-ages / drawn["running_in"])
    quiet = _quiet(specimen.background) if drawn["knocks_share"] < 1 else {}
    knocks_below = NormalDist().inv_cdf(min(max(drawn["knocks_share"], 1e-9), 1 - 1e-9))
    snapshots, all_turns = list[Aged](), float(sums.at("turns", failure))
    courses = (each.tolist() for each in (ages, load, speed, warmer, louder, knocking))
    for age, of_load, of_speed, rise, of_noise, knock in zip(*courses, strict=True):
        # the damage at this age, frozen for the length of the record
        turns, length = float(sums.at("turns", age)), float(life.length_at(age))
        grown = _grown(fault, length, drawn["full_depth"])
        (length,), (depth,) = (grown.si()[name].tolist() for name in ("width", "depth"))  # to the last bit
        snapshot = Snapshot.model_construct(
            age=age,
            rul=failure - age,
            rul_revolutions=all_turns - turns,
            event=int(failure <= end),
            initiation_time=life.initiation,
            spall_length=length,
            spall_depth=depth,
            stage=int(length > 0) + int(length > law.critical),
            overloaded=int(ratio * of_load > HIGHEST_RATIO),
        )
        clearance, waviness = (drawn[name] * (turns * ratio) for name in ("clearance", "waviness"))
        # wear opens the clearance and roughens the races with the turns under load
        worn = _plus(specimen.specimen, diametral_clearance_um=clearance, waviness_nm=waviness)
        sections = {"faults": (grown if length else sound(),), "specimen": worn}
        sections |= quiet if knock > knocks_below else {}
        snapshots.append(Aged(sections, snapshot, of_load, of_speed, rise, of_noise))
    return snapshots


def _snapshot_ages(section: Any, entry: float, count: int, damaged: float) -> FloatArray:
    """Ages at ``count`` snapshots and one more, which may be denser from the age ``damaged`` on, shape (snapshot,) [s]."""
    ages = entry + to_si(section.cadence_h, "h") * np.arange(count + 1)
    if section.damaged_cadence_h is not None:
        dense = int(np.searchsorted(ages, damaged))
        later = to_si(section.damaged_cadence_h, "h") * np.arange(count + 1 - dense)
        ages[dense:] = ages[min(dense, count)] + later
    return ages


def at_snapshot(scenario: Scenario, aged: Aged) -> Scenario:
    """A record as a snapshot of the life of its specimen."""
    operation: Any = scenario.recipe.operation
    level: Any = scenario.recipe.level
    changes = {"load_n": operation.load_n * aged.load, "shaft_rpm": operation.shaft_rpm * aged.speed}
    operation = _plus(operation.model_copy(update=changes), temperature_celsius=aged.warmer)
    if aged.louder:
        noise = level.background_m_s2 * float(decibel_to_ratio(aged.louder))
        level = level.model_copy(update={"background_m_s2": noise})
    origin = scenario.origin.model_copy(update={"life": aged.snapshot})
    return scenario.edited(origin=origin, operation=operation, level=level, **aged.sections)


def _quiet(background: Any) -> dict[str, Any]:
    """Background of a machine while it does not knock, if it ever does."""
    there = {name: None for name in ("knocks", "impulses") if getattr(background, name) is not None}
    return {"background": background.model_copy(update=there)} if there else {}


def _grown(fault: Any, length: float, full_depth: float) -> Any:
    """A fault whose spall has a ``length``, and the depth that it has there [m]."""
    (depth,) = fault.si()["depth"]
    depth = float(depth) * length / max(full_depth, length) if length else 0.0
    return fault.model_copy(
        update={"width_mm": (length / UNITS["mm"].factor,), "depth_um": (depth / UNITS["um"].factor,)}
    )


def _plus(section: Any, **values: float) -> Any:
    """A drawn section with some values that are larger by so much [SI]."""
    return section.model_copy(
        update={key: getattr(section, key) + more / split_unit(key)[1] for key, more in values.items()}
    )
