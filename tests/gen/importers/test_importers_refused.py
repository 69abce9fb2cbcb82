"""Mapping files that are refused, and recordings that cannot be used: one sentence for each."""

import math
import re

import numpy as np
import pytest
import scipy.io
from scipy.io import wavfile

from gen.importers import import_generic
from gen.importers.mapping import read_mapping
from gen.support.errors import CorpusError
from tests.gen.importers.test_importers_generic import COMMON, SIGNAL, imported, write_matlab_7_3
from tests.gen.importers.test_importers_mapping_keys import FS, TOP, noise


def refusal(tmp_path, mapping):
    (tmp_path / "mapping.yaml").write_text(mapping)
    with pytest.raises(CorpusError) as refused:
        import_generic(tmp_path / "mapping.yaml", tmp_path / "corpus")
    assert not (tmp_path / "corpus").exists()
    assert "\n" not in str(refused.value)
    return str(refused.value)


REFUSED = (
    (COMMON, "mapping.yaml: files: is missing; give it."),
    (COMMON + "files: []", "files: is empty; give at least one."),
    ("files: [", "mapping.yaml: line 1: is not valid YAML ("),
    ("unit: g\nunit: g\nfiles: [{path: a}]", 'line 2: is not valid YAML (while constructing a mapping found duplicate key "unit"'),
    ("- 1\n- 2", "mapping.yaml: a mapping file has the key files, a list of sections"),
    ("bearing: '6205'\nunit: g\nfiles: [{path: a.npy, sample_rate_hz: 9, shaft_rpm: 9, specimen: A}]",
     "files[0].fault: is missing; give it there, or at the top for all files."),
    (COMMON + "files: [{path: a.npy, shaft_rmp: 5}]", "files[0].shaft_rmp: no such key; did you mean shaft_rpm?"),
    (COMMON + "files: [{path: a.npy, fault: outer, depth_mm: 0.02}]", "files[0].depth_mm: no such key; did you mean depth_um?"),
    (COMMON + "lod_n: 5\nfiles: [{path: a.npy}]", "mapping.yaml: lod_n: no such key; did you mean load_n?"),
    (COMMON + "files: [{path: a.npy, column: [1]}]", "files[0].column: is not a column; give its number, 0 to 999999,"),
    (COMMON + "files: [{path: a.npy, bearing: [1]}]", "files[0].bearing: this is not allowed here; it must be text"),
    (COMMON + "files: [{path: a.npy, fault: gear}]", "files[0].fault: 'gear' is not allowed here; it must be 'healthy'"),
    (COMMON + "files: [{path: a.npy, shaft_rpm: 0}]",
     "files[0].shaft_rpm: 0 is not allowed here; it must be greater than or equal to 0.001."),
    (COMMON + "files: [{path: a.npy, load_n: .nan}]", "files[0].load_n: nan is not allowed"),
    (COMMON + "files: [{path: a.npy, bearing: 6295}]", "files[0].bearing: 6295 is not in the catalogue ("),
    (COMMON + "files: [{path: a.npy, bearing: {n_balls: 8, pitch_diameter_mm: 40}}]",
     "files[0].bearing.ball_diameter_mm: is missing; give it."),
    (COMMON + "files: [{path: a.npy, bearing: {n_balls: 20, pitch_diameter_mm: 40, ball_diameter_mm: 8}}]",
     "20 balls of 8 mm do not fit on the pitch circle"),
    (COMMON + "files: [{path: a.npy, fault: healthy, width_mm: 1}]", "files[0]: width_mm describes a spall, and fault is healthy"),
    (COMMON + "files: [{path: /etc/passwd}]", "files[0].path: /etc/passwd leads out of the folder"),
    (COMMON + "files: [{path: data/../../a.npy}]", "leads out of the folder of the recordings"),
    (COMMON + "files: [{path: '../{rig}.npy'}]", "leads out of the folder"),
    (COMMON + "files: [{path: 'a**b'}]", "files[0].path: a**b is not a pattern of file names"),
    (COMMON + "files: [{path: '.'}]", "files[0].path: . is not a pattern of file names; write it like data/*.mat"),
    (COMMON + "files: [{path: '**/**/a'}]", "write it like data/*.mat, with ** at most once."),
    (COMMON + 'files: [{path: "a\\0b"}]', "files[0].path: '\\x00' is a control character; leave it out."),
    (COMMON + 'files: [{path: a, specimen: "b\\nc"}]', "has a tab or a line break; write it on one line."),
    (COMMON + 'title: "a\\e[2J"\nfiles: [{path: a}]', "title: '\\x1b' is a control character"),
    (COMMON + 'origin: "\\ud800"\nfiles: [{path: a}]', "is not valid YAML (a lone surrogate, which is half a character)"),
    (COMMON + f"title: {'t' * 6000}\nfiles: [{{path: a}}]", "title: 6000 characters are too many; give at most 5000."),
    (COMMON + "n_spalls: 40000\nfiles: [{path: a}]", "n_spalls: 40000 is not allowed here; it must be less than or equal to 1000."),
    (COMMON + "files: [{path: a, sample_rate_hz: 1e308}]", "files[0].sample_rate_hz: 1e+308 is not allowed here;"),
    (COMMON + "files: [{path: a, sample_rate_hz: 1e-300}]", "files[0].sample_rate_hz: 1e-300 is not allowed here;"),
    (COMMON + "files: [{path: a, shaft_rpm: 1e-300}]", "files[0].shaft_rpm: 1e-300 is not allowed here;"),
    (COMMON + "files: [{path: a, column: 99999999999999999999}]", "files[0].column: is not a column; give its number, 0 to 999999,"),
    (COMMON + "files: [{path: a, column: -1}]", "files[0].column: is not a column; give its number, 0 to 999999,"),
    (COMMON + "files: [{path: a, delimiter: ';;'}]", "files[0].delimiter: 2 characters are too many; give at most 1."),
    (COMMON + "files: [{path: a, delimiter: '5'}]", "files[0].delimiter: '5' cannot separate columns; give one character such as"),
    (COMMON + "files: [{path: a, bearing: {n_balls: 9, pitch_diameter_mm: 40, ball_diameter_mm: 1e-308}}]",
     "files[0].bearing.ball_diameter_mm: 1e-308 is not allowed here;"),
    (COMMON + "files: [{path: a.npy}]", "no recording can be used; the first of 1 skipped: a.npy"),
    (COMMON + "files: [{path: a.npy, fault: {N: healthy}}]",
     "files[0].fault: is a table, and path has no group {fault}; write {fault} in the path where it tells fault."),
    (TOP + "shaft_rpm: 9\nspecimen: A\nfault: {N: heatlhy}\nfiles: [{path: '{fault}.npy'}]",
     "fault.N: 'heatlhy' is not allowed here; it must be 'healthy'"),
    (COMMON + "files: [{path: '{rig}.npy', rig: {1.5: a}}]",
     "files[0].rig.1.5: 1.5 is not allowed here; it must be text, in quotes if it is a number."),
    (COMMON + "files: [{path: '{shaft_rpm}.npy', shaft_rpm: 5}]",
     "files[0].shaft_rpm: is given, and {shaft_rpm} in the path tells it too; remove one of the two."),
    (COMMON + "files: [{path: '{a}.npy', specimen: '{b}'}]",
     "files[0].path: has no group {b}, which another key refers to; write {b} in the path."),
    (COMMON + "files: [{path: '{a}/{a}.npy'}]", "files[0].path: {a}/{a}.npy has the group {a} twice;"),
    (COMMON + "files: [{path: '*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*{rig}.npy'}]", "has more than 16 wildcards and groups; use fewer."),
    (COMMON + "files: [{path: a.mat, shaft_rpm: {variable: x, times: 0}}]",
     "files[0].shaft_rpm.times: 0 is not allowed here; it must be greater than 0."),
    (COMMON + "files: [{path: a.npy, unit: V}]",
     "files[0]: the unit is V and the sensitivity of the sensor is missing; give it in mV per g or in mV per m/s^2."),
    (COMMON + "files: [{path: a.npy, unit: V, sensitivity_mv_per_g: 1, sensitivity_mv_per_m_s2: 1}]",
     "sensitivity_mv_per_g and sensitivity_mv_per_m_s2 are both given; remove one of the two."),
    (COMMON + "files: [{path: a.npy, unit: g, sensitivity_mv_per_g: 100}]",
     "a sensitivity is given and the unit is g, not V or mV; leave one of the two out."),
    (COMMON + "files: [{path: a.npy, sensitivity: 100}]", "files[0].sensitivity: no such key; did you mean sensitivity_mv_per_g?"),
    (COMMON + "load_n: {times: 9.81}\nfiles: [{path: a.npy}]",
     "load_n: is a factor, and path has no group {load_n}; write {load_n} in the path where it tells load_n."),
    (COMMON.replace("unit: m/s2\n", "") + "files: [{path: a.npy}]", "unit: is missing; give it there, or at the top for all files."),
    (COMMON.replace("sample_rate_hz: 2000\n", "") + "files: [{path: a.npy}]",
     "sample_rate_hz: is missing; give it there, or at the top for all files."),
    (COMMON + "files: [{path: a.npy, channels: [{name: x, column: 0}, {name: x, column: 1}]}]",
     "files[0].channels: two are called x; give each a name of its own."),
    (COMMON + "files: [{path: a.npy, channels: [{name: x, unit: V}]}]",
     "channel x: the unit is V and the sensitivity of the sensor is missing;"),
    (COMMON + "files: [{path: a.npy, channels: [{name: x, colunm: 0}]}]",
     "files[0].channels[0].colunm: no such key; did you mean column?"),
    (COMMON + "channels: [{name: x}]\nfiles: [{path: a.npy}, {path: b.npy, channels: [{name: y}]}]",
     "files[1]: has the channels y, and files[0] has x; give all files the same channels, or make a corpus of each."),
    (COMMON + "resample_hz: 0\nfiles: [{path: a.npy}]", "resample_hz: 0 is not allowed here; it must be"),
)  # fmt: skip


