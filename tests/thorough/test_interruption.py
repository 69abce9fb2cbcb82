"""After any interruption finished files are kept, no file is incomplete, and the same command completes the work."""

import os
import re
import shutil
import signal
import time
from contextlib import suppress

import numpy as np
import psutil
import pytest

from gen import generate
from gen.corpus import read_manifest, validate_corpus
from tests.kills import killed
from tests.labels import write_labels
from tests.same_corpora import assert_the_same_corpus, files

N_PARTS = 12
PATIENCE_S = 60


@pytest.fixture(scope="module")
def recipe(tiny_recipe, tmp_path_factory):
    """The tiny recipe in many small parts; a part of one batch takes the same time for any number of records."""
    path = tmp_path_factory.mktemp("many") / "many.yaml"
    path.write_text(tiny_recipe.read_text().replace("records_per_part: 12", "records_per_part: 4"))
    return path


@pytest.fixture(scope="module")
def whole(recipe, tmp_path_factory):
    """Bytes of the parts and of the manifest that an uninterrupted call writes."""
    return part_bytes(generate(recipe, tmp_path_factory.mktemp("whole") / "corpus").path)


def part_bytes(folder):
    """Bytes of the parts, the index and the manifest."""
    paths = (*(folder / "parts").iterdir(), folder / "manifest.json", folder / "index.nc")
    return {path.name: path.read_bytes() for path in sorted(paths)}


def listed(folder):
    """Names of the whole parts."""
    if not (folder / "manifest.json").exists():
        return []
    return [row.name for row in read_manifest(folder).parts]


def wait_for(found, process):
    """Return as soon as ``found()`` is true; fail if the process ends before that."""
    stop = time.monotonic() + PATIENCE_S
    while not found():
        if process.poll() is not None or time.monotonic() > stop:
            pytest.fail(f"the process ended ({process.poll()}) before it could be interrupted")
        time.sleep(5e-3)


@pytest.mark.parametrize(
    ("number", "workers", "name"), [(signal.SIGINT, 2, "c"), (signal.SIGTERM, 1, "c"), (signal.SIGINT, 2, "c.nc")]
)
def test_a_signal_leaves_finished_parts_and_one_line(start, recipe, whole, tmp_path, number, workers, name):
    corpus, folder = tmp_path / name, tmp_path / ("c" if name == "c" else "c.nc.parts")
    process = start("generate", recipe, "-o", corpus, "--workers", workers)
    wait_for(lambda: listed(folder), process)
    os.killpg(process.pid, number)
    output, errors = process.communicate(timeout=PATIENCE_S)
    assert (process.returncode, output) == (130, "")
    said = re.fullmatch(
        rf"interrupted; (\d+) of {N_PARTS} parts kept in {re.escape(str(folder))}; the same command completes the corpus.\n",
        without_progress(errors),
    )
    assert said, errors
    kept = listed(folder)
    assert 1 <= int(said[1]) <= len(kept) < N_PARTS
    assert {name: (folder / "parts" / name).read_bytes() for name in kept}.items() <= whole.items()
    assert not list(folder.glob("**/.*"))
    assert generate(recipe, corpus).kept == len(kept)
    assert not kept_open(corpus)
    assert corpus.is_file() or part_bytes(folder) == whole
    assert validate_corpus(corpus) == []


def without_progress(errors):
    """What a call says beside its compilation and its progress."""
    return "".join(
        line
        for line in errors.splitlines(keepends=True)
        if not line.startswith(("compiling ", "kernel ", "generating: ", "workers: "))
    )


def kept_open(corpus):
    """Hidden and unfinished files beside a finished corpus."""
    return [path for path in corpus.parent.iterdir() if path.name.startswith(".") or path.name.endswith(".parts")]


KILLS = 6


@pytest.mark.parametrize("name", ["c", "c.nc"])
def test_a_corpus_killed_at_any_moment_has_whole_parts_and_is_completed_to_the_byte(recipe, tmp_path, name):
    """Between the kills nothing unfinished is removed, so that most of them meet the last steps of a file."""
    corpus, whole = tmp_path / name, {}
    for _ in killed(lambda: generate(recipe, corpus, records=16), moments=KILLS):
        problems = validate_corpus(corpus) if corpus.exists() else ["not there"]
        assert corpus.is_dir() or problems in ([], ["not there"])
        if problems == []:
            whole = whole or files(corpus)
            corpus.unlink() if corpus.is_file() else shutil.rmtree(corpus)
        for part in (corpus / "parts").glob("part-*.nc"):
            assert part.read_bytes() == whole[part.relative_to(corpus)]
    generate(recipe, corpus, records=16)
    assert files(corpus) == whole
    assert not kept_open(corpus)
    assert not list(tmp_path.glob("**/.*"))


