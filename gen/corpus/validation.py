"""Validation of a corpus: its files, the format of its variables, and the agreement of index, manifest and parts."""

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus.index import corpus_attributes, open_corpus
from gen.corpus.manifest import (
    INDEX_NAME,
    MANIFEST_NAME,
    Manifest,
    facts_of_parts,
    file_problems,
    read_manifest,
    recipe_text,
)
from gen.corpus.slices import blocks_of, file_facts, read_columns, stored_blocks
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
            return problems or [f"{path}: is unfinished; run the raceway generate command that began it again."]
        with open_corpus(path, check="size") as corpus:
            return [*_facts_problems(path, manifest, corpus), *_records_problems(path, manifest)]
    except CorpusError as error:
        return [str(error)]


def _facts_problems(path: Path, manifest: Manifest, corpus: xr.Dataset) -> list[str]:
    """Facts of ``manifest.json`` and ``recipe.yaml`` that ``index.nc`` has in another form."""
    if path.is_file():
        return []
    content = manifest.model_dump(mode="json", exclude_unset=True)
    content = facts_of_parts(manifest.parts, content | {"publication": manifest.publication})
    wanted = corpus_attributes(content, recipe_text(path), path)
    names = {*wanted, *(Manifest.model_fields.keys() & corpus.attrs.keys() - {"raceway_format"})}
    wrong = sorted(name for name in names if str(corpus.attrs.get(name)) != wanted.get(name))
    advice = "run raceway card again if a call of it was interrupted, or copy the corpus again"
    return [f"{path}: {MANIFEST_NAME} and {INDEX_NAME} disagree about {', '.join(wrong)}; {advice}."] if wrong else []


def _records_problems(path: Path, manifest: Manifest) -> list[str]:
    """Problems of signals and texts, and of parts with other values than the index."""
    first, problems = 0, list[str]()
    if path.is_file():
        for block in blocks_of(path, manifest.records):
            read_columns(path, first=block.first, stop=block.stop)
        return _signal_problems(path, manifest.signals)
    # one part at a time, so that memory does not grow with the corpus
    for row in manifest.parts:
        file = path / "parts" / row.name
        columns, index = read_columns(file), read_columns(path / INDEX_NAME, first=first, stop=first + row.records)
        problems += [
            f"{file}: {name} differs from {INDEX_NAME}; make or copy the corpus again."
            for name in sorted(columns.keys() | index.keys())
            if name not in columns or name not in index or not _same(columns[name], index[name])
        ]
        problems += [*_origin_problems(file, manifest), *_signal_problems(file, row.signals)]
        first += row.records
    return problems


def _same(part: NDArray[Any], index: NDArray[Any]) -> bool:
    """Whether values and their kind are equal; text of the index can be wider."""
    same_type = part.dtype == index.dtype or part.dtype.kind == index.dtype.kind == "U"
    return same_type and np.array_equal(part, index, equal_nan=part.dtype.kind == "f")


def _origin_problems(file: Path, manifest: Manifest) -> list[str]:
    """Facts by which a part was made from another recipe, or with other sources, than the manifest tells."""
    facts, _ = file_facts(file)
    return [
        f"{file}: its {name} is not that of {MANIFEST_NAME}: it was made from another recipe or with other sources; make it again."
        for name in _MADE_BY
        if name in facts and facts[name] != getattr(manifest, name)
    ]


def _signal_problems(file: Path, listed: SignalCounts) -> list[str]:
    """Samples that are not finite, and counts of unusable records other than the listed ones."""
    verdicts = np.concatenate([judge(block) for block in stored_blocks(file)])
    lost = np.flatnonzero(verdicts == VERDICTS.index("not_finite"))
    problems = [f"{file}: record {record} of it has samples that are not finite." for record in lost]
    if count_verdicts(verdicts) != listed:
        counts = counts_in_words(count_verdicts(verdicts))
        problems.append(f"{file}: {counts} of its records cannot be used, {counts_in_words(listed)} are listed.")
    return problems
