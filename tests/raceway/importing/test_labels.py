"""Recordings described by a table of labels: formats, facts, joined files, channels, and other sample rates."""

import math
import re

import h5py
import numpy as np
import pytest
import scipy.io
import scipy.signal
from scipy.io import wavfile

from gen.corpus import FAULTS, UNKNOWN, UNKNOWN_CODE, open_corpus, validate_corpus
from gen.physics.bearing_text import Geometry
from gen.recipe.keys import recipe_keys
from gen.support.units import unit_suffix
from raceway.importing import import_generic
from raceway.importing.label_keys import Labels
from raceway.importing.resampling import resample
from raceway.sharing.card.card_page import data_card
from tests.labels import import_labelled, write_labels
from tests.raceway.importing.file_writers import excel

FS = 2000
G = 9.80665
SIGNAL = np.random.default_rng(1).normal(size=2100)
COMMON = {"bearing": "6205", "unit": "m/s2", "sample_rate_hz": FS, "shaft_rpm": 1500, "fault": "inner", "specimen": "A"}
STATED = {key: value for key, value in COMMON.items() if key != "sample_rate_hz"}


def noise(seed, size=1100):
    return np.random.default_rng(seed).normal(size=size)


def imported(folder, *rows, **common):
    done = import_labelled(folder, rows, **(common or COMMON))
    assert validate_corpus(done.path) == []
    with open_corpus(done.path) as corpus:
        return done, corpus.load()


def signals(corpus):
    return corpus.acceleration.values[:, 0].reshape(-1)


def write_matlab_7_3(path):
    with h5py.File(path, "w", userblock_size=512) as file:
        file["vibration"] = SIGNAL[np.newaxis]
    with path.open("r+b") as stream:
        stream.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")


WRITERS = {
    "a.mat": (lambda path: scipy.io.savemat(path, {"vibration": SIGNAL}), {"variable": "vibration"}),
    "field.mat": (lambda path: scipy.io.savemat(path, {"run": {"fs": 2000, "x": SIGNAL}}), {"variable": "run.x"}),
    "table.mat": (
        lambda path: scipy.io.savemat(path, {"x": np.stack([0 * SIGNAL, SIGNAL])}),
        {"variable": "x", "column": 1},
    ),
    "7_3.mat": (write_matlab_7_3, {"variable": "v*n"}),
    "a.npy": (lambda path: np.save(path, SIGNAL), {}),
    "a.csv": (
        lambda path: np.savetxt(path, np.c_[0 * SIGNAL, SIGNAL], delimiter=",", header="ay,ax", comments=""),
        {"column": "ax"},
    ),
    "titled.txt": (
        lambda path: np.savetxt(path, np.c_[SIGNAL, SIGNAL], delimiter="; ", header="run 7\nstarted late"),
        {"column": 1},
    ),
    "marked.dat": (
        lambda path: np.savetxt(path, np.c_[SIGNAL, SIGNAL], delimiter="|"),
        {"delimiter": "|", "column": 0},
    ),
    "a.xlsx": (excel(["x", "y"], 0 * SIGNAL, SIGNAL), {"variable": "Data", "column": "y"}),
    "a.wav": (lambda path: wavfile.write(path, FS, np.c_[0 * SIGNAL, SIGNAL]), {"column": 1}),
}


def test_every_format_gives_the_numbers_that_were_written(tmp_path):
    for name, (write, _) in WRITERS.items():
        write(tmp_path / name)
    done, corpus = imported(tmp_path, *({"path": name, **keys} for name, (_, keys) in WRITERS.items()))
    assert (done.recordings, done.records, done.skipped) == (len(WRITERS), 2 * len(WRITERS), ())
    for values in signals(corpus).reshape(len(WRITERS), -1):
        np.testing.assert_array_equal(values, SIGNAL[:2000].astype(np.float32))


