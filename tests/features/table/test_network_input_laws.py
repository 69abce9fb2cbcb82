"""Laws of the input of networks: lines of a bearing lie at the same multiples, whatever its speed, orders and sample rate."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from features import envelope_orders, open_waveforms
from features.signal.lines import Orders
from features.table.network_input import FAMILY_NAMES, GRID
from tests.tone_corpora import write_corpus

ORDERS = Orders(0.4, 3.58, 5.42, 2.36)


def known(fs=12_000.0, shaft_rate=25.0, orders=ORDERS):
    return {"sample_rate": fs, "shaft_rate": shaft_rate, **orders._asdict()}


def modulated(order, fs=12_000.0, shaft_rate=25.0, duration=1.0, seed=0):
    """Noise whose level rises at each pass of a spall of an order, shape (1, time)."""
    turns = shaft_rate * np.arange(round(duration * fs)) / fs
    noise = np.random.default_rng(seed).standard_normal(len(turns))
    return ((1 + 3 * np.exp(30 * (np.cos(2 * np.pi * order * turns) - 1))) * noise)[None]


@given(st.integers(0, 2), st.floats(15, 45), st.sampled_from([12_000.0, 20_480.0]), st.floats(0.9, 1.1))
def test_a_comb_stands_at_whole_multiples_of_its_family(family, shaft_rate, fs, other):
    orders = Orders(*(other * order for order in ORDERS))
    order = (orders.bpfo, orders.bpfi, 2 * orders.bsf)[family]
    levels = envelope_orders(modulated(order, fs, shaft_rate), known(fs, shaft_rate, orders))[0]
    assert levels.shape == (len(FAMILY_NAMES), 6, len(GRID))
    whole = np.isin(GRID, [1, 2, 3])
    broad = levels[:, 1]
    assert broad[family, whole].min() > 2
    assert broad[family, whole].min() > np.percentile(broad[family, ~whole], 90)
    assert max(range(3), key=lambda one: broad[one, whole].mean()) == family


def test_a_record_depends_on_no_other():
    x = np.concatenate([modulated(order, seed=seed) for seed, order in enumerate([3.58, 5.42, 4.72] * 7)])
    together = envelope_orders(x, known())
    for row in (0, 9, 20):
        np.testing.assert_array_equal(envelope_orders(x[row : row + 1], known())[0], together[row])


@pytest.mark.parametrize(
    ("x", "changed"),
    [
        (np.zeros((1, 12_000)), {}),
        (np.full((1, 12_000), np.nan), {}),
        (modulated(3.58)[:, :500], {}),
        (modulated(3.58, duration=0.1), {"shaft_rate": 15.0}),
        (modulated(3.58), {"shaft_rate": np.nan}),
        (modulated(3.58), {"bpfo": 0.0}),
    ],
)
def test_a_record_that_shows_no_line_has_no_level(x, changed):
    assert not envelope_orders(x, known() | changed).any()


def test_waveforms_give_the_levels_of_their_signals(tmp_path):
    orders = {name: np.full(48, value) for name, value in ORDERS._asdict().items()}
    signal = write_corpus(tmp_path / "corpus", **orders)
    X = open_waveforms(tmp_path / "corpus").take([40, 3, 17])
    chosen = {name: X.operating[name] for name in known()}
    expected = envelope_orders(signal[[40, 3, 17]], chosen)
    assert expected.any(axis=(1, 2, 3)).all()
    np.testing.assert_array_equal(envelope_orders(X, X.operating), expected)
