"""The generic importer: valid mapping files, and the error sentence for each invalid one."""

import math
import re

import h5py
import numpy as np
import pytest
import scipy.io

from gen.corpus import FAULTS, open_corpus, validate_corpus
from gen.importers import import_generic
from gen.importers.mapping import read_mapping
from gen.importers.mapping_keys import FileKeys
from gen.importers.mapping_values import Geometry, bearing_of
from gen.recipe.keys import recipe_keys
from gen.support.errors import CorpusError
from gen.support.units import unit_suffix
from tests.paths import ROOT

SIGNAL = np.random.default_rng(1).normal(size=2100)
COMMON = "bearing: '6205'\nunit: m/s2\nsample_rate_hz: 2000\nshaft_rpm: 1500\nfault: inner\nspecimen: A\n"


def imported(tmp_path, mapping, **options):
    (tmp_path / "mapping.yaml").write_text(mapping)
    done = import_generic(tmp_path / "mapping.yaml", tmp_path / "corpus", **options)
    assert validate_corpus(done.path) == []
    with open_corpus(done.path) as corpus:
        return done, corpus.load()


def test_recordings_of_another_set_have_another_identity_although_their_files_have_the_same_names(tmp_path):
    found = []
    for folder, signal in (("one", SIGNAL), ("same", SIGNAL), ("other", -SIGNAL)):
        (tmp_path / folder).mkdir()
        np.savetxt(tmp_path / folder / "a.csv", signal)
        _, corpus = imported(tmp_path / folder, COMMON + "files:\n- {path: a.csv}\n", window=0.5)
        found.append(corpus["identity"].values.tolist())
    one, same, other = found
    assert one == same
    assert not set(one) & set(other)
    assert {text.split("/", 1)[1] for text in one + other} == {"0/0/0/-1"}


def refusal(tmp_path, mapping):
    (tmp_path / "mapping.yaml").write_text(mapping)
    with pytest.raises(CorpusError) as refused:
        import_generic(tmp_path / "mapping.yaml", tmp_path / "corpus")
    assert not (tmp_path / "corpus").exists()
    assert "\n" not in str(refused.value)
    return str(refused.value)


def write_matlab_7_3(path):
    with h5py.File(path, "w", userblock_size=512) as file:
        file["vibration"] = SIGNAL[np.newaxis]
    with path.open("r+b") as stream:
        stream.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")


WRITERS = {
    "matlab": ("a.mat", lambda path: scipy.io.savemat(path, {"vibration": SIGNAL}), "variable: vibration"),
    "matlab_structure": (
        "a.mat",
        lambda path: scipy.io.savemat(path, {"run": {"fs": 2000, "x": SIGNAL}}),
        "variable: run.x",
    ),
    "matlab_table": (
        "a.mat",
        lambda path: scipy.io.savemat(path, {"x": np.stack([0 * SIGNAL, SIGNAL])}),
        "{variable: x, column: 1}",
    ),
    "matlab_7_3": ("a.mat", write_matlab_7_3, "variable: vibration"),
    "numpy": ("a.npy", lambda path: np.save(path, SIGNAL), "rig: 1"),
    "comma_and_header": (
        "a.csv",
        lambda path: np.savetxt(path, np.c_[0 * SIGNAL, SIGNAL], delimiter=",", header="t,ax", comments=""),
        "column: ax",
    ),
    "semicolon_and_title": (
        "a.txt",
        lambda path: np.savetxt(path, np.c_[SIGNAL, SIGNAL], delimiter="; ", header="run 7\nstarted late"),
        "column: 1",
    ),
    "bare_column": ("a.txt", lambda path: np.savetxt(path, SIGNAL), "rig: 1"),
    "stated_delimiter": (
        "a.dat",
        lambda path: np.savetxt(path, np.c_[SIGNAL, SIGNAL], delimiter="|"),
        "{delimiter: '|', column: 0}",
    ),
}


@pytest.mark.parametrize(("name", "write", "keys"), WRITERS.values(), ids=WRITERS)
def test_every_format_gives_the_numbers_that_were_written(tmp_path, name, write, keys):
    write(tmp_path / name)
    keys = keys.strip("{}")
    done, corpus = imported(tmp_path, f"{COMMON}files:\n  - {{path: {name}, {keys}}}\n")
    assert (done.recordings, done.records, done.skipped) == (1, 2, ())
    np.testing.assert_array_equal(corpus.acceleration.values.reshape(-1), SIGNAL[:2000].astype(np.float32))


