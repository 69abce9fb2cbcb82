"""The manifest of a corpus: its files with size and hash, and where its records come from.

A folder has it as ``manifest.json``; a single file has the same facts as global attributes. All checks of a folder start at
``manifest.json``: a part with another size or hash is refused before anything is read from it.
"""

import hashlib
import json
from collections import Counter
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from gen.corpus.disk import (
    INDEX_NAME,
    MANIFEST_NAME,
    RECIPE_NAME,
    has_whole_bytes,
    plain_file,
    sha256,
    stored_checksum,
    write_text_durably,
)
from gen.corpus.part import PartRow, part_number
from gen.corpus.publication import Publication
from gen.corpus.schema import FORMAT, RECIPE_TEXT
from gen.corpus.slices import RecordBlock, blocks_of, file_facts
from gen.corpus.unusable import Count, SignalCounts, sum_counts
from gen.support.errors import CorpusError
from gen.support.executor import cores
from gen.support.limits import check_limit

if TYPE_CHECKING:
    import xarray as xr

Check = Literal["sha256", "size"]

_HASH = "sha256"
"""Key of ``manifest.json`` with the hash of all else in it."""
_TEXTS = ("title", "recipe", "recipe_sha256", "sources_sha256", "parts_sha256", "importer")
"""Facts that are text; the others are stored as JSON in global attributes."""

COUNTED = ("raceway_format", "complete", "records", "signals", "publication", "parts_sha256", "parts")
"""Facts that :func:`facts_of_parts` computes or checks."""

_Sentences = tuple[str, ...]


class Strict(BaseModel):
    """Checked value of the manifest: no conversion of types, no unknown field, and no change."""

    model_config = ConfigDict(strict=True, frozen=True, extra="forbid")


class Overrides(Strict):
    """Seed and number of records that replaced those of the recipe."""

    seed: int | None = None
    records: int | None = None


class Manifest(Strict):
    """Facts of a corpus after their check; those of simulated corpora are None in imported ones, and the other way round."""

    raceway_format: int
    complete: bool = True
    records: Count
    signals: SignalCounts = SignalCounts()
    """Counts of the records that cannot be used."""
    title: str | None = None
    recipe: str | None = None
    """Name of the recipe."""
    recipe_sha256: str | None = None
    """Hash of the recipe that whole parts were generated from; None for a choice of records."""
    sources_sha256: str | None = None
    """Hash of the source files of Raceway that made the records."""
    parts_sha256: str | None = None
    """Hash over those of the parts; a single file keeps that of the parts that it was made of."""
    overrides: Overrides | None = None
    publication: Publication = Publication()
    versions: Annotated[dict[str, str], Field(default_factory=dict)]
    failures: _Sentences = ()
    importer: str | None = None
    basis: _Sentences = ()
    """Sentences on what labels and units of recordings rest on."""
    recordings: Count | None = None
    skipped: _Sentences = ()
    warnings: _Sentences = ()
    parts: tuple[PartRow, ...] = ()
    """Rows of the parts, in the order of their records; none of a single file."""

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        """Refuse names and counts that disagree."""
        names = [part.name for part in self.parts]
        if (repeated := next((name for name, count in Counter(names).items() if count > 1), None)) is not None:
            raise ValueError(f"it lists {repeated} more than once")
        if names and sum(part.records for part in self.parts) != self.records:
            raise ValueError(f"it counts {self.records} records, its parts {sum(part.records for part in self.parts)}")
        if names and sum_counts(row.signals for row in self.parts) != self.signals:
            raise ValueError("its number of unusable records is not the sum over its parts")
        for counts, records in ((self.signals, self.records), *((row.signals, row.records) for row in self.parts)):
            if sum(counts) > records:
                raise ValueError(f"it counts {sum(counts)} unusable records of {records}")
        return self


def facts_of_parts(rows: Iterable[PartRow], facts: Mapping[str, Any], *, complete: bool = True) -> dict[str, Any]:
    """Contents of the manifest: counts and parts, and further ``facts`` by the names of the fields of :class:`Manifest`.

    ``publication`` is a :class:`gen.corpus.Publication`; the others are values of JSON.
    """
    rows = list(rows)
    publication: Publication = facts.get("publication") or Publication()
    # a fact without content is left out
    known = {name: value for name, value in facts.items() if name not in COUNTED and value is not None}
    return {
        "raceway_format": FORMAT,
        "complete": complete,
        "records": sum(row.records for row in rows),
        "signals": sum_counts(row.signals for row in rows)._asdict(),
        **known,
        **({"publication": publication.stored} if publication.stored else {}),
        "parts_sha256": hashlib.sha256("\n".join(row.sha256 for row in rows).encode()).hexdigest(),
        "parts": [row._asdict() | {"signals": row.signals._asdict()} for row in rows],
    }


