"""``raceway diagnose``: a sentence, a JSON object and a page for good recordings, one sentence for all others."""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.io import savemat

import raceway
from features.baselines import Model
from features.baselines.classifying import predict
from features.signal import velocity_rms
from features.table.durations import windows_of
from features.table.indicators import Orders
from features.table.recording_features import recording_table
from gen import open_corpus
from gen.physics.bearing_text import bearing_orders
from gen.support.errors import CorpusError
from raceway.cli import cli
from tests.diagnoses import FS, call, corpus, told, write_csv, write_wav
from tests.pulses import impulses_beside_a_shaft

LINE_ORDERS = {"inner": 5.4152, "outer": 3.5848, "ball": 4.7135}


@pytest.mark.parametrize(("fault", "suffix"), [("healthy", "csv"), ("inner", "wav"), ("outer", "csv"), ("ball", "wav")])
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
        # longer recordings were not called healthy less often
        assert not any("Record longer" in sentence for sentence in found["advice"])
        assert any("--healthy FILE" in sentence for sentence in found["advice"])
        return
    first = found["evidence"][0]
    assert first["fault"] == fault
    assert first["order"] == pytest.approx(first["harmonic"] * LINE_ORDERS[fault], rel=0.02)
    assert first["frequency_hz"] == pytest.approx(first["order"] * found["shaft_rpm"] / 60, rel=1e-3)
    assert first["level_db"] >= 3
    assert found["explanations"][0]["shaft_rpm"] == pytest.approx(found["shaft_rpm"], abs=0.01)
    assert len(first["band"]) == 2
    assert first["line"] in found["sentence"]


