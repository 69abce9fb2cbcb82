"""Laws of the verdict on stored signals: exactly the unusable signals are found, whatever the other records of the part are."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gen.corpus.schema import MISSING_COUNT
from gen.corpus.unusable import CLIPPED_SHARE, VERDICTS, complaint, count_verdicts, judge

N = 1000
counts = st.dictionaries(st.sampled_from(VERDICTS[1:]), st.integers(1, 50))


def noise(*shape, seed=0):
    """Noise that uses a tenth of a converter [counts]."""
    return np.random.default_rng(seed).normal(0, 3000, shape).clip(-32000, 32000)


def verdict(record):
    """Verdict on one channel."""
    return VERDICTS[judge(np.asarray(record)[None, None])[0]]


def stored(record, kind):
    return np.rint(record).astype(np.int16) if kind == "counts" else record.astype(np.float32)


kinds = pytest.mark.parametrize("kind", ["counts", "floats"])


def with_sample(record, place, value):
    record[place] = value
    return record


COUNTS, FLOATS = np.int16, np.float32
SEEN = [
    *[(noise(N).astype(kind), "sound") for kind in (COUNTS, FLOATS)],
    *[(np.zeros(N, kind), "dead") for kind in (COUNTS, FLOATS)],
    *[(np.full(N, -7, kind), "constant") for kind in (COUNTS, FLOATS)],
    # a signal of a few counts reaches its largest value often: it is small, and not clipped
    (np.tile(np.array([-2, -1, 0, 1, 2], COUNTS), N // 5), "sound"),
    (np.clip(noise(N), -1000, 1000).astype(COUNTS), "sound"),
    # floats that were cut off before they came here
    (np.clip(noise(N), -4000, 2000).astype(FLOATS), "clipped"),
    (np.sin(np.arange(N)).astype(FLOATS), "sound"),
    (with_sample(noise(N).astype(COUNTS), N // 2, MISSING_COUNT), "not_finite"),
    *[
        (with_sample(noise(N).astype(FLOATS), place, value), "not_finite")
        for place in (0, N // 2, N - 1)
        for value in (np.nan, np.inf, -np.inf)
    ],
]


@pytest.mark.parametrize(("record", "expected"), SEEN)
def test_every_signal_that_tells_nothing_has_its_reason(record, expected):
    assert verdict(record) == expected


@kinds
@pytest.mark.parametrize("end", [-1, 1])
def test_a_record_is_clipped_if_more_than_a_twentieth_of_it_is_at_an_end(kind, end):
    for extra, expected in ((0, "sound"), (1, "clipped")):
        record = noise(N)
        record[: round(CLIPPED_SHARE * N) - (kind == "floats") + extra] = (
            end * 32767
        )  # the other end of floats is there once
        assert verdict(stored(record, kind)) == expected


@kinds
@pytest.mark.parametrize("channel", [0, 1, 2])
def test_the_worst_channel_decides(kind, channel):
    signal = noise(1, 3, N)
    signal[0, channel] = 0
    assert VERDICTS[judge(stored(signal, kind))[0]] == "dead"


@given(st.permutations(range(6)))
def test_a_record_is_judged_alike_alone_and_among_others(order):
    kinds_of_record = [noise(N), np.zeros(N), np.full(N, 3), np.full(N, 32767), np.clip(1e3 * noise(N), -32767, 32767)]
    signal = np.stack([*kinds_of_record, noise(N, seed=1)])[list(order), None].astype(np.int16)
    alone = [judge(signal[[place]])[0] for place in range(6)]
    assert judge(signal).tolist() == alone
    assert count_verdicts(judge(signal)) == {"clipped": 1, "dead": 1, "constant": 2}


@pytest.mark.parametrize(("useless", "complains"), [(0, False), (1, False), (2, True), (100, True)])
def test_more_than_one_record_in_a_hundred_is_a_complaint(useless, complains):
    assert (complaint({"dead": useless}, 100) is not None) == complains
