"""One recording of the user: every format gives the numbers that were written, and each error is one sentence."""

import re
import struct

import h5py
import numpy as np
import pytest
import scipy.io
from scipy.io import wavfile

from gen.support.errors import CorpusError
from raceway.importing import read_signal

X = np.random.default_rng(3).uniform(-0.9, 0.9, 600)


def write_matlab_7_3(path):
    with h5py.File(path, "w") as file:
        file["run/x"] = X[np.newaxis]
        file["rpm"] = np.array([[1500.0]])
        file["notes"] = np.full((200, 1), ord("a"), "u2")
        file["notes"].attrs["MATLAB_class"] = np.bytes_("char")


FILES = {
    "only_variable.mat": lambda path: scipy.io.savemat(path, {"rpm": 1500, "x": X}),
    "only_field.mat": lambda path: scipy.io.savemat(path, {"bearing": {"sr": 12000, "gs": X}, "name": "a"}),
    "level_7_3.mat": write_matlab_7_3,
    "column.csv": lambda path: np.savetxt(path, X, fmt="%.17g"),
    "values.npy": lambda path: np.save(path, X),
    "float.wav": lambda path: wavfile.write(path, 12_000, X),
}


@pytest.mark.parametrize("name", FILES)
def test_the_only_signal_of_a_file_is_read_without_being_named(tmp_path, name):
    FILES[name](tmp_path / name)
    signal = read_signal(tmp_path / name)
    np.testing.assert_array_equal(signal.values, X)
    assert signal.fs == (12_000 if name in ("float.wav", "only_field.mat") else None)
    assert signal.warnings == (f"{name}: it states no unit, and m/s2 is assumed.",)


def wav(path, samples, rate=8000, *, extensible=False):
    """Write PCM of 24 bits, which SciPy does not write; ``samples`` of shape (time, channel)."""
    count, channels = samples.shape
    data = samples.astype("<i4").reshape(-1, 1).view(np.uint8)[:, :3].tobytes()
    described = struct.pack("<HHIIHH", 1, channels, rate, 3 * channels * rate, 3 * channels, 24)
    if extensible:
        described = struct.pack("<H", 0xFFFE) + described[2:] + struct.pack("<HHI", 22, 24, 0)
        described += struct.pack("<H", 1) + bytes.fromhex("000000001000800000aa00389b71")
    note = b"LIST" + struct.pack("<I", 3) + b"abc\0"
    chunks = b"fmt " + struct.pack("<I", len(described)) + described + note
    chunks += b"data" + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2)
    path.write_bytes(b"RIFF" + struct.pack("<I", 4 + len(chunks)) + b"WAVE" + chunks)
    return count


@pytest.mark.parametrize(("dtype", "scale", "silence"), [("u1", 128, 128), ("i2", 2**15, 0), ("i4", 2**31, 0)])
def test_integers_of_a_wav_file_are_shares_of_its_full_scale(tmp_path, dtype, scale, silence):
    counts = np.round(X * scale) + silence
    wavfile.write(tmp_path / "a.wav", 44_100, counts.astype(dtype))
    signal = read_signal(tmp_path / "a.wav")
    np.testing.assert_array_equal(signal.values, (counts - silence) / scale)
    assert signal.fs == 44_100
    assert signal.warnings == (
        "a.wav: its header states 44100 Hz, as for sound; give the rate of the recording if it is another.",
        "a.wav: it holds integers, whose full scale is taken as 1, so that its level is not absolute.",
    )


@pytest.mark.parametrize("extensible", [False, True])
def test_24_bits_and_a_chosen_channel_of_stereo_are_read(tmp_path, extensible):
    counts = np.round(np.stack([X, -X / 2], axis=1) * 2**23)
    wav(tmp_path / "a.wav", counts, extensible=extensible)
    for column in (0, 1):
        np.testing.assert_array_equal(read_signal(tmp_path / "a.wav", column=column).values, counts[:, column] / 2**23)
    assert read_signal(tmp_path / "a.wav", column=0).fs == 8000
    with pytest.raises(
        CorpusError, match=re.escape("a.wav: has 2 columns (0, 1) and none is chosen; choose one with column.")
    ):
        read_signal(tmp_path / "a.wav")


