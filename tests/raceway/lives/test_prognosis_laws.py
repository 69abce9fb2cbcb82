"""Laws of estimates of remaining life: the signal helps where it tells the end alone; survival curves."""

import numpy as np
import pytest
import xarray as xr

from gen.corpus.schema import identity
from gen.support.errors import CorpusError
from raceway.lives.prognosis import age_and_features, lives_of, score_lives, scores_of
from raceway.lives.survival import kaplan_meier, weibull, weibull_median_left

CADENCE = 10.0


def table(seed, bearings=30, told=True, corpus="a"):
    """Made-up lives: one feature rises for the last four tenths of each life, if it tells anything, beside two that are noise."""
    rng, rows = np.random.default_rng(seed), []
    for number in range(bearings):
        life, out = 1000 * rng.weibull(2), 2000 * rng.random() + 300
        begun = 0.6 * life
        age = np.arange(0, min(life, out), CADENCE)
        rise = np.maximum(age - begun, 0) / (life - begun)
        noise = rng.standard_normal((len(age), 3))
        noise[:, 0] += 20 * rise * told
        for place, features in enumerate(noise):
            rows.append((features, age[place], life - age[place], life <= out, number, age[place] > begun))
    features, age, rul, failed, number, damaged = map(np.array, zip(*rows, strict=True))
    order = rng.permutation(len(age))
    columns = {
        "age": age, "rul": rul, "event": failed.astype(int), "rig": 0 * number, "specimen": number, "bearing": np.full(len(number), "6205"),
        "stage": damaged.astype(int),
        "identity": np.array([identity(f"{corpus}{seed}", 0, *some) for some in zip(number, age, strict=True)]),
    }  # fmt: skip
    variables = {name: ("record", values) for name, values in columns.items()}
    return xr.Dataset({"features": (("record", "feature"), features)} | variables).isel(record=order)


def test_estimates_by_the_truth_have_the_best_scores():
    lives = lives_of(table(1))
    truth = scores_of(lives, {"truth": lives.rul}).loc["truth"]
    assert truth[["mae_50", "mae_75", "mae_90", "mae_before"]].tolist() == [0, 0, 0, 0]
    assert truth[["phm_2012", "alpha_lambda", "concordance"]].tolist() == [1, 1, 1]


def test_a_feature_that_tells_the_end_helps_near_the_end_alone():
    scores = score_lives(table(2, bearings=60), table(3, bearings=60))
    assert scores.mae_before["boosting"] > 0.9 * scores.mae_before["without_signal"]
    for name in ("phm_2012", "alpha_lambda", "concordance"):
        assert scores[name]["boosting"] > scores[name]["without_signal"]
    assert scores.mae_90["boosting"] < 0.8 * scores.mae_90["without_signal"]


def test_features_that_tell_nothing_are_no_better_than_age():
    scores = score_lives(table(4, bearings=60, told=False), table(10, bearings=60, told=False))
    for name in ("mae_50", "mae_75", "mae_90", "mae_before"):
        assert scores[name]["boosting"] > 0.9 * scores[name]["without_signal"]


def test_the_remaining_life_of_censored_bearings_is_never_used():
    known = table(5)
    hidden = known.assign(rul=known["rul"].where(known["event"] == 1))
    one, other = score_lives(known, table(11)), score_lives(hidden, table(11))
    scored = ["mae_50", "mae_75", "mae_90", "phm_2012", "alpha_lambda", "concordance"]
    assert one[scored].equals(other[scored])


def test_bearings_of_the_training_are_not_tested_at_other_ages_either():
    halves = (table(6).isel(record=slice(first, None, 2)) for first in (0, 1))
    with pytest.raises(CorpusError, match="are among those of the training"):
        score_lives(*halves)


def test_bearings_of_two_machines_are_others_though_both_begin_at_0():
    lives = table(5, bearings=10)
    number = lives["specimen"].values
    of_two = lives.assign(rig=("record", number // 5), specimen=("record", number % 5))
    for one, other in zip(lives_of(lives), lives_of(of_two), strict=True):
        np.testing.assert_array_equal(one, other)


def test_the_order_of_records_does_not_matter():
    given = table(7, bearings=12)
    shuffled = given.isel(record=np.random.default_rng(8).permutation(given.sizes["record"]))
    assert score_lives(given, folds=2).equals(score_lives(shuffled, folds=2))


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (table(9).drop_vars("stage"), "the feature table: has no lives"),
        (table(9).assign(event=0 * table(9)["event"]), "no bearing of the feature table failed"),
        (table(9, bearings=3), "folds: 5 is not a whole number from 2 to 3, the number of bearings"),
    ],
)
def test_a_table_without_lives_is_refused(wrong, sentence):
    with pytest.raises(CorpusError, match=sentence):
        score_lives(wrong)


