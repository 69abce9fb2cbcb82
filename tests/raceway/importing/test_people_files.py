"""Files as people have them are read as they were written, or refused in one sentence that names the option."""

import os
import sys
import time

import h5py
import numpy as np
import pytest
import scipy.io

from gen.corpus import open_corpus
from gen.support.errors import CorpusError
from raceway.importing import import_generic, read_signal
from raceway.importing.user_folder import OPTIONS
from tests.labels import import_labelled, write_labels
from tests.raceway.importing.file_writers import FS, X, excel
from tests.raceway.importing.people_files import ONE, OTHER_VALUES, PLAIN, REFUSED, RIGHT, THREE

FACTORS = {"g": 9.80665, "mg": 9.80665e-3, "m/s2": 1.0, "mm/s2": 1e-3, "V": 1.0, None: 1.0}
OF_UNITS = ("the given unit", "states no unit, and m/s2 is assumed", "its level is not absolute")


def write(path, content):
    if callable(content):
        content(path)
    else:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())


@pytest.mark.parametrize("name", RIGHT)
def test_a_file_is_read_as_it_was_written_and_a_unit_that_it_does_not_state_is_told(tmp_path, name):
    content, keys, fs, unit = RIGHT[name]
    write(tmp_path / name, content)
    signal = read_signal(tmp_path / name, **keys, options=OPTIONS)
    coarse = {"bits_24.wav": 2e-7, "save_ascii": 1e-7, "fortran.dat": 1e-6}
    digits = next((resolution for start, resolution in coarse.items() if name.startswith(start)), 0)
    np.testing.assert_allclose(signal.values, OTHER_VALUES.get(name, X) * FACTORS[unit], rtol=1e-9, atol=digits)
    assert signal.fs == fs
    assert signal.unit == (unit or "m/s2")
    told = [note for note in signal.warnings if any(words in note for words in OF_UNITS)]
    assert len(told) == (
        unit is None or name in ("unit_given.csv", "volts.lvm.txt")
    )  # these state one that is not read


def assert_refused(path, content, keys, sentence):
    """The file is refused with one sentence that says so."""
    write(path, content)
    with pytest.raises(CorpusError) as refused:
        read_signal(path, **keys, options=OPTIONS)
    assert sentence in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("name", REFUSED)
def test_a_file_that_leaves_something_open_is_refused_with_the_option(tmp_path, name):
    assert_refused(tmp_path / name, *REFUSED[name])


def test_notes_and_the_sheet_that_was_chosen_are_told(tmp_path):
    write(tmp_path / "a.csv", PLAIN + "RMS,0.5\nend\n")
    assert "a.csv: text after the numbers is left out: 'RMS 0.5', lines: 2." in read_signal(tmp_path / "a.csv").warnings
    excel(["x [g]"], X)(tmp_path / "a.xlsx")
    assert "a.xlsx: sheet Data is read, and not Notes." in read_signal(tmp_path / "a.xlsx").warnings


def test_without_its_extra_an_excel_file_tells_what_to_install(tmp_path, monkeypatch):
    excel(["x [g]"], X)(tmp_path / "a.xlsx")
    monkeypatch.setitem(sys.modules, "python_calamine", None)
    with pytest.raises(CorpusError, match=r"needs python-calamine; pip install raceway\[files\]\."):
        read_signal(tmp_path / "a.xlsx")


PADDED = {
    "nothing.csv": lambda path: path.write_bytes(b""),
    "numbers.csv": lambda path: path.write_text(ONE),
    "nothing.mat": lambda path: path.write_bytes(b""),
    "level_5.mat": lambda path: scipy.io.savemat(path, {"x": X}),
    "level_4.mat": lambda path: scipy.io.savemat(path, {"x": X}, format="4"),
    "damaged_7_3.mat": lambda path: path.write_bytes(b"\x89HDF\r\n\x1a\n"),
    "archive.xlsx": lambda path: excel(["x"], X)(path),
    "sound.wav": lambda path: path.write_bytes(b"RIFF"),
}


@pytest.mark.parametrize("name", PADDED)
def test_a_file_of_zeros_up_to_the_limit_ends_within_seconds(tmp_path, name):
    PADDED[name](tmp_path / name)
    os.truncate(tmp_path / name, 2_000_000_000)
    start = time.monotonic()
    with pytest.raises(CorpusError):
        read_signal(tmp_path / name)
    assert time.monotonic() - start < 10  # at most 0.5 s were measured; level 4 took minutes


def test_a_matlab_7_3_file_with_a_long_end_is_read(tmp_path):
    with h5py.File(tmp_path / "a.mat", "w") as file:
        file["x"] = X
    os.truncate(tmp_path / "a.mat", 2_000_000_000)
    assert read_signal(tmp_path / "a.mat").values.size == X.size


LABELS = {"bearing": "6205", "shaft_rpm": 1500, "fault": "inner", "specimen": "A"}


def test_a_corpus_takes_the_rate_from_the_times_and_names_its_own_keys(tmp_path):
    (tmp_path / "a.csv").write_text(THREE)
    table = write_labels(tmp_path, [{"path": "a.csv"}], **LABELS)
    done = import_generic(table, tmp_path / "corpus", window=0.02, common={"unit": "g", "column": "DE"})
    assert (done.records, done.warnings) == (2, ())
    for keys, sentence in (
        ({"unit": "g"}, "choose one with column"),
        ({"unit": "m/s2", "column": "DE"}, "the unit m/s2 is given; correct what is given with unit"),
        (
            {"unit": "g", "column": "DE", "sample_rate_hz": 9000},
            "9000 Hz are given; correct what is given with sample_rate_hz",
        ),
    ):
        with pytest.raises(CorpusError, match=sentence):
            import_generic(table, tmp_path / "refused", window=0.02, common=keys)


def test_a_corpus_takes_the_unit_from_the_header_and_assumes_none(tmp_path):
    (tmp_path / "a.csv").write_text(THREE)
    (tmp_path / "b.csv").write_text(THREE.replace(" [g]", ""))
    table = write_labels(tmp_path, [{"path": "a.csv"}, {"path": "b.csv"}], **LABELS, column="DE")
    done = import_generic(table, tmp_path / "corpus", window=0.05)
    assert done.skipped == ("b.csv:DE: states no unit; give it with unit; skipped.",)
    with open_corpus(done.path) as corpus:
        np.testing.assert_allclose(corpus.acceleration[0, 0], 9.80665 * X, rtol=1e-6)


def test_an_import_warns_of_what_is_left_out_and_of_a_unit_that_is_read_as_another(tmp_path):
    (tmp_path / "a.csv").write_text(PLAIN.replace("[g]", "[counts]") + "end\n")
    done = import_labelled(tmp_path, [{"path": "a.csv"}], window=0.02, **LABELS, unit="g")
    assert done.warnings == (
        "a.csv: text after the numbers is left out: 'end', lines: 1.",
        "a.csv: states column 1 acc [counts] in its header; the given unit g is used.",
    )


@pytest.mark.parametrize("size", [4096 + 300, 3 * 4096])
def test_rows_are_lost_nowhere_in_a_long_file(tmp_path, size):
    values = np.arange(size) * 0.37 % 1.7
    for end in ("", "\n\n", "end\n"):
        (tmp_path / "a.csv").write_text("".join(f"{value!r}\n" for value in values.tolist()) + end)
        np.testing.assert_array_equal(read_signal(tmp_path / "a.csv", rate=FS).values, values)
