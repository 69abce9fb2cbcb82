"""The manifest of a corpus: its files with size and hash, and whether it is complete.

All checks start at ``manifest.json``: a part or an index with another size or hash is refused before anything is read from it. The
manifest of an unfinished corpus is completed by the rows of the journal (:mod:`gen.corpus.journal`).
"""

import json
import os
from collections import Counter
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any, Literal

from pydantic import ValidationError

from gen.corpus.files import plain_file, sha256, stamp, write_text_durably
from gen.corpus.journal import (
    FileRow,
    first_problem,
    listed,
    name_problem,
    part_number,
    read_journal,
)
from gen.corpus.manifest_fields import Manifest
from gen.corpus.packed import is_packed, packed_contents
from gen.corpus.part import PartRow
from gen.corpus.publication import Publication
from gen.corpus.record_checks import record_problems
from gen.corpus.schema import FORMAT
from gen.corpus.signals import summed
from gen.errors import CorpusError
from gen.limits import check_limit

Check = Literal["sha256", "size"]

INDEX_NAME = "corpus.nc"
MANIFEST_NAME = "manifest.json"
EXTENSION_NAME = "extension.json"
"""Manifest of a corpus that is being extended: as it will be, with the finished parts; the other manifest is as it was."""


def manifest_content(
    rows: Iterable[PartRow], *, index: Path | None = None, publication: Publication | None = None, **facts: Any
) -> dict[str, Any]:
    """Content of ``manifest.json``; ``index`` is ``corpus.nc`` of a complete corpus."""
    rows = list(rows)
    content = {
        "raceway_format": FORMAT,
        "complete": index is not None,
        "records": sum(row.records for row in rows),
        "signals": summed(row.signals for row in rows)._asdict(),
        "index": None if index is None else listed_file(index),
        **facts,
        "parts": [listed(row) for row in rows],
    }
    return with_publication(content, publication or Publication())


def with_publication(content: dict[str, Any], publication: Publication) -> dict[str, Any]:
    """Content of ``manifest.json`` with another publication, which stands before the parts, and with one index."""
    kept = {key: value for key, value in content.items() if key not in ("next_index", "publication", "parts")}
    return kept | ({"publication": publication.stored} if publication.stored else {}) | {"parts": content["parts"]}


def listed_file(path: Path) -> dict[str, Any]:
    """Size and hash of a file as they are stored in JSON."""
    return {"bytes": stamp(path)[0], "sha256": sha256(path)}


def write_manifest(
    directory: Path, rows: Iterable[PartRow], *, complete: bool, name: str = MANIFEST_NAME, **facts: Any
) -> None:
    """Write ``manifest.json``: the finished parts, whether they are all, and ``facts`` such as recipe hash and versions.

    For a complete corpus the index must exist. ``publication`` is a :class:`gen.corpus.Publication`; other facts are values of JSON.
    ``name`` is that of the file.
    """
    content = manifest_content(rows, index=directory / INDEX_NAME if complete else None, **facts)
    write_content(directory, content, name)


def write_content(directory: Path, content: dict[str, Any], name: str = MANIFEST_NAME) -> None:
    """Write ``manifest.json`` with the given content."""
    write_text_durably(json.dumps(content, indent=1) + "\n", directory / name)


def read_manifest(directory: Path, name: str = MANIFEST_NAME) -> Manifest:
    """Read and check ``manifest.json`` of a folder or of a packed file, and the journal if the corpus is unfinished.

    Names that lead out of the corpus are refused. ``name`` is that of the file in a folder.

    Raises
    ------
    CorpusError
        If it is missing, unreadable or of another format version, has a wrong or repeated name of a part, or its counts disagree.
    """
    path = directory / name
    if directory.is_file():
        return _checked(_packed_manifest(directory), path)
    if not directory.is_dir():
        raise CorpusError(
            f"{directory}: no such folder; give the folder of a corpus, the one that holds manifest.json."
        )
    if not path.exists():
        raise CorpusError(f"{directory}: has no manifest.json, so it is not a corpus; make one with raceway generate.")
    plain_file(directory, path.name)
    try:
        check_limit("manifest_bytes", path.stat().st_size, f"{path}:", CorpusError)
        content = path.read_bytes()
    except OSError as error:
        raise CorpusError(f"{path}: cannot be read ({error.strerror or error}); copy the corpus again.") from None
    manifest = _checked(content, path)
    return manifest if manifest.complete else _with_journal(manifest, directory)


def _checked(content: bytes, path: Path) -> Manifest:
    """Manifest from its JSON; CorpusError if it is of another format version or its counts disagree."""
    try:
        manifest = Manifest.model_validate_json(content)
    except ValidationError as error:
        raise CorpusError(
            f"{path}: not a corpus manifest ({first_problem(error)}); generate or copy the corpus again."
        ) from None
    if manifest.raceway_format != FORMAT:
        found = manifest.raceway_format
        raise CorpusError(
            f"{path}: corpus format {found}, this version of raceway reads format {FORMAT}; make the corpus again."
        )
    problem = _inconsistency(manifest)
    if problem is not None:
        raise CorpusError(f"{path}: {problem}; do not trust this corpus.")
    return manifest