def test_a_training_without_a_failure_is_refused():
    few = table(6, bearings=6)
    failed = few["specimen"].values[few["event"].values == 1][0]
    few["event"] = few["event"].where(few["specimen"] == failed, 0)
    with pytest.raises(CorpusError, match=r"no bearing of the training failed in one of the folds; use more folds"):
        score_lives(few, folds=3)


def test_bearings_with_other_features_are_refused():
    with pytest.raises(CorpusError, match="have other features than those of the training"):
        score_lives(table(6), table(7).isel(feature=[0, 1]))


SLOPE, SCALE = 10 / 9, 1000.0
MEDIAN = SCALE * np.log(2) ** (1 / SLOPE)


def drawn(rng, count, late=0.0):
    """Entry, end and failure of lives with censoring at random, those that failed before they entered left out."""
    life, entry = SCALE * rng.weibull(SLOPE, 4 * count), late * rng.random(4 * count)
    seen = np.flatnonzero(life > entry)[:count]
    life, entry = life[seen], entry[seen]
    out = entry + 2000 * rng.random(count)
    return entry, np.minimum(life, out), life <= out


@pytest.mark.parametrize("late", [0.0, 300.0, 1000.0])
def test_the_true_survival_is_inside_its_band_in_nearly_all_runs(late):
    inside = 0
    for seed in range(2000):  # the share of 400 runs is known to 1 %
        curve = kaplan_meier(*drawn(np.random.default_rng(seed), 60, late))
        place = np.searchsorted(curve.time, MEDIAN, side="right") - 1
        low, high = curve.band()
        inside += low[place] <= 0.5 <= high[place]
    assert inside / 2000 >= 0.93


def test_without_censoring_the_curve_is_the_share_that_lives():
    life = np.random.default_rng(1).weibull(1.5, 100)
    curve = kaplan_meier(np.zeros(100), life, np.ones(100, bool))
    np.testing.assert_allclose(curve.share, 1 - np.arange(1, 101) / 100, atol=1e-12)
    assert curve.at(np.array([0.0]))[0] == 1


@pytest.mark.parametrize("late", [0.0, 300.0])
def test_the_weibull_fit_finds_the_distribution_of_censored_lives(late):
    slope, scale = weibull(*drawn(np.random.default_rng(2), 20_000, late))
    assert slope == pytest.approx(SLOPE, rel=0.03)
    assert scale == pytest.approx(SCALE, rel=0.03)


def test_half_of_the_bearings_of_an_age_live_for_the_median_of_a_weibull_distribution():
    age = np.array([0.0, 100.0, 1000.0, 5000.0])
    left = weibull_median_left(SLOPE, SCALE, age)
    np.testing.assert_allclose(((age + left) / SCALE) ** SLOPE - (age / SCALE) ** SLOPE, np.log(2), rtol=1e-9)


def test_a_fit_to_one_life_leaves_no_time_beyond_it():
    """Its slope is as steep as numbers allow."""
    slope, scale = weibull(np.zeros(1), np.array([SCALE]), np.ones(1, bool))
    left = weibull_median_left(slope, scale, np.array([0.0, 0.5, 1.0, 2.0]) * SCALE)
    np.testing.assert_allclose(left, np.array([1.0, 0.5, 0.0, 0.0]) * SCALE, atol=1e-6)


def test_bearings_of_one_name_are_told_apart():
    """Joined corpora of two seeds have bearings of the same name and other specimens."""
    one, other = table(7), table(8)
    joined = xr.concat([one, other.assign(specimen=other["specimen"] + 30)], "record")
    assert len(np.unique(lives_of(joined).bearing)) == 60


def test_a_snapshot_is_compared_with_those_before_it_alone():
    lives = lives_of(table(9))
    later = lives._replace(features=lives.features + 100 * (lives.age[:, None] >= 3 * CADENCE))
    early = lives.age < 3 * CADENCE
    np.testing.assert_array_equal(age_and_features(later)[early], age_and_features(lives)[early])
