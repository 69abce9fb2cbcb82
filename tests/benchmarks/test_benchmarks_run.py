"""Every benchmark runs once, on small input."""

import importlib.util
import math

from benchmarks import features, kernel, opening, pipeline, reading, rivals, roofline, starting, truth
from benchmarks.__main__ import table
from benchmarks.pairs import Row, Skipped, row
from benchmarks.profile import PARTS, kernel_parts
from gen.generation import generate
from gen.recipe import read_recipe


def finite_rows(lines) -> dict[str, Row]:
    rows = {line.name: line for line in lines if isinstance(line, Row)}
    assert all(math.isfinite(found.ratio) and found.ratio > 0 for found in rows.values())
    return rows


def test_the_kernel_is_compared_with_c_and_the_full_model_with_the_seed(brief_seed, brief_full):
    lines = list(kernel.rows(1, recipe=brief_seed, full=brief_full, records=4, samples=20))
    assert {line.name for line in lines} == {"kernel plain", "kernel fused", "kernel intrinsics", "kernel full"}
    assert "kernel full" in finite_rows(lines)


def test_the_step_is_compared_with_its_roofline():
    found = finite_rows(roofline.rows(1, times=1000, shapes=("seed model",)))
    assert not found or {"roofline seed model", "roofline roots"} == set(found)


def test_the_time_of_the_kernel_is_told_part_by_part(brief_full):
    parts, n_steps = kernel_parts(read_recipe(brief_full))
    assert set(parts) == set(PARTS)
    assert n_steps > 1
    assert 0 < sum(parts.values()) < 1e-4


def test_the_kernel_is_compared_with_its_rivals(brief_seed):
    lines = list(rivals.rows(1, recipe=brief_seed, records=4, steps=4, sampled_s=0.002))
    assert {"kernel solve_ivp", "kernel numpy"} <= set(finite_rows(lines))
    assert isinstance(lines[-1], Row if importlib.util.find_spec("jax") else Skipped)


def test_a_corpus_is_compared_with_the_kernel_alone(brief_full):
    assert set(finite_rows(pipeline.throughput_rows(1, brief_full, 2))) == {"pipeline zlib", "pipeline zstd"}


def test_two_workers_are_compared_with_one(few_short):
    assert set(finite_rows(pipeline.worker_rows(1, few_short, 12, 4))) == {"pipeline workers", "pipeline started"}


def test_a_large_corpus_is_compared_with_a_small_one(few_short):
    rows = finite_rows(pipeline.growth_rows(1, few_short, (4, 16)))
    assert 20 < rows["growth memory"].value < 4000


def test_a_cold_start_is_compared_with_a_warm_one(few_short):
    (found,) = finite_rows(pipeline.start_rows(1, few_short)).values()
    assert found.ratio > 1


def test_features_are_compared_where_tsfel_is_installed_and_their_memory_does_not_grow():
    memory, line = features.rows(1, records=2, theirs=1, scales=(250, 4000))
    assert isinstance(line, Row if importlib.util.find_spec("tsfel") else Skipped)
    assert 0 < memory.value < memory.alternative_value + 15  # MB; the signals are 20 MB


def test_opening_a_corpus_is_compared_with_opening_its_parts():
    assert set(finite_rows(opening.rows(1, parts=3, records_per_part=2))) == {"opening size", "opening sha256"}


def test_reading_a_corpus_is_compared_with_its_virtual_dataset():
    found = finite_rows(reading.rows(1, parts=3, records_per_part=2, seconds_each=0.02))
    assert set(found) == {
        f"reading {way}" for way in ("in order", "at random", "through dask", "in processes", "hashes")
    }


def test_short_commands_are_compared_with_the_import_of_the_libraries_they_need():
    found = finite_rows(starting.rows(1))
    names = ("help", "recipes", "info", "misspelt", "import gen", "import gen.corpus", "import features")
    assert set(found) == {f"starting {name}" for name in names}
    assert all(line.value < 5 for line in found.values())


def test_a_record_is_the_same_from_the_index_and_from_the_parts(few_short, tmp_path):
    corpus = generate(few_short, tmp_path / "corpus", records=12).directory
    assert (opening.read_record(corpus, 7) == opening.read_from_parts(corpus, 7)).all()


def test_the_table_has_a_line_for_each_row_and_a_sentence_for_each_that_is_missing():
    made = row("kernel", "speed", "records/s", [2.0, 9.0, 4.0], "rival", [1.0, 3.0, 4.0])
    assert made[2:] == (4.0, "records/s", "rival", 3.0, 2.0, 3)
    lines = table([made, Skipped("rival", "it is not here.")]).splitlines()
    assert lines[1].split() == ["kernel", "speed", "4", "records/s", "rival", "3", "records/s", "2", "3"]
    assert lines[2] == "rival: it is not here."


def test_judged_records_are_compared_with_records_that_are_not(brief_full):
    assert set(finite_rows(truth.rows(1, 12, brief_full))) == {"truth full", "truth redraw"}
