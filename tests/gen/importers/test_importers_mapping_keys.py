"""Facts of a recording from its path, its file and tables; joined files, sensitivities, channels and resampling."""

import re

import numpy as np
import pytest
import scipy.io
import scipy.signal
from hypothesis import given
from hypothesis import strategies as st
from scipy.io import wavfile

from gen.corpus import FAULTS, open_corpus, validate_corpus
from gen.importers import import_generic
from gen.importers.paths import match_path, parse_pattern
from gen.importers.resampling import resample
from tests.gen.importers.test_importers_generic import COMMON, imported

FS = 2000
G = 9.80665
TOP = f"bearing: '6205'\nunit: m/s2\nsample_rate_hz: {FS}\n"


def noise(seed, size=1100):
    return np.random.default_rng(seed).normal(size=size)


def classes(corpus):
    return [FAULTS[code] for code in corpus.fault.values]


def test_groups_of_the_path_tell_class_speed_load_and_specimen(tmp_path):
    for number, name in enumerate(("N_800_5", "outer_race_1200.5_5", "N_800_7", "X_800_7", "N_fast_7")):
        (tmp_path / "A1").mkdir(exist_ok=True)
        np.save(tmp_path / "A1" / f"{name}kN.npy", noise(number))
    done, corpus = imported(
        tmp_path,
        TOP + "fault: {N: healthy, outer_race: outer}\nload_n: {times: 1000}\nwidth_mm: 0.5\n"
        "files: [{path: '{rig}/{fault}_{shaft_rpm}_{load_n}kN.npy', specimen: '{rig} {fault} {load_n}'}]\n",
    )
    assert classes(corpus) == ["healthy", "healthy", "outer"]
    np.testing.assert_allclose(corpus.shaft_rate.values * 60, [800, 800, 1200.5], rtol=1e-14)
    assert corpus["load"].values.tolist() == [5000, 7000, 5000]
    assert corpus.width.values.tolist() == [0, 0, 5e-4]  # a key of a spall is for files with a spall
    assert corpus.specimen.values.tolist() == [0, 1, 2]
    assert done.skipped == tuple(
        f"A1/{name}_7kN.npy: does not fit {{rig}}/{{fault}}_{{shaft_rpm}}_{{load_n}}kN.npy with shaft_rpm a number and "
        f"load_n a number and fault one of N, outer_race; skipped."
        for name in ("N_fast", "X_800")
    )
    card = (done.path / "README.md").read_text()
    assert "- Class: from the path, N is healthy, outer_race is outer." in card
    assert "- Load (N): from the path, {rig}/{fault}_{shaft_rpm}_{load_n}kN.npy, times 1000." in card
    assert "- Unit: m/s^2." in card
    assert "- Bearing: 6205, geometry from the catalogue: 9 balls of 7.94 mm on 39.04 mm; BPFO 3.585," in card


def test_a_table_gives_any_key_and_a_path_value_goes_before_one_for_all(tmp_path):
    for name in ("007_0", "014_1"):
        np.save(tmp_path / f"{name}.npy", noise(0))
    _, corpus = imported(
        tmp_path,
        COMMON + "shaft_rpm: {0: 1797, 1: 1772}\nwidth_mm: {'007': 0.18, '014': 0.36}\n".replace("shaft_rpm", "load_n")
        + "files: [{path: '{width_mm}_{load_n}.npy'}]\n",
    )  # fmt: skip
    assert corpus["load"].values.tolist() == [1797, 1772]
    np.testing.assert_allclose(corpus.width.values, [1.8e-4, 3.6e-4])