def test_a_file_overrides_what_is_said_at_the_top_and_units_become_si(tmp_path):
    np.save(tmp_path / "a.npy", SIGNAL)
    np.save(tmp_path / "b.npy", SIGNAL)
    _, corpus = imported(
        tmp_path,
        COMMON + "title: Pump 7\nchannel: drive side\nfiles:\n"
        "  - {path: a.npy, fault: healthy, specimen: 1}\n"
        "  - {path: b.npy, unit: g, shaft_rpm: 1.2e3, load_n: 50, width_mm: 1e-1,"
        " depth_um: 20, angle_deg: -90,"
        " bearing: {n_balls: 8, pitch_diameter_mm: 40, ball_diameter_mm: 8, contact_angle_deg: 60}}\n",
    )
    last = corpus.isel(record=-1)
    assert [FAULTS[fault] for fault in corpus.fault.values] == ["healthy", "healthy", "inner", "inner"]
    assert float(last.acceleration[0, 0]) == pytest.approx(SIGNAL[1000] * 9.80665, rel=1e-6)
    assert float(last.shaft_rate) == 20.0
    assert float(last["load"]) == 50.0
    assert float(last.width) == pytest.approx(1e-4)
    assert float(last.angle) == pytest.approx(-math.pi / 2)
    assert float(last.bpfo) == pytest.approx(8 / 2 * (1 - 0.2 * 0.5))
    assert corpus.attrs["title"] == "Pump 7"
    assert corpus.channel.values.tolist() == ["drive side"]
    assert corpus.n_spalls.values.tolist() == [0, 0, 1, 1]


def test_patterns_name_files_and_specimens_belong_to_their_rig(tmp_path):
    for place in ("one/a", "one/b", "two/a"):
        (tmp_path / place).parent.mkdir(exist_ok=True)
        np.save(tmp_path / f"{place}.npy", SIGNAL)
    done, corpus = imported(
        tmp_path, COMMON + "files:\n- {path: one/*.npy, rig: north}\n- {path: '**/a.npy', rig: south}\n"
    )
    assert corpus.source.values[::2].tolist() == ["one/a.npy#0", "one/b.npy#0", "two/a.npy#0"]
    assert corpus.rig.values[::2].tolist() == [0, 0, 1]
    assert corpus.specimen.values[::2].tolist() == [0, 0, 1]
    assert corpus.recording.values[::2].tolist() == [0, 1, 2]
    assert done.skipped == ("one/a.npy: is listed again by files[1]; skipped.",)


def test_one_file_may_hold_several_recordings(tmp_path):
    np.save(tmp_path / "a.npy", np.stack([SIGNAL, -SIGNAL]))
    done, corpus = imported(
        tmp_path, COMMON + "files:\n- {path: a.npy, column: 0}\n- {path: a.npy, column: 1, specimen: B}\n"
    )
    assert done.recordings == 2
    assert corpus.source.values[::2].tolist() == ["a.npy:0#0", "a.npy:1#0"]


