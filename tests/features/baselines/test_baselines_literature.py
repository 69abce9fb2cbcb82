"""The untrained baseline against known results: rare false alarms in noise, and race faults of real recordings.

The recordings are in the folder that ``RACEWAY_REAL`` names, or beside the repository.
"""

import numpy as np
import pandas as pd
import pytest

from features.baselines import Model, cross_validate
from features.baselines.estimators import EnvelopeRule
from features.table.class_features import COMBS
from features.table.corpus_features import feature_table
from features.table.indicators import Orders, feature_names, indicators
from gen.corpus import FAULTS
from gen.support.errors import CorpusError
from raceway.importing import import_set
from tests.paths import REAL


def real_table(name, folder):
    if not (REAL / name).is_dir():
        pytest.skip(f"no real recordings: set RACEWAY_REAL to the folder that holds {name}")
    return feature_table(import_set(name, REAL / name, folder / name).path, ("lines", "shape"))


@pytest.fixture(scope="module")
def cwru(tmp_path_factory):
    return real_table("cwru", tmp_path_factory.mktemp("real"))


@pytest.fixture(scope="module")
def mfpt(tmp_path_factory):
    return real_table("mfpt", tmp_path_factory.mktemp("real"))


def test_white_noise_exceeds_the_threshold_of_the_rule_in_fewer_than_one_record_in_a_hundred():
    rng, records, fs, samples = np.random.default_rng(1), 1000, 12_000.0, 6000
    orders = Orders(*(np.full(records, order) for order in (0.3983, 3.5848, 5.4152, 2.3567)))
    x, shaft_rate = rng.standard_normal((records, samples)), rng.uniform(15, 50, records)
    values, _ = indicators(x, fs, shaft_rate, orders, ("lines",))
    frame = pd.DataFrame(values, columns=list(feature_names(("lines",))))
    assert np.mean(frame[list(COMBS.values())].max(axis=1) > EnvelopeRule().threshold) < 0.01
    assert np.mean(EnvelopeRule().fit(frame, np.arange(len(FAULTS))).predict(frame) > 0) < 0.01


def test_the_rule_scores_on_cwru_as_comparable_rules_do(cwru):
    # rules with other floors and thresholds reach 0.59-0.65; no rule on lines alone exceeds 0.83
    found = Model("envelope_rule").fit(cwru).score(cwru)
    assert 0.59 < found.balanced_accuracy < 0.80
    assert found.by_recording is not None
    assert found.by_recording.records == 64


def test_the_rule_finds_every_fault_of_mfpt(cwru, mfpt):
    assert Model("envelope_rule").fit(cwru).score(mfpt).balanced_accuracy > 0.98


def test_a_set_with_one_healthy_bearing_cannot_be_cross_validated_by_bearing(cwru):
    with pytest.raises(CorpusError, match="all healthy records are of one specimen"):
        cross_validate(cwru, "envelope_rule")