def _packed_manifest(file: Path) -> bytes:
    """Manifest in a packed file; CorpusError if the file is no packed file."""
    if not is_packed(file):
        raise CorpusError(not_a_corpus(file))
    packed = packed_contents(file)
    manifest = packed.files.get("manifest.json", b"")
    listed = {part.name: part.records for part in _checked(manifest, file / "manifest.json").parts}
    if listed != {name: part.records for name, part in packed.parts.items()}:
        raise CorpusError(f"{file}: its manifest lists other parts than it holds; do not trust this corpus.")
    return manifest


def not_a_corpus(file: Path) -> str:
    """Sentence about a file that is no packed corpus."""
    if file.name != INDEX_NAME:
        return f"{file}: is a file and no packed corpus; give the folder of a corpus, the one that holds manifest.json."
    if (file.parent / "manifest.json").is_file():
        return f"{file}: is one file of a corpus; give the folder of the corpus, {file.parent}."
    return (
        f"{file}: is the index of a corpus without its parts, so it holds no signals; copy the whole folder, "
        "or make one file of it with raceway pack."
    )


def _with_journal(manifest: Manifest, directory: Path) -> Manifest:
    """Manifest of an unfinished corpus with the parts of its journal, in the order of their records; of a part, the last row counts."""
    rows = {part.name: part for part in (*manifest.parts_, *read_journal(directory))}
    parts = tuple(sorted(rows.values(), key=lambda part: part_number(part.name)))
    records = sum(part.records for part in parts)
    check_limit("records", records, f"{directory}: holds", CorpusError)
    return manifest.model_copy(update={"parts_": parts, "records": records})


def _inconsistency(manifest: Manifest) -> str | None:
    names = [part.name for part in manifest.parts_]
    if (problem := next(filter(None, map(name_problem, names)), None)) is not None:
        return problem
    if (repeated := next((name for name, count in Counter(names).items() if count > 1), None)) is not None:
        return f"it lists {repeated} more than once"
    records = sum(part.records for part in manifest.parts_)
    if manifest.records != records:
        return f"it counts {manifest.records} records, its parts {records}"
    if manifest.complete and (manifest.index is None or not names):
        return "it is marked complete but has no hash of corpus.nc or no parts"
    if manifest.origins and sum(origin.parts for origin in manifest.origins) != len(names):
        return "its origins have another number of parts than it lists"
    check_limit("records", records, str(names and "the corpus holds"), CorpusError)
    return None


def file_problems(directory: Path, manifest: Manifest, check: Check) -> list[str]:
    """Missing and altered files, one sentence each; the index is included if the corpus is complete. Of a packed file: damaged records."""
    if directory.is_file():
        return record_problems(directory) if check == "sha256" else []
    wanted = {f"parts/{row.name}": [FileRow(bytes=row.bytes, sha256=row.sha256)] for row in manifest.parts}
    if manifest.complete:
        wanted[INDEX_NAME] = [row for row in (manifest.index, manifest.next_index) if row is not None]
    judge, items = partial(_file_problem, directory, check), list(wanted.items())
    if check == "size":
        found = [judge(item) for item in items]
    else:
        threads = min(8, len(os.sched_getaffinity(0)))  # hashing releases the interpreter lock
        with ThreadPoolExecutor(threads) as pool:
            shares = pool.map(lambda first: [judge(item) for item in items[first::threads]], range(threads))
            found = [problem for share in shares for problem in share]
    return sorted(problem for problem in found if problem is not None)


def _file_problem(directory: Path, check: Check, item: tuple[str, list[FileRow]]) -> str | None:
    """Sentence about a file that is missing, or is none of those that the manifest allows under its name."""
    name, rows = item
    try:
        path = plain_file(directory, name)
    except CorpusError as error:
        return str(error)
    size = path.stat().st_size
    if any(size == row.bytes and (check == "size" or sha256(path) == row.sha256) for row in rows):
        return None
    return f"{path}: is altered: its size or hash differs from the manifest; copy it again, or delete it and make the corpus again."


def part_paths(directory: Path | str, check: Check = "sha256") -> list[Path]:
    """Paths of all parts of a finished corpus, after a check of every file; through a packed file they lead to ranges of its records.

    ``check="size"`` compares sizes only, for corpora that take too long to hash. It checks no record of a packed file.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, or one of its files is missing, altered or outside its folder.
    """
    directory = Path(directory)
    manifest = read_manifest(directory)
    if not manifest.complete:
        raise CorpusError(f"{directory}: is unfinished; run the raceway generate command that began it again.")
    problems = file_problems(directory, manifest, check)
    if problems and (directory / EXTENSION_NAME).exists():
        raise CorpusError(
            f"{problems[0].split('; ')[0]}; run the raceway extend command that began an extension of it again."
        )
    if problems:
        raise CorpusError(problems[0])
    return [directory / "parts" / row.name for row in manifest.parts]
