"""Laws of completion: a call that was interrupted is completed by the same call to the byte, and by no other."""

import importlib
import os
import shutil
import subprocess
import sys

import pytest

from gen.corpus import open_corpus, part_name, read_manifest, write_manifest
from gen.generation import identity
from gen.generation.corpus import generate
from gen.generation.identity import made_by, sources_sha256
from gen.recipe import read_recipe
from gen.support import sources
from gen.support.errors import ClusterError, CorpusError
from tests.paths import ROOT
from tests.same_corpora import assert_the_same_corpus
from tests.tampering import edit_manifest, edited, manifest_content

GENERATE = importlib.import_module("gen.generation.corpus")


def hashes(folder):
    return {row.name: row.sha256 for row in read_manifest(folder).parts}


def set_facts(path, **facts):
    """Change facts of an unfinished corpus or of a part."""
    if path.suffix == ".nc":
        with edited(path) as file:
            for name, value in facts.items():
                file.attrs[name] = value
        return
    edit_manifest(path, **facts)


def unfinished(folder):
    """The corpus as a killed call leaves it before its last steps."""
    nothing = {"records": 0, "signals": {}, "parts_sha256": "0" * 64, "parts": []}
    write_manifest(folder, manifest_content(folder) | {"complete": False} | nothing)
    (folder / "index.nc").unlink()
    return folder


@pytest.fixture
def begun(copied):
    """An unfinished corpus all of whose parts are there."""
    return unfinished(copied)


@pytest.mark.parametrize(("kept", "name"), [(1, "c"), (2, "c"), (1, "c.nc")])
def test_an_interrupted_corpus_is_refused_until_the_same_call_completes_it(
    recipe_file, whole, single, tmp_path, kept, name
):
    folder = tmp_path / (name if name == "c" else "c.nc.parts")

    def interrupted(*_counts):
        if len(hashes(folder)) >= kept:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        generate(recipe_file, tmp_path / name, progress=interrupted)
    with pytest.raises(CorpusError, match="is unfinished; run the raceway generate command"):
        open_corpus(tmp_path / name)
    assert hashes(folder).items() <= hashes(whole.path).items()
    before = {path: path.stat() for path in (folder / "parts").iterdir()}
    made_again = []
    again = generate(recipe_file, tmp_path / name, progress=lambda *_: made_again.extend(changed(before)))
    assert again.kept == kept
    assert made_again == []
    assert_the_same_corpus(tmp_path / name, whole if name == "c" else single)


def changed(before):
    return [path for path, stat in before.items() if path.exists() and path.stat().st_mtime_ns != stat.st_mtime_ns]


@pytest.mark.parametrize("step", [None, "corpus.finishing._join_parts", "generation.corpus.remove_parts"])
def test_files_of_the_user_beside_the_parts_of_a_file_stay(recipe_file, single, tmp_path, monkeypatch, step):
    target = tmp_path / "c.nc"
    notes = [tmp_path / "c.nc.parts" / name for name in ("notes.txt", "parts/notes.txt")]
    if step is None:
        shutil.copyfile(single.path, target)
        notes[1].parent.mkdir(parents=True)
    else:
        with monkeypatch.context() as patch:
            patch.setattr(f"gen.{step}", lambda *_, **_named: 1 / 0)
            with pytest.raises(ZeroDivisionError):
                generate(recipe_file, target)
    for note in notes:
        note.write_text("mine")
    assert generate(recipe_file, target).kept == 3
    assert target.read_bytes() == single.path.read_bytes()
    assert {path for path in (tmp_path / "c.nc.parts").rglob("*") if path.is_file()} == set(notes)


def flip(path):
    content = bytearray(path.read_bytes())
    content[-500] ^= 0xFF
    path.write_bytes(content)


def link(part):
    part.rename(part.parents[2] / "moved.nc")
    part.symlink_to(part.parents[2] / "moved.nc")


STRANGE = {
    "deleted": lambda part, _: part.unlink(),
    "altered": lambda part, _: flip(part),
    "cut short": lambda part, _: os.truncate(part, 5000),
    "a copy of another": lambda part, _: shutil.copyfile(part.with_name(part_name(11)), part),
    "of another seed": lambda part, other: shutil.copyfile(other / "parts" / part.name, part),
    "no netCDF file": lambda part, _: part.write_text("mine"),
    "of the format before": lambda part, _: set_facts(part, raceway_format=2),
    "of other sources": lambda part, _: set_facts(part, sources_sha256="0" * 64),
    "of another library": lambda part, _: set_facts(part, versions="{}"),
    "without facts": lambda part, _: set_facts(part, failures="["),
    "a link": lambda part, _: link(part),
}


