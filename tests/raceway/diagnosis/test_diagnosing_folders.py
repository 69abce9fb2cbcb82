"""``raceway diagnose FOLDER``: a table, pages with an index, and a list; each file is read with what it states."""

import csv
import html
import os
import re
import tempfile
from pathlib import Path
from urllib.parse import unquote, urljoin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.io import savemat

from raceway.importing.user_folder import recordings_in
from tests.diagnoses import FS, call, told, write_csv, write_wav

pytestmark = pytest.mark.usefixtures("unpainted")


def test_a_folder_of_recordings_becomes_a_table_and_pages(model, recordings, tmp_path):
    folder, pages = tmp_path / "campaign", tmp_path / "pages"
    folder.mkdir()
    for fault in ("inner", "outer"):
        write_csv(folder / f"{fault}.csv", recordings[fault][0])
    write_wav(folder / "new.wav", recordings["healthy"][0])
    (folder / "note.txt").write_text("nothing measured", encoding="utf-8")
    (folder / "list.doc").write_text("no recording", encoding="utf-8")
    options = (folder, "--bearing", "6205", "--rpm", "1700-1800", "--model", model)
    result = call(*options, "--healthy", folder / "new.wav", "-o", pages)
    assert result.exit_code == 0, result.output
    header, *rows = result.stdout.partition("\n\n")[0].splitlines()
    assert header.split() == ["recording", "verdict", "probability", "rpm", "strongest", "lines", "warnings"]
    assert [row.split()[:2] for row in rows] == [["inner.csv", "inner"], ["outer.csv", "outer"], ["note.txt", "not"]]
    assert "BPFI" in rows[0]
    assert "note.txt: has no row of numbers among its first 1 lines" in result.stdout
    assert sorted(page.name for page in pages.iterdir()) == [
        "diagnoses.csv",
        "index.html",
        "inner.csv.html",
        "outer.csv.html",
    ]
    listed = told(*options)
    assert [Path(one["recording"]).name for one in listed] == ["inner.csv", "new.wav", "outer.csv", "note.txt"]
    assert [one.get("verdict") for one in listed] == ["inner", "healthy", "outer", None]
    alone = told(folder / "inner.csv", *options[1:])
    assert {**listed[0]} == alone


def test_a_folder_gets_an_index_page_and_a_csv_file_with_the_same_rows(model, recordings, tmp_path):
    folder, pages = tmp_path / "<b>campaign", tmp_path / "pages"
    folder.mkdir()
    write_wav(folder / "=a: <i>&#100%.wav", recordings["outer"][0])
    (folder / "note.txt").write_text("nothing measured", encoding="utf-8")
    options = (folder, "--bearing", "6205", "--rpm", "1700-1800", "--model", model, "-o", pages)
    _, found = (told(*options)[0] for _ in range(2))  # the second call replaces the files of the first
    with (pages / "diagnoses.csv").open(encoding="utf-8", newline="") as file:
        outer, note = csv.DictReader(file)
    assert outer["recording"] == "'=a: <i>&#100%.wav"  # no formula
    assert (outer["verdict"], outer["likeliest"], outer["page"]) == ("outer", "outer", "'=a: <i>&#100%.wav.html")
    assert float(outer["probability"]) == pytest.approx(found["probabilities"]["outer"], abs=1e-4)
    assert float(outer["rpm"]) == pytest.approx(found["shaft_rpm"], abs=0.1)
    assert outer["strongest_lines"].startswith(
        f"{found['evidence'][0]['line']} {found['evidence'][0]['level_db']:.0f} dB"
    )
    assert (int(outer["warnings"]), outer["sentence"]) == (len(found["warnings"]), found["sentence"])
    assert (note["recording"], note["verdict"], note["probability"]) == ("note.txt", "not used", "")
    page = (pages / "index.html").read_text(encoding="utf-8")
    assert "Diagnoses of &lt;b&gt;campaign" in page
    assert "2 recordings: 1 outer, 1 not used." in page
    assert ">=a: &lt;i&gt;&amp;#100%.wav</a>" in page
    (link,) = re.findall(r'href="([^"]*)"', page)
    assert urljoin("file:///pages/index.html", link) == f"file:///pages/{link}"  # the colon makes no scheme
    assert unquote(link) == "=a: <i>&#100%.wav.html"
    assert note["sentence"].startswith("note.txt: has no row of numbers")
    assert note["sentence"] in html.unescape(page)
    assert str(tmp_path) not in page


