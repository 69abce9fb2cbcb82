"""Laws of generation: a corpus is the same for any number of workers and interruptions."""

import fcntl
import importlib
import json
import math
import os
import shutil
import threading
import time

import h5py
import numpy as np
import pytest
from distributed import LocalCluster

from gen.corpus import FAULTS, SIGNAL, SPLITS, open_corpus, open_part, part_name, read_manifest, validate_corpus
from gen.errors import ClusterError, CorpusError, RecipeError
from gen.generation import generate
from gen.physics.bearing import orders
from gen.physics.catalogue import CATALOGUE
from gen.recipe import read_recipe
from gen.replaying import replay
from gen.scenarios import draw_scenarios, read_scenario

GENERATE = importlib.import_module("gen.generation")


def hashes(folder):
    return {row.name: row.sha256 for row in read_manifest(folder).parts}


def counts(folder):
    with open_corpus(folder) as corpus:
        return np.rint(corpus[SIGNAL].values * 32767 / 500).astype(np.int16)


@pytest.fixture(scope="module")
def recipe_file(write_recipe, tmp_path_factory):
    return write_recipe(tmp_path_factory.mktemp("recipe") / "small.yaml")


@pytest.fixture(scope="module")
def whole(recipe_file, tmp_path_factory):
    """The small corpus: three parts of eight records."""
    folder = tmp_path_factory.mktemp("whole") / "corpus"
    return generate(recipe_file, folder)


@pytest.fixture
def copied(whole, tmp_path):
    return shutil.copytree(whole.directory, tmp_path / "copy")


def assert_the_same_corpus(folder, whole):
    assert validate_corpus(folder) == []
    assert hashes(folder) == hashes(whole.directory)
    np.testing.assert_array_equal(counts(folder), counts(whole.directory))
    for name in ("recipe.yaml", "README.md", "manifest.json", "corpus.nc"):
        assert (folder / name).read_bytes() == (whole.directory / name).read_bytes()


def test_one_call_makes_a_complete_and_valid_corpus(whole):
    assert (whole.records, whole.parts, whole.kept, whole.failures) == (24, 3, 0, ())
    assert validate_corpus(whole.directory) == []
    manifest = read_manifest(whole.directory)
    assert manifest.complete
    assert manifest.recipe == "small"
    assert [row.records for row in manifest.parts] == [8, 8, 8]
    assert "A small corpus for tests" in (whole.directory / "README.md").read_text()
    leftovers = [path.name for path in whole.directory.rglob(".*")]
    assert leftovers == []


@pytest.mark.parametrize("workers", [2, 3], ids="{} threads".format)
def test_threads_make_the_same_corpus_as_one(recipe_file, whole, tmp_path, workers):
    done = []
    generate(recipe_file, tmp_path / "c", workers=workers, progress=lambda *counts: done.append(counts))
    assert_the_same_corpus(tmp_path / "c", whole)
    assert done[-1] == (24, 24)


def test_processes_with_threads_make_the_same_corpus_as_one(recipe_file, whole, tmp_path, monkeypatch):
    monkeypatch.setattr("gen.generation.threads_of", lambda _: 2)
    generate(recipe_file, tmp_path / "four", workers=4)
    assert_the_same_corpus(tmp_path / "four", whole)


def test_an_error_in_a_thread_ends_all_threads_and_is_told(recipe_file, tmp_path, monkeypatch):
    def full_disk(*_args):
        raise CorpusError("no space left")

    monkeypatch.setattr("gen.part_task.write_part", full_disk)
    before = threading.active_count()
    with pytest.raises(CorpusError, match="no space left"):
        generate(recipe_file, tmp_path / "c", workers=2)
    assert threading.active_count() == before


def test_workers_of_a_given_scheduler_make_the_same_corpus(recipe_file, whole, tmp_path):
    with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=":0") as cluster:
        generate(recipe_file, tmp_path / "given", scheduler=cluster.scheduler_address)
    assert_the_same_corpus(tmp_path / "given", whole)


