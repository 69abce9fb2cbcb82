"""Laws of the labels that can be recovered: correlations are those of the signals, over specimens where the label is theirs."""

import numpy as np
import pytest
import xarray as xr
from scipy.stats import spearmanr

from gen.corpus import FAULTS, SIGNAL, recoverable
from gen.corpus.recoverable import rank_correlation, recoveries


def corpus_of(width, specimen, load, seed=0):
    """Records of noise whose rms is the width of their fault [mm]."""
    rng = np.random.default_rng(seed)
    signal = rng.standard_normal((len(width), 1, 400)) * np.asarray(width)[:, None, None]
    columns = {"fault": np.full(len(width), FAULTS.index("inner")), "width": width, "load": load, "specimen": specimen}
    data = {name: ("record", np.asarray(values)) for name, values in columns.items()}
    return xr.Dataset({SIGNAL: (("record", "channel", "elapsed_time"), signal), **data})


@pytest.fixture
def corpus():
    rng = np.random.default_rng(1)
    return corpus_of(np.repeat(rng.uniform(0.5, 5, 40), 3), np.repeat(np.arange(40), 3), rng.uniform(1, 9, 120))


def test_a_label_that_the_signal_follows_is_found_and_another_is_not(corpus):
    found = {row.label: row for row in recoveries(corpus)}
    assert found["width"].number == "rms"
    assert found["width"].correlation > 0.98
    assert abs(found["load"].correlation) < 0.3


def test_a_label_of_the_specimen_counts_specimens_and_one_of_the_record_counts_records(corpus):
    assert {row.label: row.items for row in recoveries(corpus)} == {"width": 40, "load": 120}


def test_labels_that_do_not_vary_and_healthy_records_are_left_out(corpus):
    assert [row.label for row in recoveries(corpus.assign(width=corpus["width"] * 0 + 1))] == ["load"]
    assert recoveries(corpus.assign(fault=corpus["fault"] * 0)) == []


def test_records_of_every_rung_are_looked_at_in_a_corpus_of_ladders(corpus, monkeypatch):
    monkeypatch.setattr(recoverable, "MOST_RECORDS", 60)
    damaged_each_second = corpus.assign(fault=corpus["fault"] * (np.arange(120) % 2))
    assert {row.label for row in recoveries(damaged_each_second)} == {"width", "load"}


@pytest.mark.parametrize("seed", range(5))
def test_the_rank_correlation_is_that_of_spearman_with_ties_too(seed):
    rng = np.random.default_rng(seed)
    x, y = rng.integers(0, 8, 50).astype(float), rng.standard_normal(50)
    assert rank_correlation(x, y + x / 3) == pytest.approx(spearmanr(x, y + x / 3).statistic, abs=1e-12)
