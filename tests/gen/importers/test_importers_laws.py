"""Laws of the importers: no sample is lost in cutting, and every damaged file ends as an `UnusableError`."""

import io
import tempfile
from contextlib import suppress
from pathlib import Path

import hypothesis.extra.numpy as arrays
import numpy as np
import pytest
import scipy.io
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.corpus import open_corpus, validate_corpus
from gen.importers.assemble import Collection, import_recordings
from gen.importers.files import UnusableError
from gen.importers.matlab import read_matlab
from gen.importers.recordings import Candidate, Recording, cut
from gen.physics.catalogue import CATALOGUE

law = settings(deadline=None, max_examples=60)
NUMBERS = arrays.arrays(
    dtype=st.sampled_from(["f8", "f4", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8"]),
    shape=arrays.array_shapes(min_dims=2, max_dims=2, min_side=0, max_side=5),
)


def recording(signal, number=0, specimen=0, fault="inner"):
    return Recording(number, 0, specimen, CATALOGUE["6205"], 25.0, fault, signal)


def matlab_bytes(content, *, compressed=False):
    stream = io.BytesIO()
    scipy.io.savemat(stream, content, do_compression=compressed)
    return stream.getvalue()


def read_bytes(content, variable):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.mat"
        path.write_bytes(content)
        return read_matlab(path, variable)


DAMAGED = {
    compressed: matlab_bytes(
        {"other": np.arange(3), "bearing": {"gs": np.arange(40.0), "load": "50"}}, compressed=compressed
    )
    for compressed in (False, True)
}


@law
@given(size=st.integers(0, 200), length=st.integers(2, 50))
def test_the_windows_put_together_are_the_recording_without_its_incomplete_end(size, length):
    signal = np.random.default_rng(size).normal(size=size)
    records = cut(recording(signal), "a.mat", length, 1000.0)
    assert len(records) == size // length
    together = np.concatenate([record.signal[0] for record in records]) if records else np.zeros(0)
    np.testing.assert_array_equal(together, signal[: len(records) * length].astype(np.float32))
    assert [record.columns["source"] for record in records] == [f"a.mat#{length * n}" for n in range(len(records))]


@settings(deadline=None, max_examples=10)
@given(sizes=st.lists(st.integers(1, 120), min_size=1, max_size=5).filter(lambda sizes: max(sizes) >= 10))
def test_a_corpus_holds_every_window_of_every_recording_that_is_long_enough(sizes):
    signals = [np.random.default_rng(number).normal(size=size) for number, size in enumerate(sizes)]
    with tempfile.TemporaryDirectory() as folder:
        candidates = [
            Candidate(Path(__file__), f"{number}.mat", lambda n=number: recording(signals[n], n, n))
            for number in range(len(sizes))
        ]
        collection = Collection("test", "Test", "Nowhere.", 100.0, ("sensor",))
        done = import_recordings(collection, candidates, Path(folder) / "corpus", window=0.1)
        assert validate_corpus(done.directory) == []
        long = [signal for signal in signals if signal.size >= 10]
        assert (done.recordings, done.records) == (len(long), sum(signal.size // 10 for signal in long))
        assert len(done.skipped) == len(signals) - len(long)
        expected = np.concatenate([signal[: signal.size // 10 * 10] for signal in long])
        with open_corpus(done.directory) as corpus:
            stored = corpus.acceleration.values.reshape(-1)
        np.testing.assert_array_equal(stored, expected.astype(np.float32))


@law
@given(values=NUMBERS, compressed=st.booleans())
def test_matlab_numbers_are_read_as_scipy_wrote_them(values, compressed):
    content = matlab_bytes({"first": "text", "x": values}, compressed=compressed)
    np.testing.assert_array_equal(read_bytes(content, "x"), values)


@law
@given(text=st.text(st.characters(codec="ascii", categories=("L", "N")), min_size=1, max_size=9))
def test_fields_of_a_matlab_structure_are_read_as_scipy_wrote_them(text):
    content = matlab_bytes({"s": {"a": np.arange(7.0), "long_field_name": text}})
    np.testing.assert_array_equal(read_bytes(content, "s.a"), [np.arange(7.0)])
    assert read_bytes(content, "s.long_field_name").item() == text


@pytest.mark.parametrize("compressed", [False, True])
def test_a_matlab_file_cut_short_anywhere_is_refused(compressed):
    content = DAMAGED[compressed]
    for size in range(len(content)):
        with pytest.raises(UnusableError):
            read_bytes(content[:size], "bearing.gs")


@law
@given(data=st.data(), compressed=st.booleans())
def test_an_altered_matlab_file_gives_numbers_or_is_refused_but_nothing_else(data, compressed):
    content = bytearray(DAMAGED[compressed])
    for _ in range(data.draw(st.integers(1, 5))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    with suppress(UnusableError):
        assert read_bytes(bytes(content), "bearing.gs").dtype.kind in "iufU"
