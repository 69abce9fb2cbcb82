"""Warnings and refusals of the commands that learn: they come before the work, or beside the score that they concern."""

import sys

import numpy as np
import pytest

from features.baselines import Model
from features.table.table_files import write_table
from gen.support.errors import CorpusError
from raceway.commands import benchmark_commands, feature_commands, model_commands
from tests.model_files import make_table


def table():
    """A feature table without a test split."""
    return make_table(records=48).assign(split=("record", np.zeros(48, int)))


@pytest.fixture
def model(tmp_path):
    Model("logistic_regression").fit(table()).save(tmp_path / "model.skops")
    return tmp_path / "model.skops"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder in the place of a corpus, and the table that the commands compute of it."""
    (tmp_path / "corpus").mkdir()

    def returning(made):
        for module in (feature_commands, model_commands, benchmark_commands):
            monkeypatch.setattr(module, "table_of", lambda *_: made)
        return tmp_path / "corpus"

    return returning


def test_parquet_without_pyarrow_is_refused_before_any_feature_is_computed(run, folder, tmp_path, monkeypatch):
    corpus = folder(None)
    monkeypatch.setattr(feature_commands, "table_of", lambda *_: pytest.fail("features were computed"))
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    result = run("features", corpus, "-o", tmp_path / "x.parquet")
    assert result.exit_code != 0
    sentence = str(result.exception) + result.output
    assert "x.parquet: Parquet needs pyarrow; pip install pyarrow, or write .nc instead" in sentence
    with pytest.raises(CorpusError, match="Parquet needs pyarrow"):
        write_table(table(), tmp_path / "x.parquet")
    assert not (tmp_path / "x.parquet").exists()
