"""The reference model is kept per user: made once, under a name that tells recipe and versions, made again if damaged."""

import json
import threading
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest

from benchmarks.reference_table import WIDE_BAND, both_lengths, identities, wide_recipe
from features import feature_table
from features.baselines import Model
from features.baselines.records import DEFAULT_GROUPS
from features.baselines.references import with_energies
from features.table.band import DEFAULT_BAND
from gen import generate
from gen.recipe import read_recipe
from raceway import kept_models
from raceway.commands.model_commands import warn_of_durations
from tests.model_files import make_table

pytestmark = pytest.mark.usefixtures("unpainted", "quick_estimators", "tables_once")


@pytest.fixture
def trainings(tiny_table, tmp_path, monkeypatch):
    """List that grows with each training; the table of the tiny corpus replaces the shipped one."""
    made = []
    monkeypatch.setenv("RACEWAY_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(kept_models, "shipped_tables", lambda: made.append(1) or (tiny_table,) * 3)
    return made


def test_other_sources_or_another_library_make_another_model(monkeypatch):
    names = {kept_models.reference_path().name}
    for place, changed in (
        ("raceway.kept_models.hash_sources", lambda *_: "other"),
        ("raceway.kept_models.version", lambda name: "0.0" if name == "scipy" else version(name)),
    ):
        with monkeypatch.context() as patch:
            patch.setattr(place, changed)
            names.add(kept_models.reference_path().name)
    assert len(names) == 3


def test_the_reference_model_is_made_once_and_loaded_afterwards(trainings, tmp_path):
    first, path = kept_models.open_model()
    second, again = kept_models.open_model()
    assert len(trainings) == 1
    assert path == again
    assert path.parent == tmp_path / "cache"
    assert first.classes == second.classes
    assert [found.name for found in path.parent.glob("*.skops")] == [path.name]


@pytest.mark.parametrize("damage", [lambda content: content[: len(content) // 2], lambda _: b"no model"])
def test_a_damaged_file_is_made_again_with_a_notice(damage, trainings, capfd):
    _, path = kept_models.open_model()
    path.write_bytes(damage(path.read_bytes()))
    capfd.readouterr()
    kept_models.open_model()
    assert len(trainings) == 2
    assert "It is made again." in capfd.readouterr().err
    Model.load(path)


def test_two_that_need_it_at_once_train_it_once(trainings):
    threads = [threading.Thread(target=kept_models.open_model) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(trainings) == 1
    Model.load(kept_models.reference_path())


def test_evaluate_takes_the_reference_model_by_name_and_by_default(run, tiny_corpus, trainings, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "reference").write_text("no model", encoding="utf-8")
    assert run("evaluate", "nowhere").exit_code == 2
    assert trainings == []  # a wrong path is told first
    default, named = (run("evaluate", tiny_corpus, "--json", *more) for more in ((), ("--model", "reference")))
    assert (default.exit_code, named.exit_code, len(trainings)) == (0, 0, 1)
    path = kept_models.reference_path()
    assert json.loads(default.stdout) == json.loads(named.stdout)
    assert json.loads(named.stdout)["model"] == str(path)
    file = run("evaluate", tiny_corpus, "--model", "./reference")
    assert (file.exit_code, "reference: not a readable model" in file.stderr) == (2, True)


def test_benchmark_scores_trained_models_as_evaluate_does(
    run, tiny_corpus, tiny_table, trainings, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "own.skops"
    for name in (path, Path("reference")):
        kept_models.train_and_score(tiny_table, "logistic_regression")[0].save(name)
    models = ("--model", "reference", "--model", path, "--model", "./reference")
    line = ("benchmark", tiny_corpus, "-o", tmp_path / "report", "--folds", 2, "--estimator", "majority")
    done = run(*line, *models, "--json")
    assert done.exit_code == 0, done.output
    assert len(trainings) == 1
    found = json.loads(done.stdout)["models"]
    assert found.keys() == {"reference", str(path), "./reference"}
    for name, (scores,) in found.items():
        alone = json.loads(run("evaluate", tiny_corpus, "--model", name, "--json").stdout)
        assert scores == {key: alone[key] for key in scores}
        assert f"warning: {name} was trained on 36 of these 48 records; this is no fair test." in done.stderr
    page = (tmp_path / "report" / "report.html").read_text(encoding="utf-8")
    assert '<tr><th scope="row">reference</th><td>' in page
    assert "reference was trained on 36 of 48 records" in page
    text = run(*line, *models).stdout  # with the rows of the earlier call
    assert f"\nreference  {' ' * (len(str(path)) - len('reference'))}" in text
    assert json.loads(run(*line, "--json").stdout)["models"] == {}
    lost = run(*line, "--model", "nowhere.skops")
    assert (lost.exit_code, "nowhere.skops: no such file" in lost.stderr) == (2, True)


@pytest.mark.usefixtures("trainings")
def test_a_cache_that_cannot_be_written_is_told_with_a_way_out(run, tiny_corpus, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("", encoding="utf-8")
    monkeypatch.setenv("RACEWAY_CACHE", str(tmp_path / "file" / "cache"))
    result = run("evaluate", tiny_corpus)
    assert result.exit_code == 2
    assert "RACEWAY_CACHE" in result.stderr


def test_the_shipped_table_is_that_of_the_recipe_and_the_features_of_today(tmp_path):
    """Other processors may round the signals otherwise by a count or two of the converter."""
    tables, labels = kept_models.shipped_tables(), ["fault", "rig", "specimen", "split", "duration"]
    both, wide = both_lengths(read_recipe("domain_randomised")), wide_recipe()
    assert [table.attrs["recipes"] for table in tables[1:]] == [identities(both), identities([wide])]
    for place, (table, recipe) in enumerate(zip(tables, (*both, wide), strict=True)):
        corpus = generate(recipe, tmp_path / f"{place}", records=4).path
        fresh = feature_table(corpus, band=WIDE_BAND if recipe is wide else DEFAULT_BAND)
        names = fresh["feature"].values[np.isin(fresh["group"].values, with_energies(DEFAULT_GROUPS))]
        assert list(table["feature"].values) == list(names)
        stored, again = (one.set_index(record="recording") for one in (table, fresh))
        stored = stored.sel(record=again["record"])
        assert (stored[labels] == again[labels]).all()
        np.testing.assert_allclose(stored["features"], again["features"].sel(feature=names), rtol=1e-3, atol=1e-3)


def test_the_reference_model_has_models_for_shorter_records_and_for_a_wider_band():
    of = [make_table(records=48, seed=seed).assign(split=("record", np.arange(48) % 3)) for seed in (0, 1)]
    long, short = (
        one.assign(duration=("record", np.full(48, lasting))) for one, lasting in zip(of, (2.0, 0.5), strict=True)
    )
    wide = long.assign_attrs(band_low_hz=300.0, band_high_hz=9000.0)
    model = kept_models.train_reference(long, short, wide, "logistic_regression")
    assert (model.durations, model.shorter.durations, model.wide.band) == ((2.0, 2.0), (0.5, 0.5), (300.0, 9000.0))
    for table in (long, short, wide):
        alone, _ = kept_models.train_and_score(table, "logistic_regression")
        assert (alone.shorter, alone.wide) == (None, None)
        np.testing.assert_array_equal(model.predict_proba(table), alone.predict_proba(table))


@pytest.mark.parametrize(("seconds", "told"), [(0.2, "0.2"), (1.0, "1"), (0.503, ""), (2.0, "")])
def test_records_of_another_duration_than_those_of_the_training_are_told(seconds, told, capfd):
    of = [make_table().assign(duration=("record", np.full(24, one))) for one in (2.0, 0.5, seconds)]
    model, short = (Model("majority").fit(table) for table in of[:2])
    model.shorter = short
    warn_of_durations("the model", model, of[2])
    sentence = f"warning: the records last {told} s, and those that the model was trained on 0.5 or 2 s"
    assert sentence in capfd.readouterr().err if told else capfd.readouterr().err == ""
