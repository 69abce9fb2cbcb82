"""Tables of labels as spreadsheets save them: one row for each file of recordings.

``table -> rows of texts -> numbers in one form -> with the keys of all rows -> labels``

Keys that all rows share are in the YAML file of the same name beside the table, or are given by the caller.
"""

import csv
import io
import re
from collections.abc import Mapping, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from gen.support.errors import CorpusError
from gen.support.limits import check_limit, limit
from gen.support.sentences import sentences
from gen.support.units import unit_suffix
from gen.support.yaml_files import parse_yaml, read_yaml
from raceway.importing.columns import column_of
from raceway.importing.label_keys import Labels
from raceway.importing.numerals import IN_THOUSANDS, decimal_marks, in_doubt, is_number, number_in
from raceway.importing.refused_files import guarded, told_of
from raceway.importing.text_files import text_of

_TABLES = (".csv", ".txt", ".tsv")
_MARKS = "\t;,"
_NUMBERS = {key for key in Labels.model_fields if unit_suffix(key) or key == "n_spalls"}
_SPEEDS = {key for key in _NUMBERS if unit_suffix(key) == "rpm"}
_ALIKE = ("title", "origin", "resample_hz", "channel_names")
_OF_ALL = ("age_s", "motor_load_w")
_MOST_SENTENCES = 20


_Row = tuple[str, Mapping[str, Any]]
"""Place of a file in the table, and its keys."""


def read_table_of_labels(path: Path, common: Mapping[str, Any]) -> list[tuple[str, Labels]]:
    """Place and labels of each file that a table names, in its order.

    ``common`` has keys of all rows, with values or texts as in cells. They go before those of the YAML file, and keys of a row before both.

    Raises
    ------
    CorpusError
        If the file is no table, or has wrong keys or values; one sentence for each, with row and column.
    """
    if path.suffix.lower() not in _TABLES:
        raise CorpusError(
            f"{path}: is no table of labels; save one as CSV, such as labels.csv, with a row for each file."
        )
    (first, names), *lines = lines_of(path, "path, fault and specimen")
    texts: list[_Row] = []
    for number, cells in lines:
        place, named = f"{path}, row {number}", [*names, *[""] * len(cells)]
        # a value without a key would be lost in silence
        lost = next((cell for name, cell in zip(named, cells, strict=False) if cell and not name), None)
        if lost is not None:
            raise CorpusError(
                f"{place}: {lost!r:.60} is in a column without a key in row {first}; give the key, or quote a text with commas."
            )
        texts.append((place, {name: cell for name, cell in zip(named, cells, strict=False) if cell}))
    columns = {
        key: [text for _, keys in texts if is_number(text := keys.get(key, ""))] for key in names if key in _NUMBERS
    }
    of_table = decimal_marks(chain(*columns.values()))
    # nobody sees a wrong speed, so the other speeds must tell how it is read
    marks = {key: "" if key in _SPEEDS and in_doubt(column) else of_table for key, column in columns.items()}
    rows = [
        (place, {key: value_of(f"{place}, column {key}", key, text, marks.get(key, "")) for key, text in keys.items()})
        for place, keys in texts
    ]
    beside = path.with_suffix(".yaml")
    shared = keys_of_yaml(beside) if beside.is_file() else {}
    return labels_of(rows, shared, common, str(beside), f"there, or for all files in {beside.name}")