def test_a_file_name_that_is_no_text_gets_a_page_too(model, recordings, tmp_path):
    folder, pages = tmp_path / "campaign", tmp_path / "pages"
    folder.mkdir()
    try:
        write_wav(folder / os.fsdecode(b"a\xff.wav"), recordings["outer"][0])
    except OSError:
        pytest.skip("this disk takes names in UTF-8 alone")
    done = call(folder, "--bearing", "6205", "--rpm", "1700-1800", "--model", model, "-o", pages)
    assert done.exit_code == 0, done.output
    assert {page.name for page in pages.iterdir()} == {r"a\xff.wav.html", "index.html", "diagnoses.csv"}
    assert 'href="a%5Cxff.wav.html">a.wav</a>' in (pages / "index.html").read_text(encoding="utf-8")


def test_a_file_of_a_folder_that_states_another_rate_or_unit_is_read_as_it_states(model, recordings, tmp_path):
    signal, rpm = recordings["outer"]
    folder = tmp_path / "campaign"
    folder.mkdir()
    np.savetxt(folder / "plain.csv", signal / 9.80665, header="drive_end", comments="")
    text = write_csv(folder / "times.csv", signal).read_text(encoding="utf-8")
    (folder / "unit.csv").write_text(text.replace("drive_end", "drive_end [m/s2]"), encoding="utf-8")
    how = ("--channel", "drive_end", "--rate", 25_600, "--bearing", "6205", "--rpm", rpm, "--model", model)
    plain, times, other = told(folder, "--unit", "V", "--sensitivity", 1000, *how)
    assert [one["sample_rate_hz"] for one in (plain, times, other)] == [25_600, FS, FS]
    assert times["verdict"] == other["verdict"] == "outer"
    assert "times.csv: it states otherwise than --rate 25600, and is read as it states." in times["warnings"]
    for option in ("--rate 25600", "--unit V", "--sensitivity 1000"):
        assert f"unit.csv: it states otherwise than {option}, and is read as it states." in other["warnings"]
    assert [one["levels"][0]["rms"] for one in (times, other)] == pytest.approx(
        [signal.std(), signal.std() / 9.80665], rel=1e-3
    )
    assert plain["warnings"] == [one for one in plain["warnings"] if "states otherwise" not in one]
    alone = call(folder / "unit.csv", "--unit", "V", "--sensitivity", 1000, *how)
    assert (alone.exit_code, "correct what is given" in alone.stderr) == (2, True)


