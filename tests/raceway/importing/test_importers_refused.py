"""Recordings that are refused, or cannot be used: one sentence for each."""

import math
import re

import numpy as np
import pytest
import scipy.io
from scipy.io import wavfile

from gen.support.errors import CorpusError
from raceway.importing import import_generic
from tests.labels import import_labelled, write_labels
from tests.raceway.importing.test_labels import COMMON, FS, SIGNAL, imported, noise, write_matlab_7_3


def refusal(folder, *rows, **common):
    with pytest.raises(CorpusError) as refused:
        import_labelled(folder, rows, **(common or COMMON))
    assert not (folder / "corpus").exists()
    assert "\n" not in str(refused.value)
    return str(refused.value)


@pytest.mark.parametrize(
    ("window", "sentence"),
    [
        (1e300, "window: 1e+300 s are 1e18 or more samples, and the limit is 25000000;"),
        (1e306, "window: 1e+306 s is shorter than two samples"),
        (math.nan, "window: nan s is shorter than two samples"),
        (1e5, "window: 100000 s are 200000000 samples, and the limit is 25000000;"),
    ],
)
def test_a_window_that_cannot_be_meant_is_refused(tmp_path, window, sentence):
    np.save(tmp_path / "a.npy", SIGNAL)
    with pytest.raises(CorpusError, match=re.escape(sentence)):
        import_labelled(tmp_path, [{"path": "a.npy"}], window=window, **COMMON)


def test_what_is_no_table_is_refused_with_what_to_give(tmp_path):
    for source, what in ((tmp_path, "is a folder"), (tmp_path / "none.csv", "no such file")):
        with pytest.raises(CorpusError, match=f"{what}; give the table of labels, such as labels.csv."):
            import_generic(source, tmp_path / "corpus")


def test_a_link_out_of_the_folder_is_refused(tmp_path):
    inside = tmp_path / "inside"
    inside.mkdir()
    np.save(tmp_path / "a.npy", SIGNAL)
    (inside / "a.npy").symlink_to(tmp_path / "a.npy")
    assert "row 2: a.npy is a link that leads out of the folder; copy" in refusal(inside, {"path": "a.npy"})


def test_files_that_differ_are_not_joined(tmp_path):
    rows = [{"path": f"{name}.npy", "recording": "r", "shaft_rpm": rpm} for name, rpm in (("a", 1500), ("b", 900))]
    assert refusal(tmp_path, *rows).endswith(
        "row 3: b.npy belongs to recording r as a.npy does, and shaft_rpm is 900.0 here and 1500.0 there; "
        "give each recording a name of its own."
    )
    rows = [{"path": f"{unit}.npy", "recording": "r", "unit": unit} for unit in ("g", "mg")]
    assert "and unit is mg, 1 g = 9.80665 m/s^2 here" in refusal(tmp_path, *rows)


UNUSABLE = {
    "missing.npy": (None, "could not be read (No such file or directory); check the path"),
    "empty.csv": (lambda path: path.write_bytes(b""), "is empty"),
    "words.csv": (lambda path: path.write_text("no\nnumbers\n"), "has no row of numbers among its first 2"),
    "gap.csv": (
        lambda path: path.write_text("1\nx\n2\n"),
        "has text among its rows in line 2 ('x'), where 1 rows would be lost; correct",
    ),
    "nan.csv": (
        lambda path: path.write_text("1\nnan\n" * 2000),
        "has no number in line 2 ('nan'), where 1999 rows would be lost;",
    ),
    "two.csv": (lambda path: path.write_text("1.5,2.5\n" * 2000), "has 2 columns (0, 1) and none is chosen"),
    "objects.npy": (
        lambda path: np.save(path, np.array([{}]), allow_pickle=True),
        "is truncated, damaged or not a NumPy file",
    ),
    "cut.npy": (lambda path: path.write_bytes(b"\x93NUMPY\x01\x00"), "is truncated, damaged or not a NumPy file"),
    "notes.doc": (lambda path: path.write_bytes(b"RIFF"), "is of no known type; known are .mat, .npy, .wav"),
    "folder": (lambda path: path.mkdir(), "is of no known type"),
    "two.mat": (
        lambda path: scipy.io.savemat(path, {"x": SIGNAL, "y": SIGNAL, "rpm": 5}),
        "holds x, y, more than one variable with 100 numbers or more; name one with variable",
    ),
    "broken_7_3.mat": (
        lambda path: (write_matlab_7_3(path), path.write_bytes(path.read_bytes()[:900])),
        "is truncated, damaged or not a MATLAB file",
    ),
    "other.mat": (write_matlab_7_3, {"variable": "x"}, "holds vibration, not x"),
    "stereo.wav": (
        lambda path: wavfile.write(path, FS, np.c_[SIGNAL, SIGNAL]),
        {"column": 2},
        "has the columns 0, 1, and no numbers in 2; choose one with column",
    ),
    "table.npy": (
        lambda path: np.save(path, np.c_[SIGNAL, SIGNAL]),
        {"column": "ax"},
        "has columns without names, so none is called ax; give a number from 0 with column",
    ),
}


def test_each_file_that_cannot_be_used_is_named_with_its_reason(tmp_path):
    np.save(tmp_path / "good.npy", SIGNAL)
    rows = [{"path": "good.npy"}]
    for name, (write, *keys, _) in UNUSABLE.items():
        if write is not None:
            write(tmp_path / name)
        rows.append({"path": name, **(keys[0] if keys else {})})
    done, corpus = imported(tmp_path, *rows)
    told = dict(sentence.split(": ", 1) for sentence in done.skipped)
    assert (done.recordings, len(done.skipped)) == (1, len(UNUSABLE))
    assert set(corpus.source.values.tolist()) == {"good.npy#0", "good.npy#1000"}
    for name, (*_, reason) in UNUSABLE.items():
        assert reason in next(text for key, text in told.items() if key.startswith(name)), name


def test_channels_of_different_lengths_are_no_recording(tmp_path):
    scipy.io.savemat(tmp_path / "a.mat", {"x": noise(0), "y": noise(0)[:550]})
    channels = [{"name": "a", "variable": "x"}, {"name": "b", "variable": "y"}]
    assert "has channels of 1100 and 550 samples" in refusal(tmp_path, {"path": "a.mat"}, **COMMON, channels=channels)


def test_if_no_file_can_be_used_nothing_is_written(tmp_path):
    assert "no recording can be used; the first of 1 skipped: a.npy" in refusal(tmp_path, {"path": "a.npy"})


def test_rows_of_different_rates_are_refused(tmp_path):
    table = write_labels(tmp_path, [{"path": "a.npy"}, {"path": "b.npy", "sample_rate_hz": 4000}], **COMMON)
    with pytest.raises(
        CorpusError, match=r"row 3: has sample_rate_hz 4000.0, and .*row 2 has 2000.0; give resample_hz"
    ):
        import_generic(table, tmp_path / "corpus")
