"""Corpora of ringing pulses at the lines of their faults, written without a simulation."""

import numpy as np

from gen.corpus import FAULTS
from tests.corpora import write_records

ORDERS = {"ftf": 0.4, "bpfo": 3.6, "bpfi": 5.4, "bsf": 2.35}
LINES = {"healthy": None, "inner": 5.4, "outer": 3.6, "ball": 4.7}


def pulse_train(fs, duration, rate, ringing, rng, *, decay=800.0, noise=0.3, wander=0.0):
    """Decaying oscillations at ``rate`` [Hz] in noise; ``wander`` is the rms of the random walk of a pulse [of a spacing]."""
    time = np.arange(round(fs * duration)) / fs
    signal = noise * rng.standard_normal(time.size)
    if rate is not None:
        starts = np.arange(0.0, duration * rate) + np.cumsum(
            wander * rng.standard_normal(int(np.ceil(duration * rate)))
        )
        for start in starts / rate:
            after = np.maximum(time - start, 0.0)
            signal += np.exp(-decay * after) * np.sin(2 * np.pi * ringing * after)
    return signal


def write_pulses(
    folder, *, fs=12_000.0, duration=0.4, classes=tuple(LINES), records=12, ringing=3000.0, seed=0, silent=(), **changed
):
    """Write a corpus with some records of each class, each on a specimen of its own.

    ``silent`` are numbers of records without a signal; ``changed`` replaces variables.
    """
    rng = np.random.default_rng(seed)
    fault = np.repeat([FAULTS.index(name) for name in classes], records)
    count = len(fault)
    columns = {name: np.full(count, order) for name, order in ORDERS.items()}
    columns |= {
        "shaft_rate": rng.uniform(25, 30, count),
        "sample_rate": np.full(count, fs),
        "load": np.full(count, np.nan),
        "fault": fault,
        "specimen": np.arange(count),
        "recording": np.arange(count),
    } | changed
    signal = []
    for code, rate in zip(fault, columns["shaft_rate"], strict=True):
        line = LINES[FAULTS[code]]
        signal.append(pulse_train(fs, duration, None if line is None else line * rate, ringing, rng))
    for number in silent:
        signal[number][:] = 0.0
    return write_records(folder, signal, fs, columns, title="pulses", text="a")


def impulses_beside_a_shaft(order, seed, *, fs, rate, seconds, shaft=0.3):
    """Noise, harmonics of a shaft at ``rate`` [Hz], and impulses at an order of it that excite a resonance; order 0 for none."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(seconds * fs)) / fs
    x = rng.standard_normal(t.size) + sum(shaft * np.cos(2 * np.pi * k * rate * t + k) / k for k in range(1, 7))
    if not order:
        return x
    since = np.mod(t + rng.uniform(), 1 / (order * rate))
    return x + 8 * np.exp(-900 * since) * np.sin(2 * np.pi * 2800 * since)
