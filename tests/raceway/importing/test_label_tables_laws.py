"""Laws of tables of labels: every key is a column and a common key, numbers are read in one way, and flaws are told with row and column."""

import codecs
import re
import tempfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gen.support.errors import CorpusError
from gen.support.limits import VARIABLE
from gen.support.units import unit_suffix
from raceway.importing.label_keys import Labels
from raceway.importing.label_tables import read_table_of_labels
from raceway.importing.speed_tables import read_speed_table
from tests.labels import write_labels
from tests.paths import ROOT

BASE = {"path": "a.npy", "fault": "outer", "specimen": "A", "bearing": "6205", "shaft_rpm": 1500, "sample_rate_hz": 2000, "unit": "V",
        "sensitivity_mv_per_g": 100}  # fmt: skip
VALUES = {
    "path": "b/c d.mat", "fault": "ball", "specimen": "007", "rig": "2", "recording": "r", "bearing": "NU206", "shaft_rpm": 1480.5,
    "nominal_rpm": 1500, "load_n": 0.25, "motor_load_w": 750, "age_s": 10, "rul_s": 20, "event": "censored", "note": "worn",
    "long_samples": 9,
    "long_rate_hz": 48000, "width_mm": 1.25, "depth_um": 20, "angle_deg": -90, "n_spalls": 2, "sample_rate_hz": 12800, "resample_hz": 6400,
    "delimiter": "\t", "channel": "drive end", "decimal": ",",
    "title": "Pump; 7", "origin": "Plant, spring", "variable": "X*_DE", "column": "ax", "speed_column": 3, "speed_unit": "60",
    "unit": "mV", "sensitivity_mv_per_g": 50.5, "sensitivity_mv_per_m_s2": 10.2,
    "channels": '[{"name": "x", "column": 0}, {"name": "y", "column": "ay"}]',
}  # fmt: skip
QUANTITIES = [key for key in Labels.model_fields if unit_suffix(key) or key == "n_spalls"]
law = settings(deadline=None, max_examples=50)


def read(folder, *rows, common=None, **options):
    return [labels for _, labels in read_table_of_labels(write_labels(folder, rows, **options), common or {})]


def refusal(folder, *rows, **options):
    with pytest.raises(CorpusError) as refused:
        read(folder, *rows, **options)
    return str(refused.value).replace(f"{folder}/", "")


@pytest.mark.parametrize("key", Labels.model_fields)
def test_every_key_is_a_column_and_a_key_of_all_rows(tmp_path, key):
    value = VALUES[key]
    rest = {name: common for name, common in BASE.items() if name != key}
    rest |= {"age_s": 5} if key in ("rul_s", "event") else {}
    rest.pop({"sensitivity_mv_per_m_s2": "sensitivity_mv_per_g", "speed_column": "shaft_rpm"}.get(key), None)
    (column,) = read(tmp_path, rest | {key: value}, mark=";")
    assert column != Labels.model_validate({**BASE, "path": "a.npy"})
    (given_to_all,) = read(tmp_path, rest, common={key: str(value)})
    in_yaml = [{"name": "x", "column": 0}, {"name": "y", "column": "ay"}] if key == "channels" else value
    (shared,) = read(tmp_path, rest, **{key: in_yaml})
    assert column == given_to_all == shared


def test_a_row_goes_before_a_given_key_and_this_before_the_file_of_common_keys(tmp_path):
    rows = [BASE | {"load_n": 1}, BASE | {"path": "b.npy"}]
    assert [labels.load_n for labels in read(tmp_path, *rows, load_n=3)] == [1, 3]
    assert [labels.load_n for labels in read(tmp_path, *rows, load_n=3, common={"load_n": 2})] == [1, 2]


@law
@given(numbers=st.lists(st.decimals(0, 10**6, places=3), min_size=1, max_size=4), comma=st.booleans())
def test_a_number_is_read_as_it_was_written(numbers, comma):
    texts = [f"{number:f}".replace(".", "," if comma else ".") for number in numbers]
    rows = [BASE | {"path": f"{n}.npy", "load_n": text} for n, text in enumerate(texts)]
    with tempfile.TemporaryDirectory() as folder:
        rows_read = read(Path(folder), *rows, mark=";" if comma else ",")
    assert [labels.load_n for labels in rows_read] == [float(number) for number in numbers]


