"""``raceway diagnose``: a sentence, a JSON object and a page for good recordings, one sentence for all others."""

import csv
import html
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote, urljoin

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.io import savemat, wavfile
from scipy.stats import kurtosis

import features
from features import feature_table
from features.baselines import Model
from features.signal import velocity_rms
from gen import generate, open_corpus
from gen.corpus import FAULTS
from gen.importers.bearing_text import bearing_orders
from raceway.cli import cli

FS = 12_000
RECIPE = """\
# Recordings to diagnose, for tests; they share the kernel of the tiny recipe.
name: recordings
title: Recordings
seed: {seed}
corpus: {{rigs: {rigs}, specimens_per_rig: 4, records_per_specimen: {records}}}
storage: {{records_per_part: 48}}
recording: {{sample_rate_hz: 12000, duration_s: {duration}, settle_s: 0.05, converter: {{kind: float32}}}}
bearing: {{kind: catalogue, designations: ["6205"]}}
specimen: {{waviness_nm: 20}}
operation: {{shaft_rpm: 'uniform(1700, 1800)'}}
background: {{slope: 'uniform(0, 1)'}}
faults:
  - {{kind: healthy}}
  - {{kind: inner, width_mm: 'uniform(0.5, 1)'}}
  - {{kind: outer, width_mm: 'uniform(0.5, 1)'}}
  - {{kind: ball, width_mm: 'uniform(0.5, 1)'}}
"""
LINE_ORDERS = {"inner": 5.4152, "outer": 3.5848, "ball": 4.7135}


def corpus(folder, **values):
    recipe = folder / "recipe.yaml"
    recipe.write_text(RECIPE.format(**values), encoding="utf-8")
    return generate(recipe, folder / "corpus").path


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    folder = tmp_path_factory.mktemp("training")
    table = feature_table(corpus(folder, seed=5, rigs=6, records=2, duration=0.5))
    Model("logistic_regression").fit(table).save(folder / "model.skops")
    return folder / "model.skops"


@pytest.fixture(scope="module")
def recordings(tmp_path_factory):
    """Signal [m s-2] and speed [rpm] of one recording of each class."""
    found = {}
    with open_corpus(corpus(tmp_path_factory.mktemp("tested"), seed=11, rigs=1, records=1, duration=3.0)) as opened:
        for number, code in enumerate(opened["fault"].values):
            signal = opened["acceleration"][number, 0].values.astype(float)
            found[FAULTS[code]] = signal, 60 * float(opened["shaft_rate"][number])
    return found


def call(*arguments):
    return CliRunner().invoke(cli, ["diagnose", *map(str, arguments)], prog_name="raceway")


