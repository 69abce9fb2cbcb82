"""CPU time of the functions of ``features.signal`` that an analyst calls, compared with lines of SciPy for the same result.

The recording has 3 s at 20 kHz in single precision. docs/running.md says which lines of SciPy do less.
"""

import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
from scipy import interpolate
from scipy import signal as sp
from scipy.fft import irfft, rfft

from benchmarks.pairs import Line, interleaved, row
from features import signal

Array = np.ndarray
Work = Callable[[Array], Any]
FS, SHAFT_RATE, FAULT_RATE, HIGHEST = 20_000.0, 25.0, 90.0, 500.0  # Hz
PER_TURN, ORDER, LENGTH = 256, 100, 300


def power(x: Array, band: Array) -> Array:
    return np.abs(sp.hilbert(sp.sosfilt(sp.butter(4, band, "bandpass", fs=FS, output="sos"), x))) ** 2


def kurtosis(powers: Array) -> Array:
    return np.mean(powers**2, axis=-1) / np.mean(powers, axis=-1) ** 2 - 2


def coherence(x: Array) -> list[Array]:
    t = np.arange(len(x)) / FS
    shifted = (x * np.exp(-2j * np.pi * alpha * t) for alpha in np.linspace(0.2, 1, 5) * HIGHEST)
    return [sp.coherence(x + 0j, other, FS, nperseg=100)[1] for other in shifted]


def velocity_rms(x: Array) -> Array:
    f, density = (part[10:1001] for part in sp.welch(x, FS, nperseg=round(FS)))
    return np.sqrt(np.trapezoid(density / (2 * np.pi * f) ** 2, f))


def cases(samples: int) -> dict[str, tuple[tuple, str, Work]]:
    """By function: its arguments after the records, and the functions of SciPy with their work on one record."""
    t, cyclic, rate = np.arange(samples) / FS, (FS, HIGHEST), np.array([FAULT_RATE])
    angle, hann = 2 * np.pi * (20 * t + t**2), np.hanning(samples).astype(np.float32)
    places, turned = np.arange(0, angle[-1], 2 * np.pi / PER_TURN), (angle[None], PER_TURN)
    every = signal.kurtogram(np.ones((1, samples)), FS).edges.clip(1, FS / 2 - 1)  # those that a filter can have
    wide = every[np.diff(every)[:, 0] >= 4 * FAULT_RATE]
    return {
        "kurtogram": ((FS,), "butter, sosfilt, hilbert", lambda x: [kurtosis(power(x, band)) for band in every]),
        "comb_bands": ((FS, rate), "butter, sosfilt, hilbert, rfft", lambda x: [rfft(power(x, band)) for band in wide]),
        "spectral_coherence": (cyclic, "coherence, 5 cyclic frequencies", coherence),
        "spectral_coherence stft": (
            cyclic,
            "stft, rfft",
            lambda x: rfft(abs(sp.stft(x, FS, "hann", 128, 112)[2]) ** 2),
        ),
        "resample_to_angle": (turned, "CubicSpline", lambda x: interpolate.CubicSpline(angle, x)(places)),
        "order_spectrum": ((PER_TURN,), "rfft, four times padded", lambda x: abs(rfft(x * hann, 4 * samples))),
        "velocity_rms": ((FS, SHAFT_RATE), "welch", velocity_rms),
        "cepstrum": ((), "irfft(log(abs(rfft(x))))", lambda x: irfft(np.log(abs(rfft(x))), samples)),
        "psd": ((FS,), "welch", lambda x: sp.welch(x, FS, nperseg=round(FS / 4))),
    }


def rows(pairs: int = 3, *, samples: int = 60_000) -> Iterator[Line]:
    """Lines of the table."""
    x = np.random.default_rng(0).standard_normal((1, samples)).astype(np.float32)
    for name, (arguments, alternative, theirs) in cases(samples).items():
        ours = getattr(signal, name.split()[0])
        ours(x, *arguments)  # compiles
        speeds = interleaved(pairs, ours=partial(speed, ours, x, *arguments), scipy=partial(speed, theirs, x[0]))
        yield row(f"analysis {name}", f"{samples:,} samples", "1/s", speeds["ours"], alternative, speeds["scipy"])


def speed(work: Callable[..., Any], *arguments: Any) -> float:
    """Calls per second of CPU time."""
    start, calls = time.process_time(), 0
    while (spent := time.process_time() - start) < 0.04:
        work(*arguments)
        calls += 1
    return calls / spent
