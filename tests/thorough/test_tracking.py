"""Courses of the shaft speed: errors over many draws as the page of features prints them, and none of a hundred for noise."""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

from features.signal import track_speed
from tests.run_ups import FS, run_up

RANGE = (10.0, 45.0)
KINDS = {"ramp": "ramp", "10 % at 0.1 Hz": "slow sine", "10 % at 0.5 Hz": "fast sine"}
LEVELS = (30, 0, -10, -20)
DRAWS = 5


def printed():
    """Rows of the table: course, harmonics, and errors [%] by level."""
    page = (Path(__file__).parents[2] / "docs" / "features.md").read_text()
    rows = re.findall(r"^\| (ramp|10 % at 0\.\d Hz) \| ([\d, ]+) \| (.+) \|$", page, re.MULTILINE)
    return [(kind, [int(k) for k in ks.split(",")], [float(e) for e in errors.split("|")]) for kind, ks, errors in rows]


@pytest.mark.parametrize(("kind", "harmonics", "errors"), printed())
def test_the_median_error_is_the_printed_one(kind, harmonics, errors):
    for level, expected in zip(LEVELS, errors, strict=True):
        rates, signals = zip(*(run_up(KINDS[kind], level, harmonics, seed) for seed in range(DRAWS)), strict=True)
        found = track_speed(np.stack(signals), FS, *RANGE).rate
        error = 100 * np.median(np.median(np.abs(found / np.stack(rates) - 1), axis=1))
        assert error == pytest.approx(expected, rel=0.1, abs=2e-3)


def test_the_table_is_read():
    assert len(printed()) == 6


@pytest.mark.parametrize(("level", "largest"), [(0, 0.01), (-20, 0.1)])
def test_a_ramp_from_12_to_36_hz_is_told_throughout_in_each_of_a_hundred_draws(level, largest):
    for seed in range(100):
        rate, x = run_up("ramp", level, seed=seed)
        assert 100 * np.median(np.abs(track_speed(x, FS, *RANGE).rate / rate - 1)) < largest


@pytest.mark.parametrize("pole", [0.0, 0.97, -0.97], ids=["white", "red", "blue"])
@pytest.mark.parametrize(("search", "seconds"), [((10.0, 45.0), 20), ((10.0, 45.0), 2), ((25.0, 35.0), 10)])
def test_noise_has_a_course_in_at_most_one_of_a_hundred_draws(pole, search, seconds):
    fs = 13 * search[1]
    x = lfilter([1], [1, -pole], np.random.default_rng(0).standard_normal((100, int(seconds * fs))), axis=1)
    assert np.isfinite(track_speed(x, fs, *search).rate).any(axis=1).sum() <= 1
