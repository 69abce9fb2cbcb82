"""Recordings brought to another sample rate, with a sentence that names the filter."""

from fractions import Fraction

from gen.support.limits import check_limit
from raceway.importing.refused_files import FloatArray, UnusableError

FLAT = 0.84  # of the lower Nyquist frequency: the filter passes more than 99 % of the amplitude below
_FINEST = 10_000  # largest denominator of the ratio of two rates; its rounding is below 6e-5 of the rate
_WIDEST = 1000  # ratio of two rates


def resample(signal: FloatArray, fs: float, wanted: float) -> tuple[FloatArray, str]:
    """Signal at the rate ``wanted`` [Hz] along its last axis, and a sentence without its end on how it was obtained.

    The anti-alias filter is that of ``scipy.signal.resample_poly``: linear phase, Kaiser window with beta 5, half amplitude at the lower
    of the two Nyquist frequencies.

    Raises
    ------
    UnusableError
        If the rates are too far apart, or the result is above the limit ``file_bytes``.
    """
    from scipy.signal import resample_poly  # loads scipy.stats

    if not 1 / _WIDEST <= wanted / fs <= _WIDEST:
        raise UnusableError(f"is at {fs:g} Hz, too far from {wanted:g} Hz to be resampled")
    ratio = Fraction(wanted / fs).limit_denominator(_FINEST)
    check_limit("file_bytes", int(signal.nbytes * ratio), f"resampled to {wanted:g} Hz holds", UnusableError)
    up, down = ratio.numerator, ratio.denominator
    sentence = (
        f"resampled from {fs:g} to {wanted:g} Hz with scipy.signal.resample_poly(x, {up}, {down}), which attenuates above "
        f"{FLAT * min(fs, wanted) / 2:.0f} Hz: compare below that frequency"
    )
    return resample_poly(signal, up, down, axis=-1), sentence