@pytest.mark.parametrize("kept", [0, 1, 2])
def test_an_interrupted_corpus_is_refused_until_the_same_call_completes_it(recipe_file, whole, tmp_path, kept):
    def interrupted(*_counts):
        if len(hashes(tmp_path / "c")) >= kept:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        generate(recipe_file, tmp_path / "c", progress=interrupted)
    with pytest.raises(CorpusError, match="unfinished"):
        open_corpus(tmp_path / "c")
    again = generate(recipe_file, tmp_path / "c")
    assert again.kept == kept
    assert_the_same_corpus(tmp_path / "c", whole)


def test_a_corpus_interrupted_before_its_first_part_was_done_is_completed_too(
    recipe_file, whole, tmp_path, monkeypatch
):
    def interrupted(*_args):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(GENERATE, "make_parts", interrupted)
        with pytest.raises(KeyboardInterrupt):
            generate(recipe_file, tmp_path / "c")
    generate(recipe_file, tmp_path / "c")
    assert_the_same_corpus(tmp_path / "c", whole)


UNLISTED = {
    "a copy of another part": lambda parts: shutil.copyfile(parts / part_name(0), parts / part_name(2)),
    "a part with a flipped byte": lambda parts: (parts / part_name(1)).write_bytes(
        (parts / part_name(1)).read_bytes()[:-100] + b"x" + (parts / part_name(1)).read_bytes()[-99:]
    ),
    "the right part": lambda _: None,
}


@pytest.mark.parametrize("left", UNLISTED)
def test_a_part_that_the_manifest_does_not_list_is_made_again(recipe_file, whole, copied, left):
    manifest = json.loads((copied / "manifest.json").read_text())
    manifest |= {"complete": False, "index": None, "records": 8, "parts": manifest["parts"][:1]}
    (copied / "manifest.json").write_text(json.dumps(manifest))
    UNLISTED[left](copied / "parts")
    assert generate(recipe_file, copied).kept == 1
    assert_the_same_corpus(copied, whole)


def test_no_part_of_other_library_versions_is_kept(recipe_file, whole, copied):
    manifest = json.loads((copied / "manifest.json").read_text())
    manifest["versions"]["numpy"] = "1.0"
    (copied / "manifest.json").write_text(json.dumps(manifest))
    assert generate(recipe_file, copied).kept == 0
    assert_the_same_corpus(copied, whole)


def test_a_second_call_in_the_same_folder_is_told_so(recipe_file, copied):
    handle = os.open(copied, os.O_RDONLY)
    fcntl.flock(handle, fcntl.LOCK_EX)
    with pytest.raises(CorpusError, match="another raceway command is writing into it; wait until it ends"):
        generate(recipe_file, copied)
    os.close(handle)
    assert generate(recipe_file, copied).kept == 3


def test_what_a_killed_call_left_is_removed_and_nothing_of_the_user(recipe_file, whole, copied):
    for name in (".manifest.json.1.1.tmp", ".corpus.nc.22.33.tmp", "parts/.part-00001.nc.4.5.tmp"):
        (copied / name).write_bytes(b"half")
    (copied / ".notes.tmp").write_text("mine")
    generate(recipe_file, copied)
    assert [path.name for path in copied.rglob(".*")] == [".notes.tmp"]
    assert_the_same_corpus(copied, whole)


def test_a_second_call_keeps_every_part(recipe_file, whole, copied):
    again = generate(recipe_file, copied)
    assert (again.records, again.parts, again.kept) == (24, 3, 3)
    assert_the_same_corpus(copied, whole)


@pytest.mark.parametrize("damage", ["deleted", "altered", "swapped for another", "of another recipe"])
def test_a_part_that_is_gone_or_not_the_right_one_is_made_again_to_the_byte(
    recipe_file, write_recipe, whole, copied, tmp_path, damage
):
    part = copied / "parts" / part_name(1)
    if damage == "deleted":
        part.unlink()
    elif damage == "altered":
        content = bytearray(part.read_bytes())
        content[-500] ^= 0xFF
        part.write_bytes(content)
    elif damage == "swapped for another":
        shutil.copyfile(copied / "parts" / part_name(0), part)
    else:
        other = generate(write_recipe(tmp_path / "other.yaml", {"seed": 4}), tmp_path / "other")
        shutil.copyfile(other.directory / "parts" / part_name(1), part)
    assert validate_corpus(copied) != []
    assert generate(recipe_file, copied).kept == 2
    assert_the_same_corpus(copied, whole)


