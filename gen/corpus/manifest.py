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
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError

from gen.corpus.files import plain_file, sha256, stamp, write_text_durably
from gen.corpus.journal import (
    Count,
    FileRow,
    ListedPart,
    Strict,
    first_problem,
    listed,
    name_problem,
    part_number,
    read_journal,
)
from gen.corpus.part import PartRow
from gen.corpus.schema import FORMAT
from gen.corpus.signals import SignalCounts, summed
from gen.errors import CorpusError
from gen.limits import check_limit

Check = Literal["sha256", "size"]

INDEX_NAME = "corpus.nc"
_Texts = tuple[str, ...]


class Overrides(Strict):
    """Seed and number of records that replaced those of the recipe."""

    seed: int | None = None
    records: int | None = None


class Choice(Strict):
    """Choice of records and channels of another corpus, as ``raceway select`` was called."""

    records: Count
    """Number of records that were chosen from."""
    where: str | None = None
    split: str | None = None
    channels: _Texts | None = None


class Manifest(Strict):
    """Contents of ``manifest.json`` after its check; fields of simulated corpora are None in imported ones, and the other way round."""

    raceway_format: int
    complete: bool
    records: Count
    index: FileRow | None = None
    """``corpus.nc``; None until the corpus is complete."""
    parts_: Annotated[tuple[ListedPart, ...], Field(alias="parts")]
    title: str | None = None
    recipe: str | None = None
    recipe_sha256: str | None = None
    overrides: Overrides | None = None
    versions: Annotated[dict[str, str], Field(default_factory=dict)]
    failures: _Texts = ()
    importer: str | None = None
    recordings: Count | None = None
    skipped: _Texts = ()
    warnings: _Texts = ()
    selections: tuple[Choice, ...] = ()
    """Choices by which the records were taken from a larger corpus, the first one first."""
    scenarios: Literal["given"] | None = None
    """``given`` if the scenarios were not drawn from the recipe: each record is made again from the scenario that is stored with it."""

    @property
    def parts(self) -> list[PartRow]:
        """Rows of the parts, in the order of their records."""
        return [part.row for part in self.parts_]

    @property
    def signals(self) -> SignalCounts:
        """Counts of the records that cannot be used."""
        return summed(row.signals for row in self.parts)


def write_manifest(directory: Path, rows: Iterable[PartRow], *, complete: bool, **facts: Any) -> None:
    """Write ``manifest.json``: the finished parts, whether they are all, and ``facts`` such as recipe hash and versions.

    For a complete corpus the index must exist.
    """
    rows = list(rows)
    index = directory / INDEX_NAME
    content = {
        "raceway_format": FORMAT,
        "complete": complete,
        "records": sum(row.records for row in rows),
        "signals": summed(row.signals for row in rows)._asdict(),
        "index": {"bytes": stamp(index)[0], "sha256": sha256(index)} if complete else None,
        **facts,
        "parts": [listed(row) for row in rows],
    }
    write_text_durably(json.dumps(content, indent=1) + "\n", directory / "manifest.json")


def read_manifest(directory: Path) -> Manifest:
    """Read and check ``manifest.json``, and the journal if the corpus is unfinished; names that lead out of the corpus are refused.

    Raises
    ------
    CorpusError
        If it is missing, unreadable or of another format version, has a wrong or repeated name of a part, or its counts disagree.
    """
    path = directory / "manifest.json"
    if directory.is_file():
        raise CorpusError(f"{directory}: is a file; give the folder of a corpus, the one that holds manifest.json.")
    if not directory.is_dir():
        raise CorpusError(
            f"{directory}: no such folder; give the folder of a corpus, the one that holds manifest.json."
        )
    if not path.exists():
        raise CorpusError(f"{directory}: has no manifest.json, so it is not a corpus; make one with raceway generate.")
    plain_file(directory, path.name)
    try:
        check_limit("manifest_bytes", path.stat().st_size, f"{path}:", CorpusError)
        manifest = Manifest.model_validate_json(path.read_bytes())
    except OSError as error:
        raise CorpusError(f"{path}: cannot be read ({error.strerror or error}); copy the corpus again.") from None
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
    return manifest if manifest.complete else _with_journal(manifest, directory)


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
    check_limit("records", records, str(names and "the corpus holds"), CorpusError)
    return None


def file_problems(directory: Path, manifest: Manifest, check: Check) -> list[str]:
    """Missing and altered files, one sentence each; the index is included if the corpus is complete."""
    wanted = {f"parts/{row.name}": FileRow(bytes=row.bytes, sha256=row.sha256) for row in manifest.parts}
    if manifest.complete and manifest.index is not None:
        wanted[INDEX_NAME] = manifest.index
    judge, items = partial(_file_problem, directory, check), list(wanted.items())
    if check == "size":
        found = [judge(item) for item in items]
    else:
        threads = min(8, len(os.sched_getaffinity(0)))  # hashing releases the interpreter lock
        with ThreadPoolExecutor(threads) as pool:
            shares = pool.map(lambda first: [judge(item) for item in items[first::threads]], range(threads))
            found = [problem for share in shares for problem in share]
    return sorted(problem for problem in found if problem is not None)


def _file_problem(directory: Path, check: Check, item: tuple[str, FileRow]) -> str | None:
    name, row = item
    try:
        path = plain_file(directory, name)
    except CorpusError as error:
        return str(error)
    if path.stat().st_size == row.bytes and (check == "size" or sha256(path) == row.sha256):
        return None
    return f"{path}: is altered: its size or hash differs from the manifest; copy it again, or delete it and make the corpus again."


def part_paths(directory: Path | str, check: Check = "sha256") -> list[Path]:
    """Paths of all parts of a finished corpus, after a check of every file.

    ``check="size"`` compares sizes only, for corpora that take too long to hash.

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
    if problems:
        raise CorpusError(problems[0])
    return [directory / "parts" / row.name for row in manifest.parts]
