"""Files from a stranger cannot read other files, block the reader, or use more memory than their values need."""

import os
import struct
import subprocess
import sys
import zlib

import h5py
import numpy as np
import pytest
import scipy.io

from gen.corpus import validate_corpus
from gen.errors import CorpusError
from gen.importers import import_cwru, import_generic
from gen.importers.files import UnusableError, one_column, read_numpy, read_text
from gen.importers.matlab import read_matlab
from gen.limits import VARIABLE

SIGNAL = np.random.default_rng(1).normal(size=(1, 3000))


def element(kind, data):
    return struct.pack("<II", kind, len(data)) + data + b"\0" * (-len(data) % 8)


def compressed_zeros(size, *, announced=None):
    """Level 5 file of one compressed array of zeros; made without unpacking it."""
    head = element(6, struct.pack("<II", 6, 0)) + element(5, struct.pack("<ii", size // 8, 1)) + element(1, b"x")
    head += struct.pack("<II", 9, size)
    packer = zlib.compressobj()
    packed = packer.compress(struct.pack("<II", 14, len(head) + (announced or size)) + head)
    packed += b"".join(packer.compress(bytes(min(1_000_000, size - start))) for start in range(0, size, 1_000_000))
    packed += packer.flush()
    return b"MATLAB 5.0".ljust(124) + b"\0\1IM" + struct.pack("<II", 15, len(packed)) + packed


def refused(path, variable="x"):
    with pytest.raises(UnusableError) as caught:
        read_matlab(path, variable)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def peak_of(code, *arguments):
    """Megabytes that a process uses for some code, beyond the memory of its imports."""
    script = (
        "import resource, sys; from pathlib import Path; from gen.importers.matlab import *; from gen.importers.files import *\n"
        "peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3\n"
        f"before = peak()\ntry:\n    {code}\nexcept UnusableError: pass\nprint(peak() - before)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script, *map(str, arguments)], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    return float(done.stdout)


def test_a_small_file_that_unfolds_to_gigabytes_is_refused_before_it_does(tmp_path):
    """A file of 1 MB took 2 GB; the sizes that a file states are compared with its content."""
    (tmp_path / "bomb.mat").write_bytes(compressed_zeros(1_000_000_000))
    assert refused(tmp_path / "bomb.mat").startswith("is damaged: 97")
    assert "bytes that decompress to 1000000" in refused(tmp_path / "bomb.mat")
    assert peak_of("read_matlab(Path(sys.argv[1]), 'x')", tmp_path / "bomb.mat") < 50
    assert refused(tmp_path / "bomb.mat", "y") == "holds x, not y"
    assert peak_of("read_matlab(Path(sys.argv[1]), 'y')", tmp_path / "bomb.mat") < 50


def test_a_file_beyond_the_limit_is_refused_with_the_limit(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, "file_bytes=20000")
    scipy.io.savemat(tmp_path / "plain.mat", {"x": SIGNAL})
    scipy.io.savemat(tmp_path / "packed.mat", {"x": np.zeros((1, 9000))}, do_compression=True)
    with h5py.File(tmp_path / "large.h5", "w") as file:
        file["x"] = SIGNAL
    np.save(tmp_path / "large.npy", SIGNAL)
    np.savetxt(tmp_path / "large.csv", SIGNAL.T)
    for name in ("plain.mat", "packed.mat", "large.h5"):
        assert "and the limit is 20000; if that is meant, raise it with raceway --limit file_bytes=" in refused(
            tmp_path / name
        )
    for read, name in ((read_numpy, "large.npy"), (read_text, "large.csv")):
        with pytest.raises(UnusableError, match="and the limit is 20000"):
            read(tmp_path / name)


@pytest.mark.parametrize("announced", [8000, 16_000, 7_000_000])
def test_a_length_that_is_not_what_unfolds_is_told(tmp_path, announced):
    (tmp_path / "odd.mat").write_bytes(compressed_zeros(12_000, announced=announced))
    assert "is truncated or damaged: " in refused(tmp_path / "odd.mat")


def test_tens_of_thousands_of_variables_are_no_recording(tmp_path):
    (tmp_path / "many.mat").write_bytes(b"MATLAB 5.0".ljust(124) + b"\0\1IM" + struct.pack("<II", 14, 0) * 50_000)
    assert refused(tmp_path / "many.mat") == "is damaged: more than 10000 variables"


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


def one_chunk_written(file):
    file.create_dataset("x", (40_000_000,), "f8", chunks=(1_000_000,))[0] = 1


def one_chunk_missing(file):
    file.create_dataset("x", (2000,), "f8", chunks=(1000,))[0] = 1


def chunk_of_a_gigabyte(file):
    found = file.create_dataset("x", (10,), "f8", maxshape=(None,), chunks=(125_000_000,), compression="gzip")
    found.id.write_direct_chunk((0,), zlib.compress(bytes(1000)))


def chunk_that_unfolds(file):
    found = file.create_dataset("x", (1000,), "f8", chunks=(1000,), compression="gzip")
    found.id.write_direct_chunk((0,), zlib.compress(bytes(300_000_000), 1))


def deflated_twice(file):
    layout = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    layout.set_chunk((1000,))
    layout.set_deflate(1)
    layout.set_filter(1, 0, (1,))
    space = h5py.h5s.create_simple((1000,))
    found = h5py.h5d.create(file.id, b"x", h5py.h5t.IEEE_F64LE, space, layout)
    found.write_direct_chunk((0,), zlib.compress(zlib.compress(bytes(300_000_000))))


@pytest.mark.parametrize(
    ("write", "reason"),
    [
        (
            lambda file: file.create_dataset("x", (10,), "f8", chunks=(10,)),
            "holds x, but its values were never written",
        ),
        (lambda file: file.create_dataset("x", (10,), "f8"), "holds x, but its values were never written"),
        (one_chunk_missing, "is damaged: parts of its values were never written"),
        (one_chunk_written, "is damaged: parts of its values were never written"),
        (chunk_of_a_gigabyte, " bytes that decompress to 1000000000 are not a recording"),
        (chunk_that_unfolds, "is truncated or damaged: the compressed data goes on after 8000 bytes"),
        (deflated_twice, "uses the HDF5 filters [1, 1]; only deflate and shuffle are read"),
        (lambda file: file.create_dataset("x", data=["a", "b"]), "holds x, but it is not real numbers"),
        (lambda file: file.create_dataset("x", data=[1j]), "holds x, but it is not real numbers"),
        (lambda file: file.create_dataset("x", data=h5py.Empty("f8")), "holds x, but it is not real numbers"),
    ],
)
def test_a_dataset_that_holds_less_than_it_says_is_refused(tmp_path, write, reason):
    with h5py.File(tmp_path / "hostile.mat", "w") as file:
        write(file)
    assert reason in refused(tmp_path / "hostile.mat")
    assert peak_of("read_matlab(Path(sys.argv[1]), 'x')", tmp_path / "hostile.mat") < 100


@pytest.mark.parametrize("dtype", ["f8", ">f4", "i2"])
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"chunks": (1, 700)},
        {"chunks": (1, 700), "compression": "gzip"},
        {"chunks": (1, 700), "compression": "gzip", "shuffle": True},
        {"chunks": (1, 700), "compression": "gzip", "shuffle": True, "fletcher32": True},
        {"chunks": (1, 5000), "maxshape": (None, None), "shuffle": True},
    ],
    ids=str,
)
def test_chunks_unfolded_here_are_those_that_the_library_gives(tmp_path, options, dtype):
    values = (SIGNAL * 1000).astype(dtype)
    with h5py.File(tmp_path / "a.mat", "w") as file:
        file.create_dataset("x", data=values, **options)
    np.testing.assert_array_equal(read_matlab(tmp_path / "a.mat", "x"), values)


