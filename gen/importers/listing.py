"""Files that a mapping names, with the facts that their paths tell, and the recordings that they make up."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from pydantic import ValidationError

from gen.importers.mapping import MappingFile
from gen.importers.mapping_keys import Facts
from gen.importers.paths import fill_in, match_path
from gen.importers.recordings import name_of, some_files
from gen.importers.section import Section
from gen.support.errors import CorpusError
from gen.support.sentences import sentences


class File(NamedTuple):
    """A file of a recording: its path, its name in messages, its section, the groups of its path, and its facts before it is read."""

    path: Path
    name: str
    section: Section
    groups: dict[str, str]
    facts: Facts


def listed_recordings(source: Path, folder: Path, mapping: MappingFile) -> tuple[list[tuple[File, ...]], list[str]]:
    """Recordings in the order of the mapping, each of one file or of several in their order, and a sentence for each skipped file.

    Files with the same rig, specimen and ``recording`` are one recording, in the order of the sections and of the numbers in their paths.

    Raises
    ------
    CorpusError
        If a path leads out of the folder, or files that are to be joined differ in another key.
    """
    skipped: list[str] = []
    recordings: dict[tuple[str, ...], list[File]] = {}
    for file in _files(source, folder, mapping, skipped):
        facts = file.facts
        key = (file.name,) if facts.recording is None else ("", facts.rig, facts.specimen, facts.recording)
        known = recordings.setdefault(key, [])
        if facts.recording is None and known:
            skipped.append(f"{file.name}: is listed again by files[{file.section.position}]; skipped.")
            continue
        if known:
            _check_alike(source, known[0], file)
        if file.path in [other.path for other in known]:
            skipped.append(f"{file.name}: is listed again by files[{file.section.position}]; skipped.")
            continue
        known.append(file)
    return [tuple(sorted(files, key=_place)) for files in recordings.values()], skipped


def name_of_recording(files: tuple[File, ...]) -> str:
    """Name of a recording: its file, or the first and the last of several."""
    return files[0].name if len(files) == 1 else f"{files[0].name}..{files[-1].name.rpartition('/')[2]}"


def _files(source: Path, folder: Path, mapping: MappingFile, skipped: list[str]) -> Iterator[File]:
    looked_at = 0
    for section in mapping.sections:
        paths = _matches(source, folder, section, looked_at)
        looked_at += len(paths)
        if not paths:
            beside = f"beside {source.name}" if folder == source.parent else f"in {folder}"
            skipped.append(f"{section.pattern.text}: no file {beside} matches; skipped.")
        for path in paths:
            place = name_of(path, folder)
            groups = match_path(section.pattern, place, section.suits()) if section.pattern.groups else {}
            if groups is None:
                skipped.append(f"{place}: does not fit {section.pattern.text}{section.wanted()}; skipped.")
                continue
            try:
                facts = section.facts(groups)
            except ValidationError as error:
                skipped.append(f"{place}: {sentences(error, Facts)[0].removesuffix('.')}; skipped.")
                continue
            variable, column = section.keys.variable, section.keys.column
            parts = [
                place,
                *(str(part) for part in (variable and fill_in(variable, groups), column) if part is not None),
            ]
            yield File(path, ":".join(parts), section, groups, facts)


def _matches(source: Path, folder: Path, section: Section, looked_at: int) -> list[Path]:
    """Files that a pattern names, sorted; none may lie outside the folder of the recordings."""
    pattern, where = section.pattern, f"{source}: files[{section.position}].path: {section.pattern.text}"
    exact = folder / pattern.text
    try:
        plain = not pattern.groups and exact.is_file()
        files = [exact] if plain else filter(Path.is_file, folder.glob(pattern.wildcard))
        paths = some_files(files, looked_at, f"{where} and the patterns before match")
    except (ValueError, OSError) as error:
        message = f"{where} is not a pattern of file names ({error}); write it like data/*.mat."
        raise CorpusError(message) from None
    root = folder.resolve()
    for path in paths:
        if not path.resolve().is_relative_to(root):
            message = f"{where} matches a link that leads out of the folder; copy the files into it."
            raise CorpusError(message)
    return paths


def _check_alike(source: Path, first: File, other: File) -> None:
    """Refuse to join files with different facts or units."""
    facts = [
        {**dict(file.facts), "unit": ", ".join(str(sensor.scale) for sensor in file.section.sensors())}
        for file in (other, first)
    ]
    different = next((key for key in facts[0] if facts[0][key] != facts[1][key]), None)
    if different is not None:
        here, there = (each[different] for each in facts)
        message = (
            f"{source}: files[{other.section.position}] ({other.name}) belongs to recording {other.facts.recording} as "
            f"{first.name} does, and {different} is {here} here and {there} there; give each recording a name of its own."
        )
        raise CorpusError(message)


def _place(file: File) -> tuple[int, list[tuple[int, str]]]:
    """Key that sorts the files of a recording: by section, and with numbers by their value (2 before 10)."""
    parts = re.split(r"(\d{1,18})", file.name)
    return file.section.position, [(int(part), "") if number % 2 else (-1, part) for number, part in enumerate(parts)]
