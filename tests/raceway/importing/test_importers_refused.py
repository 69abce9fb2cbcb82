"""Recordings that are refused, or cannot be used: one sentence for each."""

import math
import re
import struct
import zlib

import numpy as np
import pytest
import scipy.io
from scipy.io import wavfile

from gen.support.errors import CorpusError
from raceway.importing import import_generic, read_signal
from raceway.importing.matlab import read_variable
from raceway.importing.refused_files import UnusableError
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
        (0.0, "window: 0.0 s is shorter than two samples"),
        (-1.0, "window: -1.0 s is shorter than two samples"),
        (math.inf, "window: inf s is shorter than two samples"),
        (1e306, "window: 1e+306 s is shorter than two samples"),
        (math.nan, "window: nan s is shorter than two samples"),
        (3.0, "holds 1.05 s, less than one window of 3 s"),
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


@pytest.mark.parametrize("other", ["a.npy", "./a.npy", "link.npy"])
def test_a_file_under_two_classes_is_refused_with_both_rows(tmp_path, other):
    np.save(tmp_path / "a.npy", SIGNAL)
    (tmp_path / "link.npy").symlink_to(tmp_path / "a.npy")
    told = refusal(tmp_path, {"path": "a.npy", "fault": "inner"}, {"path": other, "fault": "outer"})
    assert "row 3: " in told
    assert "row 2, and fault is outer here and inner there; remove one of the two rows." in told


def test_files_that_differ_are_not_joined(tmp_path):
    rows = [{"path": f"{name}.npy", "recording": "r", "shaft_rpm": rpm} for name, rpm in (("a", 1500), ("b", 900))]
    assert refusal(tmp_path, *rows).endswith(
        "row 3: b.npy belongs to recording r as a.npy does, and shaft_rpm is 900.0 here and 1500.0 there; "
        "give each recording a name of its own."
    )
    rows = [{"path": f"{unit}.npy", "recording": "r", "unit": unit} for unit in ("g", "mg")]
    assert "and unit is mg, 1 g = 9.80665 m/s^2 here" in refusal(tmp_path, *rows)


def mat(**variables):
    return lambda path: scipy.io.savemat(path, variables)


def cut_to(size, write):
    return lambda path: (write(path), path.write_bytes(path.read_bytes()[:size]))


def csv(text):
    return lambda path: path.write_text(text)


