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


@kinds
def test_noise_is_sound_and_zeros_are_dead_and_one_value_is_constant(kind):
    assert verdict(stored(noise(N), kind)) == "sound"
    assert verdict(stored(np.zeros(N), kind)) == "dead"
    assert verdict(stored(np.full(N, -7.0), kind)) == "constant"
    assert verdict(stored(np.eye(1, N)[0], kind)) != "dead"


@kinds
@pytest.mark.parametrize("end", [-1, 1])
def test_a_record_is_clipped_if_more_than_a_twentieth_of_it_is_at_an_end(kind, end):
    for extra, expected in ((0, "sound"), (1, "clipped")):
        record = noise(N)
        record[: round(CLIPPED_SHARE * N) - (kind == "floats") + extra] = (
            end * 32767
        )  # the other end of floats is there once
        assert verdict(stored(record, kind)) == expected


def test_counts_that_repeat_inside_the_converter_are_not_clipped():
    """A signal of a few counts reaches its largest value often: it is small, and not clipped."""
    assert verdict(np.tile(np.array([-2, -1, 0, 1, 2], np.int16), N // 5)) == "sound"
    assert verdict(np.clip(noise(N), -1000, 1000).astype(np.int16)) == "sound"


def test_floats_that_were_cut_off_before_they_came_here_are_clipped():
    cut = np.clip(noise(N), -4000, 2000).astype(np.float32)
    assert verdict(cut) == "clipped"
    assert verdict(np.sin(np.arange(N)).astype(np.float32)) == "sound"


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("place", [0, N // 2, N - 1])
def test_a_single_sample_that_is_no_number_is_enough(value, place):
    record = noise(N).astype(np.float32)
    record[place] = value
    assert verdict(record) == "not_finite"


def test_a_missing_count_is_no_number():
    record = noise(N).astype(np.int16)
    record[N // 2] = MISSING_COUNT
    assert verdict(record) == "not_finite"


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
