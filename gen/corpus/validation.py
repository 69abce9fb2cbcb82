"""Validation of a corpus: its files, the format of its variables, and the agreement of index, manifest and parts."""

from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.index import open_corpus
from gen.corpus.lazy import blocks_of, stored_records
from gen.corpus.manifest import (
    INDEX_NAME,
    MANIFEST_NAME,
    RECIPE_NAME,
    RECIPE_TEXT,
    Manifest,
    facts_as_attributes,
    file_problems,
    read_manifest,
    recipe_text,
    unfinished,
)
from gen.corpus.schema import SIGNAL
from gen.corpus.unusable import VERDICTS, SignalCounts, count_verdicts, counts_in_words, judge
from gen.support.errors import CorpusError

_MADE_BY = ("recipe_sha256", "sources_sha256")
"""Facts by which the parts of a generated corpus belong together; parts of a copy have none."""


def validate_corpus(path: Path | str) -> list[str]:
    """All problems of a corpus, one sentence each; an empty list if it has none.

    Checks the bytes of every file, the manifest, the format of all variables, the values of the signal, and the agreement of the index
    with manifest and parts. One part at a time is held in memory.
    """
    path = Path(path)
    try:
        manifest = read_manifest(path)
        problems = file_problems(path, manifest, "sha256")
        if problems or not manifest.complete:
            return problems or [unfinished(path)]
        with open_corpus(path, check="size") as corpus:
            return [*_facts_problems(path, manifest, corpus), *_records_problems(path, manifest)]
    except CorpusError as error:
        return [str(error)]


def _facts_problems(path: Path, manifest: Manifest, corpus: xr.Dataset) -> list[str]:
    """Facts of ``manifest.json`` and ``recipe.yaml`` that ``index.nc`` has in another form."""
    if path.is_file():
        return []
    problems, wanted = [], facts_as_attributes(manifest.content)
    if recipe_text(path) != corpus.attrs.get(RECIPE_TEXT):
        problems.append(
            f"{path / RECIPE_NAME}: is missing or is not the recipe that {INDEX_NAME} has as {RECIPE_TEXT}; copy the corpus again."
        )
    names = {*wanted, *(Manifest.model_fields.keys() & corpus.attrs.keys() - {"raceway_format"})}
    if wrong := sorted(name for name in names if str(corpus.attrs.get(name)) != wanted.get(name)):
        advice = "run raceway card again if a call of it was interrupted, or copy the corpus again"
        problems.append(f"{path}: {MANIFEST_NAME} and {INDEX_NAME} disagree about {', '.join(wrong)}; {advice}.")
    return problems


def _records_problems(path: Path, manifest: Manifest) -> list[str]:
    """Problems of signals and texts, and of parts with other values or origins than the index and the manifest tell."""
    files = [(path / "parts" / row.name, row.signals) for row in manifest.parts] or [(path, manifest.signals)]
    described, counts = path if path.is_file() else path / INDEX_NAME, [row.records for row in manifest.parts]
    first, problems = 0, list[str]()
    with stored_records([described], [file for file, _ in files], counts or None) as index:
        for file, signals in files:
            with stored_records([file]) as part:
                count = part.sizes["record"]
                problems += _values_problems(file, part, index.isel(record=slice(first, first + count)), signals)
                advice = "it was made from another recipe or with other sources; make it again"
                problems += [
                    f"{file}: its {name} is not that of {MANIFEST_NAME}: {advice}."
                    for name in _MADE_BY
                    if name in part.attrs and part.attrs[name] != getattr(manifest, name)
                ]
            first += count
    return problems


def _values_problems(file: Path, records: xr.Dataset, index: xr.Dataset, signals: SignalCounts) -> list[str]:
    """Variables that differ from the index, samples that are not finite, and other counts of unusable records than the listed ones."""
    labels, listed = (some.drop_dims(["channel", "elapsed_time"]).variables for some in (records, index))
    different, verdicts = {str(name) for name in labels.keys() ^ listed.keys()}, list[NDArray[np.int8]]()
    # some records at a time, so that memory does not grow with the file
    for rows in blocks_of(records):
        verdicts.append(judge(records[SIGNAL].variable[rows].values))
        different |= {
            str(name) for name in labels.keys() & listed.keys() if not _same(labels[name][rows], listed[name][rows])
        }
    problems = [
        f"{file}: {name} differs from {INDEX_NAME}; make or copy the corpus again." for name in sorted(different)
    ]
    verdict_of = np.concatenate(verdicts)
    lost = np.flatnonzero(verdict_of == VERDICTS.index("not_finite"))
    problems += [f"{file}: record {record} of it has samples that are not finite." for record in lost]
    if (counts := count_verdicts(verdict_of)) != signals:
        told = f"{counts_in_words(counts)} of its records cannot be used, {counts_in_words(signals)} are listed"
        problems.append(f"{file}: {told}.")
    return problems


def _same(part: xr.Variable, index: xr.Variable) -> bool:
    """Whether values and their kind are equal; text of the index can be wider."""
    same_type = part.dtype == index.dtype or part.dtype.kind == index.dtype.kind == "U"
    return same_type and np.array_equal(part.values, index.values, equal_nan=part.dtype.kind == "f")
