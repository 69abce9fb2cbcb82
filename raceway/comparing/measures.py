"""The measures that synthetic and real records are compared by.

``window -> band-limited to 20 Hz ... top -> colour, impulsiveness; whitened envelope -> lines of the class``

Each measure is a number of one window and does not depend on gain. The measures of lines need a class whose faults have
a line of their own. Those of its width and sidebands are NaN unless the line stands out clearly.
"""

from typing import NamedTuple

import numpy as np
from scipy.fft import irfft

from features.signal.colour import centroid, roll_off, tonality
from features.signal.demodulation import ZERO_PADDING, analytic_band, spectrum_over_floor
from features.signal.impulsive import band_kurtosis, equal_bands
from features.signal.lines import single_lines
from features.signal.modulation import cyclostationarity, highest_place, phase_wander, sideband_ratio
from features.signal.rows import FloatArray, squared_modulus
from features.signal.shape import envelope_shape, time_statistics
from features.signal.spectra import band_energies, fourier_coefficients, power_density, whiten_by_psd
from features.table.band import DEFAULT_BAND
from features.table.class_features import COMBS, class_features
from features.table.indicators import Orders
from features.table.record_batch import FLOOR_WIDTH
from gen.corpus.fault_classes import fault_class

LOWEST = 20.0  # Hz, lower edge of the compared band: below it sensors and their amplifiers differ
UPPER_BAND = 3500.0  # Hz
ROLLED_OFF = 0.85  # share of the energy below the roll-off
KURTOSIS_BANDS = (4, 8, 16)
WHITENING_WIDTH = 300.0  # Hz, wider than the spacing of fault lines: a narrower one raises the noise between them
SEARCHED = 0.025  # relative, of a line: labelled speeds, nominal orders and slip are off by up to 2 %
CLEAR_DB = 14.0  # level of a clear line over the median floor: five times as high
HALF_WIDTH = 0.45  # of the distance between a line and its nearest sidebands
SIDEBAND_REACH = 2  # bins of the zero-padded spectrum, half a resolution
HARMONICS = 3
DB_PER_NEPER = 20 / np.log(10)

SPALLED = tuple(COMBS)  # classes with a line of their own
RACES = tuple(name for name in SPALLED if fault_class(name).lines[0].base in ("bpfi", "bpfo"))
BALLS = tuple(name for name in SPALLED if fault_class(name).lines[0].base == "bsf")


class Measure(NamedTuple):
    """A measure: its name, its unit, its meaning, and the classes that have it (none: all)."""

    name: str
    unit: str
    meaning: str
    classes: tuple[str, ...] = ()

    def belongs_to(self, fault: str) -> bool:
        """Whether records of this class have the measure."""
        return not self.classes or fault in self.classes


MEASURES = (
    Measure("energy_above_3500_hz", "dB", "energy from 3.5 kHz to the top of the band over that of the whole band"),
    Measure("roll_off", "Hz", "frequency below which 85 % of the energy lies"),
    Measure("centroid", "Hz", "mean frequency weighted with the energy"),
    Measure("tonality", "1", "share of the energy in spectral lines 10 dB above the median of the 100 Hz around them"),
    Measure("kurtosis", "1", "fourth moment over the squared second; 3 for Gaussian noise"),
    Measure("crest_factor", "1", "largest modulus over the rms"),
    Measure("spectral_kurtosis", "1", "largest kurtosis of the envelopes of 4, 8 and 16 equal bands; 0 for noise"),
    Measure("skewness", "1", "modulus of the third moment over the cubed rms, whose sign is that of the mounting"),
    Measure("slow_share", "1", "share of the power of the whitened envelope below 0.8 orders of the shaft"),
    Measure("line_level", "dB", "height of the line of the class over the median floor of the envelope", SPALLED),
    Measure("line_width", "rad", "rms wander of the phase of that line against a constant frequency", SPALLED),
    Measure("shaft_sidebands", "dB", "mean of both sidebands at the shaft rate over the line", RACES),
    Measure("cyclostationarity", "1", "degree of cyclostationarity at the line and two harmonics", SPALLED),
    Measure("cage_line", "dB", "height of the line of the cage over the median floor of the envelope", BALLS),
    Measure("cage_sidebands", "dB", "mean height of the cage sidebands of the line over the floor", BALLS),
)
NAMES = tuple(measure.name for measure in MEASURES)


def limit_band(x: FloatArray, fs: float, rate: float, top: float) -> FloatArray:
    """Windows limited to 20 Hz to ``top`` and sampled at about ``rate``, shape (window, time).

    The number of samples is the rounded product of rate and length, so that the exact rate is this number over the length.

    Parameters
    ----------
    x
        Accelerations, shape (window, time).
    fs
        Sample rate [Hz].
    rate
        New sample rate [Hz], at least twice ``top``.
    top
        [Hz], at most half of fs.
    """
    seconds = x.shape[-1] / fs
    coefficients = fourier_coefficients(x, fs, top)
    coefficients[:, : round(LOWEST * seconds)] = 0.0
    return np.asarray(irfft(coefficients, n=round(rate * seconds), axis=-1, norm="forward"))