def test_the_share_of_missed_faults_is_that_of_the_reference_model_alone(model, recordings):
    signal, rpm = recordings["healthy"]
    own = Model.load(model)
    answer = raceway.diagnose(signal, FS, orders="6205", rpm=rpm, model=own)
    assert np.isnan(answer.missed)
    assert answer.sentence.endswith("; how often this model calls faulty recordings healthy was not measured.")
    own.wide = own  # as the reference model has
    answer = raceway.diagnose(signal, FS, orders="6205", rpm=rpm, model=own)
    assert 0 < answer.missed < 0.5
    assert answer.sentence.endswith("; 4 of 86 faulty recordings of up to 2 s from three machines were called healthy.")
    healthy = [np.roll(signal, signal.size // 3)]
    compared = raceway.diagnose(signal, FS, orders="6205", rpm=rpm, model=own, healthy=healthy).sentence
    assert "; 0 of 288 comparisons of faulty recordings of up to 2 s from two machines were called healthy." in compared


@pytest.mark.parametrize("fault", ["healthy", "inner"])
def test_a_speed_in_hertz_given_as_rpm_is_unsure(fault, model, recordings):
    signal, rpm = recordings[fault]
    answer = raceway.diagnose(np.tile(signal, 5), FS, orders="6205", rpm=rpm / 60, model=model)
    assert answer.verdict == "unsure"
    assert f"the shaft turns {10 * rpm / 3600:.2g} times" in answer.sentence


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


RPM = 1770.0


def impulses(order):
    return impulses_beside_a_shaft(order, 0, fs=FS, rate=RPM / 60, seconds=3.0)


@pytest.mark.parametrize("seconds", [0.5, 1.4])
def test_records_of_a_corpus_are_cut_for_a_model_as_a_recording_is(seconds, model, tmp_path):
    loaded, folder = Model.load(model), corpus(tmp_path, seed=3, rigs=1, records=1, duration=seconds)
    with open_corpus(folder) as opened:
        pairs = zip(opened["acceleration"].values[:, 0], opened["shaft_rate"].values, strict=True)
        cut = [
            recording_table(windows_of(x, FS, loaded.durations), FS, rate, Orders(*bearing_orders("6205")), 0)
            for x, rate in pairs
        ]
    alone = [predict(table, loaded).by_recording.probabilities[0] for table in cut]
    np.testing.assert_allclose(loaded.predict_proba(folder), alone, rtol=1e-6)
    scores = json.loads(CliRunner().invoke(cli, ["evaluate", str(folder), "--model", str(model), "--json"]).stdout)
    assert scores["log_loss"] == pytest.approx(loaded.score(folder).log_loss)


@pytest.mark.usefixtures("unpainted")
@pytest.mark.parametrize(("fault", "error"), [("inner", -0.2), ("outer", 0.25)])
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
    page = tmp_path / "page.html"
    searched = told(path, "--rpm", RPM, "--model", model, "-o", page)
    (alike,) = ([pair["bearing"], *pair["alike"]] for pair in searched["explanations"] if "6205" in pair["alike"])
    assert f">{', '.join(alike)}<" in page.read_text(encoding="utf-8")


def write_axes(path, header, *signals):
    np.savetxt(path, np.stack(signals, axis=1), delimiter=",", header=header, comments="", fmt="%.7g")
    return path


def test_all_axes_of_a_file_are_used_without_being_chosen_and_the_answer_says_so(model, recordings, tmp_path):
    (signal, rpm), (healthy, _) = recordings["outer"], recordings["healthy"]
    options = ("--bearing", "6205", "--rpm", rpm, "--rate", FS, "--model", model)
    header, page = "x [m/s2],speed [rpm],y [m/s2],z [m/s2]", tmp_path / "page.html"
    path = write_axes(tmp_path / "r.csv", header, healthy, np.full(signal.size, rpm), signal, signal)
    found, chosen = told(path, *options, "-o", page), told(path, *options, "--channel", "x,y,z")
    alone = told(path, *options, "--channel", "x")
    assert found["probabilities"]["outer"] > max(0.5, alone["probabilities"]["outer"])
    assert found["windows"] == alone["windows"]
    assert {line["channel"] for line in found["evidence"]} <= {"y", "z"}
    assert "(y)</td>" in page.read_text(encoding="utf-8")
    assert found["channels"] == [levels["channel"] for levels in found["levels"]] == ["x", "y", "z"]
    assert found["sentence"].endswith("; channels x, y and z, as axes of one housing.")
    assert found["sentence"] in page.read_text(encoding="utf-8")
    assert found["probabilities"] == chosen["probabilities"]
    assert told(path, *options, "--channel", "y")["channels"] == ["y"]


def test_a_healthy_recording_has_the_channels_of_the_recording(model, recordings, tmp_path):
    signal, rpm = recordings["outer"][0][:FS], recordings["outer"][1]
    options = ("--bearing", "6205", "--rpm", rpm, "--rate", FS, "--model", model, "--unit", "g")
    three = write_axes(tmp_path / "r.csv", "x,y,z", signal, signal, signal)
    two = write_axes(tmp_path / "h.csv", "x,y", signal, np.roll(signal, 9))
    assert told(two, *options, "--healthy", three)["channels"] == ["x", "y"]
    copied = shutil.copy(three, tmp_path / "copied.csv")
    itself = call(three, *options, "--healthy", copied)
    assert (itself.exit_code, "copied.csv: is the recording itself" in itself.stderr) == (2, True)
    form = call(three, *options, "--channel", "y", "--healthy", write_wav(tmp_path / "h.wav", signal))
    assert (form.exit_code, "read as r.csv is: write both in one form, such as .csv with" in form.stderr) == (2, True)
    result = call(three, *options, "--healthy", two)
    assert (result.exit_code, len(result.stderr.strip().splitlines())) == (2, 1)
    assert "h.csv: has other channels (x and y) than the recording (x, y and z)" in result.stderr


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
    assert far["advice"][0].startswith(
        "Check load, mounting and sensor, and give a healthy recording of the same state "
    )
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
    assert levels["velocity_rms_mm_s"] == pytest.approx(1e3 * velocity_rms(signal[None], FS, rpm / 60)[0], rel=1e-4)
    assert (without["velocity_rms_mm_s"], without["unit"]) == (None, "unit of the file")
    assert re.search(r"<th scope=.row.>h.wav</th><td>\d", page.read_text(encoding="utf-8"))


def test_a_channel_that_a_pattern_chose_is_called_by_its_name_in_the_file(model, recordings, tmp_path):
    for number, fault in ((97, "healthy"), (105, "outer")):
        signal, _ = recordings[fault]
        savemat(tmp_path / f"{number}.mat", {f"X{number:03d}_{end}_time": signal for end in ("DE", "FE")})
    options = ("--rate", FS, "--unit", "m/s2", "--bearing", "6205", "--rpm", "1700-1800", "--model", model)
    for channels, names in (("*_DE_time", ["X105_DE_time"]), ("*DE*,*FE*", ["X105_DE_time", "X105_FE_time"])):
        how = (*options, "--channel", channels, "--healthy", tmp_path / "97.mat", "-o", tmp_path / "page.html")
        facts = told(tmp_path / "105.mat", *how)
        assert facts["channels"] == names
        assert {level["channel"] for level in facts["levels"]} == {*names}
        page = (tmp_path / "page.html").read_text(encoding="utf-8")
        assert channels not in page
        assert names[0] in page


def test_an_array_gets_the_diagnosis_of_its_file(model, recordings, tmp_path):
    signal, rpm = recordings["outer"]
    signal = signal.astype(np.float32)
    known = {"orders": "6205", "model": model}
    found = told(write_wav(tmp_path / "r.wav", signal), "--bearing", "6205", "--rpm", rpm, "--model", model)
    diagnosis = raceway.diagnose(signal, FS, rpm=rpm, **known)
    assert diagnosis.sentence == found["sentence"]
    assert diagnosis.probabilities == found["probabilities"]
    axes = raceway.diagnose([signal, signal], FS, rpm=(0.9 * rpm, 1.1 * rpm), healthy=[[signal, signal[::-1]]], **known)
    assert [levels.channel for levels in axes.levels] == ["0", "1", "0", "1"]
    several = raceway.diagnose(
        signal, FS, rpm=rpm, model=model, orders={"6205": bearing_orders("6205"), "other": "6308"}
    )
    assert several.bearing == "6205"
    assert axes.sentence.endswith("; channels 0 and 1, as axes of one housing.")
    with pytest.raises(CorpusError, match=r"has other channels \(one without a name\) than the recording \(0 and 1\)"):
        raceway.diagnose([signal, signal], FS, rpm=rpm, healthy=[signal], **known)
    for wrong, shape in (([[[1.0, 2.0]]], (1, 1, 2)), (signal[:, None], (len(signal), 1)), (signal[:3], (3,))):
        sentence = f"an array of shape {shape} is given in place of (channel, time) or (time,), with at least 8 samples in time."
        with pytest.raises(ValueError, match=re.escape(sentence)):
            raceway.diagnose(wrong, FS, rpm=rpm, **known)
    for speed in (-rpm, (1900, 1400)):
        with pytest.raises(
            ValueError, match=r"^rpm: .* is no speed and no range such as 1400-1900, the lower first, of "
        ):
            raceway.diagnose(signal, FS, rpm=speed, **known)
    with pytest.raises(ValueError, match=r"^fs: None is not a finite number above 0"):
        raceway.diagnose(signal, None, rpm=rpm, **known)


def test_an_array_needs_no_model_and_a_bearing_of_the_catalogue(model, recordings, monkeypatch):
    signal, rpm = recordings["outer"]
    monkeypatch.setattr("raceway.diagnosis.arrays.reference_model", lambda: Model.load(model))
    diagnosis = raceway.diagnose(signal, FS, orders="6205", rpm=rpm)
    same = raceway.diagnose(signal, FS, orders=bearing_orders("6205"), rpm=rpm, model=model)
    assert (diagnosis.sentence, diagnosis.probabilities) == (same.sentence, same.probabilities)
    with pytest.raises(CorpusError, match="bearing '6295' is not in the catalogue"):
        raceway.diagnose(signal, FS, orders="6295")


def test_a_signal_that_tells_nothing_gives_unsure_and_advice(model, recordings, tmp_path):
    """Which signals do is tested in tests/raceway/diagnosis/test_quality_laws.py."""
    signal, rpm = recordings["inner"]
    page, sentence = tmp_path / "report.html", "the signal is constant"
    path = write_wav(tmp_path / "r.wav", 0 * signal + 3.7)
    found = told(path, "--bearing", "6205", "--rpm", rpm, "--model", model, "-o", page)
    assert found["verdict"] == "unsure"
    assert sentence in found["sentence"]
    assert found["evidence"] == []
    assert found["advice"] == ["Check sensor, cable and channel, and record again."]
    assert "check sensor" not in found["sentence"]
    assert len(set(found["probabilities"].values())) == 1
    assert sentence in page.read_text(encoding="utf-8")


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
        (("r.wav", "--unit", "V"), "sensitivity"),
        (("r.wav", "--bearing", "62O5"), "6205"),
        (("r.wav", "--bearing", "n_balls=8"), "pitch_diameter_mm: is missing"),
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
    Path("r.pdf").write_text("no recording", encoding="utf-8")
    np.save("nan.npy", np.where(np.arange(600) == 5, np.nan, 1.0))
    result = call("--bearing", "6205", "--rpm", 1750, "--model", model, *options)
    assert result.exit_code == 2
    assert sentence in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1
    assert result.stdout == ""
