"""Noise of resonances, on which analyses of impacts are tested."""

import numpy as np
from scipy.signal import lfilter


def ringing_noise(rng, fs, n, records, modes, drive=None):
    """Acceleration of oscillators in parallel, (resonance [Hz], damping ratio) each, that white noise or a force drives.

    Shape (record, time), with the onset of the slowest mode left out if noise drives.
    """
    lead = 0 if drive is not None else round(fs * max(1 / (frequency * damping) for frequency, damping in modes))
    force = rng.standard_normal((records, lead + n)) if drive is None else drive
    out = np.zeros_like(force)
    for frequency, damping in modes:
        omega = 2 * np.pi * frequency / fs
        pole = np.exp(omega * (-damping + 1j * np.sqrt(1 - damping**2)))
        out += np.sqrt(damping) * lfilter([1.0, -2.0, 1.0], np.poly([pole, pole.conj()]).real, force)
    return out[:, lead:]