def test_a_table_of_a_spreadsheet_has_a_mark_semicolons_commas_and_empty_rows(tmp_path):
    text = "\n;;;\nspecimen;path;shaft_rpm;load_n;\n007;a.npy;1.480,5;0,25;\n;;;;\n\nNeu ä;b.npy;900;1.200,0\n"
    for encoding, start in (("utf-8", codecs.BOM_UTF8), ("utf-16", b""), ("latin-1", b"")):
        (tmp_path / "labels.csv").write_bytes(start + text.replace("\n", "\r\n").encode(encoding))
        common = {key: BASE[key] for key in ("fault", "bearing", "sample_rate_hz")} | {"unit": "g"}
        rows_read = [labels for _, labels in read_table_of_labels(tmp_path / "labels.csv", common)]
        assert [(labels.specimen, labels.shaft_rpm, labels.load_n) for labels in rows_read] == [
            ("007", 1480.5, 0.25),
            ("Neu ä", 900, 1200),
        ]


@pytest.mark.parametrize("key", QUANTITIES)
def test_a_quantity_out_of_range_is_told_with_its_place(tmp_path, key):
    rows = [BASE, BASE | {"path": "b.npy", key: -1e9}]
    assert f"labels.csv, row 3, column {key}: -1000000000.0 is not allowed here; it must be gr" in refusal(
        tmp_path, *rows
    )
    assert refusal(tmp_path, *rows, mark=";").count("\n") == 0
    rest = [{name: common for name, common in BASE.items() if name != key}]
    assert f"labels.yaml: {key}: -1000000000.0 is not allowed here" in refusal(tmp_path, *rest, **{key: -1e9})
    (tmp_path / "labels.yaml").unlink()
    assert f"common key {key}: '-1e9' is not allowed here" in refusal(tmp_path, *rest, common={key: "-1e9"}).replace(
        "-1000000000.0", "'-1e9'"
    )


@pytest.mark.parametrize("key", [key for key, field in Labels.model_fields.items() if field.is_required()])
def test_a_missing_key_is_told_with_the_places_where_it_can_be_given(tmp_path, key):
    rest = {name: common for name, common in BASE.items() if name != key}
    expected = f"labels.csv, row 2, column {key}: is missing; give it there, or for all files in labels.yaml."
    assert refusal(tmp_path, rest, rest) == expected


