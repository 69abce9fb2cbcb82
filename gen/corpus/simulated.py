"""Variables that readers know, and that a corpus may have beside those of every corpus.

All others are declared beside the stage or mechanism of the simulator that knows them. Readers take their names, units, roles and meanings
from the corpus.
"""

from collections.abc import Callable
from typing import Any

from gen.corpus.fault_classes import UNKNOWN
from gen.corpus.schema import DRAWS, SCHEMA, Variable

UNJUDGED = 2
"""Value of ``detectable`` of a fault that was not judged."""
_SEEN = {0: "no", 1: "yes", UNJUDGED: "unjudged"}

SIMULATED = (
    Variable("true_shaft_rate", "f8", "Hz", "latent", "mean shaft rate of the record"),
    Variable("first_shaft_rate", "f8", "Hz", "latent", "shaft rate at the start of the record, wander aside"),
    Variable("last_shaft_rate", "f8", "Hz", "latent", "shaft rate at the end of the record, wander aside"),
    Variable("detectable", "i1", "1", "latent", "whether the fault can be seen in the record", flags=_SEEN),
    Variable("clipped", "i4", "1", "latent", "samples at the limits of the converter"),
    Variable("pair", "i4", "1", "provenance", "number of the group of records that differ in their fault's severity alone, -1 without"),
    Variable("oversampling", "i4", "1", "provenance", "integration steps per sample"),
    Variable("step_error", "f8", "1", "provenance", "relative rms change of the bodies' motion at half the step, NaN if not tried"),
    Variable("fault_tries", "i2", "1", "provenance", "faults drawn before this one, which could not be seen"),
    Variable("level_tries", "i2", "1", "provenance", "levels drawn before this one, at which the fault could not be seen"),
    Variable(DRAWS, "str", "1", "provenance", "the whole scenario of the record, as JSON"),
)  # fmt: skip
"""Of simulated corpora."""


LIFE = (
    Variable("age", "f8", "s", "operating", "time since the first turn of the bearing"),
    Variable("rul", "f8", "s", "label", "remaining life: time to the failure of the bearing, NaN if not known"),
    Variable("rul_revolutions", "f8", "1", "label", "turns of the shaft to the failure of the bearing, NaN if not known"),
    Variable("event", "i1", "1", "label", "how the test of the bearing ended", flags={0: "censored", 1: "failed", 2: UNKNOWN}),
    Variable("initiation_time", "f8", "s", "label", "age of the bearing at which its spall begins"),
    Variable("spall_length", "f8", "m", "label", "length of the spall along the rolling direction, 0 before it begins"),
    Variable("spall_depth", "f8", "m", "label", "depth of the spall, 0 before it begins"),
    Variable("stage", "i1", "1", "label", "stage of the damage", flags={0: "intact", 1: "spalled", 2: "critical", 3: UNKNOWN}),
    Variable("first_detectable_time", "f8", "s", "label", "age at the first snapshot whose spall can be seen, NaN if in none"),
    Variable("overloaded", "i1", "1", "latent", "whether the load is above the validity of ISO 281", flags={0: "no", 1: "yes", 2: UNKNOWN}),
)  # fmt: skip
"""Of corpora whose records are snapshots of lives."""


def with_values(**values: Callable[[Any], Any] | None) -> tuple[Variable, ...]:
    """Variables of the format, each with the function that a stage of the simulator has for its value."""
    declared = {variable.name: variable for variable in SCHEMA + SIMULATED}
    return tuple(declared[name]._replace(value=value) for name, value in values.items())
