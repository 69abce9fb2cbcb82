"""Gains of bearing and background of a record, from the drawn level and the mean products of its parts.

The products are exact: parts that are correlated over a short record neither raise nor lower its rms.
"""

import math

from gen.corpus.schema import Variable
from gen.corpus.simulated import with_values
from gen.measurement.mixing import Products
from gen.physics.elementary import decibels
from gen.scenarios import Gains, Scenario

SILENCE = 1e-30  # m s-2; a smaller rms counts as no signal

# 20 log10 of the ratio of two rms; CF has no unit for levels
_SNR = "bearing over background or rounding of the converter in decibels re 1, NaN without either or in silence"
_FAULT_SNR = "what the fault adds over all else of the record in decibels re 1, NaN without a fault or if not known"
LABELS = (
    Variable("snr", "f8", "1", "latent", _SNR),
    Variable("fault_snr", "f8", "1", "latent", _FAULT_SNR),
    Variable("fault_share", "f8", "1", "latent", "power of what the fault adds over its sum with that of all else, NaN if not known"),
    *with_values(detectable=None, clipped=None),
)  # fmt: skip
"""Variables of the corpus, arrays of a :class:`gen.measurement.measure.Measured`."""


def gains_of(scenario: Scenario, products: Products) -> Gains:
    """Gains that a record has already, or that give it its drawn level.

    With ``level.kind: snr``, the drawn ratio is that of the fault (d) over all else, which is the healthy bearing (h) and the background
    (n): with the bearing ``q`` times as strong as the background, ``q^2 dd = r^2 (q^2 hh + 2 q hn + nn)``. A record without a fault, or
    of which the fault's own part is not known, has the ratio of the bearing over the background.
    """
    rig, record = scenario.rig, scenario.record
    if record.gains is not None:
        return record.gains
    if record.snr is None or record.rms is None:
        return Gains(rig.gain, rig.gain * rig.background_rms)
    square = 10 ** (record.snr / 10)
    least = SILENCE**2
    nn = max(products.nn, least)
    bearing_alone = math.sqrt(square * nn / max(products.hh, least))
    gains = Gains(bearing_alone if products.dd <= least else _ratio_of_fault(products, square, nn), 1.0)
    whole = math.sqrt(max(mean_square(products, gains), least))
    return Gains(gains.bearing * record.rms / whole, gains.background * record.rms / whole)


def _ratio_of_fault(products: Products, square: float, nn: float) -> float:
    """Gain of the bearing over that of the background, for a drawn ratio with the given square.

    No gain is enough if the fault is too weak beside the healthy bearing. Then both the bearing without its fault and the background have
    the same rms.
    """
    left = products.dd - square * products.hh
    if left <= 0.01 * products.dd:
        return math.sqrt(nn / max(products.hh, SILENCE**2))
    half = square * products.hn
    return (half + math.sqrt(half**2 + left * square * nn)) / left


def mean_square(products: Products, gains: Gains, *, fault: bool = True) -> float:
    """Mean square of a record, with or without what the fault adds [m2 s-4]."""
    b, n = gains.bearing, gains.background
    rest = b * b * products.hh + 2 * b * n * products.hn + n * n * products.nn
    if not fault:
        return rest
    return rest + b * b * products.dd + 2 * b * b * products.dh + 2 * b * n * products.dn


def bearing_over_background(products: Products, gains: Gains, rounding: float) -> float:
    """Rms of the whole bearing signal over that of the background, or over the converter's ``rounding`` if that is larger [dB].

    NaN if either is silent or not finite.
    """
    bearing = gains.bearing * math.sqrt(max(products.dd + 2 * products.dh + products.hh, 0.0))
    if bearing <= SILENCE:
        return math.nan
    return level_of_ratio(bearing, max(gains.background * math.sqrt(max(products.nn, 0.0)), rounding))


def fault_over_rest(products: Products, gains: Gains, rounding: float) -> tuple[float, float]:
    """Rms of what the fault adds over that of all else [dB], and its share of the sum of both powers [1]; NaN where they are silent."""
    fault = gains.bearing * math.sqrt(max(products.dd, 0.0))
    rest = max(math.sqrt(max(mean_square(products, gains, fault=False), 0.0)), rounding)
    whole = fault**2 + rest**2
    return level_of_ratio(fault, rest), fault**2 / whole if 0 < whole < math.inf else math.nan


def level_of_ratio(part: float, rest: float) -> float:
    """Level of one rms over another [dB]; minus infinity if the first alone is silent, NaN if the second is silent or either not finite."""
    if not (math.isfinite(part) and math.isfinite(rest)) or rest <= SILENCE:
        return math.nan
    return float(decibels(part / rest)) if part > SILENCE else -math.inf
