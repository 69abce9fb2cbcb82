"""Variables that a simulated corpus holds beside those of every corpus.

:mod:`gen.labels` fills them; ``docs/format.md`` lists them.
"""

from gen.corpus.schema import DRAWS, Variable

SIMULATED = (
    Variable("axial_load", "f8", "N", "operating", "axial load"),
    Variable("temperature", "f8", "degC", "operating", "temperature of the oil in the contacts, NaN without a lubricant"),
    Variable("parts", "str", "1", "label", "parts that are damaged, joined by +, empty if healthy"),
    Variable("largest_drop", "f8", "m", "label", "largest drop of a rigid ball over the widest spall, 0 without a spall"),
    Variable("width_share", "f8", "1", "label", "width of the widest spall over that from ball to ball, or round a ball; 0 without"),
    Variable("wear", "f8", "m", "label", "rms waviness of a worn race, 0 if none is"),
    Variable("pitch_error", "f8", "rad", "label", "angle by which a ball is out of its place in a broken cage"),
    Variable("knock", "f8", "N", "label", "typical knock of a broken cage on the housing"),
    Variable("true_shaft_rate", "f8", "Hz", "latent", "mean shaft rate of the record"),
    Variable("first_shaft_rate", "f8", "Hz", "latent", "shaft rate at the start of the record, wander aside"),
    Variable("last_shaft_rate", "f8", "Hz", "latent", "shaft rate at the end of the record, wander aside"),
    Variable("true_ftf", "f8", "1", "latent", "mean fundamental train frequency in shaft orders, slip included"),
    Variable("true_bpfo", "f8", "1", "latent", "mean ball pass frequency of the outer race in shaft orders, slip included"),
    Variable("true_bpfi", "f8", "1", "latent", "mean ball pass frequency of the inner race in shaft orders, slip included"),
    Variable("true_bsf", "f8", "1", "latent", "mean ball spin frequency in shaft orders"),
    Variable("snr", "f8", "dB", "latent", "bearing over background or rounding of the converter, NaN without either or in silence"),
    Variable("diametral_clearance", "f8", "m", "latent", "diametral internal clearance as built, negative if preloaded"),
    Variable("operating_clearance", "f8", "m", "latent", "diametral clearance in operation: warm, oiled, under axial load"),
    Variable("clipped", "i4", "1", "latent", "samples at the limits of the converter"),
    Variable("pair", "i4", "1", "provenance", "number of the group of records that differ in their fault's severity alone, -1 without"),
    Variable("rung", "i4", "1", "provenance", "place of the severity in corpus.rungs of the recipe, -1 outside a group"),
    Variable("oversampling", "i4", "1", "provenance", "integration steps per sample"),
    Variable("step_phase", "f8", "rad", "provenance", "bound of the fastest angular frequency of the record times the step"),
    Variable("step_error", "f8", "1", "provenance", "relative rms change of the bodies' motion at half the step, NaN if not tried"),
    Variable(DRAWS, "str", "1", "provenance", "every drawn value of the record, as JSON"),
)  # fmt: skip
