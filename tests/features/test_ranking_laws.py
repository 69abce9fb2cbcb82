"""Laws of rankings: a feature that tells the class, or follows a series, comes before one that does not."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from features import rank_features, rank_series
from features.baselines.importance import permutation_importance
from features.baselines.records import Records
from features.baselines.tracks import track_splits
from features.ranking import MEASURES, SERIES_MEASURES, series_measures
from gen.support.errors import CorpusError
from raceway.reports.pictures import picture
from raceway.reports.ranking import draw_ranking


def table_of(fault, specimen, recording, **features):
    """Feature table of given columns, in one group."""
    rows = {
        name: ("record", np.asarray(values))
        for name, values in (("fault", fault), ("specimen", specimen), ("recording", recording))
    }
    values = np.stack([np.broadcast_to(column, len(fault)) for column in features.values()], axis=1).astype(float)
    held = {"features": (("record", "feature"), values), "rig": ("record", np.zeros(len(fault), int))}
    coords = {"feature": list(features), "group": ("feature", ["time"] * len(features))}
    return xr.Dataset(rows | held, coords)


@pytest.fixture
def classes():
    """240 records of 40 specimens and two classes."""
    rng, specimen = np.random.default_rng(0), np.repeat(np.arange(40), 6)
    fault = specimen % 2
    own = rng.standard_normal(40)[specimen]
    noise = rng.standard_normal((3, 240))
    missing = np.where(np.arange(240) == 7, np.nan, 2 * fault + noise[1])
    columns = {
        "noise": noise[0],
        "of_the_specimen": own,
        "constant": 1.0,
        "class": missing,
        "class_in_part": fault + 2 * noise[2],
    }
    return table_of(fault, specimen, np.arange(240) % 6, **columns)


def test_the_feature_of_the_class_comes_first_and_one_of_the_specimen_tells_no_more_than_noise(classes):
    ranked = rank_features(classes)
    assert list(ranked.index[:2]) == ["class", "class_in_part"]
    assert ranked.importance["class"] > 0.3 > 0.1 > ranked.importance[["noise", "of_the_specimen"]].abs().max()
    assert ranked.anova_f["class"] > 100 > 10 > ranked.anova_f[["noise", "of_the_specimen"]].max()
    assert ranked.index[-1] == "constant"
    assert ranked.loc["constant", list(MEASURES)[:3]].isna().all()
    assert picture(draw_ranking(ranked), "svg").count(b"<!-- class in part -->") == 1


def test_a_ranking_does_not_depend_on_gain_nor_on_the_order_of_the_features(classes):
    other = classes.isel(feature=[4, 3, 2, 1, 0]).assign(features=7 * classes.features.isel(feature=[4, 3, 2, 1, 0]))
    first = rank_features(classes)
    second = rank_features(other).loc[first.index]
    np.testing.assert_allclose(second[["anova_f", "kruskal_h"]], first[["anova_f", "kruskal_h"]])


def test_a_table_of_one_class_is_refused(classes):
    with pytest.raises(CorpusError, match="two or more classes"):
        rank_features(classes.isel(record=classes.fault.values == 0))


def test_a_trend_is_monotonic_alike_and_ends_at_one_level():
    rng, time = np.random.default_rng(1), [np.linspace(0, 1, n) for n in (30, 50, 41)]
    series = [np.stack([t, t**2 * 3, 1 - t, (1 - t) * k, np.sin(20 * t + k)], axis=1) for k, t in enumerate(time, 1)]
    measures = series_measures(series)
    np.testing.assert_allclose(measures["monotonicity"][:4], 1)
    np.testing.assert_allclose(measures["trendability"][:4], 1)
    np.testing.assert_allclose(measures["prognosability"][:4], 1)
    assert max(measures[name][4] for name in SERIES_MEASURES) < 0.7
    ends = series_measures([t[:, None] * k for k, t in enumerate(time, 1)])["prognosability"][0]
    assert ends == pytest.approx(np.exp(-np.std([1, 2, 3], ddof=1) / 2))
    noisy = series_measures([rng.standard_normal((200, 1)) for _ in range(3)])
    assert max(noisy["monotonicity"][0], noisy["trendability"][0]) < 0.2


def test_series_are_those_of_specimens_in_the_order_of_their_recordings():
    order = np.random.default_rng(2).permutation(30)
    specimen, recording = order // 10, order % 10
    table = table_of(recording // 6, specimen, recording, noise=np.sin(7.7 * order), wear=recording**2 + 0.5)
    ranked = rank_series(table)
    assert list(ranked.index) == ["wear", "noise"]
    np.testing.assert_allclose(ranked.loc["wear", list(SERIES_MEASURES)].astype(float), 1)
    with pytest.raises(CorpusError, match="are no series"):
        rank_series(table.isel(record=specimen == 0))


def test_a_noise_feature_has_no_importance_and_features_exchanged_together_have_that_of_what_they_share(classes):
    values = classes["features"].values
    rows = pd.DataFrame(np.column_stack([values[:, 3], values[:, 3], values[:, 0]]))
    unused = np.zeros(240)
    fault, specimen = classes["fault"].values, classes["specimen"].values
    records = Records("made up", rows, fault, unused, specimen, np.arange(240), unused)
    splits = track_splits(records, fault, "specimen", 5, seed=0)
    one, both, noise = permutation_importance(records, [[0], [0, 1], [2]], "extra_trees", splits, seed=0)
    assert abs(noise) < 0.05
    assert both > 0.2 > one