def test_a_mapping_that_cannot_be_meant_is_refused_with_a_sentence(tmp_path):
    said = [(sentence, refusal(tmp_path, mapping)) for mapping, sentence in REFUSED]
    assert [(sentence, found) for sentence, found in said if sentence not in found] == []


def test_recordings_at_different_rates_are_refused(tmp_path):
    for name in "ab":
        np.save(tmp_path / f"{name}.npy", SIGNAL)
    sentence = "b.npy is at 4000 Hz and a.npy at 2000 Hz; a corpus has one sample rate: give resample_hz at the top, or"
    assert sentence in refusal(tmp_path, COMMON + "files: [{path: a.npy}, {path: b.npy, sample_rate_hz: 4000}]")


def test_every_wrong_key_of_a_mapping_has_a_sentence_of_its_own(tmp_path):
    (tmp_path / "mapping.yaml").write_text(COMMON + "unti: g\nfiles: [{path: a.npy, load_n: -1}, {pat: b.npy}]")
    with pytest.raises(CorpusError) as refused:
        read_mapping(tmp_path / "mapping.yaml")
    assert [line.removeprefix(f"{tmp_path / 'mapping.yaml'}: ") for line in str(refused.value).split("\n")] == [
        "files[0].load_n: -1 is not allowed here; it must be greater than or equal to 0.",
        "files[1].pat: no such key; did you mean path?",
        "unti: no such key; did you mean unit?",
    ]


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
    (tmp_path / "mapping.yaml").write_text(COMMON + "files: [{path: a.npy}]")
    with pytest.raises(CorpusError, match=re.escape(sentence)):
        import_generic(tmp_path / "mapping.yaml", tmp_path / "corpus", window=window)


