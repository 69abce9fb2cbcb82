"""The manifest of a corpus: its files with size and hash, and where its records come from.

A folder has it as ``manifest.json``; a single file has the same facts as global attributes. All checks of a folder start at
``manifest.json``: a part with another size or hash is refused before anything is read from it.
"""

import hashlib
import json
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_serializer, model_validator

from gen.corpus.disk import (
    INDEX_NAME,
    MANIFEST_NAME,
    RECIPE_NAME,
    has_whole_bytes,
    plain_file,
    reading,
    sha256,
    write_text_durably,
)
from gen.corpus.part import PartRow, part_number
from gen.corpus.schema import FORMAT, RECIPE_TEXT
from gen.corpus.trust import file_facts
from gen.corpus.unusable import Count, SignalCounts, sum_counts
from gen.support.errors import CorpusError
from gen.support.executor import cores
from gen.support.limits import check_limit

Check = Literal["sha256", "size"]

_HASH = "sha256"
"""Key of ``manifest.json`` with the hash of all else in it."""
_TEXTS = ("title", "recipe", "recipe_sha256", "sources_sha256", "parts_sha256", "importer")
"""Facts that are text; the others are stored as JSON in global attributes."""

COUNTED = ("raceway_format", "complete", "records", "signals", "parts_sha256", "parts")
"""Facts that :func:`manifest_of_parts` computes."""

_Sentences = tuple[str, ...]


class Strict(BaseModel):
    """Checked value of the manifest: no conversion of types, no unknown field, and no change."""

    model_config = ConfigDict(strict=True, frozen=True, extra="forbid")


class Manifest(Strict):
    """Facts of a corpus after their check; those of simulated corpora are None in imported ones, and the other way round."""

    raceway_format: int = FORMAT
    complete: bool = True
    records: Count = 0
    signals: Annotated[SignalCounts, Field(default_factory=dict)]
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
    overrides: dict[Literal["seed", "records"], int | None] | None = None
    """Seed and number of records that replaced those of the recipe."""
    publication: Annotated[dict[str, Any], Field(default_factory=dict)]
    """Licence, creators and other facts of publication (`raceway.publish`)."""
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

    @property
    def content(self) -> dict[str, Any]:
        """Facts in values of JSON; one without content is left out."""
        return {name: value for name, value in self.model_dump(mode="json").items() if value not in (None, [], {})}

    @field_serializer("parts")
    def _rows(self, rows: tuple[PartRow, ...]) -> list[dict[str, Any]]:
        return [row._asdict() for row in rows]

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        """Refuse names and counts that disagree."""
        rows = self.parts or (self,)
        if len({row.name for row in self.parts}) < len(self.parts):
            raise ValueError("it lists a part more than once")
        counts = sum(row.records for row in rows), sum_counts(row.signals for row in rows)
        if counts != (self.records, self.signals) or any(sum(row.signals.values()) > row.records for row in rows):
            raise ValueError("its counts are not those of its parts")
        return self


def manifest_of_parts(rows: Iterable[PartRow], facts: Mapping[str, Any], *, complete: bool = True) -> Manifest:
    """Manifest of parts, with further ``facts`` by the names of its fields, in values of JSON; one that is None is left out."""
    rows = tuple(rows)
    further = {name: value for name, value in facts.items() if name not in COUNTED and value is not None}
    return manifest_of(further, Path(MANIFEST_NAME)).model_copy(
        update={
            "complete": complete,
            "records": sum(row.records for row in rows),
            "signals": sum_counts(row.signals for row in rows),
            "parts_sha256": hashlib.sha256("\n".join(row.sha256 for row in rows).encode()).hexdigest(),
            "parts": rows,
        }
    )


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
        if isinstance(content, bytes):
            _check_format(values["raceway_format"], place)
            # the hash covers all other keys, so that an edited manifest is noticed
            if values.pop(_HASH, None) != _hash_of(values):
                raise CorpusError(_altered(place, "in it"))
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
    with reading(path):
        return _read_manifest(path, check)


def _read_manifest(path: Path, check: Check) -> Manifest:
    if path.is_file():
        # before a library opens it
        if check == "sha256" and not has_whole_bytes(path):
            raise CorpusError(_altered(path) if path.suffix == ".nc" else _other_form(path))
        return _manifest_of_file(path)
    if not path.is_dir():
        # a single file is generated from parts beside it
        if path.with_name(f"{path.name}.parts").is_dir():
            raise CorpusError(unfinished(path))
        raise CorpusError(
            f"{path}: no such folder or file; give a corpus: a folder with manifest.json, or one .nc file."
        )
    if not (path / MANIFEST_NAME).exists():
        if any(path.glob("data/*.parquet")):
            raise CorpusError(_other_form(path))
        raise CorpusError(f"{path}: has no manifest.json, so it is not a corpus; make one with raceway generate.")
    place = plain_file(path, MANIFEST_NAME)
    # before memory is taken for it
    check_limit("manifest_bytes", place.stat().st_size, f"{place}:", CorpusError)
    manifest = manifest_of(place.read_bytes(), place)
    if manifest.complete and not manifest.parts:
        raise CorpusError(f"{place}: is marked complete and lists no parts; do not trust this corpus.")
    return manifest if manifest.complete else _with_present_parts(manifest, path)


