"""The generic importer: every format and key of a mapping file."""

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
        lambda path: np.savetxt(path, np.c_[0 * SIGNAL, SIGNAL], delimiter=",", header="ay,ax", comments=""),
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


def test_mapping_files_and_recipes_spell_a_quantity_alike():
    in_recipes = {key.key.rpartition(".")[2] for key in recipe_keys()}
    keys = {*FileKeys.model_fields, *Geometry.model_fields}
    quantities = {key for key in keys if unit_suffix(key) or key.startswith("n_")}
    assert quantities > {"shaft_rpm", "depth_um", "n_spalls", "ball_diameter_mm"}
    assert quantities - in_recipes == {"sensitivity_mv_per_m_s2"}
