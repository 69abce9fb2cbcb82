"""The kurtogram against its definition: a bank of plain filters, J. Antoni, Mech. Syst. Signal Process. 21 (2007) 108-124."""

import numpy as np
import pytest
from scipy.signal import firwin, hilbert, oaconvolve

from features.signal import kurtogram
from tests.features.signal.test_impulsive_laws import FS, impacts


def filter_bank(x, levels):
    """Kurtosis of the envelopes behind a bank of complex filters per level: the definition of the kurtogram."""
    values = []
    for level in levels:
        taps = firwin(16 * level + 1, 0.5 / level) if level > 1 else np.ones(1)
        for band in range(level):
            carrier = np.exp(1j * np.pi * (band + 0.5) / level * np.arange(len(taps)))
            power = np.abs(oaconvolve(x, taps * carrier, mode="valid") if level > 1 else hilbert(x)) ** 2
            values.append(np.mean(power**2) / np.mean(power) ** 2 - 2)
    return np.array(values)


@pytest.mark.parametrize(("resonance", "decibels"), [(1250.0, -11), (1250.0, 0), (2700.0, -11), (6000.0, -11)])
def test_the_kurtogram_picks_the_planted_band_wherever_a_filter_bank_does(resonance, decibels):
    rng = np.random.default_rng(int(resonance) + decibels)
    x = np.stack([impacts(rng, 20_000, resonance, 100.0, decibels) for _ in range(100)])
    tree = kurtogram(x.astype(np.float32), FS)

    def picked(edges):
        return (edges[:, 0] <= resonance) & (resonance <= edges[:, 1]) & (np.diff(edges)[:, 0] < 3400)

    defined = picked(np.stack([tree.edges[np.argmax(filter_bank(row, np.unique(tree.levels)))] for row in x]))
    assert defined.sum() > 60
    assert np.mean(picked(tree.best())[defined]) >= 0.95
