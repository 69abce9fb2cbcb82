"""Laws of the course of the shaft speed: as exact as the noise lets it be, and none where there is no shaft."""

import math
import re
from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from features.signal import track_speed
from features.signal.tracking import JUMP, _path
from tests.run_ups import FS, run_up

RANGE = (10.0, 45.0)


def error(rate, x):
    """Median relative error over the record, its ends included; NaN if it is not tracked throughout."""
    return np.median(np.abs(track_speed(x, FS, *RANGE).rate / rate - 1))


@given(st.integers(0, 1000))
def test_the_path_is_the_best_of_all_paths(seed):
    evidence, candidates = np.random.default_rng(seed).exponential(size=(4, 5)), np.arange(10, 60, 10)
    paths = list(product(range(5), repeat=4))
    jumps = [sum((10 * (after - before)) ** 2 for before, after in pairwise(path)) for path in paths]
    best = paths[np.argmax(evidence[range(4), paths].sum(axis=1) - JUMP * np.array(jumps))]
    np.testing.assert_array_equal(_path(evidence, candidates), candidates[list(best)])


@pytest.mark.parametrize("kind", ["ramp", "slow sine", "run-up"])
@pytest.mark.parametrize(("level_db", "largest"), [(30, 5e-4), (0, 5e-4), (-20, 3e-3)])
def test_one_harmonic_tells_the_course_to_within_the_noise(kind, level_db, largest):
    assert error(*run_up(kind, level_db)) < largest


@pytest.mark.parametrize("harmonics", [(1, 2, 3), (2, 3, 4), (1, 3)])
@pytest.mark.parametrize(("level_db", "largest"), [(0, 2e-4), (-20, 1e-3)])
def test_neither_half_nor_double_the_speed_is_taken_whatever_harmonics_there_are(harmonics, level_db, largest):
    assert error(*run_up("ramp", level_db, harmonics)) < largest


@pytest.mark.parametrize(("level", "largest"), [(1.0, 5e-4), (10.0, 2e-3)])
def test_a_line_of_the_mains_is_not_taken_for_a_shaft_that_changes_its_speed(level, largest):
    rate, x = run_up("ramp", -10)
    assert error(rate, x + level * np.cos(2 * np.pi * 50 * np.arange(len(x)) / FS)) < largest


@pytest.mark.parametrize(
    "x",
    [
        np.zeros(60_000),
        np.full(60_000, 3.0),
        np.random.default_rng(0).standard_normal(60_000),
        np.cumsum(np.random.default_rng(1).standard_normal(60_000)),
        np.diff(np.random.default_rng(2).standard_normal(60_001)),
    ],
    ids=["zeros", "constant", "white", "red", "blue"],
)
def test_a_signal_without_a_shaft_has_no_course(x):
    found = track_speed(x, 1000.0, *RANGE)
    assert np.isnan(found.rate).all()
    assert np.isnan(found.uncertainty).all()


@pytest.mark.parametrize("noisy", [False, True])
def test_a_part_without_lines_has_no_course_and_the_rest_has_the_right_one(noisy):
    rate, x = run_up("ramp", 0, (1, 2, 3))
    silent = slice(100_000, 160_000)  # 4.7 s, of which a window of 0.8 s at each end holds lines too
    x[silent] = noisy * np.random.default_rng(1).standard_normal(60_000)
    found = track_speed(x, FS, *RANGE).rate
    assert np.isnan(found[115_000:145_000]).all()
    known = np.r_[found[:90_000], found[170_000:]]
    np.testing.assert_allclose(known, np.r_[rate[:90_000], rate[170_000:]], rtol=1e-2)


def test_a_unit_changes_nothing_and_a_recording_played_twice_as_fast_is_of_a_shaft_twice_as_fast():
    _, x = run_up("ramp", -10, seconds=5)
    found = track_speed(x, FS, *RANGE)
    np.testing.assert_allclose(track_speed(1024 * x, FS, *RANGE).rate, found.rate, rtol=1e-9)
    faster = track_speed(x, 2 * FS, 20, 90)
    np.testing.assert_allclose(faster.rate, 2 * found.rate, rtol=1e-6)
    np.testing.assert_allclose(faster.uncertainty, 2 * found.uncertainty, rtol=1e-4)


@pytest.mark.parametrize(("slowest", "fastest", "said"), [(30, 20, "no range"), (5, 3000, "no range"), (1, 9, "16 s")])
def test_a_range_of_speeds_that_a_signal_does_not_show_is_refused(slowest, fastest, said):
    with pytest.raises(ValueError, match=said):
        track_speed(run_up("ramp", 0, seconds=10)[1], FS, slowest, fastest)


def test_the_length_and_the_speed_that_a_refusal_names_are_accepted():
    x = run_up("ramp", 0, seconds=5)[1]
    with pytest.raises(ValueError, match=r"give \S+ s or more") as refused:
        track_speed(x[: int(2 * FS)], FS, 7, 40)
    seconds = float(re.search(r"give (\S+) s or more", str(refused.value))[1])
    assert seconds == pytest.approx(16 / 7, rel=1e-3)
    track_speed(x[: math.ceil(seconds * FS)], FS, 7, 40)
    with pytest.raises(ValueError, match="no range up to") as refused:
        track_speed(x, FS + 1 / 3, 7, FS)
    track_speed(x, FS + 1 / 3, 7, float(re.search(r"no range up to (\S+) Hz", str(refused.value))[1]))
