"""Detection of records that no analysis can use, from the samples of their stored signals.

A recipe with an unsuitable full scale, gain or load gives records that are clipped, all zeros or not numbers. They are written like
other records, and counted when a part is written; the manifest holds the counts.
"""

from collections import Counter
from collections.abc import Iterable
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from gen.corpus.schema import MISSING_COUNT

VERDICTS = ("sound", "clipped", "dead", "constant", "not_finite")

# Share of the samples of a channel. Faulty records of quickstart clipped at 1, 5 and 10 % of their samples kept 89, 60 and 40 % of their
# power, and features of their fault lines changed by 0.1, 0.3 and 0.3 of their spread over the corpus: a few clipped impacts do no harm.
CLIPPED_SHARE = 0.05
USELESS_SHARE = 0.01  # share of the records of a corpus above which generate reports the recipe as unsuitable

_ADVICE = {
    "clipped": "raise recording.converter.full_scale_m_s2, or lower operation.load_n, level.gain or level.rms_m_s2",
    "dead": "lower recording.converter.full_scale_m_s2, or raise level.gain, level.background_m_s2 or level.rms_m_s2",
    "constant": "lower recording.converter.full_scale_m_s2, or raise level.gain, level.background_m_s2 or level.rms_m_s2",
    "not_finite": "lower level.gain",
}


Count = Annotated[int, Field(ge=0, lt=2**63)]
"""Count in a manifest, which may come from a stranger."""


SignalCounts = dict[Annotated[str, Field(pattern=f"^({'|'.join(VERDICTS[1:])})$")], Count]
"""Number of records that cannot be used, by reason; a reason without records is left out."""


def judge(signal: NDArray[np.integer] | NDArray[np.floating]) -> NDArray[np.int8]:
    """Verdict on each record, shape (record,), as an index of ``VERDICTS``.

    The worst channel counts: not finite if a sample is missing or not a number; dead if all samples are zero; constant if all have one
    other value; clipped if more than ``CLIPPED_SHARE`` of them are at the ends of the converter. The ends of counts are the largest and
    the smallest count. The ends of a floating-point signal are unknown; its own largest and smallest value are used, which an unclipped
    signal seldom takes more than once.

    Parameters
    ----------
    signal : array, shape (record, channel, time)
        Counts of a 16-bit converter, or accelerations [m s-2].
    """
    lowest, highest = signal.min(axis=2), signal.max(axis=2)
    counts = np.issubdtype(signal.dtype, np.integer)
    # extremes tell enough for most channels, and need no mask of all samples
    lost = lowest == MISSING_COUNT if counts else ~(np.isfinite(lowest) & np.isfinite(highest))
    low = np.full_like(lowest, MISSING_COUNT + 1) if counts else lowest
    high = -low if counts else highest
    # samples are counted only where a channel reaches an end of the converter
    at_ends = np.zeros(lowest.shape, int)
    for place in zip(
        *np.nonzero((lowest <= low) | (highest >= high)), strict=True
    ):  # one by one, for a part can take most of the memory
        at_ends[place] = np.count_nonzero((signal[place] == low[place]) | (signal[place] == high[place]))
    channels = np.select(
        [lost, (lowest == 0) & (highest == 0), lowest == highest, at_ends > CLIPPED_SHARE * signal.shape[2]],
        [VERDICTS.index(verdict) for verdict in ("not_finite", "dead", "constant", "clipped")],
        VERDICTS.index("sound"),
    )
    return channels.max(axis=1).astype(np.int8)


def count_verdicts(verdicts: NDArray[np.int8]) -> SignalCounts:
    """Number of records of each verdict except ``sound``.

    >>> count_verdicts(np.array([0, 1, 1, 4], np.int8))
    {'clipped': 2, 'not_finite': 1}
    """
    counts = np.bincount(verdicts, minlength=len(VERDICTS)).tolist()
    return {verdict: n for verdict, n in zip(VERDICTS, counts, strict=True) if n and verdict != "sound"}


def sum_counts(counts: Iterable[SignalCounts]) -> SignalCounts:
    """Sum of the counts of several parts."""
    return dict(sum(map(Counter, counts), Counter()))


def counts_in_words(counts: SignalCounts) -> str:
    """Counts in words.

    >>> counts_in_words({"clipped": 1204, "not_finite": 2}), counts_in_words({})
    ('1,204 clipped, 2 not finite', 'none')
    """
    return ", ".join(f"{n:,} {kind.replace('_', ' ')}" for kind, n in counts.items()) or "none"


def complaint(counts: SignalCounts, records: int) -> str | None:
    """Sentence with the number of records that cannot be used and the keys to change; None if they are few."""
    useless = sum(counts.values())
    if useless <= USELESS_SHARE * records:
        return None
    advice = dict.fromkeys(_ADVICE[kind] for kind in counts)
    return f"{useless:,} of {records:,} records cannot be used ({counts_in_words(counts)}): {'; '.join(advice)}."


def clipping_complaint(clipped: int, records: int) -> str | None:
    """Sentence with the number of records with a clipped sample, usable or not, and the key to change; None if there are none.

    >>> clipping_complaint(23, 100)
    '23 of 100 records are clipped at least once; raise recording.converter.full_scale_m_s2.'
    """
    key = "recording.converter.full_scale_m_s2"
    return f"{clipped:,} of {records:,} records are clipped at least once; raise {key}." if clipped else None
