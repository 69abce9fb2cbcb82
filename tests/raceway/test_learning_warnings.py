"""What a command that learns refuses, it refuses before the work."""

import sys

import pytest

from features.table.table_files import write_table
from gen.support.errors import CorpusError
from raceway.commands import feature_commands
from tests.model_files import make_table


def test_parquet_without_pyarrow_is_refused_before_any_feature_is_computed(run, tmp_path, monkeypatch):
    (tmp_path / "corpus").mkdir()
    monkeypatch.setattr(feature_commands, "table_of", lambda *_: pytest.fail("features were computed"))
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    result = run("features", tmp_path / "corpus", "-o", tmp_path / "x.parquet")
    assert result.exit_code != 0
    sentence = str(result.exception) + result.output
    assert "x.parquet: Parquet needs pyarrow; pip install pyarrow, or write .nc instead" in sentence
    with pytest.raises(CorpusError, match="Parquet needs pyarrow"):
        write_table(make_table(), tmp_path / "x.parquet")
    assert not (tmp_path / "x.parquet").exists()
