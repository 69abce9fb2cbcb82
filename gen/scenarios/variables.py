"""Variables of a corpus that the scenario of a record tells."""

import math

from gen.corpus import FAULTS, SPLITS, Variable, identity
from gen.corpus.simulated import with_values
from gen.mechanisms.background.machine_conditions import conditions_named
from gen.physics.bearing import FaultOrders, orders
from gen.physics.rating import static_rating
from gen.scenarios.scenario import Scenario


def _bearing(scenario: Scenario) -> str:
    name = scenario.drawing.designation
    return name if scenario.origin.life is None else f"{name} #{scenario.origin.specimen}"


def _identity(scenario: Scenario) -> str:
    origin = scenario.origin
    return identity(origin.corpus, origin.rig, origin.specimen, origin.record, origin.pair)


def _of_level(scenario: Scenario, name: str) -> float:
    """A value of a level that is not drawn as a ratio, else NaN."""
    return scenario.recipe.level.si().get(name, math.nan)


LABELS = (
    *with_values(
        sample_rate=lambda of: of.recipe.recording.sample_rate_hz,
        **{name: lambda of, name=name: getattr(orders(of.drawing), name) for name in FaultOrders._fields},
        bearing=_bearing,
        fault=lambda of: FAULTS.index(of.fault),
        n_spalls=lambda of: len(of.spalls),
        rig=lambda of: of.origin.rig,
        specimen=lambda of: of.origin.specimen,
        recording=lambda of: of.origin.record,
        split=lambda of: SPLITS.index(of.origin.split),
        source=lambda of: f"{of.recipe.name}/{of.origin.record}",
        identity=_identity,
        pair=lambda of: of.origin.pair,
        fault_tries=lambda of: of.origin.fault_try,
        level_tries=lambda of: of.origin.level_try,
    ),
    Variable("axial_load", "f8", "N", "operating", "axial load", lambda of: of.conditions["axial_load"]),
    Variable("temperature", "f8", "degC", "operating", "temperature of the oil in the contacts, NaN without a lubricant",
        lambda of: None if of.recipe.contact.lubricant is None else of.conditions["temperature"]),
    Variable("gain", "f8", "1", "operating", "factor of the sensor on the acceleration, NaN if unknown",
        lambda of: _of_level(of, "gain")),
    Variable("background_rms", "f8", "m s-2", "latent", "rms of the noise of the machine, before the gain; NaN if drawn per record",
        lambda of: _of_level(of, "background")),
    Variable("parts", "str", "1", "label", "parts that are damaged, joined by +, empty if healthy",
        lambda of: "+".join(of.damaged_parts)),
    Variable("machine_condition", "str", "1", "label", "conditions of the machine, whatever that of its bearing, joined by +, or sound",
        lambda of: conditions_named(of.recipe, static_rating(of.drawing))),
    Variable("diametral_clearance", "f8", "m", "latent", "diametral internal clearance as built, negative if preloaded",
        lambda of: of.properties["diametral_clearance"]),
    Variable("rung", "i4", "1", "provenance", "place of the severity in corpus.rungs of the recipe, -1 outside a group",
        lambda of: of.origin.rung),
)  # fmt: skip
"""Each is computed from a :class:`Scenario`."""