def test_speed_load_and_rate_are_read_from_the_file_and_variables_by_a_pattern(tmp_path):
    for number, rpm in ((97, 1796.0), (105, 1797.0)):
        held = {f"X{number:03d}_DE_time": noise(number), f"X{number:03d}_FE_time": noise(1), "rate": rpm / 60, "fs": FS}
        scipy.io.savemat(tmp_path / f"{number}.mat", held)
    scipy.io.savemat(tmp_path / "106.mat", {"X106_DE_time": noise(1), "rate": -3.0, "fs": FS})
    scipy.io.savemat(tmp_path / "107.mat", {"X107_DE_time": noise(1), "fs": FS})
    done, corpus = imported(
        tmp_path,
        "bearing: '6205'\nunit: g\nfault: inner\nspecimen: A\nvariable: X*_DE_time\nsample_rate_hz: {variable: fs}\n"
        "shaft_rpm: {variable: rate, times: 60}\nfiles: [{path: '*.mat'}]\n",
    )
    np.testing.assert_allclose(sorted(corpus.shaft_rate.values * 60), [1796, 1797], rtol=1e-14)
    found = {
        text.split(".")[0]: signal
        for text, signal in zip(corpus.source.values, corpus.acceleration.values[:, 0], strict=True)
    }
    np.testing.assert_array_equal(found["97"], (noise(97)[:1000] * G).astype("f4"))
    assert done.skipped[0].startswith("106.mat:X*_DE_time: shaft_rpm: -180.0 is not allowed here; it must be greater")
    assert done.skipped[1] == "107.mat:X*_DE_time: holds X107_DE_time, fs, not rate; skipped."
    assert "variable rate of each file, times 60." in (done.path / "README.md").read_text()


def test_any_number_can_be_read_from_the_file(tmp_path):
    scipy.io.savemat(tmp_path / "a.mat", {"x": noise(1), "spall": {"width": 0.7, "count": 2}})
    keys = "variable: x, width_mm: {variable: spall.width, times: 2}, n_spalls: {variable: spall.count}"
    _, corpus = imported(tmp_path, f"{COMMON}files: [{{path: a.mat, {keys}}}]\n")
    np.testing.assert_allclose(corpus.width.values, 1.4e-3)
    assert corpus.n_spalls.values.tolist() == [2]


def test_a_group_can_name_the_variable(tmp_path):
    scipy.io.savemat(tmp_path / "98.mat", {"X098": noise(1), "X097": noise(2)})
    _, corpus = imported(tmp_path, COMMON + "files: [{path: '{number}.mat', variable: 'X0{number}'}]\n")
    np.testing.assert_array_equal(corpus.acceleration.values[0, 0], noise(1)[:1000].astype("f4"))


def test_files_of_one_recording_are_joined_in_the_order_of_their_numbers(tmp_path):
    whole = noise(0, 3300)
    for number, part in ((2, whole[:1100]), (9, whole[1100:2200]), (10, whole[2200:])):
        np.save(tmp_path / f"N_{number}.npy", part)
    np.save(tmp_path / "O_1.npy", noise(1))
    done, corpus = imported(
        tmp_path,
        TOP + "shaft_rpm: 1500\nfault: {N: healthy, O: outer}\nspecimen: '{fault}'\nrecording: '{fault}'\n"
        "files: [{path: '{fault}_*.npy'}]\n",
    )
    assert (done.recordings, done.records) == (2, 4)
    joined = corpus.acceleration.values[:3, 0].reshape(-1)
    np.testing.assert_array_equal(joined, whole[:3000].astype("f4"))
    assert corpus.source.values.tolist() == [*(f"N_2.npy..N_10.npy#{start}" for start in (0, 1000, 2000)), "O_1.npy#0"]


def test_joined_files_can_name_their_variables_differently(tmp_path):
    whole = noise(0, 2200)
    scipy.io.savemat(tmp_path / "a1.mat", {"X1": whole[:1100]})
    scipy.io.savemat(tmp_path / "a2.mat", {"X2": whole[1100:]})
    files = "files: [{path: '{run}{number}.mat', variable: 'X{number}', recording: '{run}'}]\n"
    done, corpus = imported(tmp_path, COMMON + files)
    assert done.recordings == 1
    np.testing.assert_array_equal(corpus.acceleration.values[:, 0].reshape(-1), whole[:2000].astype("f4"))


def test_the_card_names_the_paths_of_a_fact_that_not_all_sections_share(tmp_path):
    for name in "ab":
        np.save(tmp_path / f"{name}.npy", noise(0))
    done, _ = imported(tmp_path, COMMON + "files: [{path: a.npy}, {path: b.npy, load_n: 5, specimen: B}]\n")
    card = (done.path / "README.md").read_text()
    assert "- Load (N): given as 5 (b.npy)." in card
    assert "- Shaft speed (rpm): given as 1500." in card


