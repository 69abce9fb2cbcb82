"""The page of a comparison: complete, self-contained and escaped."""

import base64
import re

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
