"""Splits of real recordings that can leak: signs in labels, and samples that two specimens have in common.

A split by specimen keeps the records of a specimen together, so it is only as good as the names of the specimens. A recording that a set
holds twice, also cut at other places, is found by hashes of short blocks of samples [1]_. Of each record only the smallest hashes are kept:
which blocks these are depends on the samples alone, so two records that overlap keep some of the same blocks.

.. [1] S. Schleimer, D. S. Wilkerson, A. Aiken, "Winnowing: local algorithms for document fingerprinting", Proc. SIGMOD (2003) 76-85.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gen.corpus import FAULT_NAMES, SIGNAL, UNKNOWN_CODE, corpus_name, open_corpus
from gen.support.display import first_few

BLOCK = (
    64  # samples of a block: those of two recordings are not equal by chance, even of noise of few steps of a converter
)
_KEPT = 32  # blocks of a record
_FEWEST = 2  # blocks that two recordings have in common
_FACTOR = 0x9E3779B97F4A7C15  # of the polynomial of a hash; odd
_READ_BYTES = 16_000_000  # at a time
_SHOWN = 3


class _Recording(NamedTuple):
    """A recording: its source, fault, and specimen with rig."""

    source: str
    fault: int
    specimen: tuple[int, int]


def audit_splits(corpus: Path | str | xr.Dataset) -> list[str]:
    """Signs that a split of a corpus of real recordings by specimen can leak, or cannot test a class; a sentence for each kind.

    Only the first channel is compared. A copy with another gain or sample rate, filtered or with added noise, has other samples and is
    not found.

    Raises
    ------
    CorpusError
        If the corpus cannot be read.
    """
    with open_corpus(corpus) as opened:
        keys = [opened[name].values for name in ("rig", "specimen", "fault", "recording")]
        # what leaks are recordings and bearings, not records
        _, first, number = np.unique(np.stack(keys), axis=1, return_index=True, return_inverse=True)
        sources = [str(opened["source"].values[row]).rpartition("#")[0] for row in first]
        recordings = [
            _Recording(source, int(fault), (int(rig), int(specimen)))
            for source, rig, specimen, fault in zip(sources, *(key[first] for key in keys[:3]), strict=True)
        ]
        order = np.argsort(first).tolist()
        signs = [
            *_named_alike([recordings[place] for place in order]),
            *_copies(opened, recordings, number.reshape(-1).tolist()),
            *_lonely_classes(recordings, np.bincount(opened["fault"].values, minlength=UNKNOWN_CODE + 1)),
            *_one_per_file(recordings),
        ]
    return [f"{corpus_name(corpus)}: {sentence}" for sentence in signs]


def block_hashes(signal: NDArray[np.floating]) -> set[int]:
    """The smallest hashes of the blocks of a record, of shape (time,); blocks that hardly change are left out."""
    bits = np.ascontiguousarray(signal, np.float32).view(np.uint32)
    changes = np.cumsum(np.diff(bits, prepend=bits[:1]) != 0, dtype=np.int32)
    hashes, width = bits.astype(np.uint64), 1
    while width < BLOCK:  # of blocks twice as wide, from those of their halves
        hashes = hashes[:-width] * np.uint64(pow(_FACTOR, width, 2**64)) + hashes[width:]
        width *= 2
    hashes = hashes[changes[BLOCK - 1 :] - changes[: 1 - BLOCK] >= BLOCK // 2]
    return set((np.partition(hashes, _KEPT)[:_KEPT] if len(hashes) > _KEPT else hashes).tolist())


def _named_alike(recordings: Sequence[_Recording]) -> Iterator[str]:
    """Files that hold recordings of two specimens, such as two sensors of one machine."""
    held: dict[str, set[tuple[int, int]]] = {}
    for recording in recordings:
        held.setdefault(recording.source.partition(":")[0], set()).add(recording.specimen)
    shared = [source for source, specimens in held.items() if source and len(specimens) > 1]
    if shared:
        yield (
            f"{first_few(shared, _SHOWN, '; ')} holds recordings of more than one specimen; if these are sensors of one machine, "
            f"give them one specimen, or a split can test on a bearing of its training."
        )


def _copies(corpus: xr.Dataset, recordings: Sequence[_Recording], number: Sequence[int]) -> Iterator[str]:
    """Pairs of recordings of different specimens with the same blocks; ``number`` is the recording of each record."""
    samples = corpus.sizes["elapsed_time"]
    step = max(1, _READ_BYTES // (4 * samples))
    first, shared = dict[int, int](), Counter[tuple[int, int]]()
    # some records at a time, so that memory does not grow with the corpus
    for start in range(0, len(number) if samples > BLOCK else 0, step):
        signal = corpus[SIGNAL].isel(record=slice(start, start + step), channel=0).values
        for own, record in zip(number[start : start + step], signal, strict=True):
            for other in (first.setdefault(block, own) for block in block_hashes(record)):
                if recordings[other].specimen != recordings[own].specimen:
                    # a block that two recordings share by chance is not enough
                    shared[other, own] += 1
    copies = [
        f"{recordings[first_of_pair].source} and {recordings[other].source}"
        for (first_of_pair, other), count in shared.items()
        if count >= _FEWEST
    ]
    if copies:
        yield (
            f"{first_few(copies, _SHOWN, '; ')} have the same samples, and are of different specimens; remove one of the two, or "
            f"give both the same specimen."
        )


def _lonely_classes(recordings: Sequence[_Recording], counts: NDArray[np.integer]) -> Iterator[str]:
    """Classes with one specimen, which cross-validation by specimen cannot test."""
    specimens = {fault: {r.specimen for r in recordings if r.fault == fault} for fault in {r.fault for r in recordings}}
    lonely = [
        f"{counts[c]} {FAULT_NAMES[c]}" for c, held in sorted(specimens.items()) if len(held) == 1 and c != UNKNOWN_CODE
    ]
    if lonely:
        yield (
            f"all {' and all '.join(lonely)} records are of one specimen each, so that a score on them may be that of recognising "
            f"a bearing; use this corpus to test models trained on others, or add specimens."
        )


def _one_per_file(recordings: Sequence[_Recording]) -> Iterator[str]:
    """A corpus in which every recording is a specimen of its own."""
    count = len(recordings)
    if count > len({recording.fault for recording in recordings}) and len({r.specimen for r in recordings}) == count:
        yield (
            f"each of the {count} recordings is a specimen of its own; if some are of one bearing, a split by specimen leaks: give "
            f"recordings of a bearing the same specimen, or use this corpus to test models trained on others."
        )
