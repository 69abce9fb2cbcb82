"""The examples of ``docs/training.md`` run as they are printed."""

import importlib.util
import re

import numpy as np
import pytest

from tests.paths import ROOT
from tests.tone_corpora import write_corpus

PAGE = (ROOT / "docs" / "training.md").read_text(encoding="utf-8")


def blocks(page):
    return re.findall(r"```python\n(.*?)```", page, re.DOTALL)


FIRST, NETWORK, LINEAR = blocks(PAGE)
SPECIMENS, RECORDS = 16, 6


@pytest.fixture
def _corpus(tmp_path, monkeypatch):
    """A corpus of one shaft rate in the current folder, of which the last rig is for tests."""
    split = np.where(np.arange(SPECIMENS * RECORDS) < 12 * RECORDS, 0, 2)
    rates = np.full(len(split), 30.0)
    write_corpus(tmp_path / "corpus", specimens=SPECIMENS, records=RECORDS, shaft_rate=rates, split=split)
    monkeypatch.chdir(tmp_path)


def run(block):
    names = {"__name__": "example"}
    exec(compile(block, "docs/training.md", "exec"), names)  # noqa: S102 - the page of this project
    return names


def share_right(printed):
    return float(printed.split()[0])


@pytest.mark.usefixtures("_corpus")
def test_the_first_example_prints_a_signal_and_its_class(capsys):
    run(FIRST)
    assert capsys.readouterr().out == "72 (1, 1000) float32 healthy\n"


@pytest.mark.usefixtures("_corpus")
def test_the_loop_without_a_framework_learns_the_classes(capsys):
    run(LINEAR)
    assert share_right(capsys.readouterr().out) > 0.9


@pytest.mark.skipif(
    importlib.util.find_spec("torch") is None, reason="PyTorch is not installed; raceway does not need it"
)
@pytest.mark.usefixtures("_corpus")
def test_the_loop_with_a_network_classifies_every_record(capsys, tmp_path, monkeypatch):
    classifiers = (ROOT / "docs" / "own-classifiers.md").read_text(encoding="utf-8")
    (tmp_path / "cnn.py").write_text(next(block for block in blocks(classifiers) if "class Network" in block))
    monkeypatch.syspath_prepend(tmp_path)
    run(NETWORK)
    assert 0 <= share_right(capsys.readouterr().out) <= 1
