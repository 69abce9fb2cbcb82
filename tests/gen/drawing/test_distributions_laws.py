"""Laws of the distributions of recipes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import kstest, loguniform, truncnorm, uniform

from gen.drawing.distributions import Choice, Constant, Grid, LogUniform, Normal, Uniform, weighted_index

quantiles = st.floats(0, 1, exclude_max=True)
numbers = st.floats(0.01, 100)
EVEN = (np.arange(2000) + 0.5) / 2000


@st.composite
def distributions(draw):
    low, high = sorted((draw(numbers), draw(numbers)))
    mean = draw(st.floats(low, high))
    values = tuple(draw(st.lists(numbers, min_size=1, max_size=5)))
    return draw(
        st.sampled_from(
            [
                Constant(value=low),
                Uniform(kind="uniform", low=low, high=high),
                LogUniform(kind="loguniform", low=low, high=high),
                Normal(kind="normal", mean=mean, sd=draw(numbers), low=low, high=high),
                Choice(kind="choice", values=values),
                Grid(kind="grid", values=values),
            ]
        )
    )


@given(distributions(), quantiles)
def test_every_value_lies_in_the_support(distribution, u):
    low, high = distribution.support()
    assert low * (1 - 1e-12) <= distribution.draw(u) <= high * (1 + 1e-12)


@given(distributions(), quantiles, quantiles)
def test_a_higher_quantile_never_gives_a_lower_value_of_a_continuous_distribution(distribution, u, v):
    if isinstance(distribution, Constant | Uniform | LogUniform | Normal):
        assert distribution.draw(min(u, v)) <= distribution.draw(max(u, v))


@pytest.mark.parametrize(
    ("distribution", "expected"),
    [
        (Uniform(kind="uniform", low=2, high=5), uniform(2, 3)),
        (LogUniform(kind="loguniform", low=0.1, high=30), loguniform(0.1, 30)),
        (Normal(kind="normal", mean=1, sd=2, low=0, high=4), truncnorm(-0.5, 1.5, 1, 2)),
        (Normal(kind="normal", mean=0, sd=1, low=-8, high=8), truncnorm(-8, 8)),
        (Normal(kind="normal", mean=0, sd=1, low=6, high=9), truncnorm(6, 9)),
        (Normal(kind="normal", mean=100, sd=2, low=40, high=88), truncnorm(-30, -6, 100, 2)),
    ],
    ids=["uniform", "loguniform", "normal", "untouched normal", "far above", "far below"],
)
def test_values_at_even_quantiles_follow_the_distribution_they_are_named_after(distribution, expected):
    values = [distribution.draw(u) for u in EVEN]
    assert kstest(values, expected.cdf).statistic < 1e-3


@given(st.lists(st.floats(0, 1), min_size=1, max_size=5).filter(lambda weights: sum(weights) > 0.1))
def test_a_weighted_choice_gives_each_value_its_share(weights):
    shares = np.bincount([weighted_index(tuple(weights), u) for u in EVEN], minlength=len(weights)) / len(EVEN)
    np.testing.assert_allclose(shares, np.array(weights) / sum(weights), atol=1e-3)