REFUSED = {
    "labels.csv, row 2, column shaft_rmp: no such key; did you mean shaft_rpm?": {"shaft_rmp": 5},
    "labels.csv, row 2, column rpm: no such key; did you mean shaft_rpm?": {"rpm": 5},
    "column fault: 'gear' is not allowed here; it must be 'healthy'": {"fault": "gear"},
    "column load_n: 'heavy' is not allowed here; it must be a number.": {"load_n": "heavy"},
    "column load_n: 1.480 may be in thousands; write it without marks": {"load_n": "1.480", "shaft_rpm": 900, "sample_rate_hz": 800},
    "column n_spalls: 2.5 is not allowed here; it must be a whole number.": {"n_spalls": "2,5"},
    "column bearing: bearing '6295' is not in the catalogue; give its geometry": {"bearing": "6295"},
    "column bearing: bearing: 20 balls of 8 mm do not fit on the pitch circle":
        {"bearing": "n_balls=20,pitch_diameter_mm=40,ball_diameter_mm=8"},
    "column width_mm: describes a spall, and fault is unknown; remove one of the two.": {"fault": "unknown", "width_mm": 1},
    "column path: /etc/passwd leads out of the folder": {"path": "/etc/passwd"},
    "column path: data/../../a.npy leads out of the folder": {"path": "data/../../a.npy"},
    "column specimen: '\\x1b' is a control character": {"specimen": "\x1b[2J"},
    "column specimen: '\\u202e' is a control character": {"specimen": "b\u202e7"},
    "column rig: '\\u200b' is a control character": {"rig": "\u200b7"},
    "column specimen: 'b\\nc' has a tab or a line break; write it on one line.": {"specimen": "b\nc"},
    "column title: 6000 characters are too many; give at most 5000.": {"title": "t" * 6000},
    "column column: is not a column; give its number, 0 to 999999,": {"column": "9" * 5000},
    "column delimiter: 2 characters are too many; give at most 1.": {"delimiter": ";;"},
    "column delimiter: '5' cannot separate columns; give one character": {"delimiter": "5"},
    "row 2: the unit is V and the sensitivity of the sensor is missing; give it in mV per g": {"sensitivity_mv_per_g": ""},
    "sensitivity_mv_per_g and sensitivity_mv_per_m_s2 are both given; remove one": {"sensitivity_mv_per_m_s2": 10},
    "row 2: a sensitivity is given and the unit is g, not V or mV; leave one": {"unit": "g"},
    "column sample_rate_hz: is missing; give it there, or for all": {"sample_rate_hz": ""},
    "column unit: is missing; give it there, or for all": {"unit": ""},
    "column channels: two are called x; give each a name of its own.": {"channels": "[{name: x, column: 0}, {name: x}]"},
    "column channels[0].colunm: no such key; did you mean column?": {"channels": "[{name: x, colunm: 0}]"},
    "row 2: sensor x: the unit is V and the sensitivity": {"unit": "g", "sensitivity_mv_per_g": "", "channels": "[{name: x, unit: V}]"},
    "column age_s: is missing, which event and rul_s go with; give it there": {"event": "failed"},
    "row 2: 'x' is in a column without a key in row 1; give the key, or quote a text with commas.": {"": "x"},
}  # fmt: skip


@pytest.mark.parametrize("sentence", REFUSED)
def test_a_row_that_cannot_be_meant_is_refused_with_a_sentence(tmp_path, sentence):
    assert sentence in refusal(tmp_path, BASE | REFUSED[sentence])


def test_every_flaw_has_a_sentence_of_its_own_and_one_of_many_rows_is_told_once(tmp_path):
    rows = [BASE | {"load_n": -1}] * 30 + [BASE | {"fault": "gear", "rig": "\a"}]
    assert [line.split(": ")[0] for line in refusal(tmp_path, *rows).split("\n")] == [
        "labels.csv, row 2, column load_n", "labels.csv, row 32, column fault", "labels.csv, row 32, column rig"
    ]  # fmt: skip


@pytest.mark.parametrize("key", ["title", "origin", "resample_hz", "channel", "channels", "sample_rate_hz"])
def test_files_of_a_corpus_share_title_rates_and_channels(tmp_path, key):
    values = {
        "channels": ("[{name: x}, {name: y}]", "[{name: x}]"),
        "resample_hz": (10, 20),
        "sample_rate_hz": (10, 20),
    }
    rows = [BASE | {"path": f"{n}.npy", key: value} for n, value in enumerate(values.get(key, "ab"))]
    told = refusal(tmp_path, *rows)
    assert told.startswith(f"labels.csv, row 3: has {key if 'channel' not in key else 'channel_names'} ")
    assert told.endswith("or make a corpus of each.")


def test_an_age_is_given_for_all_files_or_for_none(tmp_path):
    told = refusal(tmp_path, BASE | {"age_s": 5}, BASE | {"path": "b.npy"})
    assert told == (
        "labels.csv, row 3: has age_s none, and labels.csv, row 2 has one; give all files one, or make a corpus of each."
    )


TABLES = {
    "": "labels.csv: is empty (0 bytes); copy it again.",
    "path;fault\n;\n": "labels.csv: has no rows; write one with keys such as path, fault and specimen",
    "path,path\na,b\n": "labels.csv, row 1, column path: is there twice; remove one of the two.",
    "path,fault\n" + "x" * 200_000: "labels.csv: is truncated, damaged or not a CSV file",
    "path\n" + "\0" * 10: "labels.csv: is no text with columns",
    "path\n" + "a.npy\n" * 21: "labels.csv: names 21 files, and the limit is 20;",
}


