"""Splits of real recordings that can leak: signs in labels and signals that one bearing is on both sides.

A split by specimen keeps the records of a specimen together, so it is only as good as the names of the specimens. A recording that a set
holds twice, shifted, amplified or filtered, is found by phase correlation [1]_: the cross spectrum of two recordings with all magnitudes
set to one. Its peak is near 1 for copies and near 0 for different recordings, even of one machine, since shaft harmonics are few of many
bins.

.. [1] C. H. Knapp, G. C. Carter, "The generalized correlation method for estimation of time delay", IEEE Trans. Acoust. Speech Signal
   Process. 24 (1976) 320-327.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy import fft

from features.signal.rows import FloatArray
from gen.corpus import FAULT_NAMES, SIGNAL, UNKNOWN_CODE, corpus_name, open_corpus

COPY = 0.25  # phase correlation; no two recordings of different bearings in CWRU, MFPT or UESTC reach 0.11
_LONGEST = 32_768  # samples of a recording that are compared
_MOST_PAIRS = 20_000  # of recordings, those with the most similar spectra; a pair takes about 1 ms
_BANDS = 24
_SHOWN = 3


class _Recording(NamedTuple):
    """A recording: its source, fault, specimen with rig, and its phases, shape (frequency,), and levels in bands, shape (band,)."""

    source: str
    fault: int
    specimen: tuple[int, int]
    phases: NDArray[np.complexfloating]
    levels: FloatArray


def audit_splits(corpus: Path | str | xr.Dataset) -> list[str]:
    """Signs that a split of a corpus of real recordings by specimen can leak, or cannot test a class; a sentence for each kind.

    Only the first channel is compared, and of each recording the first 32,768 samples; of more than 20,000 pairs of recordings those with
    the most similar spectra.

    Raises
    ------
    CorpusError
        If the corpus cannot be read.
    """
    with open_corpus(corpus) as opened:
        recordings = list(_recordings(opened))
        counts = np.bincount(opened["fault"].values, minlength=UNKNOWN_CODE + 1)
    signs = [
        *_named_alike(recordings),
        *_copies(recordings),
        *_lonely_classes(recordings, counts),
        *_one_per_file(recordings),
    ]
    return [f"{corpus_name(corpus)}: {sentence}" for sentence in signs]


def _recordings(corpus: xr.Dataset) -> Iterator[_Recording]:
    keys = [corpus[name].values for name in ("rig", "specimen", "fault", "recording")]
    _, first, number = np.unique(np.stack(keys), axis=1, return_index=True, return_inverse=True)
    samples = corpus.sizes["elapsed_time"]
    length = min(_LONGEST, samples * max(1, int(np.bincount(number.reshape(-1)).min())))
    for place in np.argsort(first):
        rows = np.flatnonzero(number.reshape(-1) == place)[: -(-length // samples)]
        signal = corpus[SIGNAL].isel(record=rows, channel=0).values.astype(float).reshape(-1)[:length]
        rig, specimen, fault, _ = (int(key[rows[0]]) for key in keys)
        source = str(corpus["source"].values[rows[0]]).rpartition("#")[0]
        yield _Recording(source, fault, (rig, specimen), *_signature(signal))


def _signature(signal: FloatArray) -> tuple[NDArray[np.complexfloating], FloatArray]:
    """Phases of the spectrum, padded so that shifts do not wrap around, and levels [dB] in bands relative to their mean."""
    signal = np.nan_to_num(signal, posinf=0.0, neginf=0.0)
    tapered = (signal - signal.mean()) * np.hanning(signal.size)
    spectrum = fft.rfft(tapered, fft.next_fast_len(2 * signal.size, real=True))
    magnitude = np.abs(spectrum)
    phases = np.divide(spectrum, magnitude, out=np.zeros_like(spectrum), where=magnitude > 0)
    power = [np.mean(band**2) for band in np.array_split(magnitude, _BANDS)]
    levels = 10 * np.log10(np.maximum(np.array(power), 1e-30))
    return phases.astype(np.complex64), levels - levels.mean()


def _named_alike(recordings: Sequence[_Recording]) -> Iterator[str]:
    """Files that hold recordings of two specimens, such as two sensors of one machine."""
    held: dict[str, set[tuple[int, int]]] = {}
    for recording in recordings:
        held.setdefault(recording.source.partition(":")[0], set()).add(recording.specimen)
    shared = [source for source, specimens in held.items() if len(specimens) > 1]
    if shared:
        yield (
            f"{_listed(shared)} holds recordings of more than one specimen; if these are sensors of one machine, give them one "
            f"specimen, or a split can test on a bearing of its training."
        )


def _copies(recordings: Sequence[_Recording]) -> Iterator[str]:
    """Pairs of recordings of different specimens that hold the same signal."""
    pairs = [
        (float(np.sum((one.levels - other.levels) ** 2)), first, second)
        for first, one in enumerate(recordings)
        for second, other in enumerate(recordings[:first])
        if one.specimen != other.specimen
    ]
    copies = []
    for _, first, second in sorted(pairs)[:_MOST_PAIRS]:
        one, other = recordings[first], recordings[second]
        if phase_correlation(one.phases, other.phases) > COPY:
            copies.append(f"{other.source} and {one.source}")
    if copies:
        yield (
            f"{_listed(copies)} agree in phase sample by sample, as copies of one recording do, and are of different specimens; "
            f"remove one of the two, or give both the same specimen."
        )


def phase_correlation(one: NDArray[np.complexfloating], other: NDArray[np.complexfloating]) -> float:
    """Largest magnitude of the phase correlation of two spectra over all shifts [1], from their phases, shape (frequency,)."""
    return float(np.abs(fft.irfft(one * other.conj())).max())


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


def _listed(items: Sequence[str]) -> str:
    more = len(items) - _SHOWN
    return "; ".join(items[:_SHOWN]) + (f" and {more} more" if more > 0 else "")
