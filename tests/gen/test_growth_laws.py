"""Laws of growth: a part costs the same in a large corpus as in a small one."""

import importlib
from pathlib import Path

import h5py
import pytest

from gen.corpus import JOURNAL_NAME, PartRow, open_corpus, part_name, read_manifest, write_index, write_manifest
from gen.errors import CorpusError
from gen.generation import generate
from gen.part_task import Outcome
from tests.corpora import write_corpus

GENERATE = importlib.import_module("gen.generation")


def written():
    """Number of bytes that this process has written to files, pipes and sockets."""
    return int(dict(line.split(": ") for line in Path("/proc/self/io").read_text().splitlines())["wchar"])


def interrupted_after(parts, shown):
    """Stand-in for the making of parts: rows without files, then an interruption."""

    def made(*_args):
        for number in range(parts):
            yield number, Outcome(PartRow(part_name(number), 1, 10**8, "0" * 64), kept=False, failures=())
            shown.append(written())
        raise KeyboardInterrupt

    return made


def test_each_of_2000_parts_adds_as_many_bytes_as_the_first(write_recipe, tmp_path, monkeypatch):
    shown = []
    monkeypatch.setattr(GENERATE, "_made", interrupted_after(2000, shown))
    recipe = write_recipe(tmp_path / "many.yaml", {"corpus.records_per_part": 1, "corpus.rigs": 300})
    with pytest.raises(KeyboardInterrupt):
        generate(recipe, tmp_path / "corpus")
    journal = (tmp_path / "corpus" / JOURNAL_NAME).stat().st_size
    assert shown[-1] - shown[0] <= 1.01 * journal
    assert journal <= 300 * 2000
    assert len(read_manifest(tmp_path / "corpus").parts) == 2000


@pytest.mark.parametrize("n_parts", [2, 9])
def test_the_index_opens_each_part_twice(tmp_path, monkeypatch, n_parts):
    """Once for the width of its texts, once for its values."""
    write_corpus(tmp_path, [2] * n_parts)
    rows = read_manifest(tmp_path).parts
    opened = []

    class Counted(h5py.File):
        def __init__(self, path, *args, **options):
            opened.append(Path(path).name)
            super().__init__(path, *args, **options)

    monkeypatch.setattr("gen.corpus.index.h5py.File", Counted)
    write_index(tmp_path, rows)
    assert [opened.count(row.name) for row in rows[1:]] == [2] * (n_parts - 1)


@pytest.mark.parametrize("held", [1, 10**9])
def test_the_index_has_the_same_bytes_however_many_parts_are_copied_together(tmp_path, monkeypatch, held):
    write_corpus(tmp_path, [3, 1, 4, 1, 5])
    before = (tmp_path / "corpus.nc").read_bytes()
    monkeypatch.setattr("gen.corpus.index._COPIED_BYTES", held)
    write_index(tmp_path, read_manifest(tmp_path).parts)
    assert (tmp_path / "corpus.nc").read_bytes() == before


def test_parts_beyond_the_hundred_thousandth_are_in_the_order_of_their_records(tmp_path):
    names = ["part-99999.nc", "part-100000.nc"]
    rows = [PartRow(name, 1, 1, "0" * 64) for name in names]
    write_manifest(tmp_path, reversed(rows), complete=False)
    assert [row.name for row in read_manifest(tmp_path).parts] == names


ALTERED = {
    "missing": lambda path: path.unlink(),
    "shorter": lambda path: path.write_bytes(path.read_bytes()[:-1]),
    "altered": lambda path: path.write_bytes(path.read_bytes()[:-100] + b"x" + path.read_bytes()[-99:]),
}


@pytest.mark.parametrize("damage", ALTERED)
def test_a_part_that_the_journal_lists_but_that_is_not_its_file_is_made_again(
    write_recipe, tmp_path, monkeypatch, damage
):
    recipe = write_recipe(tmp_path / "r.yaml")
    whole = generate(recipe, tmp_path / "whole").directory
    monkeypatch.setattr(GENERATE, "finished", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        generate(recipe, tmp_path / "c")
    monkeypatch.undo()
    ALTERED[damage](tmp_path / "c" / "parts" / part_name(1))
    with pytest.raises(CorpusError, match="unfinished"):
        open_corpus(tmp_path / "c")
    assert generate(recipe, tmp_path / "c").kept == 2
    for path in whole.rglob("*.*"):
        assert (tmp_path / "c" / path.relative_to(whole)).read_bytes() == path.read_bytes()
    assert {path.name for path in (tmp_path / "c").iterdir()} == {path.name for path in whole.iterdir()}


def test_rows_of_other_versions_do_not_stay_in_the_journal(write_recipe, tmp_path, monkeypatch):
    recipe = write_recipe(tmp_path / "r.yaml")
    monkeypatch.setattr(GENERATE, "library_versions", lambda: {"numpy": "1.0"})
    monkeypatch.setattr(GENERATE, "finished", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        generate(recipe, tmp_path / "c")
    assert len(read_manifest(tmp_path / "c").parts) == 3
    monkeypatch.undo()
    assert generate(recipe, tmp_path / "c").kept == 0