@pytest.mark.parametrize(
    "changes", [{"seed": 4}, {"records": 20}, {"operation.load_n": 300}], ids=lambda changes: str(changes)
)
def test_another_recipe_does_not_go_into_the_same_folder(write_recipe, copied, tmp_path, changes):
    before = hashes(copied)
    with pytest.raises(CorpusError, match="holds a corpus of another recipe, seed or size; choose another folder"):
        generate(write_recipe(tmp_path / "other.yaml", changes), copied)
    assert hashes(copied) == before


def test_comments_and_layout_do_not_make_another_recipe(recipe_file, copied, tmp_path):
    commented = tmp_path / "commented.yaml"
    commented.write_text("# the same\n\n" + recipe_file.read_text())
    assert generate(commented, copied).kept == 3


def test_what_is_in_the_way_of_a_corpus_is_named(recipe_file, tmp_path):
    (tmp_path / "file").write_text("mine")
    with pytest.raises(CorpusError, match="is a file; give a folder"):
        generate(recipe_file, tmp_path / "file")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "thesis.txt").write_text("mine")
    with pytest.raises(CorpusError, match="is not empty and holds no corpus; choose another folder"):
        generate(recipe_file, tmp_path / "full")
    assert (tmp_path / "full" / "thesis.txt").read_text() == "mine"


def test_a_folder_whose_name_is_not_utf_8_is_refused_before_anything_is_made(recipe_file, tmp_path):
    with pytest.raises(CorpusError, match="the name is not UTF-8, and netCDF needs UTF-8; choose another"):
        generate(recipe_file, tmp_path / "caf\udce9")
    assert list(tmp_path.iterdir()) == []


def test_less_than_one_worker_is_refused_before_anything_is_written(recipe_file, tmp_path):
    with pytest.raises(RecipeError, match="workers: 0 is not allowed; use 1 or more"):
        generate(recipe_file, tmp_path / "c", workers=0)
    assert list(tmp_path.iterdir()) == []


def test_a_scheduler_that_does_not_answer_is_refused_before_anything_is_written(recipe_file, tmp_path):
    with pytest.raises(ClusterError, match="does not answer"):
        generate(recipe_file, tmp_path / "c", scheduler="nowhere")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("where", ["this process", "a cluster"])
def test_progress_moves_within_a_part_and_ends_once_at_the_whole(write_recipe, tmp_path, monkeypatch, where):
    """Two batches of one part: the first is reported before the part is written."""
    recipe = write_recipe(tmp_path / "one.yaml", {"corpus.records_per_part": 24})
    done, written = [], []
    from gen.part_task import write_part

    def slowly(*given):
        time.sleep(0 if where == "this process" else 0.5)  # several times POLL_S
        written.append(len(done))
        return write_part(*given)

    monkeypatch.setattr("gen.part_task.write_part", slowly)
    monkeypatch.setattr("gen.cluster.POLL_S", 0.05)
    if where == "this process":
        generate(recipe, tmp_path / "c", progress=lambda *counts: done.append(counts))
    else:
        with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=":0") as cluster:
            address = cluster.scheduler_address
            generate(recipe, tmp_path / "c", scheduler=address, progress=lambda *counts: done.append(counts))
    numbers = [number for number, _ in done]
    assert numbers == sorted(numbers)
    assert {total for _, total in done} == {24}
    assert any(0 < number < 24 for number in numbers[: written[0]])
    assert numbers.count(24) == 1


@pytest.mark.parametrize("record", [0, 7, 8, 23])
def test_any_record_can_be_made_again_bit_for_bit(whole, record):
    replayed = replay(whole.directory, record)
    assert replayed.identical
    assert replayed.dataset["recording"].values.tolist() == [record]
    with open_corpus(whole.directory) as corpus:
        for name in ("draws", "fault", "shaft_rate", "snr", "true_bpfo"):
            assert replayed.dataset[name].values[0] == corpus[name].values[record]


