"""Records in memory are a corpus for tables, models, waveforms and pages; a corpus is read on systems without POSIX."""

import os
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

import gen
from features import Model, audit_splits, feature_table, open_waveforms, rank_features
from features.baselines import benchmark, cross_validate
from features.table.band import DEFAULT_BAND
from gen import open_corpus
from gen.support.errors import CorpusError
from raceway import copy
from raceway.reports.explore import write_explorer
from raceway.reports.subject import shown_record


@pytest.fixture(scope="module")
def records():
    faults = [gen.healthy(), gen.outer(width_mm=0.8)]
    return gen.records(bearing="6206", fault=faults, n=6, duration_s=0.5, seed=4, waviness_nm=20)


@pytest.fixture(scope="module")
def corpus(records, tmp_path_factory):
    return gen.write_corpus(records, tmp_path_factory.mktemp("memory") / "corpus")


@pytest.fixture(scope="module")
def model(records, few_trees):  # noqa: ARG001
    return Model("random_forest").fit(records)


def test_a_table_of_records_in_memory_is_that_of_their_corpus(records, corpus):
    expected = feature_table(corpus)
    for given in (records, gen.open_corpus(corpus)):
        found = feature_table(given)
        np.testing.assert_array_equal(found["features"], expected["features"])
        assert set(found.variables) == set(expected.variables)
    chosen = feature_table(gen.open_corpus(corpus).isel(record=[7, 2]))
    np.testing.assert_array_equal(chosen["features"], expected["features"][[7, 2]])


def test_one_record_is_a_table_of_one_row(records):
    np.testing.assert_array_equal(
        feature_table(records.isel(record=3))["features"], feature_table(records)["features"][[3]]
    )


def test_a_model_takes_records_in_memory(records, corpus, model):
    probabilities = Model("random_forest").fit(corpus).predict_proba(corpus)
    np.testing.assert_array_equal(model.predict_proba(records), probabilities)
    np.testing.assert_array_equal(model.predict(corpus, reference=records), model.predict(records, reference=corpus))
    assert model.score(records) == model.score(corpus)


def test_waveforms_pictures_and_pages_take_records_in_memory(records, corpus, tmp_path):
    np.testing.assert_array_equal(open_waveforms(records)[:], open_waveforms(corpus)[:])
    np.testing.assert_array_equal(
        shown_record(records, 3, 0, DEFAULT_BAND).signal, shown_record(corpus, 3, 0, DEFAULT_BAND).signal
    )
    pages = [tmp_path / name for name in ("memory.html", "folder.html")]
    for given, page in zip((records, corpus), pages, strict=True):
        write_explorer(given, page)
    assert len({page.stat().st_size for page in pages}) == 1
    assert audit_splits(records) == [s.replace(str(corpus), records.attrs["title"]) for s in audit_splits(corpus)]


def test_what_is_no_corpus_and_no_table_is_refused_in_one_sentence(model):
    calls = [feature_table, open_waveforms, audit_splits, rank_features, model.score, model.predict, Model().fit]
    calls += [benchmark, lambda x: cross_validate(x, "random_forest")]
    for wrong in (None, 3, [1, 2], {"a": 1}, xr.Dataset()):
        for call in calls:
            with pytest.raises(CorpusError, match=r"; (give|make) .*\.$|needs it\.$"):
                call(wrong)


def test_records_without_a_usable_rate_are_refused(records):
    for name, value in (("sample_rate", 0.0), ("shaft_rate", 1e12)):
        wrong = records.assign({name: records[name] * 0 + value})
        with pytest.raises(CorpusError, match=f"^Records of bearing 6206: {name}"):
            feature_table(wrong)


def test_records_beyond_the_last_one_are_not_drawn():
    recipe = gen.read_recipe("quickstart")
    assert len(gen.draw_scenarios(recipe, 447, 448)) == len(gen.draw_scenarios(recipe, 447, 500)) == 1
    for first, stop in ((1000, 1064), (-1, 3), (5, 5), (448, None)):
        with pytest.raises(gen.RecipeError, match=r"^quickstart: has no records .* it has 448, numbered from 0\.$"):
            gen.draw_scenarios(recipe, first, stop)


READ = """
import os, sys
import platformdirs  # loads other code on other systems
for name in ("fork", "forkpty", "register_at_fork", "sched_getaffinity", "process_cpu_count", "getuid", "geteuid", "killpg"):
    if hasattr(os, name):
        delattr(os, name)
for name in ("fcntl", "resource", "pwd", "grp", "termios"):
    sys.modules[name] = None
import numpy as np
from features import feature_table
from gen import open_corpus
for path in sys.argv[1:]:
    print(float(np.abs(open_corpus(path)["acceleration"].values).max()), np.nansum(feature_table(path)["features"].values))
"""


def test_a_corpus_is_read_without_what_only_posix_systems_have(tiny_corpus, tmp_path):
    copy([tiny_corpus], tmp_path / "c.nc")
    command = [sys.executable, "-c", READ, tiny_corpus, tmp_path / "c.nc"]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    run = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert run.returncode == 0, run.stderr
    largest = float(np.abs(open_corpus(tiny_corpus)["acceleration"].values).max())
    line = f"{largest} {np.nansum(feature_table(tiny_corpus)['features'].values)}\n"
    assert run.stdout == 2 * line
