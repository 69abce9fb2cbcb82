"""Mapping files of earlier versions with a plain list of files: they are read for one more release.

A path in it can have ``*`` and ``?`` in the names of folders and files. Groups, tables and readings are no longer read; a script in the
repository turns such a file into a table of labels.
"""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from gen.importers.label_tables import Row, keys_of_yaml, labels_of
from gen.importers.labels import Labels
from gen.importers.recordings import name_of, some_files
from gen.support.errors import CorpusError

_GROUP = re.compile(r"\{[a-z][a-z0-9_]*\}")
_AS_WRITTEN = ("title", "origin", "channel", "bearing", "channels")


def read_mapping(path: Path, folder: Path, common: Mapping[str, Any]) -> list[tuple[str, Labels]]:
    """Labels of the files that a mapping file lists; ``folder`` is that of the recordings.

    Raises
    ------
    CorpusError
        If it lists no files, has wrong keys or values, or is in the language of earlier versions.
    """
    shared = keys_of_yaml(path)
    files = shared.pop("files", None)
    if not isinstance(files, list) or not files or not all(isinstance(keys, dict) for keys in files):
        raise CorpusError(f"{path}: has no list of files; give a table of labels, such as {path.with_suffix('.csv')}.")
    for number, keys in enumerate([shared, *files]):
        for key, value in keys.items():
            if _is_of_the_language(str(key), value):
                place = f"files[{number - 1}].{key}" if number else key
                raise CorpusError(
                    f"{path}: {place}: is in the language of mapping files, which is no longer read; in the repository of Raceway, "
                    f"python tools/mapping_to_labels.py {path} turns it into a table of labels."
                )
    rows: list[Row] = []
    for number, keys in enumerate(files):
        place, pattern = f"{path}: files[{number}]", keys.get("path") or shared.get("path")
        rows += [Row(place, ".", given) for given in _matches(keys, pattern, folder, len(rows), place)]
    return labels_of(rows, shared, common, path)


def _is_of_the_language(key: str, value: Any) -> bool:
    if key in _AS_WRITTEN:
        return False
    return isinstance(value, dict) or (
        isinstance(value, str) and bool(_GROUP.search(value) or (key == "path" and "**" in value))
    )


def _matches(keys: dict[str, Any], pattern: Any, folder: Path, already: int, place: str) -> Iterator[dict[str, Any]]:
    """Keys of each file that a path with ``*`` or ``?`` names, or those of the one file."""
    plain = (
        not isinstance(pattern, str) or not set(pattern) & {"*", "?"} or ".." in pattern or Path(pattern).is_absolute()
    )
    files = (
        []
        if plain
        else some_files(folder.glob(pattern), already, f"{place}.path: {pattern} and the paths before match")
    )
    yield from ({**keys, "path": name_of(file, folder)} for file in files)
    if not files:
        yield keys
