"""Published sets of recordings, each a pattern of paths and a table of labels in ``published_sets.yaml``.

``files of a folder -> groups of their path -> rows of the set -> labels -> corpus, as by a table of one's own``
"""

import functools
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from gen.support.errors import CorpusError
from gen.support.progress import Progress
from gen.support.yaml_files import read_yaml
from raceway.importing.assemble import Import, nothing_usable
from raceway.importing.generic import import_labelled
from raceway.importing.label_tables import labels_of, value_of
from raceway.importing.recordings import files_below, name_of

ALL = "all"
UNTRIED = "written from its description, not tried on its files"


class PublishedSet(NamedTuple):
    """A set in ``published_sets.yaml``, where its keys are explained."""

    help: str
    tried: bool
    title: str
    origin: str
    files: str
    names: str
    pattern: str
    common: Mapping[str, Any]
    rows: Sequence[Mapping[str, Any]]
    key: str = ""
    in_turn: Mapping[str, Sequence[Any]] = {}
    facts: Sequence[str] = ()
    subsets: Mapping[str, str] = {}
    window_s: float = 0.5
    life: Mapping[str, Any] = {}


@functools.cache
def published_sets() -> Mapping[str, PublishedSet]:
    """Published sets by name."""
    sets = read_yaml(Path(__file__).with_name("published_sets.yaml"), CorpusError)
    return {name: PublishedSet(**keys) for name, keys in sets.items()}


def import_set(
    name: str,
    source: Path,
    output: Path,
    *,
    window: float | None = None,
    subset: str = ALL,
    common: Mapping[str, Any] | None = None,
    progress: Progress | None = None,
) -> Import:
    """Convert the recordings of a published set.

    Parameters
    ----------
    name : str
        A name of :func:`published_sets`.
    source : Path
        Folder of the published files; subfolders are searched.
    output : Path
        New corpus: a file if the name ends in ``.nc``, else a folder that is empty or does not exist.
    window : float, optional
        Length of a record [s]; by default 0.5, or that of a snapshot.
    subset : str
        Name of a subset of the set.
    common : mapping, optional
        Keys of all files, such as ``{"unit": "g"}``, in place of those of the set.
    progress : callable, optional
        Called with the number of files done and the number of all.

    Raises
    ------
    CorpusError
        If nothing can be imported, the output is taken, or an argument is out of range.
    """
    published = published_sets().get(name)
    if published is None:
        raise CorpusError(f"import {name}: no such set; choose one of {', '.join(published_sets())}.")
    if subset not in (ALL, *published.subsets):
        raise CorpusError(f"subset: {subset!r} is not known; choose {' or '.join((ALL, *published.subsets))}.")
    source = source.resolve()  # the names of its folders may tell labels
    rows = [*_rows(published)]
    files, skipped = _files(published, rows, source)
    courses: Mapping[Path, Mapping[str, Any]] = {path: {} for path in files}
    warnings: list[str] = []
    if published.life:
        courses, warnings = _courses(files, published.life, source, subset)
    chosen = [row for row in rows if subset in (ALL, row.get("subset", subset if published.life else ALL))]
    keys = [
        (path, {**course, **_keys(published, row, files[path])})
        for path, course in courses.items()
        for row in _fitting(chosen, files[path])
    ]
    if not keys:
        raise CorpusError(nothing_usable(name, skipped))
    if published.key:
        present = {groups[published.key] for groups in files.values()}
        missing = [number for number in (str(row[published.key]) for row in chosen) if number not in present]
        warnings += (
            [f"{len(missing)} of {len(chosen)} recordings were not found: {', '.join(missing)}."] if missing else []
        )
    callers = common or {}
    texts = [
        (
            file := name_of(path, source),
            {"path": file} | {key: value_of(file, key, value) for key, value in own.items() if key not in callers},
        )
        for path, own in keys
    ]
    labelled = labels_of(texts, {}, callers, name, "with --set")
    return import_labelled(
        name,
        [(place, path, labels) for (path, _), (place, labels) in zip(keys, labelled, strict=True)],
        output,
        window=published.window_s if window is None else window,
        skipped=skipped,
        warnings=warnings if published.tried else [f"{name}: {UNTRIED}.", *warnings],
        facts=published.facts,
        progress=progress,
    )


