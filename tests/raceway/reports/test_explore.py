"""The page to browse a corpus: what it stores, that it is safe and reproducible, and that it works in a browser."""

import base64
import json
import re
import zlib
from unicodedata import category

import numpy as np
import pytest

from features.table.band import DEFAULT_BAND
from features.table.corpus_features import feature_table
from features.table.table_files import read_table, write_table
from gen.corpus import open_corpus
from gen.corpus.choice import chosen_records
from gen.support.errors import CorpusError
from raceway.reports.explore import BLOCK, FIELDS, LEVELS, SCALES, STEP_DB, reduce_record, write_explorer
from raceway.reports.subject import shown_recording
from tests.browser import CHROMIUM, browser
from tests.pulses import ORDERS, pulse_train, write_pulses
from tests.raceway.reports.test_report import write_corpus

FS = 12_000.0
SEEN = "</script><script>alert(1)</script>'\"{{ 7 * 7 }}"
HOSTILE = "\u202e\u200f\x9b" + SEEN
RECORDS = 80  # more than a block


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    texts = np.array([HOSTILE] * RECORDS, object)
    return write_pulses(tmp_path_factory.mktemp("explored") / "corpus", records=20, silent=(3,), bearing=texts)


@pytest.fixture(scope="module")
def page(corpus, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "explore.html"
    table = path.with_name("features.nc")
    write_table(feature_table(corpus), table)
    write_explorer(corpus, path, table=table)
    return path


def parts(page):
    """Inflated parts of a page by name."""
    found = re.findall(r'<script type="text/plain" id="(\w+)">([^<]*)</script>', page.read_text())
    return {name: zlib.decompress(base64.b64decode(text)) for name, text in found}


def test_the_stored_spectra_have_their_peaks_at_the_planted_lines():
    x = pulse_train(FS, 2.0, 30.0 * ORDERS["bpfo"], 3000.0, np.random.default_rng(0))
    orders = [ORDERS[name] for name in ("ftf", "bpfo", "bpfi", "bsf")]
    stored = reduce_record(shown_recording("x", x, FS, (30.0, 30.0), orders, DEFAULT_BAND))
    scales = dict(zip(SCALES, stored["scales"].tolist(), strict=True))
    cell = scales["last_order"] / LEVELS
    assert (np.argmax(stored["envelope"]) + 0.5) * cell == pytest.approx(ORDERS["bpfo"], abs=cell)
    assert stored["envelope"].max() * STEP_DB > 20
    kilohertz = (np.argmin(stored["density"]) + 0.5) * FS / 2000 / len(stored["density"])
    assert kilohertz == pytest.approx(3.0, abs=0.2)
    assert max(stored["highest"].max(), -stored["lowest"].min()) == 127
    assert scales["peak"] == pytest.approx(np.abs(x[: round(8 / 30 * FS)]).max(), rel=0.05)
    assert {name: (value.dtype.name, value.size) for name, value in stored.items()} == dict(FIELDS)


def test_the_page_has_all_records_in_blocks_with_their_labels_and_features(page):
    found = parts(page)
    about = json.loads(found["about"])
    names = [one["name"] for one in about["quantities"]]
    values = {name: json.loads(found[f"quantity{number}"]) for number, name in enumerate(names)}
    assert values["record"] == list(range(RECORDS))
    assert values["fault"][::20] == ["healthy", "inner", "outer", "ball"]
    assert values["load"] == [None] * RECORDS
    assert {"whitened_bpfo_comb", "time_kurtosis"} <= set(names)
    assert not {"draws", "identity"} & set(names)
    assert about["axes"] == ["whitened_bpfi_comb", "whitened_bpfo_comb"]
    record = sum(np.dtype(kind).itemsize * size for kind, size in FIELDS.values())
    assert [len(found[f"block{k}"]) for k in range(2)] == [BLOCK * record, (RECORDS - BLOCK) * record]


def test_text_of_a_corpus_cannot_become_markup_and_only_the_script_of_the_page_may_run(page, tmp_path):
    made = tmp_path / "x.html"
    write_explorer(write_corpus(tmp_path / "corpus", HOSTILE + 400 * "x", specimens=4), made)
    for text in (page.read_text(), made.read_text()):
        assert "alert(1)</script>" not in text
        assert 400 * "x" not in text
        assert "style-src 'unsafe-inline'; script-src 'sha256-" in text
        assert len(re.findall(r"<script>", text)) == 1
        assert not re.search(r"""(src|href)=|https?://(?!www\.w3\.org/2000/svg)""", text)
    assert "&lt;script&gt;alert(1)" in made.read_text()
    held = made.read_text() + json.dumps(json.loads(parts(made)["about"]), ensure_ascii=False)
    assert not [letter for letter in held if category(letter) in ("Cc", "Cf") and letter != "\n"]


@pytest.mark.usefixtures("started_processes")
def test_equal_corpora_give_equal_pages_and_a_record_takes_two_kilobytes(corpus, page, tmp_path):
    for workers in (1, 2):
        write_explorer(corpus, tmp_path / f"{workers}.html", table=page.with_name("features.nc"), workers=workers)
    one, two = ((tmp_path / f"{k}.html").read_bytes() for k in (1, 2))
    assert one == two
    assert sum(len(part) for part in re.findall(rb'id="block\d+">([^<]*)', one)) < 2000 * RECORDS


def test_features_of_other_records_or_of_another_channel_are_refused(corpus, page, tmp_path):
    other = write_pulses(tmp_path / "other", records=2)
    with pytest.raises(CorpusError, match="has other records than the corpus"):
        write_explorer(other, tmp_path / "x.html", table=page.with_name("features.nc"))
    table = read_table(page.with_name("features.nc")).assign_attrs(channel="shaft")
    write_table(table, tmp_path / "shaft.nc")
    with pytest.raises(CorpusError, match=r"has features of shaft, not of housing; choose one of them\."):
        write_explorer(corpus, tmp_path / "x.html", table=tmp_path / "shaft.nc")
    with pytest.raises(CorpusError, match="lies above half the sample rate"):
        write_explorer(corpus, tmp_path / "x.html", band=(6000, 9000))
    assert not (tmp_path / "x.html").exists()


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium")
def test_the_page_works_in_a_browser_by_keys_at_any_width(page, corpus, tmp_path):
    name, count = "byId('name').textContent", "byId('count').textContent"
    with browser(tmp_path / "profile") as opened:
        opened.look(1400)
        opened.open(page)
        opened.until("document.querySelectorAll('.plots svg').length === 4")
        assert opened.value(name).startswith("Record 0: healthy, ")
        assert opened.value(count) == "80 of 80 records, 1 of them without a value to draw."
        opened.until("byId('value_bearing').textContent")
        assert opened.value("byId('value_bearing').textContent") == SEEN
        opened.press("ArrowRight")
        opened.until(f"{name}.startsWith('Record 1: ')")
        opened.press("/")
        opened.type("fault == 'inner' and shaft_rpm > 1620")
        opened.until(f"!{count}.startsWith('80')")
        assert 0 < int(opened.value(count).split()[0]) <= 20
        opened.until(f"{name}.includes(': inner')")
        opened.press("Escape")
        opened.value("byId('condition').value = 'nothing > 1'; choose()")
        told = opened.value("byId('complaint').textContent")
        assert told.startswith("nothing: no such column; the nearest is ")
        for condition in ("widht > 1", "fault > 1"):
            opened.value(f"byId('condition').value = '{condition}'; choose()")
            told = opened.value("byId('complaint').textContent")
            assert told.endswith(("the nearest is width.", "fault has text; put it in quotes."))
        opened.value("byId('condition').value = 'width > 5'; choose()")
        opened.until("byId('complaint').textContent.startsWith('where')")
        told = opened.value("byId('complaint').textContent")
        with open_corpus(corpus) as records, pytest.raises(CorpusError) as refused:
            chosen_records([records], "width > 5")
        assert told == str(refused.value)
        opened.value("show(79)")
        opened.until(f"{name}.startsWith('Record 79: ball')")
        opened.look(500, dark=True)
        opened.until("document.querySelector('#scatter svg').viewBox.baseVal.width < 500")
        assert opened.value("document.documentElement.scrollWidth <= innerWidth")
        assert opened.errors == []


OVERLAPPING = """
    [...document.querySelectorAll(".plots svg")].flatMap((svg) => {
        const boxes = [...svg.querySelectorAll("text")].map((text) => [text.textContent, text.getBoundingClientRect()]);
        return boxes.flatMap(([one, a], k) => boxes.slice(k + 1).filter(([, b]) =>
            a.left < b.right && b.left < a.right && a.top < b.bottom - 2 && b.top < a.bottom - 2
        ).map(([other]) => `${one} and ${other}`));
    })
"""


def test_no_label_of_a_line_overlaps_another_at_any_width(page, tmp_path):
    with browser(tmp_path / "profile") as opened:
        for width in (360, 1400):
            opened.look(width)
            opened.open(page)
            opened.until("document.querySelectorAll('.plots svg').length === 4")
            for record in range(4, 80, 15):
                opened.value(f"show({record})")
                opened.until(f"byId('name').textContent.startsWith('Record {record}: ')")
                assert opened.value(OVERLAPPING) == []


BROKEN = """
    [...document.querySelectorAll("#labels tr:not(.text) td")].filter((cell) => {
        const text = (cell.querySelector("small") ?? cell).firstChild;
        const range = document.createRange();
        if (text) range.selectNodeContents(text);
        return text && range.getClientRects().length > 1;
    }).map((cell) => cell.textContent)
"""


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium")
def test_no_number_and_no_unit_is_broken_at_any_width(page, tmp_path):
    with browser(tmp_path / "profile") as opened:
        for width in (1400, 1200, 1000, 500, 360):
            opened.look(width)
            opened.open(page)
            opened.until("document.querySelectorAll('.plots svg').length === 4")
            opened.value("document.querySelectorAll('#labels details').forEach((group) => { group.open = true; })")
            opened.until(
                "[...document.querySelectorAll('#labels tr td:first-of-type')].every((cell) => cell.textContent)"
            )
            assert opened.value(BROKEN) == [], width
            assert opened.value("document.documentElement.scrollWidth <= innerWidth"), width
        cells = opened.value(
            "[...document.querySelectorAll('#labels tr:not(.text) td')].map((cell) => cell.textContent)"
        )
        digits = [re.sub(r"^-?0\.0*|[^\d]", "", cell) for cell in cells if "." in cell]
        assert max(map(len, digits)) == 4
