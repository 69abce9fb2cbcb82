"""Laws of the weighted AUC and of weighted quantiles."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sklearn.metrics import roc_auc_score

from raceway.comparing.contrast import auc, quantiles

samples = st.lists(st.integers(-5, 5), min_size=1, max_size=30).map(lambda values: np.array(values, dtype=float))


def plain(below, above):
    return auc(below, above, np.ones(len(below)), np.ones(len(above)))


@given(samples, samples)
def test_the_auc_is_the_probability_of_a_higher_value_with_ties_counted_half(below, above):
    pairs = (above[:, None] > below) + 0.5 * (above[:, None] == below)
    assert plain(below, above) == pytest.approx(pairs.mean())
    labels = np.repeat([0, 1], [len(below), len(above)])
    assert plain(below, above) == pytest.approx(roc_auc_score(labels, np.concatenate([below, above])))


@given(samples, samples)
def test_the_auc_turns_over_with_the_sides_and_does_not_change_with_a_rising_function(below, above):
    assert plain(below, above) + plain(above, below) == pytest.approx(1)
    assert plain(np.exp(below), np.exp(above)) == pytest.approx(plain(below, above))


@given(samples, samples, st.integers(2, 4))
def test_a_weight_counts_as_that_many_equal_values(below, above, weight):
    weights = np.ones(len(below))
    weights[0] = weight
    repeated = np.concatenate([below, np.repeat(below[:1], weight - 1)])
    assert auc(below, above, weights, np.ones(len(above))) == pytest.approx(plain(repeated, above))
    assert quantiles(below, weights, (0.3, 0.5)) == quantiles(repeated, np.ones(len(repeated)), (0.3, 0.5))


@given(samples, st.floats(0.01, 0.99))
def test_a_quantile_is_a_value_that_the_share_does_not_exceed(values, share):
    (found,) = quantiles(values, np.ones(len(values)), (share,))
    assert np.mean(values <= found) >= share - 1e-9
    assert np.mean(values < found) < share
