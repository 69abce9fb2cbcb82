"""The tables of docs/running.md are those of the files of results."""

from benchmarks.performance_pages import PAGE, UNLISTED, tables, with_tables
from benchmarks.results import every_result


def test_the_tables_of_the_page_are_those_of_the_results():
    page = PAGE.read_text(encoding="utf-8")
    assert with_tables(page, every_result()) == page, "run python -m benchmarks --pages"
    assert page.count("<!-- table: ") == page.count("<!-- end of table -->") > 0


def test_every_table_stands_in_the_page():
    page = PAGE.read_text(encoding="utf-8")
    assert [name for name, _ in tables({}) if f"<!-- table: {name} -->" not in page] == []


def test_every_row_stands_in_a_table_or_is_named_as_unlisted():
    results = every_result()
    made = "".join(make() for _, make in tables(results))
    names = {name for rows in results.values() for name in rows}
    assert {name for name in names if f"| {name}: " not in made} == {
        name for name in names if name.startswith(UNLISTED)
    }
