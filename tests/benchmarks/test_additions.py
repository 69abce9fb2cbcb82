"""The benchmark of additions to the feature table, on a corpus of pulses."""

import numpy as np

from benchmarks.additions import ADDITIONS, tables
from gen.corpus import FAULTS
from tests.pulses import write_pulses

FAMILIES = ("outer", "inner", "ball")


def test_every_addition_but_noise_has_the_line_of_the_fault_on_top(tmp_path):
    made = tables(write_pulses(tmp_path / "pulses", duration=0.5))
    default = made.pop("default set")["features"].values
    faulty = np.flatnonzero(made["noise (control)"]["fault"].values != FAULTS.index("healthy"))
    assert set(made) == set(ADDITIONS)
    for addition, table in made.items():
        values = table["features"].values
        np.testing.assert_array_equal(values[:, : default.shape[1]], default)
        top = values[faulty, -3:].argmax(axis=1)
        own = [FAMILIES.index(FAULTS[code]) for code in table["fault"].values[faulty]]
        assert np.mean(top == own) > 0.9 or "noise" in addition
