"""Some records or channels of a corpus as a corpus of its own.

Records keep all their numbers, and the corpus keeps its recipe, so that each record can be replayed. The manifest tells the choice.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import (
    Manifest,
    PartRow,
    SignalCounts,
    finish_corpus,
    new_corpus_folder,
    open_corpus,
    part_name,
    read_manifest,
    write_part,
)
from gen.corpus.manifest_fields import Choice
from gen.errors import CorpusError
from gen.progress import Progress, counter
from gen.sharing.choice import chosen_channels, chosen_records
from gen.sharing.copying import (
    copy_recipes,
    facts_of,
    joined,
    part_attributes,
    parts_sha256,
    records_of_origins,
    stored_records,
)

_SPAN = 8  # times the records of a part; variables are read with those of the records between the chosen ones


@dataclass(frozen=True)
class Selected:
    """Result of :func:`select`."""

    directory: Path
    records: int
    of: int
    """Number of records that were chosen from."""
    parts: int
    channels: tuple[str, ...]
    signals: SignalCounts
    """Number of records that cannot be used."""


def select(
    directory: Path | str,
    output: Path | str,
    *,
    where: str | None = None,
    split: str | None = None,
    channels: Sequence[str] | None = None,
    progress: Progress | None = None,
) -> Selected:
    """Write some records or channels of a corpus as a new corpus.

    Parameters
    ----------
    directory : path
        Folder of a finished corpus.
    output : path
        Folder of the new corpus; it must be empty or not exist.
    where : str, optional
        Condition on the records, such as ``fault == 'inner' and shaft_rate > 20``; :mod:`gen.sharing.where` has the grammar.
    split : {"train", "validation", "test"}, optional
        Split of the records.
    channels : sequence of str, optional
        Names of the channels.
    progress : callable, optional
        Called with the number of records written and the number of all chosen.

    Raises
    ------
    CorpusError
        If nothing is chosen or left out, the corpus is unfinished or altered, or the folder cannot be written.
    """
    directory, output = Path(directory), Path(output)
    if where is None and split is None and channels is None:
        raise CorpusError(f"{directory}: no choice is given; give where, split or channels, or copy the folder.")
    manifest = read_manifest(directory)
    with open_corpus(directory) as corpus:
        records, kept = chosen_records(corpus, where, split), chosen_channels(corpus, channels)
        names = tuple(str(name) for name in corpus["channel"].values[[*kept]])
        choice = Choice(
            records=manifest.records,
            parts_sha256=parts_sha256(manifest),
            where=where,
            split=split,
            channels=None if channels is None else names,
        )
        told = f"selected by raceway select ({choice})"
        attributes = part_attributes(directory) | {"history": f"{corpus.attrs.get('history', '')}\n{told}"}
        with new_corpus_folder(output) as folder:
            done, rows, origins = counter(progress, len(records)), list[PartRow](), Counter[int]()
            for number, part in _parts(corpus, manifest, records, kept):
                rows.append(write_part(part.assign_attrs(attributes), folder / "parts" / part_name(len(rows))))
                origins[number] += 1
                done(rows[-1].records)
            facts = _facts(manifest, choice, origins)
            copy_recipes(directory, folder, [origin["recipe_file"] for origin in facts.get("origins", ())])
            signals = finish_corpus(folder, rows, publication=manifest.publication, **facts)
    return Selected(output, len(records), manifest.records, len(rows), names, signals)


def _parts(
    corpus: xr.Dataset, manifest: Manifest, records: NDArray[np.intp], channels: Sequence[int]
) -> Iterator[tuple[int, xr.Dataset]]:
    """Chosen records in parts as large as the largest of the corpus, each with the number of the origin of its records."""
    size = max(row.records for row in manifest.parts)
    for number, of in enumerate(records_of_origins(manifest)):
        places = records[(records >= of.start) & (records < of.stop)]
        for first in range(0, len(places), size):
            chosen = places[first : first + size]
            far = np.flatnonzero(np.diff(chosen // (_SPAN * size))) + 1
            yield number, joined([stored_records(corpus, block, channels) for block in np.split(chosen, far)])


def _facts(manifest: Manifest, choice: Choice, counts: Mapping[int, int]) -> dict[str, Any]:
    """Facts about the selection for its manifest; ``counts`` are the parts of each origin that has any."""
    facts = facts_of(manifest)
    if "origins" in facts:
        facts["origins"] = [facts["origins"][number] | {"parts": count} for number, count in counts.items()]
    return facts | {"selections": [*facts.get("selections", ()), choice.model_dump(mode="json")]}