def test_a_row_overrides_what_all_rows_share_and_units_become_si(tmp_path):
    for name in "ab":
        np.save(tmp_path / f"{name}.npy", SIGNAL)
    own = {"unit": "g", "shaft_rpm": 1.2e3, "load_n": 50, "width_mm": 0.1, "depth_um": 20, "angle_deg": -90}
    geometry = "n_balls=8,pitch_diameter_mm=40,ball_diameter_mm=8,contact_angle_deg=60"
    _, corpus = imported(
        tmp_path,
        {"path": "a.npy", "fault": "healthy", "specimen": "007"},
        {"path": "b.npy", **own, "bearing": geometry},
        **COMMON, title="Pump 7", channel="drive side",
    )  # fmt: skip
    last = corpus.isel(record=-1)
    assert [FAULTS[fault] for fault in corpus.fault.values] == ["healthy", "healthy", "inner", "inner"]
    assert float(last.acceleration[0, 0]) == pytest.approx(SIGNAL[1000] * G, rel=1e-6)
    assert (float(last.shaft_rate), float(last["load"])) == (20.0, 50.0)
    assert float(last.width) == pytest.approx(1e-4)
    assert float(last.depth) == pytest.approx(2e-5)
    assert float(last.angle) == pytest.approx(-math.pi / 2)
    assert float(last.bpfo) == pytest.approx(8 / 2 * (1 - 0.2 * 0.5))
    assert corpus.attrs["title"] == "Pump 7"
    assert corpus.channel.values.tolist() == ["drive side"]
    assert corpus.n_spalls.values.tolist() == [0, 0, 1, 1]


def test_every_class_can_be_told(tmp_path):
    np.save(tmp_path / "a.npy", np.stack([SIGNAL] * 8))
    classes = (*FAULTS, UNKNOWN)
    rows = [{"path": "a.npy", "column": n, "fault": fault, "specimen": n} for n, fault in enumerate(classes)]
    _, corpus = imported(tmp_path, *rows)
    assert corpus.fault.values[::2].tolist() == [*range(len(FAULTS)), UNKNOWN_CODE]
    assert corpus.source.values[::2].tolist() == [f"a.npy:{n}#0" for n in range(len(classes))]


def test_specimens_belong_to_their_rig_and_a_file_that_is_listed_again_is_skipped(tmp_path):
    for place in ("one/a", "one/b", "two/a"):
        (tmp_path / place).parent.mkdir(exist_ok=True)
        np.save(tmp_path / f"{place}.npy", SIGNAL)
    north, south = ({"path": "one/a.npy", "rig": "north"}, {"path": "one/b.npy", "rig": "north"}), {"rig": "south"}
    done, corpus = imported(tmp_path, *north, south | {"path": "two/a.npy"}, {"path": "./one/a.npy", "rig": "north"})
    assert corpus.rig.values[::2].tolist() == [0, 0, 1]
    assert corpus.specimen.values[::2].tolist() == [0, 0, 1]
    assert corpus.recording.values[::2].tolist() == [0, 1, 2]
    assert done.skipped == (f"one/a.npy: is listed again in {tmp_path / 'labels.csv'}, row 5; skipped.",)


def test_recordings_of_another_set_have_another_identity_although_their_files_have_the_same_names(tmp_path):
    identities = []
    for folder, signal in (("one", SIGNAL), ("same", SIGNAL), ("other", -SIGNAL)):
        (tmp_path / folder).mkdir()
        np.savetxt(tmp_path / folder / "a.csv", signal)
        _, corpus = imported(tmp_path / folder, {"path": "a.csv"})
        identities.append(corpus["identity"].values.tolist())
    first, same, other = identities
    assert first == same
    assert not set(first) & set(other)
    assert {text.split("/", 1)[1] for text in first + other} == {"0/0/0/-1"}


def test_the_card_says_where_labels_and_units_come_from(tmp_path):
    for name in "ab":
        np.save(tmp_path / f"{name}.npy", noise(0))
    done, _ = imported(tmp_path, {"path": "a.npy", "load_n": 5}, {"path": "b.npy", "specimen": "B", "unit": "g"})
    card = data_card(done.path)
    for sentence in (
        "Load (N): given for each file.", "Class: given as inner.", "Shaft speed (rpm): given as 1500.",
        "Unit: m/s^2 (a.npy).", "Unit: g, 1 g = 9.80665 m/s^2 (b.npy).",
        "Bearing: 6205, geometry from the catalogue: 9 balls of 7.94 mm on 39.04 mm; BPFO 3.585, BPFI",
    ):  # fmt: skip
        assert f"- {sentence}" in card