def _rows(published: PublishedSet) -> Iterator[dict[str, Any]]:
    """Rows with one value for each key: lists are taken in turn."""
    for row in published.rows:
        count = max((len(values) for values in row.values() if isinstance(values, list)), default=1)
        for turn in range(count):
            own = {key: values[turn] if isinstance(values, list) else values for key, values in row.items()}
            if own.get(published.key, "") is not None:  # a place that is left out
                yield {key: values[turn] for key, values in published.in_turn.items()} | own


def _fitting(rows: Sequence[Mapping[str, Any]], groups: Mapping[str, str]) -> list[Mapping[str, Any]]:
    """Rows whose keys named as groups have their values."""
    return [
        row for row in rows if all(str(row.get(name, text)).lower() == text.lower() for name, text in groups.items())
    ]


def _files(
    published: PublishedSet, rows: Sequence[Mapping[str, Any]], source: Path
) -> tuple[dict[Path, dict[str, str]], list[str]]:
    """Groups in the path of each file of a set, and a sentence for each file that is left out."""
    files: dict[Path, dict[str, str]] = {}
    skipped: list[str] = []
    first: dict[str, str] = {}
    for path in files_below(source, published.files):
        name, match = name_of(path, source), re.search(published.pattern, path.as_posix(), re.IGNORECASE)
        if match is None or not _fitting(rows, match.groupdict()):
            skipped.append(f"{name}: has no {published.names} in its path; skipped.")
            continue
        same = match[published.key or 0]
        other = first.setdefault(same.lower(), name)
        if other == name or published.life:  # of a life in two folders one is chosen later
            files[path] = match.groupdict()
        else:
            skipped.append(f"{name}: is {same.strip('/')} again, which {other} holds; skipped.")
    return files, skipped


def _keys(published: PublishedSet, row: Mapping[str, Any], groups: Mapping[str, str]) -> dict[str, Any]:
    """Keys of a file, with the groups of its path in the place of braces."""
    own = {key: value for key, value in row.items() if key not in (*groups, "subset")}
    return {
        key: value.format(**groups) if isinstance(value, str) else value
        for key, value in {"title": published.title, "origin": published.origin, **published.common, **own}.items()
    }


def _courses(
    files: Mapping[Path, Mapping[str, str]], life: Mapping[str, Any], source: Path, subset: str
) -> tuple[dict[Path, dict[str, Any]], list[str]]:
    """Age and end of the life of each file, and sentences.

    Of a life in two folders those of the longer one, or in a subset those of the shorter one, whose remaining life the longer one tells.
    """
    folders = defaultdict[Path, list[Path]](list)
    for path in files:
        folders[path.parent].append(path)
    numbers = {
        folder: [int(files[path].get("number", place)) for place, path in enumerate(paths, 1)]
        for folder, paths in folders.items()
    }
    censored = {path: re.search(life.get("censored", "$^"), f"{path}/", re.IGNORECASE) is not None for path in folders}
    longest = {
        path.name.lower(): path for path in sorted(folders, key=lambda path: (len(folders[path]), not censored[path]))
    }
    courses: dict[Path, dict[str, Any]] = {}
    warnings: list[str] = []
    for folder, paths in folders.items():
        name, whole = name_of(folder, source), longest[folder.name.lower()]
        if subset == ALL and folder != whole:
            warnings.append(f"{name}: is left out, since {name_of(whole, source)} holds more of the same life.")
        if (folder == whole) != (subset == ALL):
            continue
        taken = sorted({*numbers[folder]})
        if missing := taken[-1] - taken[0] + 1 - len(taken):
            first = next(before + 1 for before, after in pairwise(taken) if after > before + 1)
            warnings.append(f"{name}: {missing} snapshots are missing, the first is number {first}.")
        event = "censored" if censored[folder] else "failed"
        for path, number in zip(paths, numbers[folder], strict=True):
            courses[path] = {"age_s": life["every_s"] * (number - 1), "event": event}
            if folder != whole:
                courses[path]["rul_s"] = life["every_s"] * (max(numbers[whole]) - number)
    return courses, warnings
