"""The examples of ``docs/own-classifiers.md`` run as they are printed."""

import importlib.util
import re
import sys

import pytest

from tests.features.report.test_report import write_corpus
from tests.paths import ROOT

PAGE = (ROOT / "docs" / "own-classifiers.md").read_text(encoding="utf-8")
MINE, FROM_FEATURES, MODEL, FROM_WAVEFORMS, NETWORK, WITH_NETWORK, _ = re.findall(
    r"```python\n(.*?)```", PAGE, re.DOTALL
)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with a corpus and with the module of the page, as the current one."""
    write_corpus(tmp_path / "corpus", specimens=16)
    (tmp_path / "mine.py").write_text(MINE)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    yield tmp_path
    sys.modules.pop("mine", None)


def run(*blocks):
    names = {"__name__": "example"}
    for block in blocks:
        exec(compile(block, "docs/own-classifiers.md", "exec"), names)  # noqa: S102 - the page of this project
    return names


def test_the_example_with_features_runs(folder, capsys):  # noqa: ARG001
    assert run(FROM_FEATURES)["scores"].balanced_accuracy > 0.5
    assert len(capsys.readouterr().out.splitlines()) == 2


def test_the_example_of_a_model_runs(folder):
    run(MODEL)
    assert (folder / "model.skops").is_file()


def test_the_example_with_waveforms_runs(folder, capsys):  # noqa: ARG001
    run(FROM_WAVEFORMS)
    assert 0 <= float(capsys.readouterr().out) <= 1


@pytest.mark.skipif(
    importlib.util.find_spec("torch") is None, reason="PyTorch is not installed; raceway does not need it"
)
def test_the_example_with_a_network_runs(folder, capsys):
    write_corpus(folder / "other", specimens=8)
    (folder / "cnn.py").write_text(NETWORK)
    run(WITH_NETWORK)
    assert 0 <= float(capsys.readouterr().out) <= 1
    sys.modules.pop("cnn")
