"""Envelope spectrum of a band of records in one call: Fourier coefficients, analytic signal of the band, spectrum of its envelope."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from features.signal.arguments import as_records, band_ends, check_positive, like
from features.signal.demodulation import amplitude_spectrum, analytic_band
from features.signal.rows import FloatArray, squared_modulus
from features.signal.spectra import fourier_coefficients
from gen.support.rounding import rounded_down


def band_envelope_spectrum(
    x: ArrayLike, fs: float, band: tuple[float, float], *, squared: bool = False
) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz], shape (frequency,), and amplitude spectrum of the envelope of a band, shape (record, frequency).

    Parameters
    ----------
    x
        Records, shape (record, time).
    fs
        Sample rate [Hz].
    band
        Lower and upper edge [Hz]; it ends at half the sample rate.
    squared
        Of the squared envelope, in the squared unit of the records.

    Raises
    ------
    ValueError
        If no frequency lies in the band.
    """
    check_positive(fs=fs)
    records, (low, high) = as_records(x), band_ends(band)
    duration, high = records.shape[1] / fs, min(high, fs / 2)
    if low >= high or round(low * duration) >= round(high * duration):
        raise ValueError(
            f"band: {low:g}-{high:g} Hz holds no frequency of these records; give one below {rounded_down(fs / 2)} Hz."
        )
    z = analytic_band(fourier_coefficients(records, fs, high), round(low * duration), round(high * duration))
    power = squared_modulus(z)
    frequencies, spectrum = amplitude_spectrum(power if squared else np.sqrt(power), z.shape[1] / duration)
    return frequencies, like(x, spectrum)
