"""The page and the pictures: complete, self-contained, escaped and reproducible; what cannot be drawn is refused."""

import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from unicodedata import category

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from features.baselines import TrackResults, benchmark
from features.baselines.detection import detection
from features.table.band import DEFAULT_BAND
from features.table.corpus_features import feature_table
from features.table.indicators import Orders
from gen.corpus import FAULTS, open_corpus
from gen.support.errors import CorpusError
from raceway.reports import examples
from raceway.reports.curves import draw_detection
from raceway.reports.pictures import draw_record, fault_lines, thin, write_picture
from raceway.reports.report_page import _findings, write_report
from raceway.reports.subject import shown_record
from raceway.reports.summaries import quantities
from tests.browser import CHROMIUM, browser
from tests.corpora import write_records

FS = 10_000.0
ORDERS = {"ftf": 0.4, "bpfo": 3.6, "bpfi": 5.4, "bsf": 2.35}
LINES = {"compound": (5.4, 3.6)}  # of other classes their fundamental line
FOUR = FAULTS[:4]  # a recipe need not have all classes
SOME = {name: name for name in ("ensemble", "logistic_regression", "envelope_rule", "majority")}
HOSTILE = "\u202e\u200f\x9b<script>alert(1)</script>'\"{{ 7 * 7 }}$\\frac"


def signal_of(fault, shaft_rate, rng):
    """Noise with an envelope that is periodic at the lines of the fault."""
    time = np.arange(4000) / FS
    own = list(fault_lines(Orders(**ORDERS), fault)[0].values())[:1]
    lines = LINES.get(fault, own)
    amplitude = sum(3 * np.exp(-6 * (1 - np.cos(2 * np.pi * line * shaft_rate * time))) for line in lines)
    return rng.standard_normal(time.size) * (0.2 + amplitude)


def write_corpus(directory, title="a made-up corpus", specimens=8, records=3, classes=4, **changed):
    rng = np.random.default_rng(0)
    specimen = np.repeat(np.arange(specimens), records)
    count = len(specimen)
    columns = {name: np.full(count, order) for name, order in ORDERS.items()}
    columns |= {
        "shaft_rate": rng.uniform(20, 40, count),
        "sample_rate": np.full(count, FS),
        "load": rng.uniform(100, 2000, count),
        "fault": specimen % classes,
        "width": 1e-3 * ~np.isin(specimen % classes, [0, 4]) * rng.uniform(0.5, 1, count),
        "rig": specimen // classes,
        "specimen": specimen,
        "recording": np.arange(count),
    }
    signal = [signal_of(FAULTS[fault], columns["shaft_rate"][n], rng) for n, fault in enumerate(columns["fault"])]
    told = {"recipe": title, "versions": {title: title}, "warnings": (title,)}
    return write_records(directory, signal, FS, columns | changed, title=title, **told)


@pytest.fixture(scope="module")
def results_of(quick_estimators):  # noqa: ARG001
    def results(corpus, test=None, estimators=None):
        other = () if test is None else feature_table(test)
        return benchmark(feature_table(corpus), other, folds=2, estimators=estimators)

    return results


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    return write_corpus(tmp_path_factory.mktemp("report") / "corpus")


@pytest.fixture(scope="module")
def results(corpus, results_of):
    return results_of(corpus, estimators=SOME)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("report") / "new" / "folder"


@pytest.fixture(scope="module")
def page(corpus, results, folder):
    return write_report(corpus, results, folder).read_text()


