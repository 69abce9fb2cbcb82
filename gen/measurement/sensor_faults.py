"""Faults of the measuring chain, from the mount of a sensor to the transfer of its samples.

::

    machine -> mount -> cable -> gain -> amplifier -> converter -> transfer
               rattle   drift    steps   limit                     gaps
                        hum
                        bursts

Drift, hum and bursts enter ahead of the amplifier: they use up its range, and it amplifies them. A gain that steps up drives the amplifier
into its limit. Gaps come last; a converter acts on each sample by itself, so they may be made before it with the same result.
Every function takes signals of shape (channel, time) [m s-2] and returns new ones.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft

from gen.drawing.draws import Drawn
from gen.measurement.rattle import rattling
from gen.measurement.rig import base_transmissibility
from gen.scenarios import Mode, Purpose, Scenario
from gen.support.units import decibel_to_ratio

FloatArray = NDArray[np.floating]

DECAYED = 7.0  # time constants after which a filter has settled to 1e-3


class SensorFlags(NamedTuple):
    """Sensor faults found in one record, 0 for none; each has the name of the variable in the corpus that it becomes."""

    loose_mount: int = 0
    """Channels with a loose sensor."""
    rattle: int = 0
    """Impacts of loose sensors, all channels together."""
    saturated: int = 0
    """Samples at the limit of the amplifier, all channels together."""
    mains_hum: float = 0.0
    """Rms of the hum [m s-2]."""
    drift: float = 0.0
    """Largest deviation of the baseline from 0 in any channel [m s-2]."""
    dropped_samples: int = 0
    """Times without a sample of their own."""
    gain_steps: int = 0
    """Changes of the gain."""
    emi_bursts: int = 0
    """Bursts that start in the record."""


def disturb(signal: FloatArray, scenario: Scenario, fs: float) -> tuple[FloatArray, SensorFlags]:
    """Signal with all sensor faults of a scenario, and which of them are in it.

    Parameters
    ----------
    signal : array, shape (channel, time)
        Record at its final level, ahead of the converter [m s-2].
    scenario : Scenario
        Its sensor faults and random stream are used.
    fs : float
        Sample rate [Hz].

    Returns
    -------
    array, shape (channel, time), of the type of ``signal``
        The ``signal`` itself if the scenario has no sensor fault, or if the record diverged: then it is left out of the corpus.
    """
    rig, record, flags = scenario.rig.sensor_faults, scenario.record.sensor_faults, SensorFlags()
    if (rig is None and record is None) or not np.isfinite(signal).all():
        return signal, flags
    given = signal
    # a stream for each fault, so that none moves the random times of another
    mains, drifts, bursts, gaps = scenario.rng(Purpose.SENSOR_NOISE).spawn(4)
    if rig is not None and any(rig.loose_mounts):
        signal, impacts = mount_loosely(signal, rig.loose_mounts, fs)
        flags = flags._replace(loose_mount=sum(map(bool, rig.loose_mounts)), rattle=impacts)
    if record is not None and record.drift is not None:
        baseline = drift(record.drift, signal.shape, fs, drifts)
        signal, flags = signal + baseline, flags._replace(drift=float(np.abs(baseline).max()))
    if rig is not None and rig.mains_hum is not None:
        deviation = 0.0 if record is None else record.mains_deviation
        hum = mains_hum(rig.mains_hum, deviation, signal.shape[1], fs, mains)
        signal, flags = signal + hum, flags._replace(mains_hum=math.sqrt(np.mean(hum**2)))
    if record is not None and record.emi_bursts is not None:
        induced, count = emi_bursts(record.emi_bursts, signal.shape[1], fs, bursts)
        signal, flags = signal + induced, flags._replace(emi_bursts=count)
    if record is not None and record.gain_steps:
        signal = signal * gain_steps(record.gain_steps, signal.shape[1])
        flags = flags._replace(gain_steps=len(record.gain_steps))
    if rig is not None and rig.saturation is not None:
        signal, count = saturate(signal, rig.saturation, fs)
        flags = flags._replace(saturated=count)
    if record is not None and record.dropped_samples is not None:
        signal, count = with_gaps(signal, record.dropped_samples, fs, gaps)
        flags = flags._replace(dropped_samples=count)
    return signal.astype(given.dtype, copy=False), flags


def mount_loosely(signal: FloatArray, mounts: tuple[Drawn | None, ...], fs: float) -> tuple[FloatArray, int]:
    """Signal of sensors that resonate and rattle on loose mounts, and the number of impacts.

    Parameters
    ----------
    signal : array, shape (channel, time)
        Acceleration of the machine below each sensor [m s-2].
    mounts : tuple
        Mount of each channel; None for a firm one.
    fs : float
        Sample rate [Hz].
    """
    loose, impacts = signal.copy(), 0
    for channel, mount in enumerate(mounts):
        if mount is not None:
            held = through_mount(signal[channel], mount, fs)
            loose[channel], count = rattling(held, mount["frequency"], mount["damping"], mount["holding"], fs)
            impacts += count
    return loose, impacts


def compile_rattle() -> None:
    """Compile the rattling of loose sensors, or fetch it from numba's cache on disk."""
    rattling(np.zeros(2), 1000.0, 0.1, 1.0, 10_000.0)


