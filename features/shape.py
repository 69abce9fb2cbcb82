"""Shape of a signal whatever repeats in it: impulsiveness, slow fluctuation, statistics in time.

Impacts make the tails of a signal heavy (kurtosis, crest factor); a load zone, a cage or a machine at work
makes its power wander slowly against the turn of the shaft [1]_.

.. [1] R. B. Randall, *Vibration-based Condition Monitoring*, 2nd ed., Wiley, 2021, sections 3.3 and 5.5.
"""

import numpy as np

from features.spectra import ComplexArray, FloatArray

SHAPE_NAMES = ("impulsiveness", "slow_fluctuation", "slow_share")
SMOOTHING_TURNS = 0.5
SLOW_ORDERS = 0.8

TIME_NAMES = (
    "rms",
    "peak",
    "crest_factor",
    "kurtosis",
    "skewness",
    "shape_factor",
    "impulse_factor",
    "clearance_factor",
)


def envelope_shape(z: ComplexArray, spectrum: FloatArray, rate: float, shaft_rate: FloatArray) -> FloatArray:
    """Shape of the envelope of analytic signals: the three of `SHAPE_NAMES`, shape (record, 3).

    Impulsiveness is ``ln(E|z|^4 / (E|z|^2)^2)``, ln 2 for Gaussian noise; slow fluctuation is the relative
    standard deviation of ``|z|^2`` averaged over half a turn; slow share is the part of the power of the
    envelope, without its mean, below 0.8 order.

    Parameters
    ----------
    z
        Analytic signals, shape (record, time).
    spectrum
        Their `features.spectra.envelope_spectrum`, shape (record, frequency).
    rate
        Sample rate of z [Hz].
    shaft_rate
        Shape (record,) [Hz].
    """
    power = z.real**2 + z.imag**2
    power /= np.maximum(power.mean(axis=-1, keepdims=True), np.finfo(power.dtype).tiny)
    impulsiveness = np.log(np.maximum(np.mean(power**2, axis=-1), 1.0))
    span = np.maximum(1, np.rint(SMOOTHING_TURNS * rate / shaft_rate)).astype(np.intp)
    resolution = 0.5 * rate / (spectrum.shape[-1] - 1)
    slow_bins = SLOW_ORDERS * shaft_rate / resolution
    return np.stack([impulsiveness, _fluctuation(power, span), _share_below(spectrum, slow_bins)], axis=-1)


def _fluctuation(power: FloatArray, span: np.ndarray) -> FloatArray:
    """Deviation of means over ``span`` samples from one another, taken at every quarter of a span."""
    step = np.maximum(1, span // 4)
    count = np.maximum(1, (power.shape[-1] - span) // step + 1)
    place = np.arange(count.max())
    start = np.minimum(place, count[:, None] - 1) * step[:, None]
    stop = np.minimum(start + span[:, None], power.shape[-1])
    total = np.zeros((len(power), power.shape[-1] + 1))
    np.cumsum(power, axis=-1, out=total[:, 1:])
    means = np.take_along_axis(total, stop, axis=-1) - np.take_along_axis(total, start, axis=-1)
    return np.std(means / (stop - start), axis=-1, where=place < count[:, None])


def _share_below(spectrum: FloatArray, bins: FloatArray) -> FloatArray:
    power = spectrum**2
    reach = np.arange(min(int(bins.max()) + 1, spectrum.shape[-1]))
    slow = np.sum(power[:, reach], axis=-1, where=reach < bins[:, None])
    return slow / np.maximum(power.sum(axis=-1), np.finfo(power.dtype).tiny)


def time_statistics(x: FloatArray) -> FloatArray:
    """Statistics of records less their mean, in the order of `TIME_NAMES`, shape (record, 8).

    Root mean square and peak are in the unit of x, the others free of gain; shape, impulse and clearance
    factor are the rms over the mean modulus, the peak over the mean modulus and the peak over the squared
    mean root of the modulus.
    """
    centred = x - x.mean(axis=-1, keepdims=True)
    modulus = np.abs(centred)
    rms = np.sqrt(np.mean(centred**2, axis=-1))
    peak, mean = modulus.max(axis=-1), modulus.mean(axis=-1)
    kurtosis, skewness = standardised_moments(centred)
    root = np.mean(np.sqrt(modulus), axis=-1) ** 2
    factors = (rms / mean, peak / mean, peak / root)
    return np.stack([rms, peak, peak / rms, kurtosis, skewness, *factors], axis=-1)


def standardised_moments(x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Kurtosis (3 for Gaussian noise) and skewness of records of zero mean, each of shape (record,)."""
    square = x * x
    power = square.mean(axis=-1)
    return np.mean(square * square, axis=-1) / power**2, np.mean(square * x, axis=-1) / power**1.5