def compute_measures(
    x: FloatArray, fs: float, top: float, shaft_rate: FloatArray, orders: Orders, fault: str
) -> FloatArray:
    """Measures of windows of one class, in the order of `NAMES`, shape (window, measure).

    Parameters
    ----------
    x
        Band-limited windows, shape (window, time), none of them constant.
    fs
        Sample rate [Hz].
    top
        Upper edge of the band [Hz].
    shaft_rate, orders
        Rate [Hz] and nominal fault orders, shapes (window,).
    fault
        The class.
    """
    envelope = _envelopes(x, fs, top, shaft_rate)
    by_name = _colour(x, fs, top) | _impulsiveness(x, fs, top)
    shape = envelope_shape(envelope.power, envelope.weighted, envelope.spectrum, envelope.rate, shaft_rate)
    *_, by_name["slow_share"] = shape.T
    if class_features(fault):
        by_name |= _lines(envelope, shaft_rate, orders, fault)
    missing = np.full(len(x), np.nan)
    columns = [by_name.get(measure.name, missing) if measure.belongs_to(fault) else missing for measure in MEASURES]
    return np.stack(columns, axis=-1)


def _colour(x: FloatArray, fs: float, top: float) -> dict[str, FloatArray]:
    frequencies, density = power_density(x, fs)
    density[:, (frequencies < LOWEST) | (frequencies > top)] = 0.0
    # one transform over the whole window: tones need its resolution
    _, fine = power_density(x, fs, x.shape[-1] / fs)
    step = fs / x.shape[-1]
    inside = slice(round(LOWEST / step), round(top / step))
    by_name = {
        "roll_off": roll_off(density, frequencies, ROLLED_OFF),
        "centroid": centroid(density, frequencies),
        "tonality": tonality(fine[:, inside], np.arange(fine.shape[-1])[inside] * step),
    }
    # a narrower band has nothing above
    if top > UPPER_BAND:
        lower, upper = band_energies(density, frequencies, (0.0, UPPER_BAND, top)).T
        by_name["energy_above_3500_hz"] = 10 * np.log10(np.maximum(upper / (lower + upper), np.finfo(float).tiny))
    return by_name


def _impulsiveness(x: FloatArray, fs: float, top: float) -> dict[str, FloatArray]:
    crest, kurtosis, skewness = time_statistics(x)[:, 2:5].T
    coefficients = fourier_coefficients(x, fs, top)
    return {
        "kurtosis": kurtosis,
        "crest_factor": crest,
        "skewness": np.abs(skewness),
        "spectral_kurtosis": band_kurtosis(coefficients, equal_bands(coefficients.shape[-1], KURTOSIS_BANDS)).max(
            axis=-1
        ),
    }


class _Envelopes(NamedTuple):
    """Envelopes of the whitened band.

    Attributes
    ----------
    power
        Squared envelopes, shape (window, time).
    rate
        Their sample rate [Hz].
    weighted
        Envelopes under a Hann window, shape (window, time).
    spectrum, level
        Amplitude spectrum of the envelope on the fine grid, and its natural logarithm over the floor, shapes (window,
        frequency).
    step
        Distance of two frequencies [Hz].
    """

    power: FloatArray
    rate: float
    weighted: FloatArray
    spectrum: FloatArray
    level: FloatArray
    step: float


def _envelopes(x: FloatArray, fs: float, top: float, shaft_rate: FloatArray) -> _Envelopes:
    """Envelopes of windows of shape (window, time) with known shaft rates [Hz], shape (window,)."""
    seconds = x.shape[-1] / fs
    whitened = whiten_by_psd(fourier_coefficients(x, fs, top), round(WHITENING_WIDTH * seconds))
    z = analytic_band(whitened, round(DEFAULT_BAND.low * seconds), round(top * seconds))
    power = squared_modulus(z)
    step = 1 / (ZERO_PADDING * seconds)
    width = np.maximum(FLOOR_WIDTH[0] * shaft_rate, FLOOR_WIDTH[1]) / step
    whole = ZERO_PADDING * z.shape[-1] // 2 + 1
    return _Envelopes(power, z.shape[-1] / seconds, *spectrum_over_floor(np.sqrt(power), width, whole), step)


def _lines(envelope: _Envelopes, shaft_rate: FloatArray, orders: Orders, fault: str) -> dict[str, FloatArray]:
    """Measures of the line of a class with a line of its own."""
    fundamental = fault_class(fault).lines[0]
    order = fundamental.order(orders)
    line = highest_place(envelope.level, order * shaft_rate / envelope.step, SEARCHED)
    rows = np.arange(len(line))
    level = DB_PER_NEPER * envelope.level[rows, line]
    # width and sidebands of noise are not those of a line
    clear = level > CLEAR_DB
    spacing = (orders.ftf if fault in BALLS else 1.0) * shaft_rate
    sides = line[:, None] + np.outer(spacing / envelope.step, (-1, 1))
    read = DB_PER_NEPER * single_lines(
        envelope.level, np.column_stack([orders.ftf * shaft_rate / envelope.step, sides])
    )
    ratio = sideband_ratio(envelope.spectrum, line, spacing / envelope.step, SIDEBAND_REACH)
    frequency = line * envelope.step
    wander = phase_wander(np.sqrt(envelope.power), envelope.rate, frequency, HALF_WIDTH * spacing)
    return {
        "line_level": level,
        "line_width": np.where(clear, wander, np.nan),
        "shaft_sidebands": np.where(clear, 20 * np.log10(np.maximum(ratio, np.finfo(float).tiny)), np.nan),
        "cyclostationarity": cyclostationarity(envelope.power, envelope.rate, frequency, HARMONICS),
        "cage_line": read[:, 0],
        "cage_sidebands": read[:, 1:].mean(axis=-1),
    }
