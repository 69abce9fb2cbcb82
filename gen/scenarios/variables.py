"""Variables of a corpus that the scenario of a record tells."""

import math

from gen.corpus import FAULTS, SPLITS, Variable, identity
from gen.corpus.simulated import with_values
from gen.physics.bearing import FaultOrders, orders
from gen.scenarios.model import Scenario


def _bearing(scenario: Scenario) -> str:
    name = scenario.rig.bearing.designation
    return name if scenario.record.life is None else f"{name} #{scenario.specimen.number}"


def _identity(scenario: Scenario) -> str:
    numbers = scenario.rig.number, scenario.specimen.number, scenario.record.number, scenario.record.pair
    return identity(scenario.settings.corpus, *numbers)


def _of_rig(scenario: Scenario, value: float) -> float:
    """A value of the rig in records whose level is not drawn, else NaN."""
    return value if scenario.record.snr is None else math.nan


LABELS = (
    *with_values(
        sample_rate=lambda of: of.settings.sample_rate,
        **{name: lambda of, name=name: getattr(orders(of.rig.bearing), name) for name in FaultOrders._fields},
        bearing=_bearing,
        fault=lambda of: FAULTS.index(of.specimen.fault),
        n_spalls=lambda of: len(of.specimen.spalls),
        rig=lambda of: of.rig.number,
        specimen=lambda of: of.specimen.number,
        recording=lambda of: of.record.number,
        split=lambda of: SPLITS.index(of.specimen.split),
        source=lambda of: f"{of.settings.recipe}/{of.record.number}",
        identity=_identity,
        pair=lambda of: of.record.pair,
        fault_tries=lambda of: of.specimen.fault_try,
        level_tries=lambda of: of.record.level_try,
    ),
    Variable("axial_load", "f8", "N", "operating", "axial load", lambda of: of.record.conditions.axial_load),
    Variable("temperature", "f8", "degC", "operating", "temperature of the oil in the contacts, NaN without a lubricant",
        lambda of: None if of.rig.lubricant is None else of.record.conditions.temperature),
    Variable("gain", "f8", "1", "operating", "factor of the sensor on the acceleration, NaN if unknown",
        lambda of: _of_rig(of, of.rig.gain)),
    Variable("background_rms", "f8", "m s-2", "latent", "rms of the noise of the machine, before the gain; NaN if drawn per record",
        lambda of: _of_rig(of, of.rig.background_rms)),
    Variable("parts", "str", "1", "label", "parts that are damaged, joined by +, empty if healthy",
        lambda of: "+".join(of.specimen.damaged_parts)),
    Variable("diametral_clearance", "f8", "m", "latent", "diametral internal clearance as built, negative if preloaded",
        lambda of: of.specimen.properties["diametral_clearance"]),
    Variable("rung", "i4", "1", "provenance", "place of the severity in corpus.rungs of the recipe, -1 outside a group",
        lambda of: of.record.rung),
)  # fmt: skip
"""Each is computed from a :class:`Scenario`."""