@pytest.mark.parametrize("victim", ["driver", "worker", "group"])
def test_kills_at_any_moment_leave_whole_parts_and_no_process(start, recipe, whole, tmp_path, victim):
    """Ten kills of the driver, of a worker or of all processes, two workers; a lost worker is no loss: the other makes its part.

    The first process below the driver becomes the workers; the command ends with a sentence if it is killed before.
    """
    folder, rng = tmp_path / "corpus", np.random.default_rng(0)
    for moment in rng.uniform(0.5, 4.0, 10):
        process = start("generate", recipe, "-o", folder, "--workers", 2, "--records", 480)
        time.sleep(moment)
        first, *copies = sorted(members(process.pid) - {process.pid}) or [0]
        if victim == "group":
            os.killpg(process.pid, signal.SIGKILL)
        elif victim == "driver" or not first:
            process.kill()
        else:
            os.kill(rng.choice([first, *copies]), signal.SIGKILL)
        process.communicate(timeout=PATIENCE_S)
        ended = (0 if copies else 2) if victim == "worker" and first else -signal.SIGKILL
        assert process.returncode == ended
        stop = time.monotonic() + 5.0
        while members(process.pid):
            assert time.monotonic() < stop
            time.sleep(0.05)
        for part in (folder / "parts").glob("part-*.nc"):
            assert part.read_bytes() == whole.get(part.name, part.read_bytes())
        if process.returncode == 0:
            shutil.rmtree(folder)
    generate(recipe, folder, records=480)
    assert_the_same_corpus(folder, generate(recipe, tmp_path / "at_once", records=480))


def members(group):
    """Numbers of the processes of a group."""
    found = set()
    for number in psutil.pids():
        with suppress(ProcessLookupError):
            if os.getpgid(number) == group:
                found.add(number)
    return found


def test_a_full_disk_ends_in_one_sentence_and_the_same_command_completes_the_corpus(start, recipe, whole, tmp_path):
    folder = tmp_path / "corpus"
    largest_file = str(len(whole["part-00000.nc"]) // 2)
    process = start("generate", recipe, "-o", folder, "--workers", 1, LARGEST_FILE=largest_file)
    output, errors = process.communicate(timeout=PATIENCE_S)
    assert (process.returncode, output) == (2, "")
    assert re.fullmatch(
        r".*part-\d+\.nc: could not be written \(.*\); free some space or choose another folder.\n",
        without_progress(errors),
    )
    assert [path.name for path in (folder / "parts").glob("*.nc")] == []
    generate(recipe, folder)
    assert part_bytes(folder) == whole


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_the_processes_that_compile_end_with_the_command(start, tmp_path, number):
    cache = tmp_path / "cache"
    process = start("generate", "domain_randomised", "-o", tmp_path / "corpus", NUMBA_CACHE_DIR=str(cache))
    assert any("compiling the kernel for this machine" in line for line in iter(process.stderr.readline, ""))
    os.kill(process.pid, number)  # the command alone: a terminal would stop the others too
    process.communicate(timeout=PATIENCE_S)
    assert process.returncode == (130 if number == signal.SIGINT else -signal.SIGKILL)
    stop = time.monotonic() + PATIENCE_S
    while members(process.pid):
        assert time.monotonic() < stop
        time.sleep(0.05)
    assert not list(cache.glob("kernel_*/*.nbc"))


def test_an_interrupted_import_leaves_no_file(start, tmp_path):
    files = [{"path": f"{number}.npy", "fault": "healthy", "specimen": "new"} for number in range(2000)]
    for file in files:
        (tmp_path / file["path"]).write_bytes(b"no recording")
    labels = write_labels(tmp_path, files, bearing="6205", unit="g", sample_rate_hz=2000, shaft_rpm=1480)
    process = start("import", "generic", labels, "-o", tmp_path / "corpus")
    wait_for(lambda: any(tmp_path.glob(".corpus.*.tmp")), process)
    os.killpg(process.pid, signal.SIGINT)
    output, errors = process.communicate(timeout=PATIENCE_S)
    assert (process.returncode, output) == (130, "")
    assert errors == "interrupted; no unfinished file is left; the same command starts again.\n"
    assert not list(tmp_path.glob("*corpus*"))


def test_a_closed_output_ends_the_command_without_a_traceback(start):
    process = start("recipes")
    process.stdout.close()
    assert process.stderr.read() == ""
    assert process.wait(PATIENCE_S) == 141
