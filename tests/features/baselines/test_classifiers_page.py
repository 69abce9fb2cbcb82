"""The examples of ``docs/classifiers.md`` run as they are printed; the network where PyTorch is installed."""

import importlib.util
import sys

import numpy as np
import pytest

from features import Model, open_waveforms
from tests.page_examples import run_blocks
from tests.raceway.reports.test_report import write_corpus


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The current folder, with a corpus whose last rig is for tests; it is the first place of modules."""
    split = np.where(np.arange(96) < 72, 0, 2)
    write_corpus(tmp_path / "corpus", specimens=16, records=6, split=split)
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    yield tmp_path
    for module in ("mine", "cnn"):
        sys.modules.pop(module, None)


def test_the_examples_run_one_after_the_other(folder, capsys):
    names = run_blocks("classifiers.md", folder)
    assert names["scores"].balanced_accuracy > 0.5
    assert (folder / "model.skops").is_file()
    assert len(names["right"]) == 24
    assert "72 (1, " in capsys.readouterr().out
    if importlib.util.find_spec("torch"):
        classifier = importlib.import_module("cnn").Classifier
        signals = open_waveforms("corpus")
        assert 0 <= Model(classifier).fit(signals).score(signals).balanced_accuracy <= 1
