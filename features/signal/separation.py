"""Separation of the parts of a record: tones from impacts, transfer path from excitation, impacts from their smear.

============================ ==========================================================================================
`cepstrum`, `lifter`         transfer path (low quefrencies) and families of harmonics (their period), in the log spectrum [1]_
`separate_random`            tones, which repeat after a delay, from impacts that do not, because a bearing slips [2]_
`prediction_residual`        the part of a record that its past does not predict: impacts and noise [3]_
`sharpen`                    the filter whose output is closest to impulses at a known rate [4]_
============================ ==========================================================================================

Cepstral pre-whitening, which sets the whole cepstrum to zero, is `features.signal.spectra.whiten_cepstrally`.

.. [1] R. B. Randall, N. Sawalhi, "A new method for separating discrete components from a signal", *Sound Vib.* 45 (2011)
       6-9.
.. [2] J. Antoni, R. B. Randall, "Unsupervised noise cancellation for vibration signals: part II - a novel
       frequency-domain algorithm", *Mech. Syst. Signal Process.* 18 (2004) 103-117.
.. [3] N. Sawalhi, R. B. Randall, H. Endo, "The enhancement of fault detection and diagnosis in rolling element bearings
       using minimum entropy deconvolution combined with spectral kurtosis", *Mech. Syst. Signal Process.* 21 (2007)
       2616-2633.
.. [4] G. L. McDonald, Q. Zhao, "Multipoint optimal minimum entropy deconvolution and convolution fix: application to
       vibration fault detection", *Mech. Syst. Signal Process.* 82 (2017) 461-477.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.fft import irfft, next_fast_len, rfft
from scipy.linalg import cho_factor, cho_solve

from features.signal.arguments import as_records, ascending, check_positive, check_whole, like, of_each
from features.signal.rows import ComplexArray, FloatArray, brief, hann_window, squared_modulus
from features.signal.spectra import LOADING, hann_segments, prediction_filters, sine_windowed

OVERLAP_LOSS = 1.056  # segments per independent segment, Hann window and half overlap
CHANCE = 0.01  # that a coherence of noise counts as that of a tone


class Separation(NamedTuple):
    """Two parts of records that add up to them without their mean, shapes (record, time)."""

    deterministic: FloatArray
    random: FloatArray

    def __repr__(self) -> str:
        return brief(self)


def cepstrum(x: ArrayLike) -> FloatArray:
    """Real cepstrum, shape (record, time): value k belongs to the quefrency of k samples, and to the same from the end."""
    records = as_records(x)
    return like(x, np.asarray(irfft(_log_modulus(np.asarray(rfft(records, axis=-1))), n=records.shape[-1], axis=-1)))


def lifter(x: ArrayLike, fs: float, removed: Sequence[tuple[float, float]]) -> FloatArray:
    """Records with ranges of their cepstrum set to zero and with their phases unchanged, shape (record, time).

    Parameters
    ----------
    x
        Records, shape (record, time), none of them constant.
    fs
        Sample rate [Hz].
    removed
        Lowest and highest quefrency of each range [s], both included. ``[(0.002, inf)]`` keeps the transfer path,
        ``[(0, 0.002)]`` removes it together with the gain, and ranges around the multiples of ``1 / rate`` remove a
        family of harmonics or sidebands.
    """
    check_positive(fs=fs)
    if not np.ndim(removed) or not len(removed):
        raise ValueError("removed: give ranges, such as [(0, 0.002)].")
    ranges = [ascending(ends, f"removed[{place}]") for place, ends in enumerate(removed)]
    records = as_records(x)
    n = records.shape[-1]
    coefficients = np.asarray(rfft(records, axis=-1))
    quefrency = np.minimum(np.arange(n), n - np.arange(n)) / fs
    gone = np.logical_or.reduce([(quefrency >= low) & (quefrency <= high) for low, high in ranges])
    change = np.asarray(rfft(np.where(gone, irfft(_log_modulus(coefficients), n=n, axis=-1), 0.0), axis=-1)).real
    return like(x, np.asarray(irfft(coefficients * np.exp(-change), n=n, axis=-1)))


def _log_modulus(coefficients: ComplexArray) -> FloatArray:
    modulus = np.sqrt(squared_modulus(coefficients))
    return np.log(np.maximum(modulus, np.finfo(modulus.dtype).tiny))


def separate_random(x: ArrayLike, fs: float, *, segment: float = 0.1, delay: float = 0.1) -> Separation:
    """Tones, and the rest of each record, by the correlation of segments with later ones.

    The modulus of the coherence of segments with those ``delay`` later is near 1 at a tone and, in noise, as low as the
    number of segments allows. Less this bias it is the gain of a filter, that of the tones; where noise would reach it in
    one of a hundred bins, the gain is 0. With the phase of the correlation, the filter predicts the tones from samples
    that are the delay away, later ones in the first half of a record and earlier ones in the second. So it needs nothing
    beyond the ends, and the noise in the bins of the tones is equally strong over the whole record.

    Parameters
    ----------
    x
        Records, shape (record, time).
    fs
        Sample rate [Hz].
    segment
        Length of a segment [s]. Two tones closer than ``4 / segment`` are one.
    delay
        Time in which the random part forgets its phase [s]: several periods of the fault, and at least a segment.
        Twice the segment and the delay must fit the records.

    Raises
    ------
    ValueError
        If the records or the segments are too short, or the delay is shorter than a segment, with which noise that both
        segments share would count as a tone.
    """
    check_positive(fs=fs, segment=segment, delay=delay)
    records = as_records(x)
    n, length, shift = records.shape[-1], round(segment * fs), round(delay * fs)
    if not 4 <= length <= shift:
        raise ValueError(
            f"segment {segment:g} s and delay {delay:g} s at {fs:g} Hz: a segment has at least 4 samples, and the delay is at "
            "least a segment."
        )
    if n < 2 * (length + shift):
        raise ValueError(
            f"records of {n / fs:.3g} s are too short: twice the segment of {segment:g} s and the delay of {delay:g} s must fit."
        )
    centred = records - records.mean(axis=-1, keepdims=True)
    early = np.asarray(rfft(hann_segments(centred[:, : n - shift], length), axis=-1))
    late = np.asarray(rfft(hann_segments(centred[:, shift:], length), axis=-1))
    # a temporary on the left: NumPy multiplies into a large one on the right in swapped order, and rounds differently
    cross = np.sum(early.conj() * late, axis=1)
    power = np.sum(np.abs(early) ** 2, axis=1) * np.sum(np.abs(late) ** 2, axis=1)
    count = max(early.shape[1] / OVERLAP_LOSS, 1.01)
    modulus, tiny = np.abs(cross), np.finfo(power.dtype).tiny
    ratio = modulus**2 / np.maximum(power, tiny)
    significant = ratio > 1 - CHANCE ** (1 / (count - 1))
    gain = np.where(significant, np.sqrt(np.clip((count * ratio - 1) / (count - 1), 0, 1)), 0.0)
    advance = gain * (cross / np.maximum(modulus, tiny))
    deterministic = _predict(centred, advance, length, shift)
    return Separation(like(x, deterministic), like(x, centred - deterministic))


def _predict(x: FloatArray, advance: ComplexArray, length: int, distance: int) -> FloatArray:
    """Tones of records from samples ``distance`` away, shape (record, time).

    Parameters
    ----------
    x
        Records, shape (record, time).
    advance
        Change of a tone over the distance at the frequencies of segments of ``length``, shape (record, frequency).
    """
    n, half = next_fast_len(x.shape[-1] + 2 * length, real=True), x.shape[-1] // 2
    kernel = np.tile(irfft(advance, n=length, axis=-1), 2) * hann_window(2 * length, x.dtype)  # a segment to each side
    response, coefficients = np.asarray(rfft(kernel, n=n, axis=-1)), np.asarray(rfft(x, n=n, axis=-1))
    first, last = distance - length, half + length - distance
    later = np.asarray(irfft(response.conj() * coefficients, n=n, axis=-1))[:, first : first + half]
    earlier = np.asarray(irfft(response * coefficients, n=n, axis=-1))[:, last : last + x.shape[-1] - half]
    return np.concatenate([later, earlier], axis=-1)


def prediction_residual(x: ArrayLike, order: int) -> FloatArray:
    """Records less their linear prediction from ``order`` samples before, shape (record, time).

    The residual of an autoregressive process is its innovation. The first ``order`` samples, which have too few before
    them, are predicted from those after them: backwards, the same filter leaves as much of a stationary record.
    """
    check_whole(order=order)
    records = as_records(x)
    n = records.shape[-1]
    if order > n // 2:
        raise ValueError(f"order {order} is not in 1 to {n // 2}, half the length of the records.")
    centred = records - records.mean(axis=-1, keepdims=True)
    length = next_fast_len(n + order, real=True)
    filters = prediction_filters(sine_windowed(records, length), length, order)
    residual = np.asarray(irfft(rfft(centred, n=length) * rfft(filters, n=length), n=length, axis=-1))[:, :n]
    ahead = np.lib.stride_tricks.sliding_window_view(centred[:, : 2 * order], order + 1, axis=-1)
    residual[:, :order] = np.einsum("rkj,rj->rk", ahead, filters)
    return like(x, residual)


def sharpen(x: ArrayLike, fs: float, rate: ArrayLike, length: int) -> FloatArray:
    """Records through the filter whose output is closest to a train of unit impulses, shape (record, time - length + 1).

    The filter is the solution of one least-squares system for the phase of the train that fits best. It uses only complete
    products of record and filter, and so does not sharpen the ends of the record. It finds a weak train of ``rate`` in
    pure noise, too: compare with other rates.

    Parameters
    ----------
    x
        Records, shape (record, time).
    fs
        Sample rate [Hz].
    rate
        Impulses per second, shape (record,), right within a sample over the record.
    length
        Number of coefficients of the filter.
    """
    check_positive(fs=fs)
    check_whole(length=length)
    records = as_records(x)
    samples = records.shape[-1]
    count = samples - length + 1
    if count < 2 * length:
        raise ValueError(f"{length} coefficients are too many for {samples} samples: take at most a third of them.")
    centred = np.asarray(records - records.mean(axis=-1, keepdims=True), dtype=float)
    periods = fs / of_each(rate, "rate", records)
    sharpened = [_sharpen(row, period, length, count) for row, period in zip(centred, periods, strict=True)]
    return like(x, np.stack(sharpened).astype(records.dtype))


def _sharpen(x: FloatArray, period: float, length: int, count: int) -> FloatArray:
    """Output of the filter of one record, shape (time,)."""
    places = np.arange(0.0, count - int(period), period).round().astype(int)
    summed = x[places[:, None] + np.arange(int(period) + length - 1)].sum(axis=0)
    products = np.lib.stride_tricks.sliding_window_view(summed, length).T  # one column for each phase of the train
    solved = np.asarray(cho_solve(cho_factor(_covariance(x, length, count)), products))
    best = np.argmax(np.sum(products * solved, axis=0))
    return np.convolve(x, solved[::-1, best], mode="valid")


def _covariance(x: FloatArray, length: int, count: int) -> FloatArray:
    """Sums of ``x[k + i] * x[k + j]`` over k < ``count``, shape (length, length), each from that of i - 1 and j - 1."""
    padded = next_fast_len(len(x) + count, real=True)
    head = np.asarray(rfft(x[:count], n=padded)).conj()
    out = np.empty((length, length))
    out[0] = irfft(head * np.asarray(rfft(x, n=padded)), n=padded)[:length]
    first, last = x[: length - 1], x[count : count + length - 1]
    for i in range(1, length):
        out[i, 1:] = out[i - 1, :-1] + last[i - 1] * last - first[i - 1] * first
        out[i, 0] = out[0, i]
    out[np.diag_indices(length)] += LOADING * out[0, 0] + np.finfo(float).tiny
    return out
