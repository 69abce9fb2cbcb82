"""False alarms of the coherence inside resonances, down to a probability of 0.001."""

import numpy as np
import pytest

from features.signal import spectral_coherence
from tests.features.signal.test_cyclic_laws import exceedances
from tests.resonances import ringing_noise


@pytest.mark.parametrize("damping", [0.002, 0.005, 0.01, 0.02, 0.05])
@pytest.mark.parametrize("resonance", [1000.0, 4000.0])
@pytest.mark.parametrize(
    ("fs", "seconds", "records"), [(12_800.0, 1.0, 200), (25_600.0, 1.0, 200), (25_600.0, 10.0, 20)]
)
def test_noise_of_a_resonance_exceeds_the_thresholds_half_to_twice_as_often_as_promised(
    fs, seconds, records, resonance, damping
):
    rng = np.random.default_rng(int(resonance + 1e4 * damping))
    shares = exceedances(rng, fs, seconds, records, resonance, damping, (0.1, 0.01, 0.001))
    assert 0.5 < min(shares) <= max(shares) < 2


@pytest.mark.parametrize("seed", range(5))
def test_noise_of_twelve_resonances_exceeds_the_threshold_half_to_twice_as_often_as_promised(seed):
    rng, fs, seconds = np.random.default_rng(seed), 25_600.0, 2.0
    modes = list(zip(rng.uniform(500, 11_000, 12), np.exp(rng.uniform(np.log(0.002), np.log(0.05), 12)), strict=True))
    found = spectral_coherence(ringing_noise(rng, fs, round(seconds * fs), 50, modes), fs, 300.0)
    squared = found.squared[..., found.cyclic > 4.0 / seconds]
    for probability in (0.1, 0.01, 0.001):
        assert 0.5 < np.mean(squared > found.threshold(probability)) / probability < 2
