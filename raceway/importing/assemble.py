"""Write the recordings of a set as a corpus; a failed import leaves nothing behind.

Files are read one after the other, and their records are written part by part.
"""

import hashlib
import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gen.corpus import NewCorpus, Variable, check_new, identity, make_dataset, new_corpus
from gen.support.errors import CorpusError
from gen.support.limits import check_limit
from gen.support.plugins import plugin_versions
from gen.support.progress import Progress, counter
from raceway.importing.recordings import Candidate, Record, cut, read_recording
from raceway.importing.refused_files import UnusableError
from raceway.sharing import describe

_PART_RECORDS = 256
_PART_BYTES = 64_000_000


class Collection(NamedTuple):
    """Facts that all recordings of a set share.

    ``origin`` is their owner and licence; ``facts`` are sentences on what labels and units rest on.
    """

    importer: str
    title: str
    origin: str
    fs: float
    channels: tuple[str, ...]
    facts: tuple[str, ...] = ()
    extra: tuple[Variable, ...] = ()


class Import(NamedTuple):
    """The new corpus, its counts, and a sentence for each skipped file, each assumption and each change of a signal."""

    path: Path
    recordings: int
    records: int
    skipped: tuple[str, ...]
    warnings: tuple[str, ...]


class Importer(NamedTuple):
    """Importer of a plug-in."""

    help: str
    """Of its command ``raceway import NAME``."""
    convert: Callable[..., Import]
    """Called with the folder of the recordings, the new corpus, and by keyword ``window`` [s] and ``progress``, as `import_set` is."""


def import_recordings(
    collection: Collection,
    candidates: Sequence[Candidate],
    output: Path,
    *,
    window: float,
    skipped: Sequence[str] = (),
    warnings: Sequence[str] = (),
    progress: Progress | None = None,
) -> Import:
    """Write a corpus of all usable candidates.

    Parameters
    ----------
    collection : Collection
        Facts that all recordings share.
    candidates : sequence of Candidate
        The files; a file that cannot be used is skipped with a sentence.
    output : Path
        New corpus: a file if the name ends in ``.nc``, else a folder that is empty or does not exist.
    window : float
        Length of a record [s].
    skipped, warnings : sequence of str
        Sentences that the lists of the result begin with.
    progress : callable, optional
        Called with the number of files done and the number of all.

    Raises
    ------
    CorpusError
        If the output exists, the window is shorter than two samples, no file can be used, or writing fails.
    """
    output = output.absolute()
    check_new(output)
    # what can be refused is refused before a file is read
    samples = window * collection.fs
    length = round(samples) if math.isfinite(samples) else 0
    if length < 2:
        raise CorpusError(
            f"window: {window} s is shorter than two samples; give the length of a record in seconds, such as 0.5."
        )
    check_limit("record_samples", length * len(collection.channels), f"window: {window:g} s are", CorpusError)
    recordings = Counter[str]()
    left_out, told = [*skipped], [*warnings]
    tell = counter(progress, len(candidates))

    def records() -> Iterator[Record]:
        # recordings are read, cut and written one after the other
        for candidate in candidates:
            try:
                recording = read_recording(candidate, length, collection.fs, collection.channels)
            except UnusableError as reason:
                left_out.append(f"{candidate.source}: {reason}; skipped.")
            else:
                recordings[recording.fault] += 1
                told.extend(f"{candidate.source}: {warning}." for warning in recording.warnings)
                yield from cut(recording, candidate.source, length, collection.fs)
            tell(1)

    with new_corpus(
        output,
        describe=describe,
        title=collection.title,
        importer=collection.importer,
        basis=collection.facts,
    ) as corpus:
        _write_parts(records(), collection, candidates, corpus)
        if not corpus.rows:
            raise CorpusError(nothing_usable(collection.importer, left_out))
        count = sum(row.records for row in corpus.rows)
        versions = plugin_versions("importers", (collection.importer,)) | plugin_versions("classes", recordings)
        done = Import(output, recordings.total(), count, tuple(left_out), tuple(told))
        corpus.facts |= {
            "versions": versions or None,
            "recordings": done.recordings,
            "skipped": done.skipped,
            "warnings": done.warnings,
        }
    return done


def _corpus_identity(importer: str, candidates: Sequence[Candidate], first: NDArray[np.float32]) -> str:
    """First 12 digits of the SHA-256 of the importer, the names of all files and the first record: another set has another identity."""
    digest = hashlib.sha256(first.tobytes())
    for text in (importer, *(candidate.source for candidate in candidates)):
        digest.update(f"{text}\n".encode())
    return digest.hexdigest()[:12]


def _write_parts(
    records: Iterator[Record], collection: Collection, candidates: Sequence[Candidate], corpus: NewCorpus
) -> None:
    own = None
    for signal, facts in records:
        # the identity of the corpus follows from its files and its first signal
        own = own or _corpus_identity(collection.importer, candidates, signal)
        size = max(1, min(_PART_RECORDS, _PART_BYTES // signal.nbytes))
        # as many records as a part holds, or as memory should
        batch = [(signal, facts), *islice(records, size - 1)]
        columns = {name: [values[name] for _, values in batch] for name in facts}
        numbers = zip(columns["rig"], columns["specimen"], columns["recording"], strict=True)
        dataset = make_dataset(
            np.stack([window for window, _ in batch]),
            collection.fs,
            collection.channels,
            columns | {"identity": [identity(own, *some) for some in numbers]},
            extra=collection.extra,
            attributes={
                "title": collection.title,
                "source": collection.origin,
                "history": f"cut from recordings by raceway import {collection.importer}",
            },
        )
        corpus.write(dataset)


def nothing_usable(importer: str, skipped: Sequence[str]) -> str:
    """Sentence on an import of which no recording is left."""
    if not skipped:
        return f"import {importer}: no recording of the set was found; give the folder that holds them."
    return f"import {importer}: no recording can be used; the first of {len(skipped)} skipped: {skipped[0]}"