X, NO_MATLAB = {"variable": "x"}, "is truncated, damaged or not a MATLAB file"
UNUSABLE = {
    "missing.npy": (None, {}, "could not be read (No such file or directory); check the path"),
    "empty.csv": (csv(""), {}, "is empty"),
    "empty.mat": (csv(""), {}, "is empty (0 bytes); copy it again"),
    "words.csv": (csv("no\nnumbers\n"), {}, "has no row of numbers among its first 2"),
    "gap.csv": (csv("1\nx\n2\n"), {}, "has no row like the others in line 2 ('x'), where 2 lines would be lost; correct"),
    "nan.csv": (csv("1\nnan\n" * 2000), {}, "has no row like the others in line 2 ('nan'), where 3999 lines would be lost;"),
    "two.csv": (csv("1.5,2.5\n" * 2000), {}, "has 2 columns (0, 1) and none is chosen"),
    "objects.npy": (lambda path: np.save(path, np.array([{}]), allow_pickle=True), {}, "is truncated, damaged or not a NumPy file"),
    "cut.npy": (lambda path: path.write_bytes(b"\x93NUMPY\x01\x00"), {}, "is truncated, damaged or not a NumPy file"),
    "notes.doc": (csv("RIFF"), {}, "is of no known type; known are .csv, .txt, .tsv"),
    "folder": (lambda path: path.mkdir(), {}, "is of no known type"),
    "stereo.wav": (
        lambda path: wavfile.write(path, FS, np.c_[SIGNAL, SIGNAL]), {"column": 2},
        "has the columns 0, 1, and no numbers in 2; choose one with column",
    ),
    "table.npy": (
        lambda path: np.save(path, np.c_[SIGNAL, SIGNAL]), {"column": "ax"},
        "has the columns 0, 1, and no numbers in ax; choose one with column",
    ),
    "two.mat": (
        mat(x=SIGNAL, y=SIGNAL, rpm=5), {}, "holds x, y, more than one variable with 100 numbers or more; name one with variable",
    ),
    "text.mat": (csv("not found\n" * 50), X, "not a MATLAB file (Unknown mat file type"),
    "cut.mat": (cut_to(8000, mat(x=SIGNAL)), X, "damaged or not a MATLAB file (could not read bytes)"),
    "cut_in_the_header.mat": (cut_to(60, mat(x=SIGNAL)), X, NO_MATLAB),
    "broken_7_3.mat": (cut_to(900, write_matlab_7_3), {}, NO_MATLAB),
    "other.mat": (write_matlab_7_3, X, "holds vibration, not x"),
    "field.mat": (mat(run={"y": SIGNAL}), X, "holds run.y, not x"),
    "letters.mat": (mat(x="lost"), X, "not one column of real numbers"),
    "complex.mat": (mat(x=SIGNAL * 1j), X, "holds x, but neither real numbers nor text in it"),
    "cell.mat": (mat(x=np.array([SIGNAL, "a"], dtype=object)), X, "holds x, but neither real numbers nor text in it"),
    "columns.mat": (mat(x=SIGNAL.reshape(-1, 2)), X, "has 2 columns (0, 1) and none is chosen"),
    "no_sample.mat": (mat(x=np.zeros((0, 1))), X, "not one column"),
}  # fmt: skip
NO_RECORDINGS = {
    "not_finite.mat": (mat(x=np.where(np.arange(2100) < 3, np.nan, SIGNAL)), X, "has 3 samples of 2100 that are not finite numbers"),
    "short.mat": (mat(x=SIGNAL[:999]), X, "holds 0.499 s, less than one window of 0.5 s"),
    "constant.mat": (mat(x=np.zeros(2100)), X, "is constant, each sample is 0 m/s^2"),
    "beyond_any_sensor.mat": (mat(x=SIGNAL * 1e300), X, "and accelerometers end at 1e+07 m/s^2"),
}  # fmt: skip


def test_each_file_that_cannot_be_used_is_named_with_its_reason(tmp_path):
    np.save(tmp_path / "good.npy", SIGNAL)
    rows = [{"path": "good.npy"}]
    for name, (write, keys, _) in (UNUSABLE | NO_RECORDINGS).items():
        if write is not None:
            write(tmp_path / name)
        rows.append({"path": name, **keys})
    done, corpus = imported(tmp_path, *rows)
    told = dict(sentence.split(": ", 1) for sentence in done.skipped)
    assert (done.recordings, len(done.skipped)) == (1, len(UNUSABLE | NO_RECORDINGS))
    assert set(corpus.source.values.tolist()) == {"good.npy#0", "good.npy#1000"}
    for name, (*_, reason) in (UNUSABLE | NO_RECORDINGS).items():
        assert reason in next(text for key, text in told.items() if key.startswith(name)), name


@pytest.mark.parametrize("name", UNUSABLE)
def test_a_single_recording_is_refused_for_the_reason_for_which_an_import_skips_it(tmp_path, name):
    write, keys, reason = UNUSABLE[name]
    if write is not None:
        write(tmp_path / name)
    with pytest.raises(CorpusError) as refused:
        read_signal(tmp_path / name, **keys)
    assert str(refused.value).startswith(f"{tmp_path / name}: ")
    assert reason in str(refused.value)
    assert "\n" not in str(refused.value)


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


@pytest.mark.parametrize("compressed", [False, True])
@pytest.mark.parametrize("kind", [0, 14, 640])
def test_numbers_of_no_known_type_in_a_matlab_file_are_refused(tmp_path, compressed, kind):
    """SciPy would end the process."""
    path = tmp_path / "x.mat"
    scipy.io.savemat(path, {"x": np.arange(200.0)})
    content = path.read_bytes()
    body = content[128:].replace(struct.pack("<2I", 9, 1600), struct.pack("<2I", kind, 1600))
    if compressed:
        packed = zlib.compress(body)
        body = struct.pack("<2I", 15, len(packed)) + packed
    path.write_bytes(content[:128] + body)
    with pytest.raises(UnusableError, match=f"a value has the type {kind}"):
        read_variable(path, None)