UNUSABLE = {
    "missing.npy": (None, "no file beside mapping.yaml matches"),
    "empty.csv": (lambda path: path.write_bytes(b""), "is empty"),
    "words.csv": (lambda path: path.write_text("no\nnumbers\n"), "has no line of numbers among its first 2"),
    "gap.csv": (lambda path: path.write_text("1\n2\nx\n"), "is truncated, damaged or not a delimited text file"),
    "nan.csv": (
        lambda path: path.write_text("1\nnan\n" * 2000),
        "has 2000 samples of 4000 that are not finite",
    ),
    "two.csv": (lambda path: path.write_text("1,2\n" * 2000), "has 2 columns and none is chosen"),
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


def level_5(path, rpm):
    scipy.io.savemat(path, {"x": SIGNAL, "RPM": rpm})


def level_7_3(path, rpm):
    """As MATLAB writes it: text as codes with the class ``char``, and in place of an empty array its dimensions."""
    text, empty = isinstance(rpm, str), np.size(rpm) == 0
    values = np.zeros(2, "u8") if empty else np.array([[ord(letter)] for letter in rpm], "u2") if text else rpm
    with h5py.File(path, "w") as file:
        file["x"] = SIGNAL[np.newaxis]
        file["RPM"] = values
        file["RPM"].attrs["MATLAB_class"] = np.bytes_("char" if text else "double")
        if empty:
            file["RPM"].attrs["MATLAB_empty"] = 1


@pytest.mark.parametrize("write", [level_5, level_7_3])
def test_a_number_in_a_matlab_file_may_be_text_and_any_other_text_is_no_number(tmp_path, write):
    for name, rpm in {"number": 1772.0, "text": "1772", "word": "fast", "empty": np.zeros((0, 0))}.items():
        write(tmp_path / f"{name}.mat", rpm)
    keys = COMMON.replace("1500", "{variable: RPM}") + "variable: x\n"
    done, corpus = imported(tmp_path, keys + "files: [{path: '*.mat'}]\n")
    np.testing.assert_allclose(corpus.shaft_rate, 1772 / 60)
    assert done.recordings == 2
    assert done.skipped[0].startswith("empty.mat:x: holds float64 of shape (0,")
    assert done.skipped[1:] == ("word.mat:x: holds RPM, which is no number for shaft_rpm; skipped.",)


REFUSED = {
    "no_files": (COMMON, "mapping.yaml: files: is missing; give it."),
    "files_empty": (COMMON + "files: []", "files: is empty; give at least one."),
    "not_yaml": ("files: [", "mapping.yaml: line 1: is not valid YAML ("),
    "twice": ("unit: g\nunit: g\nfiles: [{path: a}]", "line 2: is not valid YAML (the key unit occurs twice)"),
    "a_list": ("- 1\n- 2", "mapping.yaml: a mapping file has the key files, a list of sections"),
    "missing_key": (
        "bearing: '6205'\nunit: g\nfiles: [{path: a.npy, sample_rate_hz: 9, shaft_rpm: 9, specimen: A}]",
        "files[0].fault: is missing; give it there, or at the top for all files.",
    ),
    "typo": (
        COMMON + "files: [{path: a.npy, shaft_rmp: 5}]",
        "files[0].shaft_rmp: no such key; did you mean shaft_rpm?",
    ),
    "renamed": (
        COMMON + "files: [{path: a.npy, fault: outer, depth_mm: 0.02}]",
        "files[0].depth_mm: no such key; did you mean depth_um?",
    ),
    "typo_at_the_top": (
        COMMON + "lod_n: 5\nfiles: [{path: a.npy}]",
        "mapping.yaml: lod_n: no such key; did you mean load_n?",
    ),
    "column": (
        COMMON + "files: [{path: a.npy, column: [1]}]",
        "files[0].column: is not a column; give its number, 0 to 999999,",
    ),
    "bearing_list": (
        COMMON + "files: [{path: a.npy, bearing: [1]}]",
        "files[0].bearing: this is not allowed here; it must be text",
    ),
    "fault": (
        COMMON + "files: [{path: a.npy, fault: gear}]",
        "files[0].fault: 'gear' is not allowed here; it must be 'healthy'",
    ),
    "speed": (
        COMMON + "files: [{path: a.npy, shaft_rpm: 0}]",
        "files[0].shaft_rpm: 0 is not allowed here; it must be greater than or equal to 0.001.",
    ),
    "not_a_number": (COMMON + "files: [{path: a.npy, load_n: .nan}]", "files[0].load_n: nan is not allowed"),
    "bearing": (
        COMMON + "files: [{path: a.npy, bearing: 6295}]",
        "files[0].bearing: 6295 is not in the catalogue (",
    ),
    "geometry": (
        COMMON + "files: [{path: a.npy, bearing: {n_balls: 8, pitch_diameter_mm: 40}}]",
        "files[0].bearing.ball_diameter_mm: is missing; give it.",
    ),
    "balls": (
        COMMON + "files: [{path: a.npy, bearing: {n_balls: 20, pitch_diameter_mm: 40, ball_diameter_mm: 8}}]",
        "20 balls of 8 mm do not fit on the pitch circle",
    ),
    "healthy_spall": (
        COMMON + "files: [{path: a.npy, fault: healthy, width_mm: 1}]",
        "files[0]: width_mm describes a spall, and fault is healthy",
    ),
    "absolute": (
        COMMON + "files: [{path: /etc/passwd}]",
        "files[0].path: /etc/passwd leads out of the folder",
    ),
    "above": (COMMON + "files: [{path: data/../../a.npy}]", "leads out of the folder of the recordings"),
    "pattern": (COMMON + "files: [{path: 'a**b'}]", "files[0].path: a**b is not a pattern of file names"),
    "folder_itself": (
        COMMON + "files: [{path: '.'}]",
        "files[0].path: . is not a pattern of file names; write it like data/*.mat",
    ),
    "every_folder_twice": (COMMON + "files: [{path: '**/**/a'}]", "write it like data/*.mat, with ** at most once."),
    "control_character": (
        COMMON + 'files: [{path: "a\\0b"}]',
        "files[0].path: '\\x00' is a control character; leave it out.",
    ),
    "specimen_on_two_lines": (
        COMMON + 'files: [{path: a, specimen: "b\\nc"}]',
        "has a tab or a line break; write it on one line.",
    ),
    "control_character_in_a_title": (
        COMMON + 'title: "a\\e[2J"\nfiles: [{path: a}]',
        "title: '\\x1b' is a control character",
    ),
    "half_a_character": (
        COMMON + 'origin: "\\ud800"\nfiles: [{path: a}]',
        "is not valid YAML (a lone surrogate, which is half a character)",
    ),
    "long_title": (
        COMMON + f"title: {'t' * 6000}\nfiles: [{{path: a}}]",
        "title: 6000 characters are too many; give at most 5000.",
    ),
    "spalls": (
        COMMON + "n_spalls: 40000\nfiles: [{path: a}]",
        "n_spalls: 40000 is not allowed here; it must be less than or equal to 1000.",
    ),
    "rate_of_1e308": (
        COMMON + "files: [{path: a, sample_rate_hz: 1e308}]",
        "files[0].sample_rate_hz: 1e+308 is not allowed here;",
    ),
    "rate_of_1e_300": (
        COMMON + "files: [{path: a, sample_rate_hz: 1e-300}]",
        "files[0].sample_rate_hz: 1e-300 is not allowed here;",
    ),
    "speed_of_1e_300": (
        COMMON + "files: [{path: a, shaft_rpm: 1e-300}]",
        "files[0].shaft_rpm: 1e-300 is not allowed here;",
    ),
    "column_beyond": (
        COMMON + "files: [{path: a, column: 99999999999999999999}]",
        "files[0].column: is not a column; give its number, 0 to 999999,",
    ),
    "column_below": (
        COMMON + "files: [{path: a, column: -1}]",
        "files[0].column: is not a column; give its number, 0 to 999999,",
    ),
    "delimiter_of_two": (
        COMMON + "files: [{path: a, delimiter: ';;'}]",
        "files[0].delimiter: 2 characters are too many; give at most 1.",
    ),
    "delimiter_of_numbers": (
        COMMON + "files: [{path: a, delimiter: '5'}]",
        "files[0].delimiter: '5' cannot separate columns; give one character such as",
    ),
    "tiny_balls": (
        COMMON + "files: [{path: a, bearing: {n_balls: 9, pitch_diameter_mm: 40, ball_diameter_mm: 1e-308}}]",
        "files[0].bearing.ball_diameter_mm: 1e-308 is not allowed here;",
    ),
    "nothing_usable": (
        COMMON + "files: [{path: a.npy}]",
        "no recording can be used; the first of 1 skipped: a.npy",
    ),
}


@pytest.mark.parametrize(("mapping", "sentence"), REFUSED.values(), ids=REFUSED)
def test_a_mapping_that_cannot_be_meant_is_refused_with_a_sentence(tmp_path, mapping, sentence):
    assert sentence in refusal(tmp_path, mapping)


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


def test_the_mapping_in_the_documentation_is_one(tmp_path):
    page = (ROOT / "docs" / "importing.md").read_text(encoding="utf-8")
    example, paths, channels = re.findall(r"```yaml\n(.*?)```", page, flags=re.DOTALL)
    (tmp_path / "mapping.yaml").write_text(example, encoding="utf-8")
    mapping = read_mapping(tmp_path / "mapping.yaml")
    facts = [section.facts({}) for section in mapping.sections]
    assert [found.fault for found in facts] == ["healthy", "outer", "ball"]
    assert [bearing_of(found.bearing).designation for found in facts] == ["6205", "6205", "L8"]
    (tmp_path / "mapping.yaml").write_text(paths, encoding="utf-8")
    (section,) = read_mapping(tmp_path / "mapping.yaml").sections
    assert section.facts({"fault": "O", "shaft_rpm": "1200"}).recording == "O 1200"
    (tmp_path / "mapping.yaml").write_text(f"{COMMON}{channels}files: [{{path: a.csv}}]", encoding="utf-8")
    assert read_mapping(tmp_path / "mapping.yaml").channel_names == ("drive end", "fan end")


def test_a_folder_in_place_of_a_mapping_file_is_refused_with_what_to_give(tmp_path):
    with pytest.raises(
        CorpusError,
        match=r": is a folder; give the YAML file that describes the recordings, such as .*mapping\.yaml\.$",
    ):
        import_generic(tmp_path, tmp_path / "corpus")


def test_mapping_files_and_recipes_spell_a_quantity_alike():
    in_recipes = {key.key.rpartition(".")[2] for key in recipe_keys()}
    keys = {*FileKeys.model_fields, *Geometry.model_fields}
    quantities = {key for key in keys if unit_suffix(key) or key.startswith("n_")}
    assert quantities > {"shaft_rpm", "depth_um", "n_spalls", "ball_diameter_mm"}
    assert quantities - in_recipes == {"sensitivity_mv_per_m_s2"}