def test_a_record_that_was_tampered_with_is_not_what_replay_makes(write_recipe, tmp_path):
    floating = {"recording.converter": {"kind": "float32"}, "corpus.codec": "none", "records": 8}
    made = generate(write_recipe(tmp_path / "r.yaml", floating), tmp_path / "c")
    with h5py.File(made.directory / "parts" / part_name(0), "r+") as part:
        part[SIGNAL][3, 0, 100] += 1e-4
    assert [replay(made.directory, record).identical for record in range(2, 5)] == [True, False, True]


@pytest.mark.parametrize("record", [-1, 24])
def test_a_record_that_is_not_there_cannot_be_replayed(whole, record):
    with pytest.raises(CorpusError, match=f"record {record} is not in it; it has records 0 to 23"):
        replay(whole.directory, record)


def test_seed_and_size_given_in_the_call_are_remembered(recipe_file, whole, tmp_path):
    made = generate(recipe_file, tmp_path / "c", seed=11, records=5)
    assert (made.records, made.parts) == (5, 1)
    assert replay(made.directory, 4).identical
    assert not np.array_equal(counts(made.directory), counts(whole.directory)[:5])


def test_a_recipe_changed_behind_the_corpus_cannot_replay_it(copied):
    text = (copied / "recipe.yaml").read_text()
    (copied / "recipe.yaml").write_text(text.replace("seed: 3", "seed: 4"))
    with pytest.raises(CorpusError, match="is not the recipe of the corpus"):
        replay(copied, 0)


def test_records_that_diverge_are_left_out_and_named_and_the_rest_is_a_valid_corpus(
    write_recipe, tmp_path, monkeypatch
):
    """One step per sample: the second of three rigs, a whole part, has a resonance that Runge-Kutta cannot hold."""
    monkeypatch.setattr("gen.simulation.steps.COARSEST_STEP", math.inf)
    resonance = {"kind": "grid", "values": [1500, 5900]}
    recipe = write_recipe(
        tmp_path / "r.yaml", {"recording.oversampling": 1, "machine.resonator.frequency_hz": resonance}
    )
    made = generate(recipe, tmp_path / "c")
    assert (made.records, made.parts) == (16, 2)
    assert [sentence.split(" diverged")[0] for sentence in made.failures] == [f"record {n}" for n in range(8, 16)]
    assert validate_corpus(made.directory) == []
    assert read_manifest(made.directory).failures == made.failures
    with open_corpus(made.directory) as corpus:
        assert corpus["recording"].values.tolist() == [*range(8), *range(16, 24)]
    assert replay(made.directory, 8).identical
    again = generate(recipe, tmp_path / "c")
    assert (again.records, again.kept, again.failures) == (16, 2, made.failures)


def test_labels_say_what_was_drawn(recipe_file, whole):
    recipe = read_recipe(recipe_file)
    nominal = orders(CATALOGUE["6205"])
    with open_corpus(whole.directory) as corpus:
        for place, scenario in enumerate(draw_scenarios(recipe)):
            row = corpus.isel(record=place)
            conditions, specimen = scenario.record.conditions, scenario.specimen
            assert FAULTS[int(row["fault"])] == specimen.fault
            assert SPLITS[int(row["split"])] == specimen.split
            assert (int(row["rig"]), int(row["specimen"])) == (scenario.rig.number, specimen.number)
            assert float(row["shaft_rate"]) == conditions["shaft"] * (1 + conditions["label_error"])
            assert float(row["true_shaft_rate"]) == pytest.approx(conditions["shaft"], rel=0.01)
            assert [float(row[name]) for name in nominal._fields] == list(nominal)
            assert (float(row["largest_drop"]) > 0) == (specimen.fault != "healthy")
            assert float(row["width"]) == (0 if specimen.fault == "healthy" else pytest.approx(0.5e-3))
            assert read_scenario(str(row["draws"].values)) == scenario


def test_a_part_can_be_read_on_its_own(whole):
    with open_part(whole.directory / "parts" / part_name(2)) as part, open_corpus(whole.directory) as corpus:
        np.testing.assert_array_equal(part[SIGNAL].values, corpus[SIGNAL].values[16:])
        assert part.attrs["title"] == corpus.attrs["title"] == "A small corpus for tests"
