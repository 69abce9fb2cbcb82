"""The comparison of synthetic lives with real ones, on made-up snapshots."""

import numpy as np
import xarray as xr

from benchmarks.lives import NAMES, lives_of_file, once_a_minute, shape
from raceway.lives.prognosis import Lives

FS = 25_600.0


def made_up(seed, bearings=4):
    """Bearings whose rms is 3 times as large in the last fifth of 100 minutes or more."""
    rng, parts = np.random.default_rng(seed), []
    for number in range(bearings):
        age = 10.0 * np.arange(600 + 60 * number)
        level = np.where(age >= 0.8 * age[-1], 3.0, 1.0)[:, None, None]
        values = np.log(level * np.exp(0.02 * rng.normal(size=(len(age), len(NAMES), 2)))).reshape(len(age), -1)
        same = np.ones(len(age), bool)
        parts.append(Lives(values, age, age[-1] - age, same, number * same, same))
    return once_a_minute(Lives(*map(np.concatenate, zip(*parts, strict=True))))


def test_onset_and_rise_are_those_of_the_lives():
    found = shape(made_up(1))
    np.testing.assert_allclose(found["onset"], 0.8, atol=0.02)
    np.testing.assert_allclose(found["end over start rms"], 3, rtol=0.1)


def test_a_file_of_indicators_is_the_lives_of_its_bearings(tmp_path):
    values = np.random.default_rng(4).random((2, 2, 50)) + 1
    values[1, :, 30:] = np.nan
    names = dict.fromkeys(NAMES, (("bearing", "channel", "snapshot"), values))
    xr.Dataset(names).to_netcdf(tmp_path / "indicators.nc")
    lives = lives_of_file(tmp_path / "indicators.nc")
    assert np.bincount(lives.bearing).tolist() == [50, 30]
    assert lives.rul[[0, 49, 50, 79]].tolist() == [490, 0, 290, 0]
    np.testing.assert_array_equal(lives.features[:50].reshape(50, len(NAMES), 2)[:, 3], np.log(values[0].T))