@pytest.mark.parametrize(
    ("files", "options", "sentence"),
    [
        ((), (), "has no recording in it (.csv, "),
        (("a.txt",), (), "no recording can be used; the first of 1: campaign/a.txt: has no row of numbers"),
        (("a.txt",), ("-o", "mine"), "page.html: was not made by raceway"),
        (("a.txt",), ("-o", "mine/page.html"), "is a file; give a folder"),
        (("a.txt",), ("-o", "new.html"), "new.html is the name of a page; give that of a folder"),
        (("a.txt",), ("-o", "list"), "diagnoses.csv: exists and is no list of diagnoses of raceway"),
        (("a.txt",), ("-o", "./campaign"), "campaign is the folder of the recordings; give another one for the pages"),
    ],
)
def test_a_folder_that_cannot_be_used_is_one_sentence(files, options, sentence, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("campaign", "mine", "list"):
        Path(name).mkdir()
    Path("list/diagnoses.csv").write_text("date,verdict", encoding="utf-8")
    Path("mine/page.html").write_text("mine", encoding="utf-8")
    for name in files:
        Path("campaign", name).write_text("nothing", encoding="utf-8")
    result = call("campaign", "--rpm", 1750, "--model", "none.skops", *options)
    assert (result.exit_code, result.stdout) == (2, "")
    assert sentence in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1


@given(st.lists(st.tuples(st.sampled_from(["run", "Run 7 part "]), st.integers(0, 10**20)), unique=True))
def test_files_are_in_the_order_of_the_numbers_in_their_names(named):
    with tempfile.TemporaryDirectory() as folder:
        for name, number in named:
            Path(folder, f"{name}{number}.csv").touch()
        Path(folder, "Run.csv").touch()
        expected = ["Run.csv", *(f"{name}{number}.csv" for name, number in sorted(named))]
        assert sorted(path.name for path in recordings_in(Path(folder), [])) == sorted(expected)
        assert [path.name for path in recordings_in(Path(folder), []) if path.name != "Run.csv"] == expected[1:]


def test_a_table_of_speeds_is_no_recording(tmp_path):
    tables = {"a.csv": "file,rpm\n", "b.csv": 'note;"rpm";"file"\n', "c.txt": "\ufeffrpm\tfile\r\n1\ta.wav\r\n"}
    for name, text in {**tables, "r.csv": "rpm,x\n", "s.csv": "file\n"}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    assert [path.name for path in recordings_in(tmp_path, [])] == ["r.csv", "s.csv"]


def test_each_recording_of_a_folder_is_diagnosed_at_its_speed_in_the_table(model, recordings, tmp_path):
    folder = tmp_path / "campaign"
    folder.mkdir()
    (signal, rpm), (_, other) = recordings["outer"], recordings["inner"]
    for number in (2, 10):
        write_wav(folder / f"{number}.wav", signal)
    table = folder / "speeds.csv"
    table.write_text(f"note;rpm;file\n;{other - 40}-{other + 40};10.wav\nas fitted;{rpm};2.wav\n", encoding="utf-8")
    options = ("--bearing", "6205", "--model", model)
    listed = told(folder, "--speed-table", table, *options)
    assert [Path(each["recording"]).name for each in listed] == ["2.wav", "10.wav"]
    assert [each["given_rpm"] for each in listed] == [
        pytest.approx([rpm, rpm]),
        pytest.approx([other - 40, other + 40]),
    ]
    assert listed[0] == told(folder / "2.wav", "--rpm", rpm, *options)


@pytest.mark.parametrize("row", ["", "new.wav,1500\n"])
def test_a_healthy_recording_of_the_folder_may_have_a_speed_in_the_table_and_needs_none(
    row, model, recordings, tmp_path
):
    for fault, name in (("outer", "worn.wav"), ("healthy", "new.wav")):
        write_wav(tmp_path / name, recordings[fault][0])
    table = tmp_path / "speeds.csv"
    table.write_text(f"file,rpm\n{row}worn.wav,{recordings['outer'][1]}\n", encoding="utf-8")
    options = ("--bearing", "6205", "--speed-table", table, "--healthy", tmp_path / "new.wav", "--model", model)
    assert [Path(each["recording"]).name for each in told(tmp_path, *options)] == ["worn.wav"]


@pytest.mark.parametrize(
    ("text", "options", "sentence"),
    [
        ("file,rpm\na.wav,1500\n", (), "speeds.csv: has no row for b.wav; add one for each recording of the folder."),
        ("file,rpm\n", (), "speeds.csv: has no rows; write one with keys such as file and rpm"),
        ("file,speed\na.wav,1500\n", (), "row 1: has the columns file, speed; name one file and one rpm."),
        ("file,rpm\nc.wav,1500\n", (), "row 2, column file: 'c.wav' is no recording of the folder; correct the name."),
        ("file,rpm\na.wav,1\n\na.wav,1\n", (), "row 4, column file: 'a.wav' is in two rows; remove one."),
        (
            "file,rpm\na.wav,1\nnew.wav,1\nnew.wav,1\n",
            ("--healthy", "new.wav"),
            "row 4, column file: 'new.wav' is in two rows",
        ),
        ("file,rpm\na.wav,fast\n", (), "row 2, column rpm: 'fast' is no speed and no range such as 1400-1900"),
        ("file,rpm\na.wav,1500\nb.wav\n", (), "row 3, column rpm: '' is no speed"),
        ("file,rpm\n", ("--rpm", 1500), "--rpm and --speed-table both tell the speed; leave one of the two out"),
        (None, (), "speeds.csv: could not be read (No such file or directory); check the path."),
    ],
)
def test_a_table_of_speeds_that_does_not_fit_the_folder_is_one_sentence(text, options, sentence, tmp_path):
    folder, table = tmp_path / "campaign", tmp_path / "speeds.csv"
    folder.mkdir()
    for name in ("a.wav", "b.wav"):
        write_wav(folder / name, np.ones(9))
    if text is not None:
        table.write_text(text, encoding="utf-8")
    result = call(folder, "--bearing", "6205", "--speed-table", table, "--model", "none.skops", *options)
    assert (result.exit_code, result.stdout) == (2, "")
    assert sentence in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1


def test_a_speed_that_a_file_states_counts_as_given_and_without_a_bearing_a_file_needs_one(model, recordings, tmp_path):
    signal, rpm = recordings["outer"]
    for name, stated in (("1", {"X001RPM": rpm}), ("2", {})):
        savemat(tmp_path / f"{name}.mat", {"X001_DE_time": signal, **stated})
    options = ("--rate", FS, "--unit", "m/s2", "--model", model)
    searched, refused = told(tmp_path, *options)
    assert searched["given_rpm"] == pytest.approx([rpm, rpm])
    sentence = "2.mat: states no speed; give --bearing, --rpm or both."
    assert refused["error"].endswith(sentence)
    alone = call(tmp_path / "2.mat", *options)
    assert (alone.exit_code, alone.stdout, sentence in alone.stderr) == (2, "", True)


def test_a_table_of_speeds_needs_a_folder(tmp_path):
    result = call(write_wav(tmp_path / "a.wav", np.ones(9)), "--speed-table", "s.csv", "--bearing", "6205")
    assert (result.exit_code, "--speed-table is for a FOLDER; give the speed of a.wav with --rpm" in result.stderr) == (
        2,
        True,
    )
