"""Recordings of a healthy machine turned into a recipe, from the command line and from Python."""

import json

import numpy as np
import pytest
from scipy.io import wavfile

import gen
import raceway
from features.baselines import Model
from gen.corpus import sha256
from gen.recipe import read_recipe
from gen.support.errors import CorpusError, RecipeError
from tests.diagnoses import FS

RPM, G = 1772, 9.80665


@pytest.fixture(scope="module")
def signals():
    """Six seconds of a machine with a healthy bearing and of one with a fault [m s-2]."""
    keys = {"shaft_rpm": RPM, "sample_rate_hz": FS, "duration_s": 6, "background_m_s2": 2, "slope": 0.5, "seed": 4}
    tones = {"probability": 1, "count": 2, "frequency_hz": [410, 1500], "level_db": -8}
    return {
        name: gen.record(fault, tones=tones, **keys).acceleration.values[0]
        for name, fault in (("healthy", None), ("inner", gen.inner(width_mm=2)))
    }


@pytest.fixture
def write(signals, tmp_path):
    """Write a signal [m s-2] as a table in g."""

    def written(name="healthy.csv", signal=None, fs=FS, header="time [s],acc [g]"):
        x = signals["healthy"] if signal is None else signal
        table = np.stack([np.arange(len(x)) / fs, x / G], axis=1)
        np.savetxt(tmp_path / name, table, delimiter=",", header=header, comments="", fmt="%.8g")
        return tmp_path / name

    return written


@pytest.fixture(autouse=True)
def _quick(model, monkeypatch, tmp_path):
    """A small model in place of the reference model; relative paths lie in a folder of their own."""
    monkeypatch.setattr("raceway.imitating.imitation.reference_model", lambda: Model.load(model))
    monkeypatch.chdir(tmp_path)