def _manifest_of_file(file: Path) -> Manifest:
    """Manifest from the global attributes of a file of records."""
    if file.name == INDEX_NAME:
        raise CorpusError(f"{file}: is the index of a corpus and holds no signals; give its folder, {file.parent}.")
    attributes, records = file_facts(file)
    _check_format(attributes.get("raceway_format"), file)
    names = Manifest.model_fields.keys() & attributes.keys() - {"raceway_format"}
    try:
        # facts that are no text are JSON in an attribute
        content = {name: attributes[name] if name in _TEXTS else json.loads(attributes[name]) for name in names}
    except (ValueError, TypeError, RecursionError) as error:
        raise CorpusError(f"{file}: has unreadable facts ({type(error).__name__}: {error}); copy it again.") from None
    return manifest_of({"raceway_format": FORMAT, "records": records, **content}, file)


def facts_as_attributes(content: Mapping[str, Any], recipe: str | None = None) -> dict[str, str]:
    """Facts of a manifest, and the recipe of all records, as global attributes of a file."""
    left_out = ("raceway_format", "complete", "parts")
    texts = {} if recipe is None else {RECIPE_TEXT: recipe}
    return texts | {
        name: value if name in _TEXTS else json.dumps(value) for name, value in content.items() if name not in left_out
    }


def _with_present_parts(manifest: Manifest, directory: Path) -> Manifest:
    """Manifest of an unfinished corpus with the whole parts in its folder, in the order of their records."""
    paths = {path: part_number(path.name) for path in (directory / "parts").glob("part-*.nc")}
    parts = sorted((number, path) for path, number in paths.items() if number is not None)
    rows = [row for _, path in parts if (row := row_of(path)) is not None]
    return manifest_of_parts(rows, manifest.content, complete=False)


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
    with reading(path / RECIPE_NAME):
        if path.is_file():
            return file_facts(path)[0].get(RECIPE_TEXT)
        if not (path / RECIPE_NAME).exists():
            return None
        file = plain_file(path, RECIPE_NAME)
        check_limit("yaml_bytes", file.stat().st_size, f"{file}:", CorpusError)
        return file.read_text("utf-8", errors="replace")


def file_problems(path: Path, manifest: Manifest, check: Check) -> list[str]:
    """Missing and altered files of the folder of a corpus, one sentence each; :func:`read_manifest` compares a single file."""
    if path.is_file():
        return []
    rows: list[PartRow | None] = [*manifest.parts, *([None] if manifest.complete else [])]
    with ThreadPoolExecutor(min(8, cores())) as pool:  # hashing releases the interpreter lock
        each = pool.map(lambda row: _file_problem(path, row, check), rows)
        return sorted(problem for problem in each if problem is not None)


def _file_problem(directory: Path, row: PartRow | None, check: Check) -> str | None:
    """Sentence about a part that is missing or not the listed one; without a row, about the index."""
    try:
        file = plain_file(directory, INDEX_NAME if row is None else f"parts/{row.name}")
        whole = row is None or file.stat().st_size == row.bytes
        if check == "sha256" and whole:
            # the index has its checksum at its end, parts have theirs in the manifest
            whole = has_whole_bytes(file) if row is None else sha256(file) == row.sha256
    except CorpusError as error:
        return str(error)
    return None if whole else _altered(file) if row is None else _altered(file, f"in {MANIFEST_NAME} for this part")


def _altered(file: Path, place: str = "at its end") -> str:
    return (
        f"{file}: its bytes do not have the hash that Raceway stored {place}: it is altered, cut off or rewritten by another "
        f"program, or is another file, such as a feature table; give a corpus, copy it again, or make it again."
    )


def _other_form(path: Path) -> str:
    return (
        f"{path}: is no corpus, which is a folder with manifest.json or one .nc file; a copy in another form, such as .parquet, holds no "
        "hashes to check, so compare the SHA-256 of its files with those that its maker states."
    )


def unfinished(path: Path) -> str:
    """Sentence about a corpus that lacks parts."""
    return f"{path}: is unfinished; run the raceway generate command that began it again."


def finished(path: Path | str, check: Check = "sha256") -> Manifest:
    """Manifest of a finished corpus.

    Every file is compared with its hash first; ``check="size"`` compares sizes only, for corpora that take too long to hash.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, or one of its files is missing, altered or outside its folder.
    """
    path = Path(path)
    manifest = read_manifest(path, check)
    if not manifest.complete:
        raise CorpusError(unfinished(path))
    for problem in file_problems(path, manifest, check):
        raise CorpusError(problem)
    return manifest


def corpus_files(path: Path | str, check: Check = "sha256") -> list[Path]:
    """Files with the signals of a finished corpus, in the order of the records: the parts of a folder, or the single file.

    It raises the errors of :func:`finished`.
    """
    rows = finished(path, check).parts
    return [Path(path) / "parts" / row.name for row in rows] or [Path(path)]
