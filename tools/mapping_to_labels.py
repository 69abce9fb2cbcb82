"""Turn a mapping file of an earlier version into a table of labels; it goes after one release.

    python tools/mapping_to_labels.py MAPPING.yaml [--folder DIR]

writes ``MAPPING_labels.csv`` and, with the keys that all rows share, ``MAPPING_labels.yaml`` beside the mapping file, for ``raceway import
generic MAPPING_labels.csv``. Groups, tables and readings are resolved for the files that are there now; ``DIR`` is their folder, by default
that of the mapping file.
"""

import argparse
import csv
import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML

from gen.importers.files import UnusableError
from gen.importers.matlab import read_number
from gen.importers.recordings import name_of
from gen.support.errors import CorpusError, RacewayError
from gen.support.yaml_files import read_yaml

SPALL = ("width_mm", "depth_um", "angle_deg", "n_spalls")
NUMBERS = ("shaft_rpm", "sample_rate_hz", "load_n", *SPALL)
FACTS = ("bearing", "fault", "specimen", "rig", "recording", *NUMBERS)
ALWAYS_COLUMNS = ("path", "fault", "specimen")
GROUP = re.compile(r"\{([a-z][a-z0-9_]*)\}")
TOKEN = re.compile(r"(\*\*/|\*\*|\*|\?|\[[^]]+\]|\{[a-z][a-z0-9_]*\})")
WILDCARDS = {"**/": "(?:.*/)?", "**": ".*", "*": "[^/]*?", "?": "[^/]"}


def is_reading(value: Any) -> bool:
    """Whether a value is a number in the file, or a factor of one in the path."""
    return isinstance(value, dict) and bool(value.keys() & {"variable", "times"})


def is_of_the_path(value: Any) -> bool:
    """Whether a value is a table or a factor, which need a text in the path."""
    return isinstance(value, dict) and "variable" not in value


def filled(value: Any, groups: dict[str, str]) -> Any:
    """Text with the groups of a path in the place of their names in braces."""
    return GROUP.sub(lambda match: groups.get(match[1], match[0]), value) if isinstance(value, str) else value


def expression(pattern: str, keys: dict[str, Any]) -> re.Pattern[str]:
    """Regular expression of a path; earlier groups are as short as possible."""
    text = ""
    for token in TOKEN.split(pattern):
        group = GROUP.fullmatch(token)
        table = keys.get(group[1]) if group else None
        if group is None:
            text += WILDCARDS.get(token, "[^/]" if token.startswith("[") else re.escape(token))
        elif isinstance(table, dict) and not is_reading(table):
            text += f"(?P<{group[1]}>{'|'.join(re.escape(str(one)) for one in sorted(map(str, table), key=len))})"
        else:
            text += f"(?P<{group[1]}>{r'-?[0-9]+?(?:[.][0-9]*?)??' if group[1] in NUMBERS else '[^/]+?'})"
    return re.compile(text)


def files_of(folder: Path, pattern: str) -> list[Path]:
    """Files that a path with wildcards and groups names, sorted."""
    if Path(pattern).is_absolute() or ".." in Path(pattern).parts:
        raise CorpusError(f"{pattern} leads out of the folder of the recordings.")
    if (folder / pattern).is_file():
        return [folder / pattern]
    return sorted(path for path in folder.glob(GROUP.sub("*", pattern)) if path.is_file())


