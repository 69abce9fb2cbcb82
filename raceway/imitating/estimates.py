"""Keys of a background that looks like recorded segments of a healthy machine: its noise, lines and modulation. Pure.

A line is narrower than 60 Hz, so the median over that width is the density without lines. The noise of a recipe is fitted to it in
decibels; the resonances of the fit stand for those of the machine.
"""

from typing import Any

import numpy as np
from scipy.ndimage import median_filter
from scipy.optimize import least_squares
from scipy.signal import find_peaks

from features.signal.rows import FloatArray
from features.signal.spectra import power_density
from gen.mechanisms.background.noise import Noise, noise_spectrum
from gen.mechanisms.path import Modes

LINE_WIDTH = 60.0  # Hz, of the median that leaves no line
LOWEST, PASSED = 20.0, 0.95  # Hz, and share of half the sample rate, between which the noise is fitted
STEP = 10.0  # Hz, of the fit
MODES, LINES = 16, 64  # most that a recipe can have
STANDS_OUT = 10.0  # times the density around a line


def background_keys(x: FloatArray, fs: float, shaft_rate: float) -> dict[str, Any]:
    """Keys of the section ``background`` from segments, shape (segment, time), at a sample rate and a shaft rate [Hz].

    A line stays at its frequency, also one of the shaft. ``x (1 + m cos(angle))`` has the power ``m cos(angle)`` about its mean.
    """
    frequency, density = power_density(x, fs, x.shape[1] / fs)
    whole = density.mean(axis=0)
    broad = median_filter(whole, max(3, round(LINE_WIDTH / frequency[1])))
    excess = np.where(whole > STANDS_OUT * broad, whole - broad, 0)
    peaks, _ = find_peaks(excess, distance=3)
    # a Hann window spreads a line over three frequencies
    level = 10 * np.log10(excess[peaks] + excess[peaks - 1] + excess[peaks + 1]) - 10 * np.log10(broad.sum())
    strongest = np.sort(np.argsort(-level)[:LINES])
    tones = {"frequency_hz": frequency[peaks][strongest].tolist(), "level_db": level[strongest].clip(-80, 40).tolist()}
    turn, power = np.exp(2j * np.pi * shaft_rate / fs * np.arange(x.shape[1] - 1)), np.diff(x) ** 2
    depths = [np.median(np.abs((power * turn**times).mean(axis=1)) / power.mean(axis=1)) for times in (1, 2)]
    modulation = dict(zip(("first", "second"), map(float, depths), strict=True))
    lines = {"tones": {"probability": 1, "count": len(strongest), **tones}} if len(strongest) else {}
    return noise_keys(frequency, broad) | {"modulation": {"probability": 1, **modulation}} | lines


def noise_keys(frequency: FloatArray, density: FloatArray) -> dict[str, Any]:
    """Keys ``slope``, ``floor_db`` and ``modes`` of the noise that is nearest to a density in decibels, shape (frequency,)."""
    top = PASSED * frequency[-1]
    inside = np.flatnonzero((frequency >= LOWEST) & (frequency <= top))[:: max(1, round(STEP / frequency[1]))]
    aim = 10 * np.log10(density[inside] / density[inside].mean())
    # neighbours of opposite sign have no gap between them
    signs = np.resize([1.0, -1.0], MODES).tolist()

    def noise(values: FloatArray) -> Any:
        of_mode, damping, gain = values[2:].reshape(3, MODES).tolist()
        keys = {"frequency_hz": of_mode, "damping_percent": np.exp(damping).tolist(), "gain_db": gain, "sign": signs}
        modes: Any = Modes.model_construct(None, count=MODES, **keys)
        return Noise.model_construct(None, slope=values[0], floor_db=values[1], modes=modes)

    def miss(values: FloatArray) -> FloatArray:
        return 20 * np.log10(noise_spectrum(noise(values), frequency[inside])) - aim

    # slope, floor, then frequency, logarithm of the damping, and gain of each mode: lowest, first, highest and scale
    low, first, high, scale = np.array(
        [(-2, 0, 4, 1), (-80, -40, 0, 10)]
        + [(LOWEST, at, 1.1 * top, top / 30) for at in np.linspace(0.03 * top, top, MODES)]
        + [(np.log(0.3), np.log(4), np.log(45), 0.5)] * MODES
        + [(-60, 0, 60, 5)] * MODES
    ).T
    fitted = noise(least_squares(miss, first, bounds=(low, high), x_scale=scale, max_nfev=MODES * 4).x)
    return {"slope": float(fitted.slope), "floor_db": float(fitted.floor_db), "modes": dict(fitted.modes)}
