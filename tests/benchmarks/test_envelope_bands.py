"""The benchmark of envelope bands, on one made-up recording of an inner race fault."""

import numpy as np
from scipy.signal import lfilter

from benchmarks.envelope_bands import FAMILIES, WHITENINGS, comb_levels
from benchmarks.speed import Recording


def test_every_cell_of_the_table_has_the_comb_of_the_fault_on_top():
    rng, fs, rate, orders = np.random.default_rng(0), 12_000.0, 29.0, (0.4, 3.58, 5.42, 2.36)
    x = 0.1 * rng.standard_normal(24_000)
    x[np.arange(100.0, 23_900.0, fs / (rate * orders[2])).astype(int)] += 5.0
    x = lfilter([1.0], np.poly(0.95 * np.exp(2j * np.pi * 3000 / fs * np.array([1, -1]))).real, x)
    x += 0.1 * np.random.default_rng(1).standard_normal(24_000)
    found = dict(comb_levels(Recording(x.reshape(4, -1), fs, rate, np.nan, orders, "inner")))
    assert len(found) == 3 * len(WHITENINGS)
    assert {FAMILIES[int(np.argmax(values))] for values in found.values()} == {"inner"}