def rows_of(folder: Path, common: dict[str, Any], own: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Keys of each file of a section; numbers that were read in the file are marked by their type."""
    pattern = str(own.get("path") or common.get("path"))
    shared = {key: value for key, value in common.items() if f"{{{key}}}" not in pattern or is_of_the_path(value)}
    keys = {**shared, **own}
    paths = files_of(folder, pattern)
    if not paths:
        print(f"{pattern}: names no file; left out.", file=sys.stderr)
    for path in paths:
        place = name_of(path, folder)
        match = expression(pattern, keys).fullmatch(place) if GROUP.search(pattern) else re.match("", "")
        if match is None:
            print(f"{place}: does not fit {pattern}; left out.", file=sys.stderr)
            continue
        groups = match.groupdict()
        row: dict[str, Any] = {key: filled(value, groups) for key, value in keys.items()} | {"path": place}
        try:
            row |= {
                key: fact(path, key, keys.get(key), groups)
                for key in FACTS
                if key in groups or is_reading(keys.get(key))
            }
        except UnusableError as reason:
            print(f"{place}: {reason}; left out.", file=sys.stderr)
            continue
        if "channels" in row:
            row["channels"] = [{key: filled(value, groups) for key, value in one.items()} for one in row["channels"]]
        if "fault" in groups and row["fault"] in ("healthy", "cage", "unknown"):
            row = {key: value for key, value in row.items() if key not in SPALL}
        yield {key: value for key, value in row.items() if value is not None}


class InFile(float):
    """A number that was read in the file."""


def fact(path: Path, key: str, given: Any, groups: dict[str, str]) -> Any:
    """Value of a key that the path or the file tells."""
    if is_reading(given):
        times = given.get("times", 1.0)
        return float(groups[key]) * times if key in groups else InFile(read_number(path, given["variable"]) * times)
    if isinstance(given, dict):
        return {str(text): value for text, value in given.items()}[groups[key]]
    return float(groups[key]) if key in NUMBERS else groups[key]


def recordings_of(rows: list[tuple[int, dict[str, Any]]]) -> list[dict[str, Any]]:
    """Rows in the order of their recordings; files of one recording by their numbers (2 before 10), with the numbers of the first."""
    recordings: dict[Any, list[tuple[int, dict[str, Any]]]] = {}
    for number, row in rows:
        key = (row.get("rig"), row["specimen"], row["recording"]) if "recording" in row else (len(recordings),)
        recordings.setdefault(key, []).append((number, row))
    ordered = []
    for files in recordings.values():
        files.sort(
            key=lambda one: (
                one[0],
                [int(part) if part.isdecimal() else part for part in re.split(r"(\d+)", one[1]["path"])],
            )
        )
        first = files[0][1]
        ordered += [
            row | {key: first[key] for key, value in row.items() if isinstance(value, InFile)} for _, row in files
        ]
    return ordered


def cell(value: Any) -> str:
    """Text of a value in a table; a number with three decimals gets a fourth, so that its mark cannot be one between thousands."""
    if isinstance(value, dict):
        return ",".join(f"{key}={one}" for key, one in value.items())
    if isinstance(value, list):
        return json.dumps(value)
    return re.sub(r"^(-?\d{1,3}\.\d{3})$", r"\g<1>0", str(value))


def convert(mapping: Path, folder: Path) -> Path:
    """Write the table of a mapping file, and the keys that all rows share; returns the table."""
    keys = read_yaml(mapping, CorpusError)
    if not isinstance(keys, dict) or not isinstance(keys.get("files"), list):
        raise CorpusError(f"{mapping}: is no mapping file: it has no list of files.")
    files = keys.pop("files")
    rows = recordings_of([(number, row) for number, own in enumerate(files) for row in rows_of(folder, keys, own)])
    if not rows:
        raise CorpusError(f"{mapping}: names no file in {folder}.")
    names = dict.fromkeys([*ALWAYS_COLUMNS, *(key for row in rows for key in row)])
    shared = {key: rows[0][key] for key in names
              if key not in ALWAYS_COLUMNS and all(key in row and row[key] == rows[0][key] for row in rows)}  # fmt: skip
    table = mapping.with_name(f"{mapping.stem}_labels.csv")
    with table.open("x", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        columns = [key for key in names if key not in shared]
        writer.writerow(columns)
        writer.writerows([cell(row.get(key, "")) for key in columns] for row in rows)
    with table.with_suffix(".yaml").open("x", encoding="utf-8") as stream:
        yaml = YAML(typ="safe")
        yaml.default_flow_style = False
        yaml.dump({key: float(value) if isinstance(value, InFile) else value for key, value in shared.items()}, stream)
    return table


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description="Turn a mapping file into a table of labels.")
    parser.add_argument("mapping", type=Path)
    parser.add_argument("--folder", type=Path, help="folder of the recordings; by default that of the mapping file")
    given = parser.parse_args()
    try:
        print(convert(given.mapping, given.folder or given.mapping.parent))
    except (RacewayError, OSError) as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