def test_the_card_says_which_speeds_are_measured(tmp_path):
    for name in "ab":
        scipy.io.savemat(tmp_path / f"{name}.mat", {"x": noise(0), "n": np.full(noise(0).size, 1500.0)})
    course = {"path": "a.mat", "variable": "x", "speed_column": "n", "speed_unit": "rpm", "shaft_rpm": None}
    plain = {"path": "b.mat", "variable": "x", "shaft_rpm": 1480}
    for rows, sentences in (
        ((course,), {"mean of the course in n."}),
        ((course, plain), {"given as 1480.", "mean of the course in n (a.mat)."}),
    ):
        table = write_labels(tmp_path, rows, **COMMON | {"shaft_rpm": None})
        done = import_generic(table, tmp_path / f"{len(rows)}.nc", window=0.02)
        told = re.findall(r"- Shaft speed \(rpm\): (.*)", data_card(done.path))
        assert {*told} == sentences


def test_files_of_one_recording_are_joined_in_the_order_of_their_rows(tmp_path):
    whole = noise(0, 3300)
    for name, part in (("b9", whole[:1100]), ("a1", whole[1100:2200]), ("a2", whole[2200:])):
        scipy.io.savemat(tmp_path / f"{name}.mat", {name: part})
    np.save(tmp_path / "alone.npy", noise(1))
    rows = [{"path": f"{name}.mat", "variable": name, "recording": "r"} for name in ("b9", "a1", "a2")]
    done, corpus = imported(tmp_path, *rows[:2], {"path": "alone.npy"}, rows[2])
    assert (done.recordings, done.records) == (2, 4)
    np.testing.assert_array_equal(signals(corpus)[:3000], whole[:3000].astype("f4"))
    assert corpus.source.values[0] == "b9.mat:b9..a2.mat:a2#0"


def test_a_recording_with_an_unusable_part_is_skipped_whole(tmp_path):
    for name in ("1", "3"):
        np.save(tmp_path / f"{name}.npy", noise(0))
    (tmp_path / "2.npy").write_bytes(b"")
    done, _ = imported(tmp_path, *({"path": f"{n}.npy", "recording": "r"} for n in (1, 2)), {"path": "3.npy"})
    assert done.skipped == ("1.npy..2.npy: is empty (0 bytes); copy it again; skipped.",)


@pytest.mark.parametrize(
    ("keys", "factor"),
    [
        ({"unit": "V", "sensitivity_mv_per_g": 100}, 10 * G),
        ({"unit": "V", "sensitivity_mv_per_m_s2": 10}, 100),
        ({"unit": "mV", "sensitivity_mv_per_m_s2": 10}, 0.1),
        ({"unit": "g"}, G),
    ],
)
def test_volts_become_accelerations(tmp_path, keys, factor):
    np.save(tmp_path / "a.npy", noise(0))
    done, corpus = imported(tmp_path, {"path": "a.npy", **keys})
    np.testing.assert_allclose(signals(corpus), noise(0)[:1000] * factor, rtol=1e-6)
    assert done.warnings == ()


CHANNELS = [{"name": "drive end", "column": "ax"},
            {"name": "fan end", "column": "ay", "unit": "V", "sensitivity_mv_per_g": 50}]  # fmt: skip


def test_several_channels_have_names_columns_and_units_of_their_own(tmp_path):
    np.savetxt(tmp_path / "a.csv", np.c_[noise(0), noise(1)], delimiter=",", header="ax,ay", comments="")
    done, corpus = imported(tmp_path, {"path": "a.csv"}, **COMMON, channels=CHANNELS)
    assert corpus.channel.values.tolist() == ["drive end", "fan end"]
    expected = np.stack([noise(0)[:1000], noise(1)[:1000] * 20 * G])
    np.testing.assert_allclose(corpus.acceleration.values[0], expected, rtol=1e-6)
    card = data_card(done.path)
    assert "- Unit of channel fan end: V, 5.09858 mV per m/s^2." in card
    assert "channels drive end, fan end, in m/s^2." in card