def write_manifest(directory: Path, content: Mapping[str, Any]) -> None:
    """Write ``manifest.json`` with the given contents."""
    write_text_durably(manifest_text(content), directory / MANIFEST_NAME)


def manifest_text(content: Mapping[str, Any]) -> str:
    """Contents of a manifest as JSON, with their hash."""
    return json.dumps({**content, _HASH: _hash_of(content)}, indent=1) + "\n"


def _hash_of(content: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def manifest_of(content: Mapping[str, Any] | bytes, place: Path) -> Manifest:
    """Manifest from its contents, or from its JSON with the hash of these.

    Raises
    ------
    CorpusError
        With the name of ``place``, if it is altered or of another format, or its counts disagree.
    """
    try:
        values: dict[str, Any] = json.loads(content) if isinstance(content, bytes) else dict(content)
        _check_format(values["raceway_format"], place)
        # the hash covers all other keys, so that an edited manifest is noticed
        if isinstance(content, bytes) and values.pop(_HASH, None) != _hash_of(values):
            raise CorpusError(_altered(place))
        manifest = Manifest.model_validate_json(json.dumps(values))
    except ValidationError as error:
        reason = first_problem(error)
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        reason = f"{type(error).__name__}: {error}"
    else:
        check_limit("records", manifest.records, f"{place}: counts", CorpusError)
        return manifest
    raise CorpusError(f"{place}: not the manifest of a corpus ({reason}); make or copy the corpus again.")


def _check_format(version: Any, place: Path) -> None:
    if version != FORMAT:
        raise CorpusError(
            f"{place}: corpus format {version}, this version of raceway reads format {FORMAT}; make the corpus again."
        )


def first_problem(error: ValidationError) -> str:
    """Place and reason of the first error."""
    item = error.errors(include_url=False, include_input=False)[0]
    place = ".".join(str(step) for step in item["loc"])
    reason = item["msg"].removeprefix("Value error, ")
    reason = reason[:1].lower() + reason[1:]
    return f"{place}: {reason}" if place else reason


def read_manifest(path: Path | str, check: Check = "sha256") -> Manifest:
    """Read and check the manifest of a corpus: ``manifest.json`` of a folder, the attributes of a single file.

    That of an unfinished corpus lists the parts that are in its folder. A single file is compared with its hash first.

    Raises
    ------
    CorpusError
        If it is missing, unreadable or of another format version, or its names or counts are wrong.
    """
    path = Path(path)
    if path.is_file():
        if check == "sha256":
            check_bytes(path)
        return _manifest_of_file(path)
    if not path.is_dir():
        raise CorpusError(
            f"{path}: no such folder or file; give a corpus: a folder with manifest.json, or one .nc file."
        )
    place = path / MANIFEST_NAME
    if not place.exists():
        raise CorpusError(f"{path}: has no manifest.json, so it is not a corpus; make one with raceway generate.")
    # a link could lead out of the folder
    plain_file(path, MANIFEST_NAME)
    try:
        # before memory is taken for it
        check_limit("manifest_bytes", place.stat().st_size, f"{place}:", CorpusError)
        content = place.read_bytes()
    except OSError as error:
        raise CorpusError(f"{place}: cannot be read ({error.strerror or error}); copy the corpus again.") from None
    manifest = manifest_of(content, place)
    if manifest.complete and not manifest.parts:
        raise CorpusError(f"{place}: is marked complete and lists no parts; do not trust this corpus.")
    return manifest if manifest.complete else _with_present_parts(manifest, path)


def _manifest_of_file(file: Path) -> Manifest:
    """Manifest from the global attributes of a file of records."""
    if file.name == INDEX_NAME:
        raise CorpusError(f"{file}: is the index of a corpus and holds no signals; give its folder, {file.parent}.")
    attributes, (records, _, _) = file_facts(file)
    _check_format(attributes.get("raceway_format"), file)
    content: dict[str, Any] = {"raceway_format": FORMAT, "records": records}
    try:
        content["signals"] = json.loads(attributes["signals"])
        # facts that are no text are JSON in an attribute
        for name in Manifest.model_fields.keys() & attributes.keys() - {"raceway_format"}:
            content[name] = attributes[name] if name in _TEXTS else json.loads(attributes[name])
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise CorpusError(f"{file}: has unreadable facts ({type(error).__name__}: {error}); copy it again.") from None
    return manifest_of(content, file)


def facts_as_attributes(content: Mapping[str, Any]) -> dict[str, str]:
    """Facts of a manifest as global attributes of a file."""
    left_out = ("raceway_format", "complete", "parts")
    return {
        name: value if name in _TEXTS else json.dumps(value) for name, value in content.items() if name not in left_out
    }


def _with_present_parts(manifest: Manifest, directory: Path) -> Manifest:
    """Manifest of an unfinished corpus with the whole parts in its folder, in the order of their records."""
    paths = {path: part_number(path.name) for path in (directory / "parts").glob("part-*.nc")}
    parts = sorted((number, path) for path, number in paths.items() if number is not None)
    rows = [row for _, path in parts if (row := row_of(path)) is not None]
    content = manifest.model_dump(mode="json") | facts_of_parts(rows, {}, complete=False)
    return manifest_of(content, directory / MANIFEST_NAME)


def row_of(path: Path) -> PartRow | None:
    """Row of a finished part, from its file; None if there is no whole file of this format."""
    if path.is_symlink() or not path.is_file() or not has_whole_bytes(path):
        return None
    try:
        manifest = _manifest_of_file(path)
    except CorpusError:
        return None
    return PartRow(path.name, manifest.records, path.stat().st_size, sha256(path), manifest.signals)


def recipe_text(path: Path | str) -> str | None:
    """Recipe of a corpus as YAML; None if it has none."""
    path = Path(path)
    if path.is_file():
        return file_facts(path)[0].get(RECIPE_TEXT)
    if not (path / RECIPE_NAME).exists():
        return None
    file = plain_file(path, RECIPE_NAME)
    check_limit("yaml_bytes", file.stat().st_size, f"{file}:", CorpusError)
    return file.read_text("utf-8", errors="replace")


def file_problems(path: Path, manifest: Manifest, check: Check) -> list[str]:
    """Missing and altered files of the folder of a corpus, one sentence each; none of a single file (see :func:`check_bytes`)."""
    if path.is_file():
        return []
    rows: list[PartRow | None] = [*manifest.parts, *([None] if manifest.complete else [])]
    if check == "size":
        each = [_file_problem(path, row, check) for row in rows]
    else:
        with ThreadPoolExecutor(min(8, cores())) as pool:  # hashing releases the interpreter lock
            each = list(pool.map(lambda row: _file_problem(path, row, check), rows, chunksize=16))
    return sorted(problem for problem in each if problem is not None)


def _file_problem(directory: Path, row: PartRow | None, check: Check) -> str | None:
    """Sentence about a part that is missing or not the listed one; without a row, about the index."""
    try:
        file = plain_file(directory, INDEX_NAME if row is None else f"parts/{row.name}")
        if row is None:
            # the index has its checksum at its end, parts have theirs in the manifest
            whole = check == "size" or has_whole_bytes(file)
        else:
            whole = file.stat().st_size == row.bytes and (check == "size" or sha256(file) == row.sha256)
    except CorpusError as error:
        return str(error)
    except OSError as error:
        return f"{directory}: cannot be read ({error.strerror or error}); copy it again."
    return None if whole else _altered(file)


def _altered(file: Path) -> str:
    return (
        f"{file}: is altered, cut off or rewritten by another program: its bytes do not have the hash that Raceway stored; copy it again, "
        f"or delete it and make the corpus again."
    )


def check_bytes(file: Path) -> None:
    """Refuse a single file that has been altered, before a library opens it."""
    try:
        ends, whole = stored_checksum(file) is not None, has_whole_bytes(file)
    except OSError as error:
        raise CorpusError(f"{file}: cannot be read ({error.strerror or error}); copy it again.") from None
    # most often another kind of file, which deserves another sentence
    if not ends:
        raise CorpusError(
            f"{file}: has no checksum of Raceway at its end: it is another file, such as a feature table, or was cut off or rewritten by "
            f"another program; give a corpus, or copy it again."
        )
    if not whole:
        raise CorpusError(_altered(file))


def corpus_files(path: Path | str, check: Check = "sha256") -> list[Path]:
    """Files with the signals of a finished corpus, in the order of the records: the parts of a folder, or the single file.

    Every file is compared with its hash first; ``check="size"`` compares sizes only, for corpora that take too long to hash.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, or one of its files is missing, altered or outside its folder.
    """
    path = Path(path)
    manifest = read_manifest(path, check)
    if not manifest.complete:
        raise CorpusError(f"{path}: is unfinished; run the raceway generate command that began it again.")
    problems = file_problems(path, manifest, check)
    if problems:
        raise CorpusError(problems[0])
    return [path] if path.is_file() else [path / "parts" / row.name for row in manifest.parts]


def record_blocks(corpus: "Path | str | xr.Dataset", check: Check = "sha256") -> list[RecordBlock]:
    """All records of a finished corpus, or of a Dataset in memory, in blocks that fit the memory of a task.

    It raises the errors of :func:`corpus_files`.
    """
    if not isinstance(corpus, Path | str):
        return blocks_of(corpus, corpus.sizes["record"])
    path = Path(corpus).absolute()
    files, manifest = corpus_files(path, check), read_manifest(path, check)
    counts = [row.records for row in manifest.parts] or [manifest.records]
    return [block for file, records in zip(files, counts, strict=True) for block in blocks_of(file, records)]
