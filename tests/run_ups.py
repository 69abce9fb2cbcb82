"""Records of a shaft whose speed is known, for tests of the course of the speed."""

import numpy as np

FS = 12_800.0


def course(kind, seconds, fs=FS):
    """Shaft rate [Hz] at each sample: a ramp, a modulation by 10 %, a run-up that begins and ends at rest, or constant."""
    time = np.arange(round(seconds * fs)) / fs
    part = np.clip((time / seconds - 0.1) / 0.8, 0, 1)
    return {
        "ramp": 12 + 24 * time / seconds,
        "slow sine": 24 * (1 + 0.1 * np.sin(2 * np.pi * 0.1 * time)),
        "fast sine": 24 * (1 + 0.1 * np.sin(2 * np.pi * 0.5 * time)),
        "run-up": 12 + 24 * part**3 * (10 - 15 * part + 6 * part**2),
        "step": 24 + 8 * np.tanh((time - seconds / 2) / 0.5),
        "constant": np.full(len(time), 24.3),
    }[kind]


def lines(rate, harmonics, fs=FS):
    """Harmonics of amplitude 1, shape (time,)."""
    turns = np.cumsum(rate) / fs
    return np.sum([np.cos(2 * np.pi * k * turns + k * k) for k in harmonics], axis=0)


def run_up(kind, level_db, harmonics=(1,), seed=0, seconds=20.0):
    """Shaft rate and signal; the level is the power of a harmonic over that of white noise, up to half the sample rate."""
    rate = course(kind, seconds)
    noise = np.random.default_rng(seed).standard_normal(len(rate))
    return rate, np.sqrt(2) * 10 ** (level_db / 20) * lines(rate, harmonics) + noise
