"""Records whose class is not known: stored, shown, and left out wherever a class is needed."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from features import feature_table
from features.baselines import DEFAULT_GROUPS, Model, benchmark, count_unknown
from features.baselines.records import features_of, labelled_records
from gen.corpus import FAULT_NAMES, UNKNOWN_CODE, open_corpus, validate_corpus
from raceway.cli import cli
from raceway.comparing.windows import common_ground, measured_windows
from raceway.console.summary import corpus_facts
from raceway.reports.examples import examples_of
from raceway.reports.report_page import write_report
from raceway.sharing.card.card_page import data_card
from tests.labels import import_labelled

pytestmark = pytest.mark.usefixtures("few_trees", "unpainted")

FS = 12_000
COMMON = {"bearing": "6205", "unit": "g", "sample_rate_hz": FS, "shaft_rpm": 1500}


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    """Three specimens each of healthy and inner, and two recordings of unknown class, of two records each."""
    folder = tmp_path_factory.mktemp("unknown")
    rng, files = np.random.default_rng(0), []
    for number, fault in enumerate(["healthy", "inner"] * 3 + ["unknown"] * 2):
        signal = rng.normal(size=FS)
        signal[:: FS // (60 if fault == "inner" else 400)] += 9.0
        np.save(folder / f"{number}.npy", signal)
        files.append({"path": f"{number}.npy", "fault": fault, "specimen": number})
    return import_labelled(folder, files, **COMMON).path


@pytest.fixture(scope="module")
def table(corpus):
    return feature_table(corpus)


def test_unknown_is_a_value_of_the_format_and_no_class(corpus):
    assert validate_corpus(corpus) == []
    with open_corpus(corpus) as opened:
        assert opened.fault.values.tolist() == [0, 0, 1, 1] * 3 + [UNKNOWN_CODE] * 4
        assert opened.fault.flag_values.tolist() == [*FAULT_NAMES]
        assert opened.n_spalls.values[-4:].tolist() == [-1] * 4
        assert np.isnan(opened.width.values[-4:]).all()
        assert [*examples_of(opened)] == ["healthy", "inner", "unknown"]
    assert corpus_facts(corpus)["classes"] == {"healthy": 6, "inner": 6, "unknown": 4}
    assert "| unknown | 4 | 2 |" in data_card(corpus)


def test_training_and_cross_validation_leave_unknown_records_out(corpus, table, tmp_path):
    names = features_of(table, DEFAULT_GROUPS)
    assert count_unknown(table) == 4
    assert np.unique(labelled_records(table, names).fault).tolist() == [0, 1]
    assert Model("majority").fit(table).records == 12
    other = table.isel(record=slice(12, None)).assign(fault=table.fault[:4])
    results = benchmark(table, other, folds=2, estimators={"logistic_regression": "logistic_regression"})
    assert (results.corpus.records, results.corpus.unknown) == (12, 4)
    assert (results.corpus.classes, results.tests[0].unknown) == ({"healthy": 6, "inner": 6}, 0)
    page = write_report(corpus, results, tmp_path).read_text()
    assert "4 records whose class is not known are left out of all scores." in page
    assert json.loads((tmp_path / "results.json").read_text())["corpus"]["unknown"] == 4


def test_a_comparison_leaves_unknown_records_out(corpus):
    found = measured_windows(corpus, "real", common_ground([corpus], 5000.0, None), 100)
    assert np.unique(found.fault).tolist() == [0, 1]
    assert found.unknown == 4


def test_scores_are_those_of_the_records_whose_class_is_known(table):
    model = Model("majority").fit(table)
    shuffled = table.isel(record=np.random.default_rng(0).permutation(table.sizes["record"]))
    assert model.score(shuffled).records == 12
    assert model.score(shuffled).accuracy == model.score(table.isel(record=slice(12))).accuracy


def test_train_and_evaluate_say_how_many_records_are_left_out(corpus, tmp_path):
    model = str(tmp_path / "m.skops")
    for command in (["train", "-o", model, "--estimator", "majority"], ["evaluate", "--model", model]):
        done = CliRunner().invoke(cli, [*command, str(corpus), "--json"], prog_name="raceway")
        assert done.exit_code == 0, done.output
        assert f"{corpus}: 4 records of class unknown left out." in " ".join(done.stderr.split())
        assert json.loads(done.stdout)["records"] == 12
