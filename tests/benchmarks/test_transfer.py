"""The tables of the pages are those of the file of results, and the figures of the benchmark those of its parts."""

import numpy as np
import pytest
import xarray as xr

from benchmarks.transfer import RECIPE, TEACHERS, figures, pooled, with_reference
from benchmarks.transfer_pages import PAGES, ROOT, TABLES, read_results, with_tables
from features import feature_table
from features.baselines import Model
from gen.corpus import FAULTS
from tests.pulses import write_pulses


@pytest.fixture(scope="module")
def tables(tmp_path_factory) -> tuple[xr.Dataset, xr.Dataset]:
    """Two sets on two rigs each, with every class on both."""
    folder = tmp_path_factory.mktemp("sets")
    halves = np.tile(np.repeat([0, 1], 6), 4)
    made = [
        write_pulses(folder / "taught", rig=halves),
        write_pulses(folder / "tested", rig=halves, seed=1, recording=np.arange(48) // 3),
    ]
    first, second = (feature_table(corpus, ("lines", "shape", "bands")) for corpus in made)
    return first, second


@pytest.mark.parametrize("page", PAGES)
def test_the_tables_of_a_page_are_those_of_the_results(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    assert with_tables(text, read_results()) == text, "run python -m benchmarks.transfer --pages"
    assert text.count("<!-- table: ") == text.count("<!-- end of table -->") > 0


def test_every_table_stands_in_a_page():
    pages = "".join((ROOT / page).read_text(encoding="utf-8") for page in PAGES)
    assert [name for name in TABLES if f"<!-- table: {name} -->" not in pages] == []


def test_the_results_have_every_figure_of_every_seed():
    results = read_results()
    assert results["recipe"] == RECIPE
    for its in results["windows"].values():
        found = [*its["zero_shot"].values(), its["speed_corrected"], its["reference"]]
        assert {len(values) for sets in found for values in sets.values()} == {results["seeds"]}
        assert {test: len(sets) for test, sets in its["teachers"].items()} == {t: len(s) for t, s in TEACHERS.items()}


def test_pooled_tables_keep_their_rigs_apart(tables):
    first, second = tables
    both = pooled([first, second, first])
    assert both.sizes["record"] == 2 * first.sizes["record"] + second.sizes["record"]
    assert len(np.unique(both["rig"].values)) == 6
    np.testing.assert_array_equal(both["features"].values[: first.sizes["record"]], first["features"].values)


def test_every_healthy_recording_is_the_reference_in_turn(tables, monkeypatch):
    first, second = tables
    used: list[set[int]] = []

    model = Model("majority").fit(first)
    scores = model.score(second)

    def score(_table, *, reference):
        used.append(set(reference["recording"].values.tolist()))
        return scores

    monkeypatch.setattr(model, "score", score)
    assert with_reference(second, model) == figures(scores)
    assert used == [{0}, {1}, {2}, {3}]
    assert with_reference(second.isel(record=second["fault"].values != FAULTS.index("healthy")), model) is None