def test_a_given_rate_is_used_and_a_different_one_in_the_file_is_told(tmp_path):
    wavfile.write(tmp_path / "a.wav", 12_000, X)
    np.save(tmp_path / "a.npy", X)
    assert read_signal(tmp_path / "a.npy", rate=5000.0).fs == 5000
    signal = read_signal(tmp_path / "a.wav", rate=5000.0, unit="g")
    assert signal.fs == 5000
    assert signal.warnings == ("a.wav: is at 12000 Hz by its header; the given 5000 Hz are used.",)


DOUBTFUL = {
    "counts": (np.round(X * 2000), "it holds whole numbers, as the counts of a converter are"),
    "quiet": (
        X * 1e-5,
        "its rms is 5.1e-06 m/s^2, and machines show 0.001 to 10000 m/s^2; check the unit, which is taken as m/s2",
    ),
    "loud": (X * 1e5 + 0.5, "its rms is 5.1e+04 m/s^2"),
}


@pytest.mark.parametrize(("values", "doubt"), DOUBTFUL.values(), ids=DOUBTFUL)
def test_values_that_no_accelerometer_gives_are_doubted(tmp_path, values, doubt):
    np.save(tmp_path / "a.npy", values)
    (told,) = read_signal(tmp_path / "a.npy", unit="m/s2").warnings
    assert doubt in told


def test_whole_numbers_of_a_small_range_are_not_doubted(tmp_path):
    np.save(tmp_path / "a.npy", np.arange(500) % 90 - 45.0)
    assert read_signal(tmp_path / "a.npy", unit="m/s2").warnings == ()


def cut_wav(path):
    wavfile.write(path, 8000, X)
    path.write_bytes(path.read_bytes()[:-8])


def without_length(path):
    wavfile.write(path, 8000, X)
    content = bytearray(path.read_bytes())
    content[4:8] = bytes(4)
    path.write_bytes(content)


def with_encoding(number):
    def write(path):
        wavfile.write(path, 8000, np.zeros(9, "i2"))
        content = bytearray(path.read_bytes())
        content[20:22] = struct.pack("<H", number)
        path.write_bytes(content)

    return write


REFUSED = {
    "no_wav": ("a.wav", lambda path: path.write_bytes(b"1" * 99), {}, "not a WAV file (File format b'1111' not understood."),
    "cut_wav": ("a.wav", cut_wav, {}, "is truncated, damaged or not a WAV file (Reached EOF prematurely;"),
    "no_samples": ("a.wav", lambda path: path.write_bytes(b"RIFF1234WAVE"), {}, "not a WAV file (Unexpected end of file.)."),
    "no_length": ("a.wav", without_length, {}, "a.wav: is truncated, damaged or not a WAV file."),
    "compressed": ("a.wav", with_encoding(85), {}, "(Unknown wave file format: MPEGLAYER3. Supported formats: PCM, IEEE_FLOAT)."),
    "half_float": ("a.wav", with_encoding(3), {}, "(Unsupported bit depth: the WAV file has 16-bit floating-point data.)."),
    "no_such_variable": (
        "a.mat", FILES["only_variable.mat"], {"variable": "y*"}, "holds rpm, x, and no variable y*; name one with variable.",
    ),
    "no_voltage": ("a.npy", FILES["values.npy"], {"sensitivity": 100.0}, "a sensitivity is given and the unit is m/s2, not V or mV;"),
}  # fmt: skip


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
@pytest.mark.parametrize("header", ["", "Zeit;Beschl. [m/s²]\n"])
def test_a_text_is_read_in_the_encodings_that_spreadsheets_write(tmp_path, encoding, header):
    (tmp_path / "a.csv").write_text(header + "".join(f"{i};{x!r}\n" for i, x in enumerate(X.tolist())), encoding)
    column = "Beschl. [m/s²]" if header else 1
    np.testing.assert_array_equal(read_signal(tmp_path / "a.csv", column=column).values, X)


@pytest.mark.parametrize(("name", "write", "keys", "sentence"), REFUSED.values(), ids=REFUSED)
def test_a_recording_that_cannot_be_read_is_named_with_its_reason(tmp_path, name, write, keys, sentence):
    if write is not None:
        write(tmp_path / name)
    with pytest.raises(CorpusError) as refused:
        read_signal(tmp_path / name, **keys)
    assert str(refused.value).startswith(f"{tmp_path / name}: ")
    assert sentence in str(refused.value)
    assert "\n" not in str(refused.value)
