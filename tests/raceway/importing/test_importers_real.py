"""The importers on real recordings: content of the sets, and error sentences for damaged copies.

The recordings are expected in the folder that ``RACEWAY_REAL`` names, or beside the repository.
"""

import shutil

import numpy as np
import pytest
import scipy.signal

from gen.corpus import open_corpus, validate_corpus
from raceway.importing import import_set
from tests.paths import REAL


def folder_of(name):
    folder = REAL / name
    if not folder.is_dir():
        pytest.skip(f"no real recordings: set RACEWAY_REAL to the folder that holds {name}")
    return folder


@pytest.fixture(scope="module")
def cwru(tmp_path_factory):
    done = import_set("cwru", folder_of("cwru"), tmp_path_factory.mktemp("real") / "cwru")
    with open_corpus(done.path) as corpus:
        return done, corpus.load()


@pytest.fixture(scope="module")
def mfpt(tmp_path_factory):
    done = import_set("mfpt", folder_of("mfpt"), tmp_path_factory.mktemp("real") / "mfpt")
    with open_corpus(done.path) as corpus:
        return done, corpus.load()


def envelope_line(corpus, recording, order):
    """Order of the highest envelope line within 2 % of ``order``, and its height over the median near it."""
    rows = corpus.recording.values == recording
    signal, fs = corpus.acceleration.values[rows, 0].reshape(-1), corpus.sample_rate.values[rows][0]
    high = scipy.signal.sosfilt(scipy.signal.butter(4, [2000, 4800], "bandpass", fs=fs, output="sos"), signal)
    envelope = np.abs(scipy.signal.hilbert(high)) ** 2
    spectrum = np.abs(np.fft.rfft((envelope - envelope.mean()) * np.hanning(envelope.size)))
    orders = np.fft.rfftfreq(envelope.size, 1 / fs) / corpus.shaft_rate.values[rows][0]
    near = np.flatnonzero(abs(orders / order - 1) < 0.02)
    around = np.flatnonzero(abs(orders - order) < 0.8)
    best = near[np.argmax(spectrum[near])]
    return orders[best], spectrum[best] / np.median(spectrum[around])


def test_the_cwru_copies_give_64_recordings_of_16_bearings(cwru):
    done, corpus = cwru
    assert (done.recordings, done.skipped) == (64, ())
    assert validate_corpus(done.path) == []
    assert len(set(corpus.specimen.values.tolist())) == 16
    assert (
        len({(number, fault) for number, fault in zip(corpus.recording.values, corpus.fault.values, strict=True)}) == 64
    )
    assert done.records == 1270
    assert np.bincount(corpus.recording)[[97, 98, 105]].tolist() == [10, 20, 20]


def test_the_wang_subset_of_the_cwru_copies_is_40_recordings_of_10_bearings(tmp_path):
    done = import_set("cwru", folder_of("cwru"), tmp_path / "wang", subset="wang")
    with open_corpus(done.path) as corpus:
        assert (done.recordings, done.records, len(set(corpus.specimen.values.tolist()))) == (40, 790, 10)


def test_every_oddity_of_the_cwru_copies_is_told(cwru):
    told = "\n".join(cwru[0].warnings)
    for number in range(3001, 3009):
        assert f"{number}_" in told
    for sentence in ("158_1.mat:X158_DE_time: the speed", "its 243938 samples are taken as recorded at 48000 Hz"):
        assert sentence in told
    assert told.count("shows no outer-race line and looks healthy") == 4
    assert told.count("is of a bearing of another maker") == 8


def test_the_fault_lines_of_clear_cwru_recordings_are_at_the_nominal_orders(cwru):
    _, corpus = cwru
    for recording, order in ((209, 5.4152), (234, 3.5848)):
        measured, height = envelope_line(corpus, recording, order)
        assert measured == pytest.approx(order, rel=0.006)  # measured: BPFI -0.2 %, BPFO +0.3 % of nominal
        assert height > 30
    assert envelope_line(corpus, 100, 5.4152)[1] < 15


def test_the_mfpt_copies_give_14_recordings_whose_lines_are_a_little_below_nominal(mfpt):
    done, corpus = mfpt
    assert (done.recordings, done.records, done.skipped) == (14, 84, ())
    assert validate_corpus(done.path) == []
    assert sorted(set((corpus["load"].values / 4.4482216).round().tolist())) == [0, 25, 50, 100, 150, 200, 250, 300]
    recording = int(corpus.recording.values[corpus.source.values == "OuterRaceFault_vload_7.mat:bearing.gs#0"][0])
    measured, height = envelope_line(corpus, recording, 3.245)
    assert 0.985 < measured / 3.245 < 0.997
    assert height > 30


def test_damaged_copies_of_real_files_are_named_and_the_rest_is_imported(tmp_path):
    inner = folder_of("cwru") / "12k_drive_end" / "IR" / "007"
    source = tmp_path / "set"
    shutil.copytree(inner, source)
    whole = (source / "105_0.mat").read_bytes()
    (source / "105_0.mat").write_bytes(whole[: len(whole) // 4])
    (source / "106_1.mat").write_bytes(b"")
    shutil.copy(inner / "108_3.mat", source / "107_2.mat")
    done = import_set("cwru", source, tmp_path / "corpus")
    told = {sentence.partition(":")[0]: sentence.partition(": ")[2] for sentence in done.skipped}
    assert done.recordings == 1
    assert set(told) == {"105_0.mat", "106_1.mat", "107_2.mat"}
    assert told["105_0.mat"].startswith("is truncated, damaged or not a MATLAB file")
    assert told["107_2.mat"].startswith("holds X108_DE_time")
    assert validate_corpus(done.path) == []