def told(*arguments):
    result = call(*arguments, "--json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def write_csv(path, signal):
    time = np.arange(signal.size) / FS
    np.savetxt(
        path,
        np.stack([time, signal / 9.80665], axis=1),
        delimiter=",",
        header="time [s],drive_end",
        comments="",
        fmt="%.7g",
    )
    return path


def write_wav(path, *channels):
    wavfile.write(
        path, FS, np.stack(channels, axis=1).astype(np.float32) if len(channels) > 1 else channels[0].astype(np.float32)
    )
    return path


@pytest.mark.parametrize("fault", ["healthy", "inner", "outer", "ball"])
@pytest.mark.parametrize("suffix", ["csv", "wav"])
def test_a_simulated_recording_of_each_class_is_diagnosed(fault, suffix, model, recordings, tmp_path):
    signal, rpm = recordings[fault]
    if suffix == "csv":
        options = [write_csv(tmp_path / "r.csv", signal), "--channel", "drive_end", "--rate", FS, "--unit", "g"]
    else:
        options = [write_wav(tmp_path / "r.wav", signal)]
    found = told(*options, "--bearing", "6205", "--rpm", rpm, "--model", model)
    assert found["verdict"] == fault
    assert sum(found["probabilities"].values()) == pytest.approx(1.0)
    assert max(found["probabilities"], key=found["probabilities"].get) == fault
    assert found["shaft_rpm"] == pytest.approx(rpm, rel=0.02)
    assert f"{found['shaft_rpm']:,.0f} rpm" in found["sentence"]
    if fault == "healthy":
        assert found["evidence"] == []
        assert found["sentence"].startswith("Healthy (probability ")
        assert found["sentence"].endswith(
            " faulty recordings of about this length from three machines were called healthy."
        )
        assert 0 < found["missed_share"] < 0.5
        assert any(sentence.startswith("Record longer") for sentence in found["advice"])
        return
    assert found["missed_share"] is None
    first = found["evidence"][0]
    assert first["fault"] == fault
    assert first["order"] == pytest.approx(first["harmonic"] * LINE_ORDERS[fault], rel=0.02)
    assert first["frequency_hz"] == pytest.approx(first["order"] * found["shaft_rpm"] / 60, rel=1e-3)
    assert first["level_db"] >= 3
    assert found["explanations"][0]["shaft_rpm"] == pytest.approx(found["shaft_rpm"], abs=0.01)
    assert len(first["band"]) == 2
    assert first["line"] in found["sentence"]


def test_the_sentence_is_printed_and_the_page_is_self_contained(model, recordings, tmp_path):
    signal, rpm = recordings["outer"]
    page = tmp_path / "report.html"
    result = call(
        write_wav(tmp_path / "<fan>.wav", signal), "--bearing", "6205", "--rpm", rpm, "--model", model, "-o", page
    )
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("Outer race fault (probability ")
    text = page.read_text(encoding="utf-8")
    assert "&lt;fan&gt;.wav" in text
    assert "<fan>" not in text
    assert not re.search(r'(src|href)="(?!data:)', text)
    assert "BPFO" in text
    assert "Probabilities" in text


def test_a_speed_that_is_5_per_cent_off_is_corrected_and_told(model, recordings, tmp_path):
    signal, rpm = recordings["inner"]
    found = told(write_wav(tmp_path / "r.wav", signal), "--bearing", "6205", "--rpm", 1.05 * rpm, "--model", model)
    assert found["shaft_rpm"] == pytest.approx(rpm, rel=0.02)
    assert any("does not fit the lines" in sentence for sentence in found["warnings"])
    assert "as found" in found["sentence"]
    assert found["evidence"][0]["fault"] == "inner"


RPM = 1770.0


def impulses(order, seed=0):
    """Noise, shaft harmonics, and impulses at an order of the shaft that excite a resonance."""
    rng = np.random.default_rng(seed)
    t = np.arange(3 * FS) / FS
    since = np.mod(t + rng.uniform(), 60 / (order * RPM))
    shaft = sum(np.cos(2 * np.pi * k * RPM / 60 * t + k) / k for k in range(1, 7))
    return rng.standard_normal(t.size) + 0.3 * shaft + 8 * np.exp(-900 * since) * np.sin(2 * np.pi * 2800 * since)


@pytest.mark.parametrize("fault", ["inner", "outer"])
@pytest.mark.parametrize("error", [-0.2, 0.25])
def test_a_wrong_speed_is_unsure_and_tells_the_right_one_which_a_range_finds(fault, error, model, tmp_path):
    path = write_wav(tmp_path / "r.wav", impulses(LINE_ORDERS[fault]))
    page = tmp_path / "page.html"
    wrong = told(path, "--bearing", "6205", "--rpm", (1 + error) * RPM, "--model", model, "-o", page)
    assert wrong["verdict"] == "unsure"
    assert "does not explain the strongest lines" in wrong["sentence"]
    elsewhere = [pair["shaft_rpm"] for pair in wrong["explanations"] if not pair["as_given"]]
    assert elsewhere[0] == pytest.approx(RPM, rel=0.01)
    assert f"<td>{elsewhere[0]:.0f} ±" in page.read_text(encoding="utf-8")
    right = told(path, "--bearing", "6205", "--rpm", f"{0.75 * RPM:.0f}-{1.25 * RPM:.0f}", "--model", model)
    assert right["shaft_rpm"] == pytest.approx(RPM, rel=0.01)
    assert right["evidence"][0]["fault"] == fault


def test_the_bearing_is_found_among_alternatives_or_in_the_catalogue(model, tmp_path):
    path = write_wav(tmp_path / "r.wav", impulses(LINE_ORDERS["outer"]))
    alternatives = ("--bearing", "6303", "--bearing", "6205", "--bearing", "6006")
    found = told(path, *alternatives, "--rpm", RPM, "--model", model)
    assert [(pair["bearing"], pair["lines"]) for pair in found["explanations"]] == [("6205", "bpfo")]
    assert "bearing 6205" in found["sentence"]
    searched = told(path, "--rpm", RPM, "--model", model)
    assert "6205" in {name for pair in searched["explanations"] for name in (pair["bearing"], *pair["alike"])}


def test_several_channels_are_axes_of_one_housing(model, recordings, tmp_path):
    (signal, rpm), (healthy, _) = recordings["outer"], recordings["healthy"]
    options = ("--bearing", "6205", "--rpm", rpm, "--model", model)
    path = write_wav(tmp_path / "r.wav", healthy, signal, signal)
    page = tmp_path / "page.html"
    one, all_axes = told(path, "--channel", "0", *options), told(path, "--channel", "0,1,2", *options, "-o", page)
    assert all_axes["probabilities"]["outer"] > max(0.5, one["probabilities"]["outer"])
    assert all_axes["windows"] == one["windows"]
    assert all_axes["channels"] == ["0", "1", "2"]
    assert {line["channel"] for line in all_axes["evidence"]} <= {"1", "2"}
    assert "(1)</td>" in page.read_text(encoding="utf-8")


def test_a_healthy_verdict_needs_the_colour_of_a_healthy_recording(model, recordings, tmp_path):
    signal, rpm = recordings["healthy"]
    dull = np.convolve(signal, [0.25, 0.5, 0.25], mode="same")  # another background and the same lines
    signals = {"tested": signal, "same": np.roll(signal, signal.size // 3), "other": dull}
    paths = {name: write_wav(tmp_path / f"{name}.wav", one) for name, one in signals.items()}
    options = ("--bearing", "6205", "--rpm", rpm, "--model", model)
    near = told(paths["tested"], *options, "--healthy", paths["same"])
    far = told(paths["tested"], *options, "--healthy", paths["other"])
    assert near["verdict"] == "healthy"
    assert far["verdict"] == "unsure"
    assert "the spectral colour differs" in far["sentence"]
    both = told(paths["tested"], *options, "--healthy", paths["same"], "--healthy", paths["other"])
    assert [Path(levels["recording"]).stem for levels in both["levels"]] == ["tested", "same", "other"]


def test_levels_are_told_and_those_of_a_wav_file_without_a_unit_tell_no_velocity(model, recordings, tmp_path):
    signal, rpm = recordings["inner"]
    options = (write_wav(tmp_path / "r.wav", signal + 8.7), "--bearing", "6205", "--rpm", rpm, "--model", model)
    (without,), page = told(*options)["levels"], tmp_path / "page.html"
    (levels,) = told(*options, "--unit", "m/s2", "--healthy", write_wav(tmp_path / "h.wav", signal / 3), "-o", page)[
        "levels"
    ][:1]
    assert levels["mean"] == pytest.approx(8.7 + signal.mean(), abs=1e-3)
    assert levels["rms"] == pytest.approx(signal.std(), rel=1e-4)
    assert levels["kurtosis"] == pytest.approx(kurtosis(signal, fisher=False), rel=1e-4)
    assert levels["velocity_rms_mm_s"] == pytest.approx(1e3 * velocity_rms(signal[None], FS, rpm / 60)[0], rel=1e-4)
    assert (without["velocity_rms_mm_s"], without["unit"]) == (None, "unit of the file")
    assert re.search(r"<th scope=.row.>h.wav</th><td>\d", page.read_text(encoding="utf-8"))


def test_an_array_gets_the_diagnosis_of_its_file(model, recordings, tmp_path):
    signal, rpm = recordings["outer"]
    signal = signal.astype(np.float32)
    known = {"orders": bearing_orders("6205"), "model": model}
    found = told(write_wav(tmp_path / "r.wav", signal), "--bearing", "6205", "--rpm", rpm, "--model", model)
    diagnosis = features.diagnose(signal, FS, rpm=rpm, **known)
    assert diagnosis.sentence == found["sentence"]
    assert diagnosis.probabilities == found["probabilities"]
    axes = features.diagnose([signal, signal], FS, rpm=(0.9 * rpm, 1.1 * rpm), healthy=[[signal, signal]], **known)
    assert [levels.channel for levels in axes.levels] == ["0", "1", "0", "1"]
    several = features.diagnose(
        signal, FS, rpm=rpm, model=model, orders={"6205": known["orders"], "other": (0.4, 4, 6, 3)}
    )
    assert several.bearing == "6205"
    with pytest.raises(ValueError, match=r"shape \(1, 1, 2\)"):
        features.diagnose([[[1.0, 2.0]]], FS, rpm=rpm, **known)
    with pytest.raises(ValueError, match="not positive numbers"):
        features.diagnose(signal, FS, rpm=-rpm, **known)


@pytest.mark.parametrize("command", [("diagnose", "r.wav", "--rpm", "1500"), ("evaluate", "corpus", "--model", "m")])
def test_an_empty_channel_name_is_refused(command):
    result = CliRunner().invoke(cli, [*command, "--channel", "x,"], prog_name="raceway")
    assert (result.exit_code, "'x,' has an empty name" in result.output) == (2, True)


def test_channels_of_a_matlab_file_are_its_variables_or_the_columns_of_one(model, recordings, tmp_path):
    signal, rpm = recordings["outer"]
    savemat(tmp_path / "r.mat", {"DE_time": signal, "FE_time": signal[:-5], "both": np.stack([signal, signal], axis=1)})
    options = ("--bearing", "6205", "--rpm", rpm, "--rate", FS, "--model", model)
    variables = told(tmp_path / "r.mat", "--channel", "DE_time,FE_time", *options)
    columns = told(tmp_path / "r.mat", "--variable", "both", "--channel", "0,1", *options)
    assert variables["verdict"] == columns["verdict"] == "outer"
    assert variables["channels"] == ["DE_time", "FE_time"]


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda x: x[: round(0.05 * FS)], "the recording lasts 0.05 s"),
        (lambda x: 0 * x, "the signal is constant"),
        (lambda x: 0 * x + 3.7, "the signal is constant"),
        (lambda x: -np.arange(x.size) / FS, "only rise or only fall, as in a column of times"),
        (lambda x: 1e-30 * x, "is no vibration"),
        (lambda x: 1e30 * x, "is no vibration"),
    ],
)
def test_a_signal_that_tells_nothing_gives_unsure_and_advice(change, sentence, model, recordings, tmp_path):
    signal, rpm = recordings["inner"]
    page = tmp_path / "report.html"
    found = told(
        write_wav(tmp_path / "r.wav", change(signal)), "--bearing", "6205", "--rpm", rpm, "--model", model, "-o", page
    )
    assert found["verdict"] == "unsure"
    assert sentence in found["sentence"]
    assert found["evidence"] == []
    assert found["advice"]
    assert len(set(found["probabilities"].values())) == 1
    assert sentence in page.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("rpm", "sentence"),
    [(90_000, "a fault line lies at 8,123 Hz, and the signal is used up to 5,000 Hz"), (10, "record 120 s")],
)
def test_a_speed_that_the_recording_cannot_show_gives_unsure(rpm, sentence, model, recordings, tmp_path):
    path = write_wav(tmp_path / "r.wav", recordings["inner"][0])
    found = told(path, "--bearing", "6205", "--rpm", rpm, "--model", model)
    assert found["verdict"] == "unsure"
    assert sentence in found["sentence"]