def test_files_of_several_sections_are_joined_in_the_order_of_the_sections(tmp_path):
    whole = noise(0, 2200)
    np.save(tmp_path / "b9.npy", whole[:1100])
    np.save(tmp_path / "a1.npy", whole[1100:])
    _, corpus = imported(tmp_path, COMMON + "recording: r\nfiles: [{path: b9.npy}, {path: a1.npy}]\n")
    np.testing.assert_array_equal(corpus.acceleration.values[:, 0].reshape(-1), whole[:2000].astype("f4"))


def test_files_that_hold_different_speeds_are_not_joined(tmp_path):
    for name, rpm in (("a1", 1500.0), ("a2", 1520.0), ("b1", 1500.0), ("b2", 1800.0)):
        scipy.io.savemat(tmp_path / f"{name}.mat", {"x": noise(0), "rpm": rpm})
    keys = "variable: x, shaft_rpm: {variable: rpm}, recording: '{run}'"
    common = COMMON.replace("shaft_rpm: 1500\n", "")
    done, corpus = imported(tmp_path, f"{common}files: [{{path: '{{run}}?.mat', {keys}}}]\n")
    reason = "is joined of files at 1500 to 1800 rpm; give each recording a name of its own; skipped."
    assert done.skipped == (f"b1.mat:x..b2.mat:x: {reason}",)
    assert corpus.shaft_rate.values.tolist() == [25.0, 25.0]


def test_a_recording_with_an_unusable_part_is_skipped_whole(tmp_path):
    np.save(tmp_path / "N_1.npy", noise(0))
    (tmp_path / "N_2.npy").write_bytes(b"")
    np.save(tmp_path / "O_1.npy", noise(1))
    done, _ = imported(tmp_path, COMMON + "recording: '{run}'\nfiles: [{path: '{run}_*.npy'}]\n")
    assert done.skipped == ("N_1.npy..N_2.npy: is empty (0 bytes); copy it again; skipped.",)


@pytest.mark.parametrize(
    ("keys", "factor"),
    [
        ("unit: V\nsensitivity_mv_per_g: 100", 10 * G),
        ("unit: V\nsensitivity_mv_per_m_s2: 10", 100),
        ("unit: mV\nsensitivity_mv_per_m_s2: 10", 0.1),
        ("unit: g", G),
    ],
)
def test_volts_become_accelerations(tmp_path, keys, factor):
    np.save(tmp_path / "a.npy", noise(0))
    done, corpus = imported(tmp_path, COMMON.replace("unit: m/s2", keys) + "files: [{path: a.npy}]\n")
    np.testing.assert_allclose(corpus.acceleration.values[0, 0], noise(0)[:1000] * factor, rtol=1e-6)
    assert done.warnings == ()


def test_several_channels_have_names_columns_and_units_of_their_own(tmp_path):
    np.savetxt(tmp_path / "a.csv", np.stack([noise(0), noise(1)], axis=1), delimiter=",", header="ax,ay", comments="")
    done, corpus = imported(
        tmp_path,
        COMMON
        + "channels:\n- {name: drive end, column: ax}\n- {name: fan end, column: ay, unit: V, sensitivity_mv_per_g: 50}\n"
        "files: [{path: a.csv}]\n",
    )
    assert corpus.channel.values.tolist() == ["drive end", "fan end"]
    expected = np.stack([noise(0)[:1000], noise(1)[:1000] * 20 * G])
    np.testing.assert_allclose(corpus.acceleration.values[0], expected, rtol=1e-6)
    card = (done.path / "README.md").read_text()
    assert "- Unit of channel fan end: V, 5.09858 mV per m/s^2." in card
    assert "channels drive end, fan end, in m/s^2." in card


def test_a_wav_file_states_its_rate_and_a_channel_of_stereo_is_chosen(tmp_path):
    wavfile.write(tmp_path / "a.wav", FS, np.stack([noise(0), noise(1)], axis=1))
    keys = "bearing: '6205'\nunit: m/s2\nshaft_rpm: 1500\nfault: inner\nspecimen: A\n"
    _, corpus = imported(tmp_path, keys + "files: [{path: a.wav, column: 1}]\n")
    assert corpus.sample_rate.values.tolist() == [FS]
    np.testing.assert_array_equal(corpus.acceleration.values[0, 0], noise(1)[:1000].astype("f4"))


