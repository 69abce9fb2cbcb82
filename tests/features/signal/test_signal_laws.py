"""Laws that all functions on records share: no record depends on the others, and single precision is kept."""

import numpy as np
import pytest

from features import signal

FS, RATES = 12_000.0, np.array([87.0, 93.5, 141.0])

FUNCTIONS = {
    "kurtogram": lambda x, _: signal.kurtogram(x, FS).score,
    "comb_bands": lambda x, rates: signal.comb_bands(x, FS, rates).best(),
    "spectral_kurtosis": lambda x, _: signal.spectral_kurtosis(x, FS).kurtosis,
    "spectral_coherence": lambda x, _: signal.spectral_coherence(x, FS, 200.0).squared,
    "cepstrum": lambda x, _: signal.cepstrum(x),
    "lifter": lambda x, _: signal.lifter(x, FS, [(0.0, 0.002)]),
    "separate_random": lambda x, _: signal.separate_random(x, FS).random,
    "prediction_residual": lambda x, _: signal.prediction_residual(x, 30),
    "sharpen": lambda x, rates: signal.sharpen(x, FS, rates, 100),
}


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_no_record_depends_on_the_others(name, dtype):
    x = np.random.default_rng(0).standard_normal((3, 9000)).astype(dtype)
    together = FUNCTIONS[name](x, RATES)
    alone = np.concatenate([FUNCTIONS[name](x[row : row + 1], RATES[row : row + 1]) for row in range(3)])
    np.testing.assert_array_equal(together, alone)
    if together.shape[-1] > 1000:
        assert together.dtype == dtype