@pytest.mark.parametrize(
    ("change", "options", "sentence"),
    [
        (lambda x: np.clip(x, -0.5 * x.std(), 0.5 * x.std()), (), "clipped"),
        (lambda x: x * 1e-4 / x.std(), (), "implausible"),
        (lambda x: x[: round(0.5 * FS)], (), "The recording is short"),
        (lambda x: x, ("--rate", 8000), "leaves out part of the band"),
    ],
)
def test_what_is_to_be_read_with_care_is_a_warning(change, options, sentence, model, recordings, tmp_path):
    signal, rpm = recordings["inner"]
    path = write_wav(tmp_path / "r.wav", change(signal))
    found = told(path, "--bearing", "6205", "--rpm", rpm, "--model", model, *options)
    assert any(sentence in warning for warning in found["warnings"])


def test_the_verdict_does_not_depend_on_the_unit(model, recordings, tmp_path):
    signal, rpm = recordings["inner"]
    path = write_csv(tmp_path / "r.csv", signal)
    common = (path, "--channel", 1, "--rate", FS, "--bearing", "6205", "--rpm", rpm, "--model", model)
    answers = [told(*common, "--unit", unit) for unit in ("g", "m/s2")]
    assert answers[0]["verdict"] == answers[1]["verdict"] == "inner"
    volts = told(*common, "--unit", "V", "--sensitivity", 100)
    assert volts["evidence"][0]["order"] == answers[0]["evidence"][0]["order"]


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("two.csv", "--channel", "1"), "does not state its sample rate; give it with --rate HZ."),
        (("two.csv", "--rate", FS), "has 2 columns (0 a, 1 b) and none is chosen; choose one with --channel."),
        (
            ("r.csv", "--rate", 2 * FS),
            "is at 12000 Hz by its times in column 0 time [s], and 24000 Hz are given; correct what is given with --rate.",
        ),
        (
            ("two.csv", "--channel", "c", "--rate", FS),
            "has the columns 0 a, 1 b, and no numbers in c; choose one with --channel.",
        ),
        (("stereo.wav",), "has 2 columns (0, 1) and none is chosen; choose one with --channel."),
        (("no.csv", "--rate", FS), "no.csv"),
        (("r.pdf", "--rate", FS), "no known type"),
        (("r.wav", "--unit", "V"), "sensitivity"),
        (("r.wav", "--bearing", "62O5"), "6205"),
        (("r.wav", "--bearing", "n_balls=8"), "pitch_diameter_mm: is missing"),
        (("r.wav", "--bearing", "n_balls=8,pitch_diameter_mm=33.5,ball_diameter_mm=x"), "key=number"),
        (("r.wav", "--bearing", "n_balls=8,pitch_diameter_mm=33.5,balls_mm=8"), "balls_mm"),
        (("r.wav", "--bearing", "n_balls=8,n_balls=9"), "n_balls is given twice"),
        (("r.wav", "--rpm", "-3"), "--rpm"),
        (("r.wav", "--rpm", "nan"), "--rpm"),
        (("r.wav", "--rpm", "1900-1400"), "no range such as 1400-1900"),
        (("r.wav", "--rpm", "1400-"), "no range such as 1400-1900"),
        (("r.wav", "--rpm", ""), "no range such as 1400-1900"),
        (("r.wav", "--channel", "0,5"), "column"),
        (("r.wav", "--model", "no.skops"), "no.skops"),
        (("r.wav", "-o", "report.pdf"), ".html"),
        (("nan.npy", "--rate", FS), "has 1 samples of 600 that are not finite numbers"),
    ],
)
def test_an_error_is_one_sentence_and_exit_code_2(options, sentence, model, recordings, tmp_path, monkeypatch):
    signal = recordings["inner"][0]
    monkeypatch.chdir(tmp_path)
    write_csv(Path("r.csv"), signal[:600])
    np.savetxt("two.csv", np.stack([signal[:600], signal[:600]], axis=1), delimiter=",", header="a,b", comments="")
    write_wav(Path("r.wav"), signal[:6000])
    write_wav(Path("stereo.wav"), signal[:600], signal[:600])
    Path("r.pdf").write_text("no recording", encoding="utf-8")
    np.save("nan.npy", np.where(np.arange(600) == 5, np.nan, 1.0))
    result = call("--bearing", "6205", "--rpm", 1750, "--model", model, *options)
    assert result.exit_code == 2
    assert sentence in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1
    assert result.stdout == ""


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
        ((), (), "has no recording in it (.mat, .npy,"),
        (("a.txt",), (), "no recording can be used; the first of 1: campaign/a.txt: has no row of numbers"),
        (("a.txt",), ("-o", "mine"), "page.html: was not made by raceway"),
        (("a.txt",), ("-o", "mine/page.html"), "is a file; give a folder"),
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


