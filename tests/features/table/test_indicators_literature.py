"""Cited numbers: moments of known distributions, and fault lines known to be in public recordings."""

import re

import numpy as np
import pytest
from scipy.io import loadmat

from features.signal.shape import time_statistics
from features.table.indicators import Orders, feature_names, indicators
from features.table.waveform_groups import TIMES
from tests.paths import REAL

CWRU = REAL / "cwru" / "12k_drive_end"
NORMAL = REAL / "cwru" / "normal"
SPEEDS = (1797, 1772, 1750, 1730)  # nominal rpm at motor loads 0-3
ORDERS_6205 = (0.39828, 3.5848, 5.4152, 4.7135 / 2)  # as published with the recordings

real_recordings = pytest.mark.skipif(
    not CWRU.is_dir(), reason="no real recordings; set RACEWAY_REAL to a folder that holds cwru/"
)


def test_a_sine_has_the_statistics_of_the_arcsine_distribution():
    x = 3.0 * np.sin(2 * np.pi * 50 * np.arange(12_000) / 12_000)[None]
    values = dict(zip((feature.name.removeprefix("time_") for feature in TIMES), time_statistics(x)[0], strict=True))
    expected = {
        "rms": 3 / np.sqrt(2),
        "peak": 3.0,
        "crest_factor": np.sqrt(2),
        "kurtosis": 1.5,
        "shape_factor": np.pi / np.sqrt(8),
        "impulse_factor": np.pi / 2,
    }
    for name, value in expected.items():
        assert values[name] == pytest.approx(value, rel=1e-3), name
    assert values["skewness"] == pytest.approx(0.0, abs=1e-9)


def test_noise_has_the_statistics_of_the_normal_distribution():
    x = np.random.default_rng(0).standard_normal((1, 200_000))
    values = dict(zip((feature.name.removeprefix("time_") for feature in TIMES), time_statistics(x)[0], strict=True))
    assert values["kurtosis"] == pytest.approx(3.0, abs=0.05)
    assert values["skewness"] == pytest.approx(0.0, abs=0.02)
    assert values["shape_factor"] == pytest.approx(np.sqrt(np.pi / 2), rel=0.01)


def half_second_features(path, load):
    number = int(re.match(r"\d+", path.name).group())
    x = loadmat(path)[f"X{number:03d}_DE_time"].ravel()
    x = x[: len(x) // 6000 * 6000].reshape(-1, 6000)
    records = np.ones(len(x))
    orders = Orders(*(order * records for order in ORDERS_6205))
    values, names = indicators(x, 12_000.0, SPEEDS[load] / 60 * records, orders)
    assert names == feature_names()
    return dict(zip(names, np.median(values, axis=0), strict=True))


@real_recordings
@pytest.mark.parametrize("load", range(4))
@pytest.mark.parametrize(
    ("folder", "family"), [("IR/007", "bpfi"), ("IR/021", "bpfi"), ("OR/007/@6", "bpfo"), ("OR/021/@6", "bpfo")]
)
def test_the_comb_of_a_race_fault_stands_out_in_real_recordings(folder, family, load):
    (path,) = (CWRU / folder).glob(f"*_{load}.mat")
    values = half_second_features(path, load)
    other = {"bpfi": "bpfo", "bpfo": "bpfi"}[family]
    for view in ("cepstral", "whitened"):
        assert values[f"{view}_{family}_comb"] > 1.0
        assert values[f"{view}_{family}_comb"] > 0.4 + max(values[f"{view}_{other}_comb"], values[f"{view}_2bsf_comb"])


@real_recordings
@pytest.mark.parametrize("load", range(1, 4))
def test_no_comb_stands_out_in_healthy_real_recordings(load):
    (path,) = NORMAL.glob(f"*_{load}_12k.mat")
    values = half_second_features(path, load)
    for family in ("bpfo", "bpfi", "2bsf"):
        assert values[f"whitened_{family}_comb"] < 0.8
