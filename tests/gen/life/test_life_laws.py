"""Laws of life: the drawn lives have the rating life and the scatter of the standard, and growth is that of its equation."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.stats import kstest, weibull_min

from gen.life.ageing import STEPS, Life, ageing, history, log_normal
from gen.life.fatigue import EXPONENT, SLOPE, life_share, rating_life
from gen.life.growth import Growth, drive_between, length_after

LAW = Growth(rate=2e-9, exponent=1.2, critical=2e-3, acceleration=4.0)


def steady(load_ratio, count=50, step=3600.0, noise=None, **options):
    ones = np.ones(count)
    return ageing(step, 25 * ones, load_ratio * ones, ones if noise is None else noise, element="ball", **options)


@pytest.mark.parametrize("element", ["ball", "roller"])
def test_ten_thousand_lives_have_the_slope_and_the_rating_life_of_the_standard(element):
    failed = np.random.default_rng(1).random(10_000)
    turns = rating_life(0.2, element) * np.array([life_share(u, element) for u in failed])
    slope, _, scale = weibull_min.fit(turns, floc=0)
    assert slope == pytest.approx(SLOPE[element], rel=0.03)
    assert scale * (-math.log(0.9)) ** (1 / slope) == pytest.approx(0.2 ** -EXPONENT[element] * 1e6, rel=0.03)
    assert np.quantile(turns, 0.1) == pytest.approx(rating_life(0.2, element), rel=0.06)


def test_a_load_a_quarter_higher_halves_the_median_life():
    def median(load_ratio, seed):
        lives = [
            Life(steady(load_ratio), LAW, life_share(u, "ball"), 0.25e-3).age_at(5e-3)
            for u in np.random.default_rng(seed).random(4000)
        ]
        return np.median(lives)

    assert median(1.26 * 0.2, 2) == pytest.approx(median(0.2, 3) / 2, rel=0.05)


@settings(max_examples=8)
@given(st.floats(0, 2.5), st.floats(0.1, 4), st.floats(1, 10), st.floats(0.5, 5))
def test_growth_without_noise_is_the_solution_of_its_equation(exponent, first, acceleration, last):
    law, first, last = Growth(2e-9, exponent, 2e-3, acceleration), first * 1e-3, (first + last) * 1e-3
    drive = drive_between(law, first, last)

    def slope(_, length):
        return law.rate * (length / 1e-3) ** exponent * np.where(length > law.critical, acceleration, 1.0)

    # the step is small enough for the jump of the rate at the critical length
    solved = solve_ivp(slope, (0, drive), [first], rtol=1e-8, atol=1e-15, max_step=drive / 2000)
    assert solved.y[0, -1] == pytest.approx(last, rel=1e-3)
    np.testing.assert_allclose(length_after(law, first, solved.t), solved.y[0], rtol=1e-3)


def test_a_spall_that_grows_ever_faster_is_infinite_in_finite_time():
    assert length_after(Growth(2e-9, 2.0, 1.0, 1.0), 1e-3, 1e9) == math.inf


def test_histories_are_stationary_with_the_correlation_of_their_time():
    many = np.stack([history(np.random.default_rng([4, seed]), 3 * STEPS + 1) for seed in range(4000)])
    for step in (0, STEPS, 3 * STEPS):
        assert kstest(many[:, step], "norm").pvalue > 0.001
    assert np.mean(many[:, 5] * many[:, 5 + STEPS]) == pytest.approx(math.exp(-1), abs=0.05)
    assert np.mean(log_normal(many, 0.5)) == pytest.approx(1, abs=0.02)


def test_a_shorter_history_is_the_beginning_of_a_longer_one():
    short, long = (history(np.random.default_rng(5), count) for count in (40, 400))
    np.testing.assert_array_equal(short, long[:40])


def test_the_ages_of_a_life_and_its_lengths_agree():
    noise = log_normal(history(np.random.default_rng(6), 400), 0.5)
    life = Life(steady(0.3, 400, noise=noise), LAW, life_share(0.3, "ball"), 0.3e-3)
    ages = np.array([life.age_at(length) for length in (0.3e-3, 1e-3, 2e-3, 4e-3)])
    assert ages[0] == life.initiation
    np.testing.assert_allclose(life.length_at(ages[1:]), [1e-3, 2e-3, 4e-3], rtol=1e-9)
    assert life.length_at(0.999 * life.initiation) == 0
    grown = life.length_at(np.linspace(life.initiation, ages[-1], 500))
    assert (np.diff(grown) > 0).all()


def test_a_life_beyond_its_history_goes_on_at_the_mean_rate():
    share = life_share(0.5, "ball")
    short, long = (Life(steady(0.2, count), LAW, share, 0.3e-3) for count in (10, 50_000))
    assert short.ageing.age[-1] < short.initiation < long.ageing.age[-1]
    assert short.age_at(4e-3) == pytest.approx(long.age_at(4e-3), rel=1e-6)


def test_the_factor_of_the_standard_multiplies_the_time_to_the_spall_alone():
    share = life_share(0.5, "ball")
    whole, tenth = (Life(steady(0.4, factor=factor), LAW, share, 0.3e-3) for factor in (1.0, 0.1))
    assert tenth.initiation == pytest.approx(whole.initiation / 10)
    assert tenth.age_at(4e-3) - tenth.initiation == pytest.approx(whole.age_at(4e-3) - whole.initiation)