def test_an_imitation_that_is_interrupted_leaves_nothing(write, tmp_path, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    write()
    monkeypatch.setattr("raceway.imitating.imitation.write_nearness", interrupted)
    with pytest.raises(KeyboardInterrupt):
        raceway.imitate("healthy.csv", "machine.yaml", bearing="6205", rpm=RPM)
    assert [path.name for path in tmp_path.iterdir()] == ["healthy.csv"]


@pytest.mark.usefixtures("unpainted")
def test_a_recipe_of_a_recording_gives_its_segments_and_faults_on_them(run, write, signals, tmp_path):
    recording = write()
    told = run("imitate", recording, "--bearing", "6205", "--rpm", RPM, "--load-n", 500, "-o", "machine.yaml", "--json")
    assert told.exit_code == 0, told.output
    facts = json.loads(told.stdout)
    assert facts["warnings"] == []
    assert all(0.2 < auc < 0.8 for auc in facts["auc"].values() if auc is not None)
    text = (tmp_path / "machine.yaml").read_text()
    recipe = read_recipe("machine.yaml")
    for line in (
        "load_n: 500  # given",
        "shaft_rpm: 1772  # given",
        "sample_rate_hz: 12000.0  # read",
        "undetected: keep",
    ):
        assert line in text
    assert f"healthy.csv, SHA-256 {sha256(recording)}" in text
    assert recipe.background.recording.sha256 == sha256(tmp_path / "machine.nc")
    rms = float(np.sqrt(np.mean(signals["healthy"] ** 2)))
    assert recipe.level.background_m_s2.value == pytest.approx(rms, rel=1e-4)
    records = gen.simulate(gen.draw_scenarios(recipe)[:8])
    x = records.acceleration.values[:, 0]
    segments = signals["healthy"][: 12 * 6000].reshape(12, 6000)
    for signal in x[records.fault.values == 0]:
        assert np.abs(segments - signal).max(axis=1).min() < 1e-4 * rms
    assert set(records.fault_name.values) > {"healthy"}
    assert "12 healthy records" not in (page := (tmp_path / "machine.html").read_text())
    assert "centroid" in page


@pytest.mark.usefixtures("unpainted")
def test_a_synthetic_recipe_keeps_nothing_of_the_recording(write, signals, tmp_path):
    done = raceway.imitate(write(), "shared.yaml", bearing="6205", rpm=RPM, synthetic=True)
    assert done.recording is None
    assert sorted(path.suffix for path in tmp_path.iterdir()) == [".csv", ".html", ".yaml"]
    recipe = read_recipe("shared.yaml")
    assert recipe.background.recording is None
    assert recipe.background.tones.frequency_hz.values == pytest.approx((410, 1500), abs=1)
    # without a load a fault has a share, and a record the rms of the recording
    assert recipe.level.kind == "snr"
    healthy = [scenario for scenario in gen.draw_scenarios(recipe, 0, 12) if scenario.fault == "healthy"]
    x = gen.simulate(healthy).acceleration.values
    rms = float(np.sqrt(np.mean(signals["healthy"] ** 2)))
    assert np.median(np.sqrt(np.mean(x**2, axis=(1, 2)))) == pytest.approx(rms, rel=0.3)


@pytest.mark.usefixtures("unpainted")
def test_several_recordings_and_channels_are_kept_in_their_order(signals):
    x = np.stack([signals["healthy"], -0.5 * signals["healthy"]], axis=1)
    for number, size in enumerate((36_000, 40_000)):
        np.savetxt(f"{number}.csv", x[:size], delimiter=",", header="x [m/s²],y [m/s²]", comments="", fmt="%.8g")
    keys = {"bearing": "n_balls=9,pitch_diameter_mm=39,ball_diameter_mm=7.9", "rate": FS}
    done = raceway.imitate(["0.csv", "1.csv"], "two.yaml", rpm=(1700, 1800), **keys)
    assert f"sample_rate_hz: {FS}  # given" in done.recipe.read_text()
    recipe = read_recipe(done.recipe)
    assert [channel.name for channel in recipe.recording.channels] == ["x", "y"]
    assert recipe.operation.shaft_rpm.support() == (1700, 1800)
    with gen.open_corpus(done.recording) as kept:
        np.testing.assert_allclose(kept.acceleration[1].values, x[:36_000].T, atol=1e-5)
    records = gen.simulate(gen.draw_scenarios(recipe)[:2])
    assert records.sizes["channel"] == 2


@pytest.mark.usefixtures("unpainted")
@pytest.mark.parametrize(
    ("changed", "keys", "warning"),
    [
        (lambda x: np.clip(x["healthy"], -3, 3), {}, "is clipped; levels are not those of the machine"),
        (lambda x: x["inner"], {}, "may be no healthy recording, and then its fault is in every record."),
        (
            lambda x: x["inner"],
            {"rpm": 0.8 * RPM},
            "may be no healthy recording, and then its fault is in every record.",
        ),
    ],
    ids=["clipped", "faulty", "other speed"],
)
def test_a_doubtful_recording_is_imitated_with_a_warning(write, signals, changed, keys, warning):
    done = raceway.imitate(write(signal=changed(signals)), "machine.yaml", **{"bearing": "6205", "rpm": RPM} | keys)
    assert any(warning in sentence for sentence in done.warnings), done.warnings
    assert all(sentence.startswith("healthy.csv: ") for sentence in done.warnings)


def test_what_cannot_be_imitated_gets_one_sentence_and_leaves_nothing(write, signals, tmp_path):
    x = signals["healthy"]
    wavfile.write("own.wav", FS, x.astype(np.float32))
    usual = {"bearing": "6205", "rpm": RPM}
    for recordings, keys, sentence in (
        (
            write("short.csv", x[:11_000]),
            {},
            "short.csv: lasts 0.917 s, less than two records of 0.5 s at 1772 rpm; check",
        ),
        (write("hertz.csv"), {"rpm": RPM / 60}, "16.3 s at 29.53 rpm; check the speed, or record 326 s or more."),
        (
            [write("a.csv"), write("b.csv", fs=FS / 2)],
            {},
            "b.csv: has another sample rate or other channels than",
        ),
        (
            write("flat.csv", np.ones(24_000)),
            {},
            "flat.csv: cannot be imitated. Unsure: the signal is constant, as of a sensor or cable that is not connected. Check sensor,",
        ),
        (write("speed.csv"), {"rpm": None}, "speed.csv: does not state its speed; give it with --rpm RPM."),
        ("none.csv", {"bearing": "6295"}, "ball_diameter_mm=7.938, or, if nothing is simulated or drawn, the orders"),
        ("none.csv", {}, "none.csv: could not be read (No such file or directory); check the path."),
        (
            "none.csv",
            {"bearing": "bpfo=3.585,bpfi=5.415,bsf=2.357,ftf=0.398"},
            "has no geometry, which records need",
        ),
    ):
        before = sorted(tmp_path.iterdir())
        with pytest.raises(CorpusError) as caught:
            raceway.imitate(recordings, "machine.yaml", **usual | keys)
        assert sentence in str(caught.value)
        assert "\n" not in str(caught.value)
        assert sorted(tmp_path.iterdir()) == before
    (tmp_path / "machine.yaml").write_text("mine")
    with pytest.raises(CorpusError, match=r"machine\.yaml: exists"):
        raceway.imitate(write(), "machine.yaml", **usual)


@pytest.mark.parametrize("rpm", ["fast", -5, 0, np.nan, [1400, 1500, 1600], [1500, 1400], []])
def test_a_speed_that_is_none_is_refused_before_anything_is_written(write, tmp_path, rpm):
    recording = write()
    with pytest.raises(CorpusError, match=r"rpm: .* is no speed and no range such as 1400-1900"):
        raceway.imitate(recording, tmp_path / "machine.yaml", bearing="6205", rpm=rpm)
    assert list(tmp_path.iterdir()) == [recording]


@pytest.mark.parametrize("load", [0, 0.5, 2e7])
def test_the_range_of_the_load_is_that_of_a_recipe(run, write, load):
    # of the option, before anything is read
    result = run("imitate", write(), "--bearing", "6205", "--rpm", RPM, "--load-n", load, "-o", "machine.yaml")
    assert (result.exit_code, "'--load-n'" in result.stderr, "1<=x<=10000000.0" in result.stderr) == (2, True, True)
    with pytest.raises(RecipeError, match=r"operation.load_n: .* is not in \[1, 1e\+07\]"):
        gen.record(None, load_n=load)
