"""Whatever ``generate`` refuses with several workers, it refuses before a process is started, in one sentence and with exit code 2."""

import fcntl
import os
import shutil

import pytest

from gen import generate
from gen.support import cluster
from raceway import copy
from tests.tampering import edit_manifest

PARTS = 4


@pytest.fixture(scope="module")
def places(tiny_recipe, tiny_corpus, tmp_path_factory):
    """What is in the way of a corpus, by name."""
    here = tmp_path_factory.mktemp("in_the_way")
    (here / "file").write_text("mine")
    (here / "thesis").mkdir()
    (here / "thesis" / "thesis.txt").write_text("mine")
    (here / "table.nc").write_text("mine")
    shutil.copytree(tiny_corpus, here / "whole")
    shutil.copytree(tiny_corpus, here / "of_other_sources")
    edit_manifest(here / "of_other_sources", sources_sha256="0" * 64)
    edit_manifest(shutil.copytree(tiny_corpus, here / "of_other_libraries"), versions={"numpy": "1.0"})
    edit_manifest(shutil.copytree(tiny_corpus, here / "of_unknown_sources"), sources_sha256=None, complete=False)
    manifest = shutil.copytree(tiny_corpus, here / "altered_manifest") / "manifest.json"
    manifest.write_text(manifest.read_text().replace('"records": 48', '"records": 47'))
    edit_manifest(shutil.copytree(tiny_corpus, here / "of_a_choice"), recipe_sha256=None)
    copy(tiny_corpus, here / "copied")
    generate(tiny_recipe, here / "one.nc")
    altered = bytearray((here / "one.nc").read_bytes())
    altered[-500] ^= 0xFF
    (here / "altered_file.nc").write_bytes(altered)
    (here / "loaded.yaml").write_text(tiny_recipe.read_text().replace("operation: {", "operation: {load_n: 310, "))
    (here / "wrong.yaml").write_text(tiny_recipe.read_text().replace("storage:", "storrage:"))
    return {path.name.partition(".")[0]: path for path in here.iterdir()} | {
        "recipe": tiny_recipe, "new": here / "new", "nowhere": here / "nowhere.yaml", "caf": here / "caf\udce9", "here": here,
    }  # fmt: skip


REFUSED = [
    ("{nowhere} -o {new}", "neither a file nor one of the recipes"),
    ("{wrong} -o {new}", "storrage"),
    ("{recipe} -o {file}", "is a file; give a folder"),
    ("{recipe} -o {thesis}", "is not empty and holds no corpus"),
    ("{recipe} -o {table}", "its bytes do not have the hash"),
    ("{recipe} -o {whole}/parts/mine", "is in the corpus"),
    ("{recipe} -o {caf}", "the name is not UTF-8"),
    (
        "{recipe} -o {whole} --records 24",
        "holds a corpus of 48 records and not 24; a folder grows, and no corpus shrinks",
    ),
    (
        "{recipe} -o {one} --records 60",
        "holds a corpus of 48 records and not 60; a folder grows, and no corpus shrinks",
    ),
    ("{recipe} -o {whole} --seed 77", "choose another name, or grow a folder with its old recipe and --records N."),
    ("{loaded} -o {whole}", "holds a corpus of another recipe or seed"),
    ("{recipe} -o {of_other_sources}", "was begun with sources 000000000000"),
    ("{recipe} -o {of_unknown_sources}", "is installed and can give other samples: install the former to complete it"),
    ("{recipe} -o {altered_file}", "altered_file.nc: its bytes do not have the hash"),
    ("{recipe} -o {altered_manifest}", "manifest.json: its bytes do not have the hash"),
    ("{recipe} -o {of_a_choice}", "was not generated from a recipe as a whole"),
    ("{recipe} -o {copied}", "was not generated from a recipe as a whole"),
    ("{recipe} -o {new} --records 0", "records"),
    (f"{{recipe}} -o {{new}} --parts 0-{PARTS}", f"has the parts 0-{PARTS - 1}"),
    ("{recipe} -o {new} --parts 1-", "is no range"),
    ("{recipe} -o {new} --parts \u0660-\u0661", "is no range"),
    ("{recipe} -o {new}.nc --parts 0-1", "is one file, which has all parts"),
    ("{recipe} -o {new} --workers 0", "0 is not in the range"),
    ("{recipe} -o {new} --scheduler nowhere", "does not answer"),
]


def changed(folder):
    """Last change of everything in a folder."""
    return {path: path.lstat().st_mtime_ns for path in folder.rglob("*")}


@pytest.mark.parametrize(("line", "sentence"), REFUSED, ids=[line for line, _ in REFUSED])
def test_a_refusal_starts_no_process_and_leaves_nothing(run, places, monkeypatch, line, sentence):
    monkeypatch.setattr(cluster, "SpecCluster", lambda *_, **__: pytest.fail("a process was started"))
    before = changed(places["here"])
    result = run("generate", "--workers", 2, *line.format(**places).split())
    assert result.exit_code == 2, result.output
    assert len(result.stderr.strip().splitlines()) == 1 or "Usage" in result.stderr
    assert sentence in result.stderr
    assert changed(places["here"]) == before


def test_a_second_call_in_a_folder_is_refused_before_a_process_is_started(run, places, monkeypatch):
    monkeypatch.setattr(cluster, "SpecCluster", lambda *_, **__: pytest.fail("a process was started"))
    handle = os.open(places["whole"], os.O_RDONLY)
    fcntl.flock(handle, fcntl.LOCK_EX)
    result = run("generate", places["recipe"], "-o", places["whole"], "--records", 480, "--workers", 2)
    os.close(handle)
    assert result.exit_code == 2
    assert "another raceway command is writing into it" in result.stderr
