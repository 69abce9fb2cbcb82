"""Detection of records that no analysis can use, from the samples of their stored signals.

A recipe with an unsuitable full scale, gain or load gives records that are clipped, all zeros or not numbers. They are written like
other records, and counted when a part is written; the manifest holds the counts.
"""

from collections.abc import Iterable
from typing import Annotated, NamedTuple

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


class SignalCounts(NamedTuple):
    """Number of records that cannot be used, by reason; all others are sound."""

    clipped: Count = 0
    dead: Count = 0
    constant: Count = 0
    not_finite: Count = 0


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
    SignalCounts(clipped=2, dead=0, constant=0, not_finite=1)
    """
    return SignalCounts(*(int(np.count_nonzero(verdicts == place)) for place in range(1, len(VERDICTS))))


def sum_counts(counts: Iterable[SignalCounts]) -> SignalCounts:
    """Sum of the counts of several parts."""
    return SignalCounts(*np.array([SignalCounts(), *counts]).sum(axis=0).tolist())


def counts_in_words(counts: SignalCounts) -> str:
    """Counts in words; counts of 0 are left out.

    >>> counts_in_words(SignalCounts(clipped=1204, not_finite=2)), counts_in_words(SignalCounts())
    ('1,204 clipped, 2 not finite', 'none')
    """
    return ", ".join(f"{n:,} {kind.replace('_', ' ')}" for kind, n in counts._asdict().items() if n) or "none"


def complaint(counts: SignalCounts, records: int) -> str | None:
    """Sentence with the number of records that cannot be used and the keys to change; None if they are few."""
    useless = sum(counts)
    if useless <= USELESS_SHARE * records:
        return None
    advice = list(dict.fromkeys(_ADVICE[kind] for kind, n in counts._asdict().items() if n))
    return f"{useless:,} of {records:,} records cannot be used ({counts_in_words(counts)}): {'; '.join(advice)}."
