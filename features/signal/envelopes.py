"""Envelope spectrum of a band of records in one call: Fourier coefficients, analytic signal of the band, spectrum of its envelope."""

from __future__ import annotations

from features.signal.demodulation import analytic_band, envelope_spectrum, squared_envelope_spectrum
from features.signal.door import Band, Positive, Rows, checked
from features.signal.rows import FloatArray
from features.signal.spectra import fourier_coefficients


@checked
def band_envelope_spectrum(x: Rows, fs: Positive, band: Band, *, squared: bool = False) -> tuple[FloatArray, Rows]:
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
    duration, (low, high) = x.shape[1] / fs, band
    if not 0 <= low < min(high, fs / 2) or round(low * duration) >= round(min(high, fs / 2) * duration):
        raise ValueError(
            f"band: {low:g}-{high:g} Hz holds no frequency of these records; give one below {fs / 2:g} Hz."
        )
    z = analytic_band(fourier_coefficients(x, fs, high), round(low * duration), round(high * duration))
    return (squared_envelope_spectrum if squared else envelope_spectrum)(z, z.shape[1] / duration)