def through_mount(signal: FloatArray, mount: Drawn, fs: float) -> FloatArray:
    """Acceleration of a sensor on a compliant mount, without rattle, shape (time,) [m s-2].

    The record is continued backwards by its mirror image while the filter settles; the end of the response, which the circular
    convolution wraps around, falls into that time.
    """
    settling = math.ceil(DECAYED * fs / (2 * math.pi * mount["damping"] * mount["frequency"]))
    lead = signal[1 : min(settling, len(signal) - 1) + 1][::-1]
    n = next_fast_len(len(signal) + max(settling, len(lead)), real=True)
    frequency = np.arange(n // 2 + 1) * (fs / n)
    transmitted = base_transmissibility((Mode(mount["frequency"], mount["damping"], 1.0),), frequency)
    spectrum = rfft(np.concatenate([lead, signal]), n) * transmitted
    return irfft(spectrum, n)[len(lead) : len(lead) + len(signal)]


def drift(drawn: Drawn, shape: tuple[int, ...], fs: float, rng: np.random.Generator) -> FloatArray:
    """Baseline of each channel: a random wander and an exponential settling, shape (channel, time) [m s-2].

    The wander is white noise behind a low-pass filter of first order, stationary from the first sample on.
    """
    kept = math.exp(-2 * math.pi * drawn["wander_corner"] / fs)
    noise = rng.standard_normal(shape) * (drawn["wander"] * math.sqrt(1 - kept**2))
    noise[:, 0] = drawn["wander"] * rng.standard_normal(shape[0])
    settling = drawn["settling"] * np.exp(np.arange(shape[1]) / (-drawn["settling_time"] * fs))
    return _recursive(1.0, kept, noise) + settling


def _recursive(gain: float, pole: complex, signal: NDArray[Any]) -> NDArray[Any]:
    """Filter of first order: ``gain`` times the signal plus ``pole`` times the output one sample before."""
    from scipy.signal import lfilter  # loads for half a second, and few recipes need it

    return lfilter([gain], [1.0, -pole], signal)


def mains_hum(drawn: Drawn, deviation: float, length: int, fs: float, rng: np.random.Generator) -> FloatArray:
    """Hum at the mains frequency and its odd multiples below half the sample rate, shape (time,) [m s-2]."""
    orders = 1 + 2 * np.arange(round(drawn["count"]) + 1)
    phases = rng.random(len(orders)) * 2 * math.pi
    frequencies = orders * drawn["frequency"] * (1 + deviation)
    levels = drawn["rms"] * np.where(orders == 1, 1.0, 3 * decibel_to_ratio(drawn["third"]) / orders)
    hum = np.zeros(length)
    for frequency, level, phase in zip(frequencies, levels, phases, strict=True):
        if frequency < fs / 2:
            hum += math.sqrt(2) * level * np.cos(2 * math.pi * frequency / fs * np.arange(length) + phase)
    return hum


def emi_bursts(drawn: Drawn, length: int, fs: float, rng: np.random.Generator) -> tuple[FloatArray, int]:
    """Decaying oscillations that start at random times, shape (time,) [m s-2], and their number."""
    count = int(rng.poisson(drawn["rate"] * length / fs))
    starts = rng.integers(length, size=count)
    peaks = drawn["peak"] * rng.standard_normal(count) * np.exp(2j * math.pi * rng.random(count))
    hits = np.zeros(length, complex)
    np.add.at(hits, starts, peaks)
    pole = np.exp((-1 / drawn["decay"] + 2j * math.pi * drawn["frequency"]) / fs)
    return np.real(_recursive(1.0, pole, hits)), count


def gain_steps(steps: tuple[Drawn, ...], length: int) -> FloatArray:
    """Gain at each sample; every step multiplies that before it, shape (time,) [1]."""
    gain = np.ones(length)
    for step in steps:
        gain[1 + int(step["share"] * (length - 1)) :] *= step["gain"]
    return gain


def saturate(signal: FloatArray, drawn: Drawn, fs: float) -> tuple[FloatArray, int]:
    """Signal behind an amplifier of limited output, shape (channel, time) [m s-2], and the number of samples at its limit.

    Below the knee the gain is 1; in the knee it falls linearly with the input to 0, where the output reaches the limit. The part of the
    input beyond the limit charges the amplifier, which shifts the baseline to the other side and discharges with the same time constant.
    """
    limit, knee = drawn["limit"], drawn["knee"] * drawn["limit"]
    if drawn["recovery"] > 0:
        kept = math.exp(-1 / (drawn["recovery"] * fs))
        beyond = signal - np.clip(signal, -limit, limit)
        signal = signal - _recursive(1 - kept, kept, beyond)
    count = int(np.count_nonzero(np.abs(signal) >= limit + knee))
    output = np.clip(signal, -limit - knee, limit + knee)
    if knee > 0:
        over = np.maximum(np.abs(output) - (limit - knee), 0.0)
        output -= np.copysign(over**2 / (4 * knee), output)
    return output, count


def with_gaps(signal: FloatArray, drawn: Drawn, fs: float, rng: np.random.Generator) -> tuple[FloatArray, int]:
    """Signal with gaps, shape (channel, time), and the number of times without a sample of their own.

    A gap is filled with the last sample before it or with 0. The first sample is never lost. Where gaps overlap, the later one
    is filled from what the earlier one left.
    """
    length = signal.shape[1]
    size = min(max(round(drawn["gap"] * fs), 1), length - 1)
    starts = np.sort(rng.integers(1, length - size + 1, size=round(drawn["count"])))
    held = rng.random(len(starts)) < drawn["held"]
    filled, lost = signal.copy(), np.zeros(length, bool)
    for start, hold in zip(starts, held, strict=True):
        gap = slice(start, start + size)
        filled[:, gap] = filled[:, start - 1 : start] if hold else 0.0
        lost[gap] = True
    return filled, int(np.count_nonzero(lost))