def test_every_part_that_is_not_the_right_one_is_made_again_to_the_byte(write_recipe, tmp_path):
    recipe = write_recipe(
        tmp_path / "r.yaml", {"storage.records_per_part": 1, "corpus.rigs": 1, "corpus.specimens_per_rig": 6}
    )
    whole, other = generate(recipe, tmp_path / "whole"), generate(recipe, tmp_path / "other", seed=4, parts=range(4, 5))
    folder = unfinished(shutil.copytree(whole.path, tmp_path / "damaged"))
    for number, damage in enumerate(STRANGE.values()):
        damage(folder / "parts" / part_name(number), other.path)
    assert generate(recipe, folder).kept == whole.parts - len(STRANGE)
    assert_the_same_corpus(folder, whole)


def test_edited_sources_neither_complete_a_corpus_nor_keep_its_parts(recipe_file, begun, single, monkeypatch):
    monkeypatch.setattr(identity, "sources_sha256", lambda: "b" * 64)
    for corpus in (begun, single.path):
        with pytest.raises(CorpusError, match=r"was begun with sources [0-9a-f]{12}; sources bbbbbbbbbbbb is"):
            generate(recipe_file, corpus)


def test_a_worker_with_other_sources_is_refused_by_name_and_writes_nothing(recipe_file, tmp_path):
    recipe = read_recipe(recipe_file)
    other = made_by(recipe) | {"sources_sha256": "c" * 64}
    with pytest.raises(
        ClusterError, match=r"^worker .*: has sources [0-9a-f]{12}, and this process sources c{12}; install"
    ):
        GENERATE._write(recipe, tmp_path, other, 0)
    assert list(tmp_path.iterdir()) == []


def test_the_hash_of_the_sources_changes_with_every_file_that_makes_records(tmp_path, monkeypatch):
    package = shutil.copytree(ROOT / "gen", tmp_path / "gen", ignore=shutil.ignore_patterns("__pycache__"))
    hashes_seen = {sources_sha256()}
    monkeypatch.setattr(sources, "files", lambda _: package)
    monkeypatch.setattr(identity, "hash_sources", sources.hash_sources.__wrapped__)
    assert hashes_seen == {sources_sha256()}
    for name in (
        "life/growth.py",
        "physics/bearing.py",
        "physics/kernel/compiling.py",
        "scenarios/draw.py",
        "measurement/measure.py",
        "generation/labels.py",
    ):
        (package / name).write_text((package / name).read_text() + "\n# changed\n")
        hashes_seen.add(sources_sha256())
    assert len(hashes_seen) == 7
    (package / "corpus" / "validation.py").write_text("")
    assert sources_sha256() in hashes_seen


def test_every_module_that_a_part_is_made_with_is_in_the_hash_or_makes_no_numbers():
    loaded = "import gen.generation.make_part, sys; print(*(name for name in sys.modules if name.startswith('gen.')))"
    names = subprocess.run([sys.executable, "-c", loaded], capture_output=True, text=True, check=True).stdout.split()
    hashed = [name.removesuffix(".py").replace("/", ".") for name in identity._MAKES_RECORDS]
    others = {name for name in names if not any(name == of or name.startswith(f"{of}.") for of in hashed)}
    # reading, writing and refusing: nothing that a number of a record depends on
    assert {".".join(name.split(".")[:2]) for name in others} <= {"gen.corpus", "gen.generation", "gen.support"}


def test_a_second_call_keeps_every_part_whatever_comments_its_recipe_has(recipe_file, whole, single, copied, tmp_path):
    commented = tmp_path / "commented.yaml"
    commented.write_text("# the same\n\n" + recipe_file.read_text())
    file = shutil.copyfile(single.path, tmp_path / "c.nc")
    for corpus, first in ((copied, whole), (file, single)):
        for recipe in (commented, recipe_file):
            again = generate(recipe, corpus)
            assert (again.records, again.parts, again.kept) == (24, 3, 3)
        assert_the_same_corpus(corpus, first)
