"""Laws of rankings: a feature that tells the class comes before one that does not."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from features import rank_features
from features.baselines.inspection import permutation_losses
from features.baselines.records import Records
from features.baselines.tracks import track_splits
from gen.support.errors import CorpusError


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
    assert ranked.loc["constant", ["importance", "deviation"]].tolist() == [0, 0]


def test_a_table_of_one_class_is_refused(classes):
    with pytest.raises(CorpusError, match="two or more classes"):
        rank_features(classes.isel(record=classes.fault.values == 0))


def test_a_noise_feature_has_no_importance_and_features_exchanged_together_have_that_of_what_they_share(classes):
    values = classes["features"].values
    rows = pd.DataFrame(np.column_stack([values[:, 3], values[:, 3], values[:, 0]]))
    unused = np.zeros(240)
    fault, specimen = classes["fault"].values, classes["specimen"].values
    records = Records("made up", rows, fault, unused, specimen, np.arange(240), unused, unused, unused)
    splits = track_splits(records, fault, "specimen", 5, seed=0)
    one, both, noise = permutation_losses(records, [[0], [0, 1], [2]], "extra_trees", splits, seed=0).mean(axis=0)
    assert abs(noise) < 0.05
    assert both > 0.2 > one
