"""Shape of a signal independent of its periods: impulsiveness, slow fluctuation, statistics of the waveform.

Impacts make the distribution of a signal heavy-tailed (kurtosis, crest factor). A load zone, a cage or the process of a
machine modulates its power more slowly than the shaft turns [1]_.

.. [1] R. B. Randall, *Vibration-based Condition Monitoring*, 2nd ed., Wiley, 2021, sections 3.3 and 5.5.
"""

import numpy as np

from features.signal.demodulation import ZERO_PADDING
from features.signal.rows import PARTIAL_SUMS, FloatArray, row_kernel, total, total_with

SMOOTHING_TURNS = 0.5  # shaft revolutions over which the power is averaged
SLOW_ORDERS = 0.8  # order of the shaft below which a modulation is slow


def envelope_shape(
    power: FloatArray, weighted: FloatArray, spectrum: FloatArray, rate: float, shaft_rate: FloatArray
) -> FloatArray:
    """Shape of the envelope of analytic signals, in the order of `features.table.envelope_groups.SHAPES`, shape (record, 3).

    Impulsiveness is ``ln(E|z|^4 / (E|z|^2)^2)``, ln 2 for Gaussian noise. Slow fluctuation is the relative standard
    deviation of ``|z|^2`` averaged over half a revolution. Slow share is the fraction of the power of the envelope,
    without its mean, below 0.8 orders.

    Parameters
    ----------
    power
        Squared envelopes ``|z|^2``, shape (record, time).
    weighted
        Envelopes times their window, as from `features.signal.demodulation.weight_by_hann`, shape (record, time).
    spectrum
        Their `features.signal.demodulation.fine_amplitudes` from 0 to at least 0.8 orders, shape (record, frequency).
    rate
        Sample rate of z [Hz].
    shaft_rate
        Shape (record,) [Hz].
    """
    span = np.maximum(1, np.rint(SMOOTHING_TURNS * rate / shaft_rate)).astype(np.intp)
    n = power.shape[-1]
    slow_bins = SLOW_ORDERS * shaft_rate * ZERO_PADDING * n / rate
    return _envelope_shape(power, weighted, spectrum, span, slow_bins)


@row_kernel
def _envelope_shape(
    power: FloatArray, weighted: FloatArray, spectrum: FloatArray, span: np.ndarray, slow_bins: FloatArray
) -> FloatArray:
    out = np.empty((len(power), 3))
    n = power.shape[1]
    tiny = np.finfo(power.dtype).tiny
    for row in range(len(power)):
        mean = max(total(power[row]) / n, tiny)
        out[row, 0] = np.log(max(total(power[row] ** 2) / n / mean**2, 1.0))
        out[row, 1] = _fluctuation(power[row], span[row]) / mean
        whole = total(weighted[row] ** 2) * (8 * ZERO_PADDING / n)  # by Parseval, the sum over the whole spectrum
        out[row, 2] = total(spectrum[row, : int(np.ceil(slow_bins[row]))] ** 2) / max(whole, tiny)
    return out


@row_kernel
def _fluctuation(power: FloatArray, span: int) -> float:
    """Standard deviation of the means over ``span`` samples, taken at every quarter of a span."""
    step = max(1, span // 4)
    means, parts = np.empty(max(1, (len(power) - span) // step + 1)), np.empty(PARTIAL_SUMS)
    for number in range(len(means)):
        within = power[number * step : number * step + span]
        means[number] = total_with(within, parts) / len(within)
    return float(np.std(means))


def time_statistics(x: FloatArray) -> FloatArray:
    """Statistics of records without their mean, in the order of `features.table.waveform_groups.TIMES`, shape (record, 8).

    Root mean square and peak are in the unit of x; the others do not depend on gain. The shape factor is the rms over the
    mean modulus, the impulse factor the peak over the mean modulus, and the clearance factor the peak over the squared
    mean of the root of the modulus.
    """
    centred = x - x.mean(axis=-1, keepdims=True)
    modulus, root, square, cube, fourth = moments(centred).T
    peak, rms = peaks(centred), np.sqrt(square)
    factors = (rms / modulus, peak / modulus, peak / root**2)
    return np.stack([rms, peak, peak / rms, fourth / square**2, cube / square**1.5, *factors], axis=-1)


def peaks(x: FloatArray) -> FloatArray:
    """Largest modulus of each record, shape (record,)."""
    return np.maximum(x.max(axis=-1), -x.min(axis=-1))


@row_kernel
def moments(x: FloatArray) -> FloatArray:
    """Means of the modulus, its root, the square, the cube and the fourth power of records, shape (record, 5)."""
    out = np.empty((len(x), 5))
    for row in range(len(x)):
        modulus, root, square, cube, fourth = 0.0, 0.0, 0.0, 0.0, 0.0
        for i in range(x.shape[1]):
            size = abs(x[row, i])
            power = size * size
            modulus += size
            root += np.sqrt(size)
            square += power
            cube += power * x[row, i]
            fourth += power * power
        out[row] = np.array([modulus, root, square, cube, fourth]) / x.shape[1]
    return out