def test_a_missing_mapping_is_refused(tmp_path):
    with pytest.raises(CorpusError, match="no such file; give the YAML file that describes the recordings"):
        import_generic(tmp_path / "none.yaml", tmp_path / "corpus")


def test_a_link_out_of_the_folder_is_refused(tmp_path):
    inside = tmp_path / "inside"
    inside.mkdir()
    np.save(tmp_path / "a.npy", SIGNAL)
    (inside / "a.npy").symlink_to(tmp_path / "a.npy")
    assert "matches a link that leads out of the folder; copy" in refusal(inside, COMMON + "files: [{path: '*.npy'}]")


def test_a_folder_in_place_of_a_mapping_file_is_refused_with_what_to_give(tmp_path):
    with pytest.raises(
        CorpusError,
        match=r": is a folder; give the YAML file that describes the recordings, such as .*mapping\.yaml\.$",
    ):
        import_generic(tmp_path, tmp_path / "corpus")


def test_a_rate_that_no_file_holds_is_named(tmp_path):
    scipy.io.savemat(tmp_path / "a.mat", {"x": noise(0)})
    mapping = COMMON.replace("sample_rate_hz: 2000", "sample_rate_hz: {variable: fs}")
    assert "fs" in refusal(tmp_path, mapping + "variable: x\nfiles: [{path: a.mat}]").rpartition("a.mat")[2]


