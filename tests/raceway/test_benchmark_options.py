"""Own classifiers and tracks on the command line."""

import json
import os
import re
from contextlib import suppress
from threading import Thread

import numpy as np
import pytest

from features.baselines import TRACKS, check_submission, cross_validate, load_maker, write_submission
from raceway.commands import benchmark_commands

pytestmark = pytest.mark.usefixtures("unpainted", "tables_once")

MINE = """
import numpy as np
from sklearn.ensemble import RandomForestClassifier
from sklearn.impute import SimpleImputer
from sklearn.naive_bayes import GaussianNB
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import FunctionTransformer


def make():
    return make_pipeline(SimpleImputer(keep_empty_features=True), GaussianNB())


def forest():
    return make_pipeline(SimpleImputer(keep_empty_features=True), RandomForestClassifier(5))


def seeded_forest(seed):
    return forest().set_params(randomforestclassifier__random_state=seed)


def of_signals():
    return make_pipeline(FunctionTransformer(lambda X: np.log(np.abs(np.fft.rfft(np.asarray(X))) + 1e-3)), GaussianNB())
"""


@pytest.fixture
def mine(tmp_path, monkeypatch):
    (tmp_path / "own_module.py").write_text(MINE)
    monkeypatch.chdir(tmp_path)
    return "own_module:make"


def test_own_classifiers_and_tracks_are_shown_and_written(run, tiny_corpus, tmp_path, mine):
    line = ("benchmark", tiny_corpus, "-o", tmp_path / "report", "--folds", 2, "--estimator", mine)
    line = (*line, "--estimator", "logistic_regression", "--track", "all")
    shown = run(*line).stdout
    found = json.loads((tmp_path / "report" / "results.json").read_text())
    assert found["track"] == "specimen"
    assert list(found["baselines"]) == ["majority", "envelope_rule", mine, "logistic_regression"]
    assert {*found["further"], *found["left_out"]} == set(TRACKS[1:])
    assert {"rig", "speed"} <= set(found["further"])
    page = (tmp_path / "report" / "report.html").read_text()
    assert "<h2>Tracks</h2>" in page
    assert "By speed, 2 folds, " in shown
    for track, reason in found["left_out"].items():
        assert f"No scores by {track}. {reason}" in shown


def test_an_own_classifier_of_waveforms_is_scored_beside_baselines_on_features(told, tiny_corpus, tmp_path, mine):
    line = ("benchmark", tiny_corpus, "-o", tmp_path / "report", "--folds", 2, "--waveforms", "--per-turn", 64)
    found = told(*line, "--estimator", mine.replace("make", "of_signals"))
    assert list(found["baselines"]) == ["majority", "envelope_rule", "own_module:of_signals"]
    assert {scores["grouped"]["records"] for scores in found["baselines"].values()} == {48}
    assert json.loads((tmp_path / "report" / "results.json").read_text())["baselines"] == found["baselines"]
    assert "Tiny corpus" in (tmp_path / "report" / "report.html").read_text()


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--estimator", "forest"), "'forest' is none of majority, envelope_rule"),
        (("--estimator", ":make"), "':make' is none of majority, envelope_rule"),
        (("--estimator", "own_none:make"), "own_none:make: cannot be imported (ModuleNotFoundError"),
        (("--waveforms",), "--waveforms is for --estimator MODULE:NAME"),
        (("--estimator", "own_module:make", "--per-turn", 9), "--per-turn is for --waveforms"),
        (("--submit", "rows.csv"), "give -o OUTDIR, --check FILE.csv or both, or --submit FILE.csv"),
    ],
)
def test_options_that_cannot_be_used_are_refused_before_any_feature_is_computed(
    run, tiny_corpus, tmp_path, mine, monkeypatch, options, sentence
):
    assert mine
    monkeypatch.setattr(benchmark_commands, "table_of", lambda *_: pytest.fail("features were computed"))
    result = run("benchmark", tiny_corpus, "-o", tmp_path / "report", *options)
    assert result.exit_code != 0
    assert sentence in str(result.exception) + result.output


def test_a_classifier_that_draws_anew_in_each_call_is_warned_of_and_a_seeded_one_is_repeated(
    run, tiny_corpus, tmp_path, mine
):
    assert mine
    file = tmp_path / "rows.csv"
    warning = "own_module:forest: randomforestclassifier__random_state is None, so its scores may change"
    for name, warned in (("forest", True), ("seeded_forest", False)):
        written = []
        for _ in range(2):
            line = ("benchmark", tiny_corpus, "--folds", 2, "--estimator", f"own_module:{name}", "--submit", file)
            assert (warning in run(*line).stderr) == warned
            written.append(file.read_text())
            file.unlink()
        # a forest that draws anew may still say the same
        assert warned or written[0] == written[1]