def _speeds(folder, texts, **more):
    rows = [BASE | {"path": f"{n}.npy", "shaft_rpm": text, **more} for n, text in enumerate(texts)]
    return [labels.shaft_rpm for labels in read(folder, *rows, mark=";")]


OPEN = ["1.480 1480", "1480 1,480", "1.480 1480 990.5", "1.480,5 1.480", "1.480 1.500"]


@pytest.mark.parametrize("load", ["0.5", "1480"])
@pytest.mark.parametrize("texts", OPEN)
def test_a_speed_that_may_be_in_thousands_is_refused_whatever_other_columns_tell(tmp_path, texts, load):
    with pytest.raises(CorpusError, match=r"column shaft_rpm: 1[.,]480 may be in thousands; write it"):
        _speeds(tmp_path, texts.split(), load_n=load)


@pytest.mark.parametrize("texts", ["990.250 1480.125", "1,480.5 990.5", "1.4800 1480", "0.950 1.480"])
def test_speeds_that_all_show_the_decimal_mark_or_cannot_be_in_thousands_are_read(tmp_path, texts):
    assert _speeds(tmp_path, texts.split()) == [float(text.replace(",", "")) for text in texts.split()]


def test_a_table_of_speeds_has_the_same_rule(tmp_path):
    names = [Path(name) for name in ("a.wav", "b.wav")]
    table = tmp_path / "speeds.csv"
    table.write_text("file,rpm\na.wav,990.250-1000.125\nb.wav,1480.5\n", encoding="utf-8")
    assert read_speed_table(table, names, []) == {"a.wav": (990.25, 1000.125), "b.wav": (1480.5, 1480.5)}
    for text in ("1.480", "1.480-1.520", "1480-1.520"):
        table.write_text(f"file,rpm\na.wav,1480\nb.wav,{text}\n", encoding="utf-8")
        with pytest.raises(CorpusError, match=f"speeds.csv, row 3, column rpm: {text} may be in thousands; write it"):
            read_speed_table(table, names, [])


@pytest.mark.parametrize("content", TABLES, ids=range(len(TABLES)))
def test_a_file_that_is_no_table_is_refused(tmp_path, monkeypatch, content):
    monkeypatch.setenv(VARIABLE, "recording_files=20")
    (tmp_path / "labels.csv").write_text(content)
    with pytest.raises(CorpusError) as refused:
        read_table_of_labels(tmp_path / "labels.csv", {})
    assert TABLES[content] in str(refused.value)


def test_the_file_of_common_keys_holds_keys(tmp_path):
    table = write_labels(tmp_path, [BASE])
    for text, sentence in {"- 1": "labels.yaml: holds no keys; write those", "unit: [": "labels.yaml: line 1: is not valid YAML",
                           "unti: g": "labels.yaml: unti: no such key; did you mean unit?"}.items():  # fmt: skip
        table.with_suffix(".yaml").write_text(text)
        with pytest.raises(CorpusError, match=sentence):
            read_table_of_labels(table, {})


def test_the_table_in_the_documentation_is_one(tmp_path):
    page = (ROOT / "docs" / "importing.md").read_text(encoding="utf-8")
    table = re.search(r"```\n(path,.*?)```", page, re.DOTALL)[1]
    shared, channels = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    (tmp_path / "labels.csv").write_text(table, encoding="utf-8")
    (tmp_path / "labels.yaml").write_text(shared + channels, encoding="utf-8")
    rows_read = [labels for _, labels in read_table_of_labels(tmp_path / "labels.csv", {})]
    assert [labels.fault for labels in rows_read] == ["healthy", "healthy", "outer", "ball"]
    assert [labels.bearing.n_balls for labels in rows_read] == [9, 9, 9, 8]
    assert rows_read[0].channel_names == ("drive end", "fan end")
    rows = page.partition("| key | meaning |")[2].partition("\n\n")[0].splitlines()[1:]
    assert {key for row in rows for key in re.findall(r"`(\w+)`", row.split("|")[1])} == {*Labels.model_fields}
