"""Variables that a simulated corpus holds beside those of every corpus.

:mod:`gen.generation.labels` fills them; ``docs/format.md`` lists them.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from gen.corpus.fault_classes import UNKNOWN
from gen.corpus.schema import DRAWS, Variable, class_names

# 20 log10 of the ratio of two rms; CF has no unit for levels
_SNR = "bearing over background or rounding of the converter in decibels re 1, NaN without either or in silence"
_FAULT_SNR = "what the fault adds over all else of the record in decibels re 1, NaN without a fault or if not known"

UNJUDGED = 2
"""Value of ``detectable`` of a fault that was not judged."""
_SEEN = {0: "no", 1: "yes", UNJUDGED: "unjudged"}

SIMULATED = (
    Variable("axial_load", "f8", "N", "operating", "axial load"),
    Variable("temperature", "f8", "degC", "operating", "temperature of the oil in the contacts, NaN without a lubricant"),
    Variable("parts", "str", "1", "label", "parts that are damaged, joined by +, empty if healthy"),
    Variable("largest_drop", "f8", "m", "label", "largest drop of a rigid ball over the widest spall, 0 without a spall"),
    Variable("width_share", "f8", "1", "label", "width of the widest spall over that from ball to ball, or round a ball; 0 without"),
    Variable("true_shaft_rate", "f8", "Hz", "latent", "mean shaft rate of the record"),
    Variable("first_shaft_rate", "f8", "Hz", "latent", "shaft rate at the start of the record, wander aside"),
    Variable("last_shaft_rate", "f8", "Hz", "latent", "shaft rate at the end of the record, wander aside"),
    Variable("true_ftf", "f8", "1", "latent", "mean fundamental train frequency in shaft orders, slip included"),
    Variable("true_bpfo", "f8", "1", "latent", "mean ball pass frequency of the outer race in shaft orders, slip included"),
    Variable("true_bpfi", "f8", "1", "latent", "mean ball pass frequency of the inner race in shaft orders, slip included"),
    Variable("true_bsf", "f8", "1", "latent", "mean ball spin frequency in shaft orders"),
    Variable("snr", "f8", "1", "latent", _SNR),
    Variable("fault_snr", "f8", "1", "latent", _FAULT_SNR),
    Variable("fault_share", "f8", "1", "latent", "power of what the fault adds over its sum with that of all else, NaN if not known"),
    Variable("loaded_hits", "i4", "1", "latent", "expected number of passages of loaded balls over spalls, -1 if not known"),
    Variable("detectable", "i1", "1", "latent", "whether the fault can be seen in the record", _SEEN),
    Variable("gain", "f8", "1", "operating", "factor of the sensor on the acceleration, NaN if unknown"),
    Variable("background_rms", "f8", "m s-2", "latent", "rms of the noise of the machine, before the gain; NaN if drawn per record"),
    Variable("diametral_clearance", "f8", "m", "latent", "diametral internal clearance as built, negative if preloaded"),
    Variable("operating_clearance", "f8", "m", "latent", "diametral clearance in operation: warm, oiled, under axial load"),
    Variable("clipped", "i4", "1", "latent", "samples at the limits of the converter"),
    Variable("pair", "i4", "1", "provenance", "number of the group of records that differ in their fault's severity alone, -1 without"),
    Variable("rung", "i4", "1", "provenance", "place of the severity in corpus.rungs of the recipe, -1 outside a group"),
    Variable("oversampling", "i4", "1", "provenance", "integration steps per sample"),
    Variable("step_phase", "f8", "rad", "provenance", "bound of the fastest angular frequency of the record times the step"),
    Variable("step_error", "f8", "1", "provenance", "relative rms change of the bodies' motion at half the step, NaN if not tried"),
    Variable("fault_tries", "i2", "1", "provenance", "faults drawn before this one, which could not be seen"),
    Variable("level_tries", "i2", "1", "provenance", "levels drawn before this one, at which the fault could not be seen"),
    Variable(DRAWS, "str", "1", "provenance", "the whole scenario of the record, as JSON"),
)  # fmt: skip


LIFE = (
    Variable("age", "f8", "s", "operating", "time since the first turn of the bearing"),
    Variable("rul", "f8", "s", "label", "remaining life: time to the failure of the bearing, NaN if not known"),
    Variable("rul_revolutions", "f8", "1", "label", "turns of the shaft to the failure of the bearing, NaN if not known"),
    Variable("event", "i1", "1", "label", "how the test of the bearing ended", {0: "censored", 1: "failed", 2: UNKNOWN}),
    Variable("initiation_time", "f8", "s", "label", "age of the bearing at which its spall begins"),
    Variable("spall_length", "f8", "m", "label", "length of the spall along the rolling direction, 0 before it begins"),
    Variable("spall_depth", "f8", "m", "label", "depth of the spall, 0 before it begins"),
    Variable("stage", "i1", "1", "label", "stage of the damage", {0: "intact", 1: "spalled", 2: "critical", 3: UNKNOWN}),
    Variable("first_detectable_time", "f8", "s", "label", "age at the first snapshot whose spall can be seen, NaN if in none"),
    Variable("overloaded", "i1", "1", "latent", "whether the load is above the validity of ISO 281", {0: "no", 1: "yes", 2: UNKNOWN}),
)  # fmt: skip
"""Variables of corpora whose records are snapshots of lives."""


def unknown_value(dtype: np.dtype[Any], attributes: Mapping[Any, Any]) -> Any:
    """Value of a variable in records of a corpus that lacks it: empty text, NaN, ``unjudged`` or ``unknown`` of a class, or else -1.

    >>> unknown_value(np.dtype("f8"), {}), unknown_value(np.dtype("i4"), {}), unknown_value(np.dtype("O"), {})
    (nan, -1, '')
    """
    if dtype.kind == "f":
        return np.nan
    if dtype.kind not in "iu":
        return ""
    names = class_names(attributes).items()
    return next((code for code, name in names if name in ("unjudged", UNKNOWN)), -1)
