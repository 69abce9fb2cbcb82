"""Laws of the importers: no sample is lost in cutting."""

import tempfile
from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.corpus import open_corpus, validate_corpus
from gen.physics.catalogue import CATALOGUE
from raceway.importing.assemble import Collection, import_recordings
from raceway.importing.recordings import Candidate, Recording, cut

law = settings(deadline=None, max_examples=60)


def recording(signal, number=0, specimen=0, fault="inner"):
    return Recording(number, 0, specimen, CATALOGUE["6205"], 25.0, fault, signal)


@law
@given(size=st.integers(0, 200), length=st.integers(2, 50))
def test_the_windows_put_together_are_the_recording_without_its_incomplete_end(size, length):
    signal = np.random.default_rng(size).normal(size=size)
    records = cut(recording(signal), "a.mat", length, 1000.0)
    assert len(records) == size // length
    together = np.concatenate([signal[0] for signal, _ in records]) if records else np.zeros(0)
    np.testing.assert_array_equal(together, signal[: len(records) * length].astype(np.float32))
    assert [columns["source"] for _, columns in records] == [f"a.mat#{length * n}" for n in range(len(records))]


@settings(deadline=None, max_examples=10)
@given(sizes=st.lists(st.integers(1, 120), min_size=1, max_size=5).filter(lambda sizes: max(sizes) >= 10))
def test_a_corpus_holds_every_window_of_every_recording_that_is_long_enough(sizes):
    signals = [np.random.default_rng(number).normal(size=size) for number, size in enumerate(sizes)]
    with tempfile.TemporaryDirectory() as folder:
        candidates = [
            Candidate(f"{number}.mat", lambda n=number: recording(signals[n], n, n)) for number in range(len(sizes))
        ]
        collection = Collection("test", "Test", "Nowhere.", 100.0, ("sensor",))
        done = import_recordings(collection, candidates, Path(folder) / "corpus", window=0.1)
        assert validate_corpus(done.path) == []
        long = [signal for signal in signals if signal.size >= 10]
        assert (done.recordings, done.records) == (len(long), sum(signal.size // 10 for signal in long))
        assert len(done.skipped) == len(signals) - len(long)
        expected = np.concatenate([signal[: signal.size // 10 * 10] for signal in long])
        with open_corpus(done.path) as corpus:
            stored = corpus.acceleration.values.reshape(-1)
        np.testing.assert_array_equal(stored, expected.astype(np.float32))