def test_recordings_at_other_rates_are_resampled_if_asked_and_skipped_otherwise(tmp_path):
    wavfile.write(tmp_path / "a.wav", FS, noise(0))
    wavfile.write(tmp_path / "b.wav", 2 * FS, noise(1, 4000))
    keys = "bearing: '6205'\nunit: m/s2\nshaft_rpm: 1500\nfault: inner\nspecimen: A\nfiles: [{path: '*.wav'}]\n"
    done, _ = imported(tmp_path, keys)
    assert done.skipped == (
        "b.wav: is at 4000 Hz and the corpus at 2000 Hz; give resample_hz at the top, or make a corpus of each; skipped.",
    )
    (tmp_path / "two").mkdir()
    (tmp_path / "mapping.yaml").write_text(f"resample_hz: {FS}\n{keys}")
    done = import_generic(tmp_path / "mapping.yaml", tmp_path / "two")
    with open_corpus(tmp_path / "two") as corpus:
        expected = scipy.signal.resample_poly(noise(1, 4000), 1, 2)[:1000]
        np.testing.assert_allclose(corpus.acceleration.values[1, 0], expected, rtol=1e-5, atol=1e-6)
    (told,) = done.warnings
    assert told.startswith("b.wav: resampled from 4000 to 2000 Hz with scipy.signal.resample_poly(x, 1, 2), which ")
    assert told.endswith("attenuates above 840 Hz: compare below that frequency.")


def test_the_folder_of_the_recordings_can_be_another_than_that_of_the_mapping(tmp_path):
    for name in ("data", "elsewhere"):
        (tmp_path / name).mkdir()
    np.save(tmp_path / "data" / "a.npy", noise(0))
    (tmp_path / "elsewhere" / "mapping.yaml").write_text(COMMON + "files: [{path: a.npy}]")
    done = import_generic(tmp_path / "elsewhere" / "mapping.yaml", tmp_path / "corpus", folder=tmp_path / "data")
    assert (done.records, validate_corpus(done.path)) == (1, [])


def test_whole_numbers_and_impossible_levels_are_doubted(tmp_path):
    np.save(tmp_path / "counts.npy", np.round(noise(0) * 500))
    np.save(tmp_path / "quiet.npy", noise(1) * 1e-6)
    done, _ = imported(tmp_path, COMMON.replace("m/s2", "g") + "files: [{path: '*.npy'}]\n")
    assert done.warnings == (
        "counts.npy: it holds whole numbers, as the counts of a converter are, and the unit is taken as g; check the unit.",
        "quiet.npy: its rms is 9.7e-06 m/s^2, and machines show 0.001 to 10000 m/s^2; check the unit, which is taken as g.",
    )


@pytest.mark.parametrize(("fs", "wanted"), [(20_001, 20_000), (20_000, 999), (97_656, 12_000)])
def test_a_ratio_of_rates_is_rounded_by_less_than_6e_5(fs, wanted):
    up, down = map(int, re.findall(r"x, (\d+), (\d+)", resample(np.zeros(2), fs, wanted)[1])[0])
    assert abs(up / down * fs / wanted - 1) < 6e-5


@given(st.text("ab_", min_size=1, max_size=6), st.text("ab_1", min_size=1, max_size=8))
def test_a_pattern_of_groups_and_stars_fits_as_a_regular_expression_does(name, path):
    pattern = name.replace("a", "*", 1).replace("b", "{fault}", 1)
    try:
        parsed = parse_pattern(pattern)
    except ValueError:
        return
    expected = re.fullmatch(
        re.escape(pattern).replace(r"\*", "[^/]*?").replace(r"\{fault\}", "(?P<fault>[^/]+?)"), path
    )
    found = match_path(parsed, path, {})
    assert found == (None if expected is None else expected.groupdict())


def test_a_pattern_that_would_hang_a_regular_expression_is_compared_at_once():
    pattern = parse_pattern("{a}_{b}_{c}_{d}_{e}_{f}_{g}x")
    assert match_path(pattern, "_" * 255, {}) is None


def test_a_group_does_not_reach_into_another_folder():
    pattern = parse_pattern("**/{fault}_{rig}.npy")
    assert match_path(pattern, "x/y/N_1.npy", {}) == {"fault": "N", "rig": "1"}
    assert match_path(pattern, "x_y/N.npy", {}) is None
