"""Laws of the journal: a reader knows every part whose line is whole, and refuses a line that is not the row of a part."""

import json
import os

import pytest

from gen.corpus import JOURNAL_NAME, new_journal, read_manifest, validate_corpus, write_manifest
from gen.errors import CorpusError
from tests.corpora import SIZES, write_corpus


@pytest.fixture
def unfinished(tmp_path):
    """An unfinished corpus of three parts: the first in the manifest, the others in the journal, and the rows of all."""
    folder = tmp_path / "corpus"
    write_corpus(folder)
    rows = read_manifest(folder).parts
    write_manifest(folder, rows[:1], complete=False)
    with new_journal(folder) as append:
        append(rows[2])
        append(rows[1])
    return folder, rows


def lines(folder):
    return (folder / JOURNAL_NAME).read_bytes().splitlines(keepends=True)


def test_the_parts_of_manifest_and_journal_are_in_the_order_of_their_records(unfinished):
    folder, rows = unfinished
    manifest = read_manifest(folder)
    assert manifest.parts == rows
    assert (manifest.records, manifest.complete) == (sum(SIZES), False)
    assert validate_corpus(folder) == [
        f"{folder}: is unfinished; run the raceway generate command that began it again."
    ]


def test_a_journal_cut_at_any_byte_lists_the_parts_whose_lines_are_whole(unfinished):
    folder, rows = unfinished
    whole = (folder / JOURNAL_NAME).read_bytes()
    for size in range(len(whole)):
        (folder / JOURNAL_NAME).write_bytes(whole[:size])
        known = {row.name for row in read_manifest(folder).parts}
        assert known == {rows[0].name, *[row.name for row in (rows[2], rows[1])[: whole[:size].count(b"\n")]]}


def test_of_several_rows_of_a_part_the_last_counts(unfinished):
    folder, rows = unfinished
    first = json.loads(lines(folder)[0])
    with (folder / JOURNAL_NAME).open("a") as journal:
        journal.write(json.dumps(first | {"name": rows[0].name, "bytes": 5}) + "\n")
    assert read_manifest(folder).parts == [rows[2]._replace(name=rows[0].name, bytes=5), *rows[1:]]


def test_the_journal_of_a_complete_corpus_is_ignored(unfinished):
    folder, rows = unfinished
    (folder / JOURNAL_NAME).write_text("damaged\n")
    write_manifest(folder, rows, complete=True)
    assert validate_corpus(folder) == []


BROKEN = {
    "no JSON": lambda _: b"records",
    "an empty line": lambda _: b"",
    "not an object": lambda _: b"[]",
    "a name that leads out of the corpus": lambda row: json.dumps(row | {"name": "../part-00001.nc"}).encode(),
    "no name": lambda row: json.dumps({key: row[key] for key in row if key != "name"}).encode(),
    "a negative size": lambda row: json.dumps(row | {"bytes": -1}).encode(),
    "a size that is not whole": lambda row: json.dumps(row | {"bytes": 1.5}).encode(),
    "more records than any number": lambda row: json.dumps(row | {"records": 2**64}).encode(),
    "no hash": lambda row: json.dumps(row | {"sha256": "x" * 64}).encode(),
    "signals that are no counts": lambda row: json.dumps(row | {"signals": [0, 0, 0, 0]}).encode(),
    "bytes that are no text": lambda _: b"\xff\xfe{}",
}


@pytest.mark.parametrize("broken", BROKEN)
def test_a_line_that_is_not_the_row_of_a_part_is_refused(unfinished, broken):
    folder, _ = unfinished
    one, other = lines(folder)
    (folder / JOURNAL_NAME).write_bytes(one + BROKEN[broken](json.loads(other)) + b"\n" + other)
    with pytest.raises(CorpusError) as refused:
        read_manifest(folder)
    said = str(refused.value)
    assert said.startswith(f"{folder / JOURNAL_NAME}: line 2 is not the row of a part (")
    assert said.endswith("); delete this file, and its parts are made again.")
    assert "\n" not in said


def test_more_records_than_the_limit_are_refused(unfinished):
    folder, _ = unfinished
    row = json.loads(lines(folder)[0])
    with (folder / JOURNAL_NAME).open("a") as journal:
        journal.write(json.dumps(row | {"records": 10**12}) + "\n")
    with pytest.raises(CorpusError, match=r"holds 10000000000\d\d records, and the limit is 10000000"):
        read_manifest(folder)


def test_a_journal_larger_than_the_limit_is_refused_before_it_is_read(unfinished, monkeypatch):
    folder, _ = unfinished
    size = (folder / "manifest.json").stat().st_size
    (folder / JOURNAL_NAME).write_bytes(b" " * (size + 1))
    monkeypatch.setenv("RACEWAY_LIMITS", f"manifest_bytes={size}")
    with pytest.raises(CorpusError, match=rf"parts.jsonl: {size + 1} bytes, and the limit is {size}"):
        read_manifest(folder)


@pytest.mark.parametrize("kind", ["a link out of the corpus", "a pipe", "a folder"])
def test_a_journal_that_is_not_a_plain_file_is_neither_read_nor_written(unfinished, tmp_path, kind):
    folder, _ = unfinished
    path, mine = folder / JOURNAL_NAME, tmp_path / "mine.txt"
    path.unlink()
    mine.write_text("mine")
    {
        "a link out of the corpus": lambda: path.symlink_to(mine),
        "a pipe": lambda: os.mkfifo(path),
        "a folder": path.mkdir,
    }[kind]()
    with pytest.raises(CorpusError, match=r"is not a plain file|leads out of the corpus"):
        read_manifest(folder)
    with pytest.raises(CorpusError, match="could not be written"), new_journal(folder):
        pass
    assert mine.read_text() == "mine"