def test_a_large_recording_takes_no_more_than_three_times_its_values(tmp_path):
    values = np.random.default_rng(0).normal(size=(1, 5_000_000))  # 40 MB
    scipy.io.savemat(tmp_path / "plain.mat", {"other": values[:, :1000], "x": values})
    scipy.io.savemat(tmp_path / "packed.mat", {"other": values[:, :1000], "x": values}, do_compression=True)
    with h5py.File(tmp_path / "chunks.mat", "w") as file:
        file.create_dataset("x", data=values, chunks=(1, 100_000), compression="gzip", compression_opts=1)
    for name in ("plain", "packed", "chunks"):
        assert peak_of("one_column(read_matlab(Path(sys.argv[1]), 'x')) * 9.81", tmp_path / f"{name}.mat") < 125
    np.save(tmp_path / "a.npy", values)
    assert peak_of("one_column(read_numpy(Path(sys.argv[1]))) * 9.81", tmp_path / "a.npy") < 125


def test_pipes_and_devices_are_refused_and_never_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", tmp_path, type(tmp_path)("/dev/zero")):
        for read in (read_text, read_numpy, lambda path: read_matlab(path, "x")):
            with pytest.raises(OSError, match="is a folder, a pipe or a device"):
                read(path)


def test_an_endless_line_is_refused_and_a_recording_on_one_line_is_not(tmp_path):
    (tmp_path / "line.csv").write_text("1," * 3_000_000)
    with pytest.raises(UnusableError, match="has a line of more than 2000000 characters"):
        read_text(tmp_path / "line.csv")
    (tmp_path / "line.csv").write_text(",".join(f"{value:.6f}" for value in SIGNAL[0]))
    np.testing.assert_allclose(one_column(read_text(tmp_path / "line.csv")), SIGNAL[0], atol=1e-6)


