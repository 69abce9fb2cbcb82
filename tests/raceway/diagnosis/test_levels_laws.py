"""Levels are those of NumPy and SciPy."""

import numpy as np
import pytest
from scipy.stats import kurtosis

from raceway.diagnosis.levels import ACCELERATION, levels_of

FS = 12_000.0


def noise(seconds, seed=1):
    return np.random.default_rng(seed).standard_normal(round(FS * seconds))


@pytest.mark.parametrize("mean", [0.0, 8.7])
def test_levels_are_those_of_numpy_and_scipy_and_do_not_depend_on_the_mean(mean):
    x = noise(3.0) ** 3
    levels = levels_of((x + mean).astype(np.float32), FS, "fan", "x", ACCELERATION, 25.0)
    assert levels.mean == pytest.approx(mean + x.mean(), abs=1e-5)
    assert levels.rms == pytest.approx(x.std(), rel=1e-5)
    assert levels.peak == pytest.approx(np.abs(x - x.mean()).max(), rel=1e-5)
    assert levels.crest_factor == pytest.approx(np.abs(x - x.mean()).max() / x.std(), rel=1e-5)
    assert levels.kurtosis == pytest.approx(kurtosis(x, fisher=False), rel=1e-5)


def test_what_the_signal_cannot_tell_is_not_a_number():
    assert np.isnan(levels_of(noise(3.0), FS, "", "", "unit of the file", 25.0).velocity_rms_mm_s)
    constant = levels_of(np.full(24_000, 3.0), FS, "", "", ACCELERATION, 25.0)
    assert (constant.mean, constant.rms, constant.peak, constant.velocity_rms_mm_s) == (3.0, 0.0, 0.0, 0.0)
    assert np.isnan([constant.crest_factor, constant.kurtosis]).all()
