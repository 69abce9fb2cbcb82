"""Laws of estimates of remaining life: the signal helps where it tells the end, and nowhere else."""

import numpy as np
import pytest
import xarray as xr

from gen.support.errors import CorpusError
from raceway.lives.prognosis import lives_of, score_lives, scores_of

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
        "age": age, "rul": rul, "event": failed.astype(int), "bearing": np.array([f"6205 #{one}" for one in number]),
        "stage": damaged.astype(int), "identity": np.array([f"{corpus}{seed}/{one}/{a}" for one, a in zip(number, age, strict=True)]),
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


def test_bearings_of_the_training_are_not_tested():
    with pytest.raises(CorpusError, match="are among those of the training"):
        score_lives(table(6), table(6))


def test_the_order_of_records_does_not_matter():
    given = table(7, bearings=12)
    shuffled = given.isel(record=np.random.default_rng(8).permutation(given.sizes["record"]))
    assert score_lives(given, folds=2).equals(score_lives(shuffled, folds=2))


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (table(9).drop_vars("stage"), "the feature table: has no lives"),
        (table(9).assign(event=0 * table(9)["event"]), "no bearing of the feature table failed"),
        (table(9, bearings=3), "3 bearings are fewer than 5 folds"),
    ],
)
def test_a_table_without_lives_is_refused(wrong, sentence):
    with pytest.raises(CorpusError, match=sentence):
        score_lives(wrong)


def test_a_training_without_a_failure_is_refused():
    few = table(6, bearings=6)
    failed = few["bearing"].values[few["event"].values == 1][0]
    few["event"] = few["event"].where(few["bearing"] == failed, 0)
    with pytest.raises(CorpusError, match=r"no bearing of the training failed in one of the folds; use more folds"):
        score_lives(few, folds=3)


def test_bearings_with_other_features_are_refused():
    with pytest.raises(CorpusError, match="have other features than those of the training"):
        score_lives(table(6), table(7).isel(feature=[0, 1]))
