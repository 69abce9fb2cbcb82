"""The option --speed of the commands that compute features of recordings."""

import json
from types import SimpleNamespace

import pytest

from features.table.band import DEFAULT_BAND
from features.table.files import read_table
from features.table.recording_speeds import ESTIMATE
from tests.features.table.test_recording_speeds import write_machines

WARNING = "warning: inner.csv: labelled 1500 rpm, but its BPFI lines fit"


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    return write_machines(tmp_path_factory.mktemp("machines") / "corpus")


def test_features_warns_of_a_wrong_speed_unless_told_off(run, corpus, tmp_path):
    assert WARNING in run("features", corpus, "-o", tmp_path / "a.nc").stderr
    result = run("features", corpus, "-o", tmp_path / "b.nc", "--speed", "off")
    assert "rpm" not in result.stderr
    assert ESTIMATE not in read_table(tmp_path / "b.nc")


def test_features_counts_the_recordings_with_another_speed(told, corpus, tmp_path):
    line = ("features", corpus, "-o", tmp_path / "a.nc", "--speed")
    assert told(*line, "correct")["recordings_with_other_speed"] == 2
    assert told(*line, "off")["recordings_with_other_speed"] is None


@pytest.mark.parametrize("command", ["evaluate", "benchmark"])
def test_recordings_that_are_tested_are_checked_and_others_are_not(run, monkeypatch, corpus, tmp_path, command):
    treatments = []

    def table_of(_corpus, speed, _team, _analysis):
        treatments.append(speed)

    for module in ("models", "benchmarking"):
        monkeypatch.setattr(f"raceway.commands.{module}.table_of", table_of)
    monkeypatch.setattr("features.baselines.Model.load", lambda _: SimpleNamespace(band=DEFAULT_BAND))
    line = {
        "evaluate": ("evaluate", corpus, "--model", tmp_path / "model"),
        "benchmark": ("benchmark", corpus, "--test", corpus, "-o", tmp_path / "report"),
    }[command]
    run(*line)
    run(*line, "--speed", "correct")
    assert [treatment for treatment in treatments if treatment != "off"] == ["check", "correct"]


def test_a_simulated_corpus_is_not_checked(run, tiny_corpus, tmp_path):
    result = run("features", tiny_corpus, "-o", tmp_path / "a.nc", "--json")
    assert json.loads(result.stdout)["recordings_with_other_speed"] is None