def test_a_submission_is_scored_again_as_cross_validation_scores_it(run, told, tiny_corpus, tiny_table, tmp_path, mine):
    protocol = ("--track", "rig", "--folds", "2")
    file = tmp_path / "rows.csv"
    names = ("--estimator", mine, "--estimator", "logistic_regression")
    done = run("benchmark", tiny_corpus, *protocol, *names, "--submit", file)
    assert done.exit_code == 0
    assert "--model are for -o" in run("benchmark", tiny_corpus, "--check", file, "--model", "reference").stderr
    checked = told("benchmark", tiny_corpus, *protocol, "--check", file)
    for name, estimator in ((mine, load_maker(mine)), ("logistic_regression", "logistic_regression")):
        scores = cross_validate(tiny_table, estimator, track="rig", folds=2)
        same = ("balanced_accuracy", "false_alarms", "records")
        assert [checked[name][figure] for figure in same] == [getattr(scores, figure) for figure in same]
        assert checked[name]["interval"] == list(scores.interval)
    # rows may stand in any order
    header, *rows = file.read_text().splitlines()
    (tmp_path / "reversed.csv").write_text("\n".join([header, *rows[::-1]]))
    assert told("benchmark", tiny_corpus, *protocol, "--check", tmp_path / "reversed.csv") == checked
    # beside the baselines of a report
    line = (
        "benchmark",
        tiny_corpus,
        *protocol,
        "--estimator",
        "envelope_rule",
        "--check",
        file,
        "-o",
        tmp_path / "report",
    )
    reported = told(*line)
    assert reported["submissions"] == checked
    page = (tmp_path / "report" / "report.html").read_text()
    row = f"{mine}, submitted</th><td>{checked[mine]['balanced_accuracy']:.3f}"
    assert (row in page, "envelope rule</th>" in page) == (True, True)


def test_a_submission_of_a_foreign_corpus_begins_no_formula_and_is_scored_again(tiny_table, tmp_path):
    foreign = tiny_table.assign(identity=("record", np.full(tiny_table.sizes["record"], "=1+1", object)))
    protocol = {"track": "rig", "folds": 2}
    write_submission(foreign, {"rule": "envelope_rule"}, tmp_path / "rows.csv", **protocol)
    cells = re.split("[,\n]", (tmp_path / "rows.csv").read_text())
    assert not [cell for cell in cells if cell.startswith("=")]
    assert set(check_submission(foreign, tmp_path / "rows.csv", **protocol)) == {"rule"}


def test_a_missing_submission_is_told_before_any_feature_is_computed(run, tiny_corpus, tmp_path, monkeypatch):
    monkeypatch.setattr(benchmark_commands, "table_of", lambda *_: pytest.fail("features were computed"))
    done = run("benchmark", tiny_corpus, "--check", tmp_path / "rows.csv")
    assert done.exit_code == 2
    assert re.search(r"'--check': File '.*rows.csv' does not exist;", done.stderr)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda text: text.replace(",0,", ",1,", 1), "has other folds than the 2 by rig with seed 0; give"),
        (
            lambda text: "\n".join(text.splitlines()[:-1]),
            "does not have the 48 records that are tested (no record 47);",
        ),
        (
            lambda text: re.sub(r"^(\d+),[^,]*", r"\1,other", text, count=1, flags=re.MULTILINE),
            "records of another corpus",
        ),
        (lambda text: text.replace("identity", "name", 1), "does not begin with the columns record, identity, fold"),
        (lambda text: text.replace("healthy", "wealthy"), "'wealthy' is no class; allowed are healthy, "),
        (lambda text: text + text.splitlines()[-1], "has record 47 twice; leave one row of each"),
        (lambda text: "\n".join(line.rsplit(",", 1)[0] for line in text.splitlines()), "has no predictions"),
        (lambda _: "", "is no table of predictions"),
        (lambda text: text.replace("healthy", "x" * 4000, 1), "has 4,000 bytes or more; give a file of"),
    ],
)
def test_a_submission_of_other_records_folds_or_classes_is_refused(run, tiny_corpus, tmp_path, change, sentence):
    protocol = ("--track", "rig", "--folds", "2")
    file = tmp_path / "rows.csv"
    run("benchmark", tiny_corpus, *protocol, "--estimator", "envelope_rule", "--submit", file)
    file.write_text(change(file.read_text()))
    done = run("benchmark", tiny_corpus, *protocol, "--check", file)
    assert (done.exit_code, sentence in done.stderr) == (2, True)


@pytest.mark.parametrize("row", [b"x,", b"x\n", b"\0"])
def test_of_an_endless_submission_no_more_is_read_than_tested_records_need(run, tiny_corpus, tmp_path, row):
    file, taken = tmp_path / "rows.csv", [0]
    os.mkfifo(file)

    def write():
        with file.open("wb", buffering=0) as pipe, suppress(BrokenPipeError):
            for _ in range(1000):
                taken[0] += pipe.write(row * 5000)

    writer = Thread(target=write, daemon=True)
    writer.start()
    done = run("benchmark", tiny_corpus, "--track", "rig", "--folds", "2", "--check", file)
    writer.join()
    assert done.exit_code == 2
    assert taken[0] < 200_000  # the buffer of the pipe among them
