"""Drawings of results: of one record as of the same among several, and with the planted line where it belongs."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import gen
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


def test_an_order_map_ends_behind_the_lines_of_the_faults_which_are_drawn_if_they_are_given(records):
    result = signal.order_map(records[1], 100, 20)
    assert raceway.plot(result, Figure().subplots()).get_xlim() == (0, 20)
    orders = gen.bearing_orders("6205")
    axes = raceway.plot(result, Figure().subplots(), orders=orders)
    assert axes.get_xlim() == pytest.approx((0, 3.15 * orders.bpfi))
    drawn_at = {line.get_xdata()[0] for line in axes.lines}
    assert drawn_at >= {1.0, orders.ftf, orders.bpfo, orders.bpfi, 2 * orders.bsf}
    assert {"BPFO", "BPFI"} <= {text.get_text() for text in axes.texts}
    with pytest.raises(ValueError, match="orders: are drawn over an order map alone"):
        raceway.plot(signal.kurtogram(records[1], FS), Figure().subplots(), orders=orders)


def test_an_order_map_of_noise_is_as_dark_however_many_samples_a_turn_has():
    fs, rate = 1000.0, 10.0
    noise = np.random.default_rng(2).standard_normal((1, 10_000))
    angle = 2 * np.pi * rate * np.arange(10_000)[None] / fs
    for per_turn in (60, 128, 512, 1024):
        resampled = signal.order_map(signal.resample_to_angle(noise, angle, per_turn), per_turn)
        axes = raceway.plot(resampled, Figure().subplots())
        # half the sample rate is at order 50
        level = np.asarray(axes.collections[0].get_array())[:, resampled.orders[1:] < 28]
        assert np.median(level) == pytest.approx(0, abs=1.5), per_turn