class Links(HTMLParser):
    """Addresses in a page, its unclosed elements, and its text."""

    def __init__(self, page):
        super().__init__()
        self.addresses, self.open, self.text = [], [], ""
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        self.addresses += [value for name, value in attrs if name in ("src", "href", "action", "data", "srcset")]
        if tag not in ("meta", "img", "br", "link"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += f"{data} "


def test_the_page_refers_to_no_other_file(page):
    found = Links(page)
    assert found.open == []
    assert len(found.addresses) == 9
    assert all(address.startswith("data:image/svg+xml;base64,") for address in found.addresses)
    assert "http" not in re.sub(r"base64,[^\"]*", "", page).replace("http-equiv", "")


def test_the_page_contains_the_counts_of_the_corpus_and_every_score(page, results):
    text = " ".join(Links(page).text.split())
    assert "24 records of 0.4 s at 10 kHz, 8 specimens on 2 rigs." in text
    for name in SOME:
        found = results.baselines[name].grouped
        assert f"{name.replace('_', ' ')} {found.balanced_accuracy:.3f} ± {np.std(found.folds):.3f}" in text
        expected = (found.auc, found.log_loss, found.ece, found.coverage)
        alarms = f"{round(6 * found.false_alarms)} of 6"
        assert (
            f"{name.replace('_', ' ')} {found.balanced_accuracy:.3f} {alarms} "
            f"{' '.join(f'{figure:.3f}' for figure in expected)}"
        ) in text
    for fault in FOUR:
        assert f"{fault} 6 2 2 6 0 0" in text
    assert "compound" not in text


@pytest.mark.usefixtures("unpainted")
def test_all_classes_are_counted_drawn_and_scored_and_text_of_a_corpus_is_escaped_and_cut_short(results_of, tmp_path):
    title, classes = HOSTILE + 400 * "x", len(FAULTS)
    rates = np.where(np.repeat(np.arange(2 * classes) % classes, 3) == 2, np.nan, 30.0)
    corpus = write_corpus(tmp_path / "corpus", title, specimens=2 * classes, classes=classes, shaft_rate=rates)
    test = write_corpus(tmp_path / "test", "2" + title, records=2)
    page = write_report(corpus, results_of(corpus, test, SOME), tmp_path / "out").read_text()
    found = Links(page)
    text = " ".join(found.text.split())
    assert "No record of this class has a signal, a shaft rate and fault orders to draw." in text
    assert len(found.addresses) == len(FAULTS) - 1 + 8
    assert "<script" not in page
    assert 400 * "x" not in page
    assert "{{ 7 * 7 }}" in page
    assert "other corpus" in page
    assert not [letter for letter in page if category(letter) in ("Cc", "Cf") and letter != "\n"]
    for fault in FAULTS:
        assert f"{fault} 6 2 2 6 0 0" in text
    assert f"true \\ predicted {' '.join(FAULTS)} healthy" in text
    assert f"chance is {1 / len(FAULTS):.3f}" in text


def test_quantities_are_drawn_in_the_unit_in_which_people_read_them(corpus):
    with open_corpus(corpus) as opened:
        records = opened.load()
    told = {"units": "1", "role": "latent", "long_name": "fault over all else in decibels re 1"}
    records["level"] = "record", np.arange(records.sizes["record"], dtype=float), told
    records["$x$"] = "record", records["level"].values, {"units": "m", "role": "label", "long_name": "no name"}
    drawn = quantities(records)
    for name, unit, factor in (("shaft_rate", "rpm", 60), ("width", "mm", 1e3), ("angle", "deg", 180 / np.pi)):
        values = np.where(records[name] == 0, np.nan, records[name]) if name != "shaft_rate" else records[name].values
        np.testing.assert_allclose(drawn[f"{name.replace('_', ' ')} [{unit}]"], factor * values)
    assert {"load [N]", "depth [um]", "level [dB]"} <= set(drawn)
    assert not {"ftf [1]", "$x$ [um]"} & set(drawn)


@pytest.mark.usefixtures("unpainted")
def test_the_example_of_a_class_is_the_record_of_median_level(corpus, monkeypatch):
    """The healthy records are 0 to 2 of specimen 0 and 12 to 14 of specimen 4; their levels are their numbers here."""
    monkeypatch.setattr(examples, "_line_level", lambda shown: float(shown.title.split(":")[0].split()[1]))
    with open_corpus(corpus) as opened:
        shown, caption = examples.examples_of(opened)["healthy"]
    assert shown.title.startswith("Record 12: ")
    assert caption.startswith("Specimen 4 of rig 1, ")
    assert caption.endswith("; the median of the 6 records of its class by the level of the fault lines.")


def test_an_example_says_of_how_many_records_it_is_the_median(corpus, monkeypatch):
    monkeypatch.setattr(examples, "CANDIDATES", 4)
    with open_corpus(corpus) as opened:
        _, caption = examples.examples_of(opened)["healthy"]
    assert caption.endswith("; the median of 4 of the 6 records of its class by the level of the fault lines.")


def test_the_page_is_reproducible_and_written_with_the_results(corpus, results, page, folder):
    assert write_report(corpus, results, folder).read_text() == page
    held = json.loads((folder / "results.json").read_text())
    assert sorted(path.name for path in folder.iterdir()) == ["report.html", "results.json"]
    assert held["importance"] == results.importance
    assert held["baselines"]["ensemble"]["grouped"]["roc"]["area"] == results.baselines["ensemble"].grouped.roc.area
    assert held["baselines"]["ensemble"]["null"]["accuracy"] == results.baselines["ensemble"].null.accuracy


@pytest.fixture
def several(results):
    """Results on two tracks and on another corpus."""
    tested = {
        name: replace(row, tests=(replace(row.grouped, by_recording=row.grouped),))
        for name, row in results.baselines.items()
    }
    further = {"rig": TrackResults(2, 24, 24, results.baselines)}
    return replace(results, tests=(results.corpus,), baselines=tested, further=further)


@pytest.mark.usefixtures("unpainted")
def test_tracks_and_another_corpus_stand_on_one_page(corpus, several, tmp_path):
    assert "on every track" in write_report(corpus, several, tmp_path / "out").read_text()


def test_a_score_above_chance_with_permuted_labels_is_reported_as_a_leak(results):
    found = results.baselines["ensemble"]
    leaking = replace(found, null=replace(found.null, interval=(0.8, 0.9)))
    suspicious = replace(results, baselines=results.baselines | {"ensemble": leaking})
    assert "above chance; look for a leak" in _findings(suspicious, 0.25)[3]
    honest = replace(found, null=replace(found.null, interval=(0.2, 0.9)))
    fine = replace(results, baselines=results.baselines | {"ensemble": honest})
    assert "at chance, as expected" in _findings(fine, 0.25)[3]


@pytest.mark.parametrize(("leaky", "told"), [(0.5, True), (1.0, False)])
def test_a_leaky_split_below_the_score_and_an_interval_without_width_are_explained(results, leaky, told):
    found = results.baselines["ensemble"]
    row = replace(
        found, leaky=replace(found.leaky, balanced_accuracy=leaky),
        grouped=replace(found.grouped, balanced_accuracy=0.9, interval=(leaky + 0.5, 1.0)),
    )  # fmt: skip
    findings = " ".join(_findings(replace(results, baselines=results.baselines | {"ensemble": row}), 0.25))
    assert [text in findings for text in ("shows no leak", "interval from 1 to 1")] == [told, told]


@pytest.mark.parametrize(("suffix", "start"), [(".svg", b"<?xml"), (".pdf", b"%PDF"), (".PNG", b"\x89PNG")])
def test_a_record_is_drawn_reproducibly_in_the_format_of_the_suffix_and_replaces_its_picture(
    corpus, tmp_path, suffix, start
):
    path, written = tmp_path / f"picture{suffix}", set()
    for _ in range(2):
        write_picture(draw_record(shown_record(corpus, 3, 0, DEFAULT_BAND)), path)
        written.add(path.read_bytes())
    assert len(written) == 1
    assert path.read_bytes().startswith(start)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("record", "channel", "name", "sentence"),
    [
        (0, 0, "picture.gif", r"\.gif is no format of pictures; use \.png, \.svg or \.pdf"),
        (0, 0, "picture", "no suffix is no format of pictures"),
        (24, 0, "picture.png", "no record 24; give one of 0 to 23"),
        (-1, 0, "picture.png", "no record -1; give one of 0 to 23"),
        (0, 1, "picture.png", "no channel 1; give one of housing"),
        (0, 0, "missing/picture.png", "could not be written"),
    ],
)
def test_a_record_that_cannot_be_drawn_is_refused_in_one_sentence(corpus, tmp_path, record, channel, name, sentence):
    with pytest.raises(CorpusError, match=sentence):
        write_picture(draw_record(shown_record(corpus, record, channel, DEFAULT_BAND)), tmp_path / name)


