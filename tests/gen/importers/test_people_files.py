"""Files as people have them are read as they were written, or refused in one sentence that names the choices."""

import sys

import numpy as np
import pytest

from gen.importers import import_generic, read_signal
from gen.support.errors import CorpusError
from tests.gen.importers.people_files import REFUSED, RIGHT, THREE, X

GRAVITY = 9.80665
OPTIONS = {"column": "--channel", "variable": "--channel", "rate": "--rate", "unit": "--unit"}


@pytest.mark.parametrize("name", RIGHT)
def test_a_file_is_read_as_it_was_written(tmp_path, name):
    write, given, fs, unit = RIGHT[name]
    write(tmp_path / name)
    found = read_signal(tmp_path / name, **given)
    factor = GRAVITY if unit == "g" else 1e-3 / 9.80665 * GRAVITY if unit == "mV" else 1.0
    np.testing.assert_allclose(found.values, X * factor, rtol=1e-9, atol=2e-7 if name == "bits_24.wav" else 0)
    assert found.fs == fs
    assert found.unit == unit
    if "unit" not in given and unit != "m/s2":
        assert any(f"its unit is taken as {unit}, from" in note for note in found.warnings)


@pytest.mark.parametrize("name", REFUSED)
def test_a_file_that_leaves_a_choice_open_is_refused_with_the_choices(tmp_path, name):
    write, given, sentence = REFUSED[name]
    write(tmp_path / name)
    with pytest.raises(CorpusError) as refused:
        read_signal(tmp_path / name, **given, options=OPTIONS)
    assert sentence in str(refused.value)
    assert "\n" not in str(refused.value)


def test_without_its_extra_an_excel_file_tells_what_to_install(tmp_path, monkeypatch):
    RIGHT["sheet.xlsx"][0](tmp_path / "a.xlsx")
    monkeypatch.setitem(sys.modules, "python_calamine", None)
    with pytest.raises(CorpusError, match=r"needs python-calamine; install it with pip install raceway\[excel\]\."):
        read_signal(tmp_path / "a.xlsx")


def test_a_mapping_takes_the_rate_from_the_times_and_names_its_own_keys(tmp_path):
    common = "{bearing: '6205', shaft_rpm: 1500, fault: inner, specimen: A, unit: %s, files: [{path: '*.csv'%s}]}"
    THREE(tmp_path / "a.csv")
    (tmp_path / "mapping.yaml").write_text(common % ("g", ", column: DE"))
    done = import_generic(tmp_path / "mapping.yaml", tmp_path / "corpus", window=0.02)
    assert (done.records, done.warnings) == (2, ())
    for keys, sentence in {
        ("g", ""): "choose one with column",
        ("m/s2", ", column: DE"): "the unit m/s2 is given; correct what is given with unit",
        ("g", ", column: DE, sample_rate_hz: 9000"): "9000 Hz are given; correct what is given with sample_rate_hz",
    }.items():
        (tmp_path / "mapping.yaml").write_text(common % keys)
        with pytest.raises(CorpusError, match=sentence):
            import_generic(tmp_path / "mapping.yaml", tmp_path / "refused", window=0.02)


@pytest.mark.parametrize(
    ("line", "rate"),
    [
        ("Sampling Rate: 25,600 Hz", 25600),
        ("Sample interval: 39.0625 us", 25600),
        ("Sampling frequency [kHz];12,8", 12800),
        ("sample_rate_hz,25600", 25600),
        ("Abtastrate: 25600 1/s", 25600),
        ("dt = .0001", 10000),
        ("Sampling time: 10 s", None),
        ("fs 1,2,3.4.5", None),
        ("dt 0", None),
    ],
)
def test_a_line_of_a_header_states_the_sample_rate(line, rate, tmp_path):
    (tmp_path / "a.txt").write_text(line + "\n" + "".join(f"{x}\n" for x in X))
    assert read_signal(tmp_path / "a.txt").fs == rate
