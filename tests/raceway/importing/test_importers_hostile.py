"""Files from a stranger cannot read other files, block the reader, or use more memory than their values need."""

import os
import struct

import h5py
import numpy as np
import pytest
import scipy.io

from gen.corpus import validate_corpus
from gen.support.errors import CorpusError
from gen.support.limits import VARIABLE
from raceway.importing import import_set
from raceway.importing.array_files import read_numpy
from raceway.importing.matlab import read_variable
from raceway.importing.refused_files import UnusableError
from raceway.importing.table import read_text
from raceway.sharing.card.card_page import data_card
from tests.labels import import_labelled

SIGNAL = np.random.default_rng(1).normal(size=(1, 3000))


def refused(path, variable="x"):
    with pytest.raises(UnusableError) as caught:
        read_variable(path, variable)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_a_file_beyond_the_limit_is_refused_with_the_limit(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, "file_bytes=20000")
    scipy.io.savemat(tmp_path / "plain.mat", {"x": SIGNAL})
    with h5py.File(tmp_path / "large.h5", "w") as file:
        file["x"] = SIGNAL
    np.save(tmp_path / "large.npy", SIGNAL)
    np.savetxt(tmp_path / "large.csv", SIGNAL.T)
    for name in ("plain.mat", "large.h5"):
        assert "and the limit is 20000; if that is meant, raise it with raceway --limit file_bytes=" in refused(
            tmp_path / name
        )
    for read, name in ((read_numpy, "large.npy"), (read_text, "large.csv")):
        with pytest.raises(UnusableError, match="and the limit is 20000"):
            read(tmp_path / name)


def external_link(file, secret):
    file["x"] = h5py.ExternalLink(str(secret), "/x")


def external_storage(file, secret):
    file.create_dataset("x", (100,), "f8", external=[(str(secret), 0, 800)])


def virtual_dataset(file, secret):
    layout = h5py.VirtualLayout((3000,), "f8")
    layout[:] = h5py.VirtualSource(str(secret), "x", (1, 3000))
    file.create_virtual_dataset("x", layout)


def soft_link(file, secret):
    file["elsewhere"] = h5py.ExternalLink(str(secret), "/")
    file["x"] = h5py.SoftLink("/elsewhere/x")


@pytest.mark.parametrize(
    ("write", "reason"),
    [
        (external_link, "x is a soft or external link"),
        (soft_link, "x is a soft or external link"),
        (external_storage, "the values of x are in another file"),
        (virtual_dataset, "x is a virtual dataset"),
    ],
)
def test_a_matlab_file_gives_no_values_of_another_file(tmp_path, write, reason):
    with h5py.File(tmp_path / "secret.h5", "w") as file:
        file["x"] = SIGNAL
    with h5py.File(tmp_path / "hostile.mat", "w") as file:
        write(file, tmp_path / "secret.h5")
    assert refused(tmp_path / "hostile.mat") == f"refers to values outside the file: {reason}"


@pytest.mark.parametrize("values", [["a", "b"], [1j], h5py.Empty("f8")], ids=["text", "complex", "nothing"])
def test_a_dataset_that_holds_no_real_numbers_is_refused(tmp_path, values):
    with h5py.File(tmp_path / "odd.mat", "w") as file:
        file.create_dataset("x", data=values)
    assert refused(tmp_path / "odd.mat") == "holds x, but neither real numbers nor text in it"


def test_pipes_and_devices_are_refused_and_never_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", tmp_path, type(tmp_path)("/dev/zero")):
        for read in (read_text, read_numpy, lambda path: read_variable(path, "x")):
            with pytest.raises(OSError, match="is a folder, a pipe or a device"):
                read(path)


def test_a_recording_on_one_line_is_read(tmp_path):
    (tmp_path / "line.csv").write_text(",".join(f"{value:.6f}" for value in SIGNAL[0]))
    np.testing.assert_allclose(read_text(tmp_path / "line.csv").columns[0], SIGNAL[0], atol=1e-6)


def test_numpy_headers_that_promise_more_than_the_file_holds_are_refused(tmp_path):
    for shape in ("(1000000000000,)", "(-5,)", "(2, 1e3)", "(4611686018427387904, 4)"):
        header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}".ljust(117).encode() + b"\n"
        (tmp_path / "a.npy").write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + bytes(800))
        with pytest.raises(UnusableError, match="is truncated, damaged or not a NumPy file"):
            read_numpy(tmp_path / "a.npy")


def test_names_that_are_no_utf_8_are_imported_with_their_bytes_written_out(tmp_path):
    folder = os.fsencode(tmp_path) + b"/Pr\xfcfstand\n"
    os.mkdir(folder)  # noqa: PTH102 - a name in bytes
    source = tmp_path / os.fsdecode(b"Pr\xfcfstand\n")
    scipy.io.savemat(source / "105_0.mat", {"X105_DE_time": SIGNAL.T, "X105RPM": 1797})
    done = import_set("cwru", tmp_path, tmp_path / "cwru", window=0.1)
    assert done.records == 2
    assert validate_corpus(done.path) == []
    data_card(done.path)


def test_a_folder_of_too_many_files_is_refused(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, "recording_files=9")
    for number in range(10):
        (tmp_path / f"{number}.mat").write_bytes(b"x")
    with pytest.raises(CorpusError, match="holds 10 files, and the limit is 9;"):
        import_set("cwru", tmp_path, tmp_path / "corpus")


HOSTILE = (
    "</h1><script>alert(1)</script>| [x](javascript:y) ![p](http://z/p.png)\n\n# Heading\n[r]: http://w `code` \\[q](v)"
)


def card_of(folder, title, channel, bearing, name):
    """Data card of an imported corpus with texts of labels."""
    folder.mkdir()
    np.save(folder / "a.npy", SIGNAL)
    rows = [{"path": "a.npy"}, {"path": name}]
    facts = {
        "title": title,
        "origin": title,
        "channel": channel,
        "unit": "g",
        "sample_rate_hz": 2000,
        "shaft_rpm": 1500,
    }
    geometry = {"designation": bearing, "n_balls": 9, "pitch_diameter_mm": 39, "ball_diameter_mm": 8}
    done = import_labelled(folder, rows, **facts, bearing=geometry, fault="inner", specimen="A")
    assert validate_corpus(done.path) == []
    return data_card(done.path)


def test_text_of_labels_stays_text_in_the_data_card(tmp_path):
    plain = card_of(tmp_path / "plain", "Title", "sensor", "6205", "missing.npy")
    card = card_of(tmp_path / "hostile", HOSTILE, "<b>|`[x](y)", "<i>|", "<img src=x>[l](m).npy")
    for mark in ("<", ">", "](", "]:", "`", "|", "\n#", "\n```"):
        assert card.count(mark) == plain.count(mark), mark
    assert card.startswith("# (/h1)(script)alert(1)(/script)/ [x] (javascript:y)")