def test_numpy_headers_that_promise_more_than_the_file_holds_are_refused(tmp_path):
    for shape in ("(1000000000000,)", "(-5,)", "(2, 1e3)", "(4611686018427387904, 4)"):
        header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}".ljust(117).encode() + b"\n"
        (tmp_path / "a.npy").write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + bytes(800))
        with pytest.raises(UnusableError, match="is not a readable NumPy file"):
            read_numpy(tmp_path / "a.npy")


def test_names_that_are_no_utf_8_are_imported_with_their_bytes_written_out(tmp_path):
    folder = os.fsencode(tmp_path) + b"/Pr\xfcfstand\n"
    os.mkdir(folder)  # noqa: PTH102 - a name in bytes
    source = tmp_path / os.fsdecode(b"Pr\xfcfstand\n")
    scipy.io.savemat(source / "105_0.mat", {"X105_DE_time": SIGNAL.T, "X105RPM": 1797})
    np.save(source / "a.npy", SIGNAL)
    done = import_cwru(tmp_path, tmp_path / "cwru", window=0.1)
    assert done.records == 2
    (tmp_path / "mapping.yaml").write_text(
        "{bearing: '6205', unit: g, sample_rate_hz: 2000, shaft_rpm: 1500, fault: inner, specimen: A, files: [{path: '*/a.npy'}]}"
    )
    assert import_generic(tmp_path / "mapping.yaml", tmp_path / "own").records == 3
    for name in ("cwru", "own"):
        assert validate_corpus(tmp_path / name) == []
        (tmp_path / name / "README.md").read_text(encoding="utf-8")


def test_a_pattern_that_names_too_many_files_is_refused(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, "recording_files=20")
    for number in range(15):
        np.save(tmp_path / f"{number:02d}.npy", SIGNAL)
    mapping = (
        "{bearing: '6205', unit: g, sample_rate_hz: 2000, shaft_rpm: 1500, fault: inner, specimen: A, files: [%s]}"
    )
    (tmp_path / "mapping.yaml").write_text(mapping % "{path: '*.npy'}, {path: '*.npy'}")
    with pytest.raises(
        CorpusError, match=r"files\[1\]\.path: \*\.npy and the patterns before match 30 files, and the limit is 20;"
    ):
        import_generic(tmp_path / "mapping.yaml", tmp_path / "corpus")
    for number in range(15, 25):
        (tmp_path / f"{number}.mat").write_bytes(b"x")
    monkeypatch.setenv(VARIABLE, "recording_files=9")
    with pytest.raises(CorpusError, match="holds 10 files, and the limit is 9;"):
        import_cwru(tmp_path, tmp_path / "corpus")


HOSTILE = "</h1><script>alert(1)</script>| [x](javascript:y) ![p](http://z/p.png)\\n\\n# Heading\\n[r]: http://w `code` \\\\[q](v)"


def card_of(folder, title, channel, bearing, name):
    """Data card of an imported corpus with texts of a mapping."""
    folder.mkdir()
    np.save(folder / "a.npy", SIGNAL)
    (folder / "mapping.yaml").write_text(
        f'title: "{title}"\norigin: "{title}"\nchannel: "{channel}"\n'
        f"bearing: {{designation: '{bearing}', n_balls: 9, pitch_diameter_mm: 39, ball_diameter_mm: 8}}\n"
        "unit: g\nsample_rate_hz: 2000\nshaft_rpm: 1500\nfault: inner\nspecimen: A\n"
        f"files: [{{path: a.npy}}, {{path: '{name}'}}]\n"
    )
    done = import_generic(folder / "mapping.yaml", folder / "corpus")
    assert validate_corpus(done.directory) == []
    return (done.directory / "README.md").read_text()


def test_text_from_a_mapping_stays_text_in_the_data_card(tmp_path):
    plain = card_of(tmp_path / "plain", "Title", "sensor", "6205", "missing.npy")
    card = card_of(tmp_path / "hostile", HOSTILE, "<b>|`[x](y)", "<i>|", "<img src=x>[l](m).npy")
    for mark in ("<", ">", "](", "]:", "`", "|", "\n#", "\n```"):
        assert card.count(mark) == plain.count(mark), mark
    assert card.startswith("# (/h1)(script)alert(1)(/script)/ [x] (javascript:y)")
