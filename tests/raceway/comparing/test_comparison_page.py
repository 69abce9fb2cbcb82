"""``raceway compare``: its page is complete, self-contained and escaped; its tables, files and JSON, and what it refuses."""

import base64
import json
import re

import numpy as np
import pytest

from raceway.comparing import compare
from raceway.comparing.comparison_page import write_comparison
from raceway.comparing.measures import MEASURES
from tests.pulses import write_pulses
from tests.raceway.reports.test_report import Links

HOSTILE = "<b>{{ 7 * 7 }}'"


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sets")
    made = write_pulses(folder / "made", ringing=1500.0)
    real = [write_pulses(folder / HOSTILE), write_pulses(folder / "other", classes=("inner", "ball"), seed=1)]
    return compare(made, real)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("page") / "new" / "folder"


@pytest.fixture(scope="module")
def page(found, folder):
    return write_comparison(found, folder).read_text()


def test_the_page_has_two_pictures_per_class_and_refers_to_no_other_file(page):
    links = Links(page)
    assert links.open == []
    assert len(links.addresses) == 8
    assert all(address.startswith("data:image/svg+xml;base64,") for address in links.addresses)
    assert "http" not in re.sub(r"base64,[^\"]*", "", page).replace("http-equiv", "")


def test_the_page_has_every_auc_and_the_meaning_of_every_measure(page, found):
    text = " ".join(Links(page).text.split())
    for fault, table in found.auc.items():
        assert f" {fault} Windows: synthetic 12" in text
        for name, value in table.items():
            unit = next(measure.unit for measure in MEASURES if measure.name == name)
            assert f"{name} {unit} {'' if value is None else f'{value:.2f}'}".strip() in text
    for measure in MEASURES:
        assert measure.meaning in text


def test_names_of_folders_are_text_on_the_page_and_absent_from_pictures(page):
    assert HOSTILE not in page
    assert "&lt;b&gt;{{ 7 * 7 }}&#39;" in page
    pictures = [base64.b64decode(address.partition("base64,")[2]) for address in Links(page).addresses]
    assert not any(b"7 * 7" in picture for picture in pictures)


pytestmark = pytest.mark.usefixtures("unpainted")


@pytest.fixture(scope="module")
def sets(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sets")
    write_pulses(folder / "made", ringing=1500.0)
    write_pulses(folder / "first", ringing=3500.0, seed=1)
    write_pulses(folder / "second", fs=20_000.0, classes=("inner", "outer"), seed=2)
    write_pulses(folder / "cages", classes=("healthy",), seed=3)
    write_pulses(folder / "few", records=4)
    write_pulses(folder / "still", classes=("outer",), shaft_rate=np.zeros(12))
    return folder


def test_the_auc_of_every_class_and_measure_is_printed_as_json(told, sets, tmp_path):
    found = told("compare", sets / "made", sets / "first", sets / "second", "-o", tmp_path / "out")
    assert list(found["auc"]) == ["healthy", "inner", "outer", "ball"]
    assert found["auc"]["outer"]["centroid"] == 1.0
    assert {"line_width", "skewness", "roll_off", "kurtosis"} <= set(found["auc"]["inner"])
    assert {"cage_line", "cyclostationarity"} <= set(found["auc"]["ball"])
    assert set(found["yardstick"]) == {"first", "second"}
    assert set(found["quantiles"]["outer"]["kurtosis"]) == {"synthetic", "real", "first", "second"}
    stored = json.loads((tmp_path / "out" / "comparison.json").read_text())
    assert stored == {"generator": "Raceway"} | {key: value for key, value in found.items() if key != "report"}
    assert found["report"] == str(tmp_path / "out" / "report.html")


def test_the_table_has_a_row_per_measure_and_names_the_page(run, sets, tmp_path):
    result = run("compare", sets / "made", sets / "first", "-o", tmp_path / "out", "--window", 0.05)
    assert result.exit_code == 0
    lines = result.stdout.splitlines()
    head = next(number for number, line in enumerate(lines) if line.startswith("measure"))
    assert lines[head].split() == ["measure", "healthy", "inner", "outer", "ball"]
    assert lines[head + 1].split()[:1] == ["energy_above_3500_hz"]
    assert str(tmp_path / "out" / "report.html") in lines[-1]
    assert (tmp_path / "out" / "report.html").is_file()
    outer = json.loads((tmp_path / "out" / "comparison.json").read_text())["auc"]["outer"]
    assert outer["centroid"] > 0.99
    assert None in outer.values()  # windows are too short for lines


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("{made} -o {new}", "Missing argument 'REAL...'"),
        ("{cages} {second} -o {new}", "has no class that the real corpora have: healthy here, inner, outer there"),
        ("{made} {still} -o {new}", "still: no record has a shaft rate and fault orders above 0"),
        ("{made} {first} -o {new} --top 7000", "shows nothing above 6000 Hz, and records are compared up to 7000 Hz"),
        ("{made} {first} -o {new} --window 2", "shorter than the window of 2 s"),
        ("{made} {few} -o {new}", "no class has 10 usable windows"),
    ],
)
def test_bad_input_is_refused_in_one_sentence_and_nothing_is_written(run, sets, tmp_path, line, sentence):
    names = {path.name: path for path in sets.iterdir()} | {"nowhere": tmp_path / "nowhere", "new": tmp_path / "new"}
    result = run("compare", *line.format(**names).split())
    assert result.exit_code == 2
    assert sentence in result.stderr
    assert len([text for text in result.stderr.splitlines() if not text.startswith("measuring")]) == 1
    assert not (tmp_path / "new").exists()