def test_files_that_differ_are_not_joined(tmp_path):
    for name in "ab":
        np.save(tmp_path / f"{name}.npy", noise(0))
    message = refusal(tmp_path, COMMON + "recording: r\nfiles: [{path: a.npy}, {path: b.npy, shaft_rpm: 900}]")
    assert message.endswith(
        "files[1] (b.npy) belongs to recording r as a.npy does, and shaft_rpm is 900.0 here and 1500.0 there; "
        "give each recording a name of its own."
    )


UNUSABLE = {
    "missing.npy": (None, "no file beside mapping.yaml matches"),
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
    "two.mat": (
        lambda path: scipy.io.savemat(path, {"x": SIGNAL, "y": SIGNAL, "rpm": 5}),
        "holds x, y, more than one variable with 100 numbers or more; name one with variable",
    ),
    "broken_7_3.mat": (
        lambda path: (write_matlab_7_3(path), path.write_bytes(path.read_bytes()[:900])),
        "is truncated, damaged or not a MATLAB file",
    ),
}


def test_each_file_that_cannot_be_used_is_named_with_its_reason(tmp_path):
    np.save(tmp_path / "good.npy", SIGNAL)
    for name, (write, _) in UNUSABLE.items():
        if write is not None:
            write(tmp_path / name)
    listed = "".join(f"- {{path: {name}}}\n" for name in ("good.npy", *UNUSABLE))
    done, corpus = imported(tmp_path, COMMON + "files:\n" + listed)
    told = dict(sentence.split(": ", 1) for sentence in done.skipped)
    assert (done.recordings, len(done.skipped)) == (1, len(UNUSABLE))
    assert set(corpus.source.values.tolist()) == {"good.npy#0", "good.npy#1000"}
    for name, (_, reason) in UNUSABLE.items():
        assert reason in told[name], name


def test_a_broken_matlab_7_3_file_and_a_missing_variable_are_named(tmp_path):
    np.save(tmp_path / "good.npy", SIGNAL)
    write_matlab_7_3(tmp_path / "whole.mat")
    (tmp_path / "half.mat").write_bytes((tmp_path / "whole.mat").read_bytes()[:900])
    done, _ = imported(
        tmp_path,
        COMMON + "variable: x\nfiles: [{path: good.npy, variable: null}, {path: half.mat}, {path: whole.mat}]\n",
    )
    assert "half.mat:x: is truncated, damaged or not a MATLAB file" in done.skipped[0]
    assert done.skipped[1] == "whole.mat:x: holds vibration, not x; skipped."


OF_COLUMNS = {
    "wav_column.wav": ("{column: 2}", "has the columns 0, 1, and no numbers in 2; choose one with column"),
    "stereo.wav": ("{}", "has 2 columns (0, 1) and none is chosen; choose one with column"),
    "table.npy": ("{column: ax}", "has columns without names, so none is called ax; give a number from 0 with column"),
    "table.mat": ("{variable: x}", "has 2 columns (0, 1) and none is chosen; choose one with column"),
    "rpm.csv": ("{shaft_rpm: {variable: rpm}}", "has no variables, and shaft_rpm is to be read from rpm; give shaft_rpm as a number"),
    "channels.mat": ("{channels: [{name: a, variable: x}, {name: b, variable: y}]}", "has channels of 1100 and 550 samples"),
}  # fmt: skip


def test_messages_about_columns_and_channels_name_the_key(tmp_path):
    table = np.stack([noise(0), noise(1)], axis=1)
    for name in ("wav_column.wav", "stereo.wav"):
        wavfile.write(tmp_path / name, FS, table)
    np.save(tmp_path / "table.npy", table)
    scipy.io.savemat(tmp_path / "table.mat", {"x": table})
    scipy.io.savemat(tmp_path / "channels.mat", {"x": noise(0), "y": noise(0)[:550]})
    np.savetxt(tmp_path / "rpm.csv", noise(0))
    np.save(tmp_path / "good.npy", noise(0))
    for name, (keys, reason) in OF_COLUMNS.items():
        good = "{path: good.npy, channels: [{name: a}, {name: b}]}" if "channels" in name else "{path: good.npy}"
        own = keys.strip("{}") if keys.count("{") == 1 else keys[1:-1]
        (tmp_path / "mapping.yaml").write_text(COMMON + f"files: [{good}, {{path: {name}{', ' if own else ''}{own}}}]")
        done = import_generic(tmp_path / "mapping.yaml", tmp_path / f"corpus of {name}")
        assert reason in done.skipped[-1], name
