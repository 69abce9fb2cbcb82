"""Gains of bearing and background of a record from its drawn level, and levels from the gains, by the mean products of its parts.

The products are exact: parts that are correlated over a short record neither raise nor lower its rms.
"""

import math
from collections.abc import Sequence

from gen.corpus.schema import Variable
from gen.corpus.simulated import with_values
from gen.physics.elementary import decibels

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
"""Variables of the corpus, attributes of a :class:`gen.measurement.measure.Measured`."""


Gains = tuple[float, float]
"""Gains of bearing and background [1]."""
Products = Sequence[float]
"""Those of :class:`gen.measurement.mixing.Parts`."""


def gains_of(products: Products, ratio: float, rms: float) -> Gains:
    """Gains of bearing and background [1] that give a record its drawn ratio [dB] and rms [m s-2].

    The ratio is that of the fault (d) over all else, which is the healthy bearing (h) and the background (n): with the bearing ``q``
    times as strong as the background, ``q^2 dd = r^2 (q^2 hh + 2 q hn + nn)``. A record without a fault, or of which the fault's own
    part is not known, has the ratio of the bearing over the background.
    """
    square, least = 10 ** (ratio / 10), SILENCE**2
    nn, hn, hh, *_, dd = products
    left = dd - square * hh
    nn, hh = max(nn, least), max(hh, least)
    if dd <= least:
        q = math.sqrt(square * nn / hh)
    elif left <= 0.01 * dd:
        # No gain is enough for a fault that is too weak beside its healthy bearing: bearing and background get the same rms.
        q = math.sqrt(nn / hh)
    else:
        half = square * hn
        q = (half + math.sqrt(half**2 + left * square * nn)) / left
    scale = rms / max(rms_of(products, q, q, 1.0), SILENCE)
    return q * scale, scale


def rms_of(products: Products, fault: float, healthy: float, background: float) -> float:
    """Rms of the sum of three parts with these gains [m s-2]."""
    nn, hn, hh, dn, dh, dd = products
    d, h, n = fault, healthy, background
    return math.sqrt(max(h * h * hh + 2 * h * n * hn + n * n * nn + d * d * dd + 2 * d * h * dh + 2 * d * n * dn, 0.0))


def bearing_over_background(products: Products, gains: Gains, rounding: float) -> float:
    """Rms of the whole bearing signal over that of the background, or over the converter's ``rounding`` if that is larger [dB].

    NaN if either is silent or not finite.
    """
    bearing, background = gains
    background = max(rms_of(products, 0.0, 0.0, background), rounding)
    level = level_of_ratio(rms_of(products, bearing, bearing, 0.0), background)
    return level if level > -math.inf else math.nan


def fault_over_rest(products: Products, gains: Gains, rounding: float) -> tuple[float, float]:
    """Rms of what the fault adds over that of all else [dB], and its share of the sum of both powers [1]; NaN where they are silent."""
    bearing, background = gains
    fault, rest = rms_of(products, bearing, 0.0, 0.0), max(rms_of(products, 0.0, bearing, background), rounding)
    whole = fault**2 + rest**2
    return level_of_ratio(fault, rest), fault**2 / whole if 0 < whole < math.inf else math.nan


def level_of_ratio(part: float, rest: float) -> float:
    """Level of one rms over another [dB]; minus infinity if the first alone is silent, NaN if the second is silent or either not finite."""
    if not (math.isfinite(part) and math.isfinite(rest)) or rest <= SILENCE:
        return math.nan
    return float(decibels(part / rest)) if part > SILENCE else -math.inf