def test_recordings_at_other_rates_are_resampled_if_asked_and_skipped_otherwise(tmp_path):
    wavfile.write(tmp_path / "a.wav", FS, noise(0))
    wavfile.write(tmp_path / "b.wav", 2 * FS, noise(1, 4000))
    rows = [{"path": "a.wav"}, {"path": "b.wav"}]
    done, _ = imported(tmp_path, *rows, **STATED)
    assert done.skipped == (
        "b.wav: is at 4000 Hz and the corpus at 2000 Hz; give resample_hz for all files, or make a corpus of each; skipped.",
    )
    done = import_generic(tmp_path / "labels.csv", tmp_path / "two", common={"resample_hz": FS})
    with open_corpus(tmp_path / "two") as corpus:
        expected = scipy.signal.resample_poly(noise(1, 4000), 1, 2)[:1000]
        np.testing.assert_allclose(corpus.acceleration.values[1, 0], expected, rtol=1e-5, atol=1e-6)
    (told,) = done.warnings
    assert told.startswith("b.wav: resampled from 4000 to 2000 Hz with scipy.signal.resample_poly(x, 1, 2), which ")
    assert told.endswith("attenuates above 840 Hz: compare below that frequency.")


@pytest.mark.parametrize(("fs", "wanted"), [(20_001, 20_000), (20_000, 999), (97_656, 12_000)])
def test_a_ratio_of_rates_is_rounded_by_less_than_6e_5(fs, wanted):
    up, down = map(int, re.findall(r"x, (\d+), (\d+)", resample(np.zeros(2), fs, wanted)[1])[0])
    assert abs(up / down * fs / wanted - 1) < 6e-5


def test_the_folder_of_the_recordings_can_be_another_than_that_of_the_table(tmp_path):
    for name in ("data", "elsewhere"):
        (tmp_path / name).mkdir()
    np.save(tmp_path / "data" / "a.npy", noise(0))
    table = write_labels(tmp_path / "elsewhere", [{"path": "a.npy"}], **COMMON)
    done = import_generic(table, tmp_path / "corpus", folder=tmp_path / "data")
    assert (done.records, validate_corpus(done.path)) == (1, [])


def test_whole_numbers_and_impossible_levels_are_doubted(tmp_path):
    np.save(tmp_path / "counts.npy", np.round(noise(0) * 500))
    np.save(tmp_path / "quiet.npy", noise(1) * 1e-6)
    done, _ = imported(tmp_path, {"path": "counts.npy"}, {"path": "quiet.npy"}, **COMMON | {"unit": "g"})
    assert done.warnings == (
        "counts.npy: it holds whole numbers, as the counts of a converter are, and the unit is taken as g; check the unit.",
        "quiet.npy: its rms is 9.7e-06 m/s^2, and machines show 0.001 to 10000 m/s^2; check the unit, which is taken as g.",
    )


def test_labels_and_recipes_spell_a_quantity_alike():
    in_recipes = {key.key.rpartition(".")[2] for key in recipe_keys()}
    keys = {*Labels.model_fields, *Geometry.model_fields}
    quantities = {key for key in keys if unit_suffix(key) or key.startswith("n_")}
    assert quantities > {"shaft_rpm", "depth_um", "n_spalls", "ball_diameter_mm"}
    assert quantities - in_recipes == {
        "sensitivity_mv_per_m_s2", "resample_hz", "nominal_rpm", "age_s", "rul_s", "long_rate_hz"
    }  # fmt: skip


def test_the_rate_of_long_files_is_used_and_checked_like_that_of_all(tmp_path):
    wavfile.write(tmp_path / "a.wav", 44_100, SIGNAL)
    np.savetxt(tmp_path / "a.csv", SIGNAL, header="fs = 12 kHz\nx [m/s2]")
    scipy.io.savemat(tmp_path / "a.mat", {"x": SIGNAL, "speed": np.full(SIGNAL.size, 1500.0)})
    long = STATED | {"long_rate_hz": 48_000, "long_samples": SIGNAL.size - 1}
    done = import_labelled(tmp_path, [{"path": "a.wav"}, {"path": "a.csv"}], window=0.02, **long)
    with open_corpus(done.path) as corpus:
        assert set(corpus.sample_rate.values) == {48_000}
    assert f"a.wav: its {SIGNAL.size} samples are taken as recorded at 48000 Hz." in done.warnings
    assert "a.csv: is at 12000 Hz by its header, and 48000 Hz are given; correct what is given" in done.skipped[0]
    course = {"path": "a.mat", "variable": "x", "speed_column": "speed", "speed_unit": "rpm", "shaft_rpm": None}
    table = write_labels(tmp_path, [course], **COMMON | long | {"shaft_rpm": None, "long_samples": SIGNAL.size})
    with open_corpus(import_generic(table, tmp_path / "b.nc").path) as corpus:
        assert set(corpus.sample_rate.values) == {FS}
