"""The examples of ``docs/classifiers.md`` run as they are printed; the network where PyTorch is installed."""

import importlib.util
import sys

import numpy as np
import pytest

import gen
from features import Model, open_waveforms
from tests import tone_corpora
from tests.page_examples import blocks, run_blocks
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


def test_the_loop_without_a_framework_learns_the_classes(tmp_path, monkeypatch):
    split = np.where(np.arange(96) < 72, 0, 2)
    rates = np.full(96, 30.0)
    tone_corpora.write_corpus(tmp_path / "corpus", specimens=16, records=6, shaft_rate=rates, split=split)
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "example", "np": np, "gen": gen}
    exec(next(block for block in blocks("classifiers.md") if "SGDClassifier" in block), names)  # noqa: S102 - our own page
    assert np.mean(names["right"]) > 0.9