def labels_of(
    rows: Sequence[_Row], shared: Mapping[str, Any], common: Mapping[str, Any], source: str, advice: str
) -> list[tuple[str, Labels]]:
    """Place and labels of each row; ``shared`` keys are from a ``source``, and ``advice`` says where a missing one is given.

    A flaw of several rows is told of the first one.

    Raises
    ------
    CorpusError
        If keys or values are wrong; one sentence for each.
    """
    common_keys = {key: value_of(f"common key {key}", key, value) for key, value in common.items()}
    files: list[tuple[str, Labels]] = []
    problems: dict[str, str] = {}
    for place, own in rows:
        # the cell of a row goes before a common key, and this before the file beside the table
        keys = {key: value for key, value in {**shared, **common_keys, **own}.items() if value is not None}
        try:
            files.append((place, Labels.model_validate(keys)))
        except ValidationError as error:
            for sentence in sentences(error, Labels):
                key = re.split(r"\W", sentence)[0]
                start = place + (", column " if key in {*keys, *Labels.model_fields} else ": ")
                if key in keys and key not in own:
                    start = "common key " if key in common_keys else f"{source}: "
                told = sentence.replace("; give it.", f"; give it {advice}.")
                # the same flaw in every row is one sentence
                problems.setdefault(told, start)
    if problems:
        raise CorpusError("\n".join(f"{start}{told}" for told, start in islice(problems.items(), _MOST_SENTENCES)))
    # facts of the corpus cannot differ between its files
    for key in _ALIKE:
        _check_alike(key, [(place, getattr(labels, key)) for place, labels in files], "give all files the same")
    for key in _OF_ALL:
        presence = [(place, "none" if getattr(labels, key) is None else "one") for place, labels in files]
        _check_alike(key, presence, "give all files one")
    rates = [
        (place, labels.sample_rate_hz) for place, labels in files if labels.sample_rate_hz and not labels.long_rate_hz
    ]
    if files[0][1].resample_hz is None:
        _check_alike("sample_rate_hz", rates, "give resample_hz")
    return files


def _check_alike(key: str, values: Sequence[tuple[str, Any]], advice: str) -> None:
    for place, value in values:
        if value != values[0][1]:
            there, first = values[0]
            raise CorpusError(
                f"{place}: has {key} {value}, and {there} has {first}; {advice}, or make a corpus of each."
            )


def keys_of_yaml(path: Path) -> dict[str, Any]:
    """Keys in a YAML file."""
    keys = read_yaml(path, CorpusError)
    for key, text in re.findall(r"""(\w+)["']?:[ ]+["']?([\d.]+)""", path.read_text("utf-8", "ignore")):
        value_of(f"{path}: {key}", key, text)
    if not isinstance(keys, dict) or not all(isinstance(key, str) for key in keys):
        raise CorpusError(f"{path}: holds no keys; write those that all files share, such as unit: g.")
    return keys


def lines_of(path: Path, keys: str) -> list[tuple[int, list[str]]]:
    """Lines of a table that are not empty, with their numbers from 1, as spreadsheets count; the first has the keys, such as ``keys``.

    Raises
    ------
    CorpusError
        If the file is no text, has no rows or too many, or a key twice.
    """
    with told_of(path, {}), guarded(path, "CSV"):
        text = text_of(path).decode()
        first, _, rest = text.partition("\n")
        said = re.fullmatch("sep=(.)", first)
        text = f"\n{rest}" if said else text  # a spreadsheet says its mark
        head = next((line for line in text.split("\n") if line.strip(f" {_MARKS}")), "")
        mark = said[1] if said else next((mark for mark in _MARKS if mark in head), ",")
        cells = ([cell.strip(" \xa0") for cell in line] for line in csv.reader(io.StringIO(text), delimiter=mark))
        filled = ((number, line) for number, line in enumerate(cells, 1) if any(line))
        lines = [*islice(filled, limit("recording_files") + 2)]
    check_limit("recording_files", len(lines) - 1, f"{path}: names", CorpusError)
    if len(lines) < 2:
        raise CorpusError(f"{path}: has no rows; write one with keys such as {keys}, and below it one for each file.")
    number, names = lines[0]
    twice = next((name for name in names if name and names.count(name) > 1), None)
    if twice is not None:
        raise CorpusError(f"{path}, row {number}, column {twice}: is there twice; remove one of the two.")
    return lines


def value_of(where: str, key: str, text: Any, marks: str = "") -> Any:
    """Value of a cell; a number has the one decimal mark of the table, or else one reading, and channels are written as in YAML."""
    if not isinstance(text, str):
        return text
    if key == "channels":
        return parse_yaml(text, where, CorpusError)
    if key not in _NUMBERS or not is_number(text):
        return column_of(text) if key in ("column", "speed_column") else text
    number = number_in(text, marks if len(marks) == 1 else "")
    if number is None:
        raise CorpusError(f"{where}: {text} {IN_THOUSANDS}.")
    return number
