"""Every benchmark runs once, on small input."""

import importlib.util
import math
from pathlib import Path

import pytest

from benchmarks import (
    against,
    analysis,
    features,
    growth,
    kernel,
    million,
    opening,
    pipeline,
    rivals,
    starting,
    training,
    truth,
)
from benchmarks.__main__ import table
from benchmarks.pairs import Row, Skipped, row
from gen.generation.corpus import generate


def finite_rows(lines) -> dict[str, Row]:
    rows = {line.name: line for line in lines if isinstance(line, Row)}
    assert all(math.isfinite(found.ratio) and found.ratio > 0 for found in rows.values())
    return rows


def test_the_kernel_is_compared_with_c_and_the_full_model_with_the_seed(brief_seed, brief_full):
    lines = list(kernel.rows(1, recipe=brief_seed, full=brief_full, records=4, full_records=4))
    assert {line.name for line in lines} == {"kernel plain", "kernel full"}
    assert "kernel full" in finite_rows(lines)


def test_the_kernel_is_compared_with_its_rivals(brief_seed):
    lines = rivals.rows(1, recipe=brief_seed, records=4, steps=4, sampled_s=0.002)
    assert set(finite_rows(lines)) == {"kernel solve_ivp", "kernel numpy"}


def test_a_corpus_is_compared_with_the_kernel_alone(brief_full):
    assert set(finite_rows(pipeline.throughput_rows(1, brief_full, (4, 40)))) == {"pipeline parts"}


def test_two_workers_are_compared_with_one(few_short):
    assert set(finite_rows(pipeline.worker_rows(1, few_short, 12, 4))) == {"pipeline workers"}


def test_a_large_corpus_is_compared_with_a_small_one(few_short):
    rows = finite_rows(pipeline.growth_rows(1, few_short, (4, 16)))
    assert 20 < rows["growth memory"].value < 4000


def test_a_cold_start_is_compared_with_a_warm_one(few_short):
    found = finite_rows(starting.first_record_rows(1, few_short))
    assert found["start cold"].ratio > 1
    assert found["start warm"].value == found["start cold"].alternative_value


def test_the_cost_of_a_million_records_is_that_of_a_corpus(brief_full, monkeypatch):
    monkeypatch.setattr(million, "corpus_cost", lambda *_: {"ms": 3.6, "MB": 100.0, "bytes": 25_600.0})
    found = finite_rows(million.rows(1, recipes={"some": (brief_full, 4)}, sampled_s=0.001))
    assert found["million some"].value == pytest.approx(1.0)  # core hours
    disk = found["million some disk"]
    assert (disk.value, disk.alternative_value) == pytest.approx((25.6, 51.2))  # GB, at 12,800 Hz
    assert found["million some memory"].ratio == pytest.approx(0.2)


def checkout(folder: Path, iterations: int) -> Path:
    """A folder whose ``raceway`` only counts."""
    (folder / "raceway").mkdir(parents=True)
    (folder / "raceway" / "__init__.py").touch()
    (folder / "raceway" / "__main__.py").write_text(f"for _ in range({iterations}):\n    pass\n", encoding="utf-8")
    return folder


def test_another_checkout_is_run_with_its_own_code(few_short, tmp_path, monkeypatch):
    monkeypatch.setattr(against, "ROOT", checkout(tmp_path / "ours", 1))
    found = against.compared(checkout(tmp_path / "theirs", 20_000_000), few_short, 8, 1)
    assert found.ratio > 2


def test_a_folder_without_raceway_is_no_checkout(tmp_path, capsys):
    with pytest.raises(SystemExit):
        against.main([str(tmp_path)])
    assert "holds no checkout of Raceway" in capsys.readouterr().err


def test_a_corpus_of_many_parts_is_compared_with_one_of_few():
    found = finite_rows(growth.rows(1, parts=(2, 4), workers=2, task_s=0.01))
    assert set(found) == {"growth driver", "growth scheduler", "growth ending"}


def test_features_are_compared_where_tsfel_is_installed():
    (line,) = features.rows(1, records=2, theirs=1)
    assert isinstance(line, Row if importlib.util.find_spec("tsfel") else Skipped)


def test_functions_of_an_analyst_are_compared_with_scipy():
    found = finite_rows(analysis.rows(1, samples=20_000))
    assert found["analysis psd"].alternative == "welch"


def test_opening_a_corpus_is_compared_with_opening_its_parts():
    assert set(finite_rows(opening.rows(1, parts=3, records_per_part=2))) == {"opening folder", "opening file"}


def test_records_for_training_are_compared_with_numpy_and_h5py():
    found = finite_rows(training.rows(1, parts=1, samples=16, batch=64))
    assert set(found) == {f"training {name}" for name in ("numpy", "h5py", "zstd", "one by one")}


def test_short_commands_are_compared_with_the_import_of_the_libraries_they_need():
    found = finite_rows(starting.command_rows(1))
    names = ("help", "info", "plan", "diagnose", "import gen")
    assert set(found) == {f"starting {name}" for name in names}
    assert all(line.value < 30 for line in found.values())


def test_a_record_is_the_same_from_the_index_and_from_the_parts(few_short, tmp_path):
    corpus = generate(few_short, tmp_path / "corpus", records=12).path
    assert (opening.read_record(corpus, 7) == opening.read_from_parts(corpus, 7)).all()


def test_the_table_has_a_line_for_each_row_and_a_sentence_for_each_that_is_missing():
    made = row("kernel", "speed", "records/s", [2.0, 9.0, 4.0], "rival", [1.0, 3.0, 4.0])
    assert made[2:] == (4.0, "records/s", "rival", 3.0, 2.0, 3)
    lines = table([made, Skipped("rival", "it is not here.")]).splitlines()
    assert lines[1].split() == ["kernel", "speed", "4", "records/s", "rival", "3", "records/s", "2", "3"]
    assert lines[2] == "rival: it is not here."


def test_judged_records_are_compared_with_records_that_are_not(brief_full):
    assert set(finite_rows(truth.rows(1, 12, brief_full))) == {"truth full", "truth redraw"}
