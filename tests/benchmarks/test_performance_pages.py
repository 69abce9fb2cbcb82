"""The tables of docs/running.md are those of the files of results."""

import json

import pytest

from benchmarks.pairs import Row, Skipped
from benchmarks.performance_pages import PAGE, TARGETS, short, tables, with_tables
from benchmarks.results import every_result, keep, processor_key, results_file

FACTS = {"processor": "one", "cores": 2, "python": "3.11", "numba": "0.68", "numpy": "2.4"}


def row(name: str, ratio: float) -> Row:
    return Row(name, "speed", 2e7 * ratio, "record-steps/s", "C", 2e7, ratio, 5)


@pytest.fixture
def results(tmp_path) -> dict:
    keep([row("kernel plain", 1.4)], results_file("amd-1-2", tmp_path), FACTS)
    keep([row("kernel plain", 1.4), row("start cold", 1.0)], results_file("intel-3-4", tmp_path), FACTS)
    return every_result(tmp_path)


def test_the_tables_of_the_page_are_those_of_the_results():
    page = PAGE.read_text(encoding="utf-8")
    assert with_tables(page, every_result()) == page, "run python -m benchmarks --pages"
    assert page.count("<!-- table: ") == page.count("<!-- end of table -->") > 0


def test_every_table_stands_in_the_page():
    page = PAGE.read_text(encoding="utf-8")
    assert [name for name, _ in tables({}) if f"<!-- table: {name} -->" not in page] == []


def test_every_row_stands_in_a_table():
    results = every_result()
    made = "".join(make() for _, make in tables(results))
    assert [name for rows in results.values() for name in rows if f"| {name}: " not in made] == []


def test_a_row_is_replaced_and_the_others_are_kept(tmp_path):
    path = results_file(processor_key(), tmp_path)
    keep([row("kernel plain", 1.0), row("kernel full", 0.5)], path, FACTS)
    keep([row("kernel plain", 2.0), Skipped("kernel fused", "no compiler")], path, FACTS | {"numpy": "3"})
    rows = json.loads(path.read_text())
    assert list(rows) == ["kernel plain", "kernel full"]
    assert (rows["kernel plain"]["ratio"], rows["kernel plain"]["facts"]["numpy"]) == (2.0, "3")
    assert (rows["kernel full"]["ratio"], rows["kernel full"]["facts"]["numpy"]) == (0.5, "2.4")


def test_a_table_has_a_column_for_each_processor(results):
    made = dict(tables(results))
    assert "| kernel plain: speed | C | 1.4 (28 M against 20 M record-steps/s) | 1.4 (28 M" in made["kernel"]()
    assert "| start cold: speed | C | - | 1 (" in made["pipeline"]()


def test_a_limit_may_differ_between_vendors(results):
    (line,) = (line for line in dict(tables(results))["targets"]().splitlines() if "plain C" in line)
    assert line.endswith("| 1.3 (amd), 1.5 (intel) | 1.8 | 1.4 | 1.4 (missed) |")


def test_a_small_figure_is_good_where_the_target_says_so(results):
    cold = next(target for target in TARGETS if target.row == "start cold")
    (line,) = (line for line in dict(tables(results))["targets"]().splitlines() if cold.what in line)
    assert line.endswith("| 15 | 10 | - | 20 M (missed) |")


def test_numbers_have_three_digits():
    assert [short(value) for value in (0.99951, 999.4, 48e6)] == ["1", "999", "48 M"]
