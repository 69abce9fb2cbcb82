"""Fault lines of the reference machine over 32 seeds of every fault, and no line of a fault that is not there.

Thresholds of the model study: a line over 15 dB is clear, one below 12 dB absent. Each row is one run, shared by its tests.
"""

import functools

import numpy as np
import pytest

from benchmarks.visibility import LINES, ROWS, STATED, UNSEEN, visibilities

SEEDS, SHARE = 32, 0.95
CLEAR, ABSENT = 15.0, 12.0  # dB
row = functools.cache(lambda name: visibilities(ROWS[name], SEEDS))


@pytest.mark.parametrize("name", [name for name in ROWS if name not in UNSEEN])
def test_the_lines_of_a_fault_stand_clear(name):
    stated = STATED.get(name, STATED.get(name.split()[0], ()))
    assert stated
    for line in stated:
        assert np.mean(row(name)[line] > CLEAR) >= SHARE, line


@pytest.mark.parametrize("name", UNSEEN)
def test_a_record_without_a_fault_in_the_load_zone_shows_no_line(name):
    highest = np.max([row(name)[line] for line in LINES], axis=0)
    assert np.mean(highest < ABSENT) >= SHARE


def test_the_strongest_series_names_the_fault():
    families = {"inner": "BPFI", "outer": "BPFO", "ball": "2BSF"}
    for name in ROWS:
        if name.split()[0] in families and "+" not in name and name not in UNSEEN:
            own = row(name)[families[name.split()[0]]]
            others = [row(name)[line] for family, line in families.items() if family != name.split()[0]]
            assert np.mean(own > np.max(others, axis=0)) >= SHARE, name