@pytest.mark.parametrize(("rpm", "meant"), [("29.5", "1770"), ("28-30", "1680-1800")])
def test_a_speed_below_one_turn_a_second_may_be_in_hertz(rpm, meant, model, recordings, tmp_path):
    path = write_wav(tmp_path / "r.wav", recordings["inner"][0])
    found = told(path, "--bearing", "6205", "--rpm", rpm, "--model", model)
    assert f"--rpm {rpm} is less than one turn a second; if it is Hz, give --rpm {meant}." in found["warnings"]


def test_an_assumed_unit_is_told_in_text_in_json_and_on_the_page(model, recordings, tmp_path):
    path, page = write_csv(tmp_path / "r.csv", recordings["inner"][0]), tmp_path / "r.html"
    options = (path, "--bearing", "6205", "--rpm", 1750, "--model", model)
    assumed = "r.csv: it states no unit, and m/s2 is assumed."
    assert assumed in told(*options)["warnings"]
    assert f"warning: {assumed.removeprefix('r.csv: ')}" in call(*options, "-o", page).stderr
    assert assumed in page.read_text(encoding="utf-8")


def test_the_mark_between_columns_settles_what_commas_mean(model, recordings, tmp_path):
    signal, rpm = recordings["inner"]
    (tmp_path / "r.csv").write_text("".join(f"{x:.5f}\n" for x in signal).replace(".", ","), encoding="utf-8")
    options = (tmp_path / "r.csv", "--bearing", "6205", "--rpm", rpm, "--rate", FS, "--model", model)
    assert "give the mark between columns with --delimiter." in call(*options).stderr
    assert told(*options, "--delimiter", "semicolon")["verdict"] == "inner"


def test_a_missing_rate_is_told_before_anything_is_loaded(tmp_path):
    np.savetxt(tmp_path / "r.csv", np.zeros(600))
    done = subprocess.run(
        [sys.executable, "-X", "importtime", "-m", "raceway", "diagnose", tmp_path / "r.csv", "--rpm", "1500"],
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert "does not state its sample rate; give it with --rate HZ." in done.stderr
    assert not re.search(r"\| +(sklearn|numba|xarray|dask)$", done.stderr, re.MULTILINE)
