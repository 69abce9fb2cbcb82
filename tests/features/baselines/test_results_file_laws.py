"""Laws of results that are kept: a row is taken over if it is as it was written, by the same sources, and scored again if not."""

import json
import os
import subprocess
import sys

from features.baselines import benchmark, read_results
from features.baselines.results_file import write_results
from features.baselines.score_sources import _MAKES_SCORES
from tests.features.baselines.test_baselines_laws import make_table


def test_an_altered_or_foreign_row_is_scored_again(tmp_path, monkeypatch):
    tables, file = (make_table(24, 3), make_table(8, 4, seed=1)), tmp_path / "results.json"
    asked = {"logistic_regression": "logistic_regression"}
    first = benchmark(*tables, estimators=asked, tracks=("specimen", "rig"), folds=2)
    write_results(first, file)

    def again(change):
        """Names of the rows that are taken over after a change of the file; the new results have the right rows."""
        content = json.loads(file.read_text())
        change(content)
        (tmp_path / "changed.json").write_text(json.dumps(content))
        known = read_results(tmp_path / "changed.json")
        assert benchmark(*tables, estimators=asked, tracks=("specimen", "rig"), folds=2, known=known) == first
        return [] if known is None else [*known.baselines, *known.further["rig"].baselines]

    rows = ["majority", "envelope_rule", "logistic_regression"]
    assert again(lambda _: None) == 2 * rows
    assert again(lambda c: c["baselines"]["majority"]["grouped"].update(balanced_accuracy=0.99)) == [*rows[1:], *rows]
    assert again(lambda c: c["further"]["rig"]["baselines"]["majority"]["null"].update(accuracy=0.5)) == [
        *rows,
        *rows[1:],
    ]
    assert again(lambda c: c["baselines"].update(majority=c["baselines"]["envelope_rule"])) == [*rows[1:], *rows]
    assert again(lambda c: c.update(seed=1)) == []
    assert again(lambda c: c.update(row_sha256={})) == []
    assert again(lambda c: c.pop("row_sha256")) == []
    monkeypatch.setattr("features.baselines.results.score_sources", lambda: "of other sources")
    scored, module = [], sys.modules["features.baselines.results"]
    score = module.score_splits
    monkeypatch.setattr(module, "score_splits", lambda *a: scored.append(a[2]) or score(*a))
    benchmark(*tables, estimators=asked, tracks=("specimen", "rig"), folds=2, known=read_results(file))
    assert set(scored) == set(rows)


def test_the_sources_of_scores_cover_all_that_is_loaded_to_make_them():
    modules = "features.table.corpus_features, features.table.waveforms, features.baselines.results_file, features.baselines.models"
    code = f"import sys, {modules}; print(*sys.modules)"
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    loaded = {name.replace(".", "/") for name in run.stdout.split() if name.startswith(("gen.", "features."))}
    assert {
        name for name in loaded if not f"{name}.py".startswith(_MAKES_SCORES) and name not in _MAKES_SCORES
    } == set()


def test_a_file_that_holds_no_results_adds_no_rows(tmp_path):
    (tmp_path / "other.json").write_text('{"corpus": {"title": "x"}}')
    assert read_results(tmp_path / "other.json") is read_results(tmp_path / "none.json") is None