def test_a_record_without_a_shaft_rate_is_refused(tmp_path):
    unknown = write_corpus(tmp_path / "corpus", shaft_rate=np.zeros(24))
    with pytest.raises(CorpusError, match="record 1: cannot be drawn"):
        shown_record(unknown, 1, 0, DEFAULT_BAND)


@given(length=st.integers(2, 40_000), place=st.floats(0, 0.99), seed=st.integers(0, 99))
def test_a_thinned_waveform_keeps_its_highest_peak(length, place, seed):
    values = np.random.default_rng(seed).standard_normal(length)
    values[int(place * length * 0.9)] = 20.0
    time, drawn = thin(np.arange(length) / FS, values)
    assert drawn.max() == 20.0
    assert time.shape == drawn.shape
    assert drawn.size < 6100


def test_detection_is_drawn_with_its_bins_intervals_and_false_alarms():
    width = np.repeat(np.geomspace(0.2e-3, 2e-3, 20), 5)
    specimen = np.arange(100)
    found = detection(specimen % 5 < np.repeat(np.arange(20), 5) / 2, width, specimen)
    (panel,) = draw_detection(found, 0.2).axes
    intervals, shares = panel.collections
    np.testing.assert_allclose(shares.get_offsets(), [(1e3 * one.width, one.detected) for one in found])
    ends = np.array(intervals.get_segments())
    np.testing.assert_allclose(ends[..., 1], [(one.low, one.high) for one in found])
    (alarms,) = panel.lines
    assert list(alarms.get_ydata()) == [0.2, 0.2]


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium")
def test_figures_are_whole_and_tables_scroll_by_keys_on_a_narrow_window_alone(corpus, several, tmp_path):
    """No figure is cut, at 500 px they keep three quarters of their size, and only tables are wider than the page."""
    page = write_report(corpus, several, tmp_path / "out")
    scrolling = "[...document.querySelectorAll('div.scroll')].filter(d => d.scrollWidth > d.clientWidth)"
    with browser(tmp_path / "profile") as opened:
        for width, dark, least in ((500, False, 0.75), (500, True, 0.75), (360, False, 0.5)):
            opened.look(width, dark=dark)
            opened.open(page)
            assert opened.value("document.documentElement.scrollWidth <= document.documentElement.clientWidth")
            scales = opened.value("[...document.images].map(image => image.clientWidth / image.naturalWidth)")
            assert min(scales) > least
            assert opened.value("[...document.images].every(i => i.getBoundingClientRect().right <= innerWidth)")
            wide = opened.value(f"{scrolling}.map(d => d.tabIndex + (d.ariaLabel ? ' told' : ''))")
            assert set(wide) == {"0 told"}
        opened.look(1200)
        assert opened.value(f"{scrolling}.length") == 0
        assert opened.errors == []
