"""Drawings of results: of one record as of the same among several, and with the planted line where it belongs."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import raceway
from features import signal
from tests.pulses import pulse_train

FS, RATE = 12_000.0, 107.0


@pytest.fixture(scope="module")
def records():
    noise = np.random.default_rng(1).standard_normal((1, 24_000))
    return np.concatenate([noise, pulse_train(FS, 2.0, RATE, 3000.0, np.random.default_rng(0))[None]])


RESULTS = {
    "kurtogram": lambda x: signal.kurtogram(x, FS),
    "comb_bands": lambda x: signal.comb_bands(x, FS, RATE),
    "order_map": lambda x: signal.order_map(x, 100, 20),
    "coherence": lambda x: signal.spectral_coherence(x, FS, 400.0),
}


def drawn(result, record=0):
    axes = raceway.plot(result, Figure().subplots(), record=record)
    return axes.get_title(), [np.asarray(one.get_array()) for one in axes.collections]


@pytest.mark.parametrize("compute", RESULTS.values(), ids=RESULTS)
def test_a_record_is_drawn_as_it_is_among_several(compute, records):
    title, maps = drawn(compute(records[1]))
    among, others = drawn(compute(records), record=1)
    assert title == among
    for one, other in zip(maps, others, strict=True):
        np.testing.assert_array_equal(one, other)


def test_the_coherence_of_an_impact_train_is_darkest_at_its_rate(records):
    axes = raceway.plot(signal.spectral_coherence(records[1], FS, 400.0), Figure().subplots())
    (mesh,) = axes.collections
    shade = np.asarray(mesh.get_array())
    edges = mesh.get_coordinates()[0, :, 0]
    darkest = edges[np.argmax(shade.max(axis=0))]
    assert darkest == pytest.approx(RATE * round(darkest / RATE), abs=2 * (edges[2] - edges[1]))
