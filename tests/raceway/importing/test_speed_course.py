"""A recording of a varying speed, with its measured course beside it, has its fault lines at their orders."""

import re

import numpy as np
import pytest
import scipy.io
from scipy.io import wavfile

import gen
from features.signal.demodulation import amplitude_spectrum
from gen.corpus import open_corpus
from gen.support.errors import CorpusError
from raceway.importing import read_signal
from raceway.importing.refused_files import UnusableError
from raceway.importing.speed_course import at_equal_angles
from raceway.importing.user_folder import OPTIONS
from tests.diagnoses import told
from tests.labels import import_labelled
from tests.raceway.importing.file_writers import FS, N, X, text
from tests.run_ups import lines

RATE, SECONDS, RPM = 12_000, 4.0, 1500.0
BPFO = gen.bearing_orders("6205").bpfo
SHARE = np.linspace(0.8, 1.2, round(RATE * SECONDS))
LABELS = {"bearing": "6205", "fault": "outer", "specimen": "A", "unit": "m/s2", "sample_rate_hz": RATE}


@pytest.fixture(scope="module")
def run_up():
    """Acceleration of a bearing with a spall on its outer race while the speed rises by half."""
    profile = {"kind": "ramp", "from_percent": 80, "to_percent": 120}
    keys = {"sample_rate_hz": RATE, "duration_s": SECONDS, "speed_profile": profile, "seed": 1, "shaft_rpm": RPM}
    return gen.record(gen.outer(width_mm=1.0), bearing="6205", **keys).acceleration.values[0].astype(float)


def pulses(turns, per_turn=1):
    """Tacho that is high in a tenth of the time between pulses."""
    return ((turns * per_turn) % 1 < 0.1).astype(float)


def height_of_line(signal, rate, order):
    """Highest line of the envelope within 1 % of an order, over the median of its neighbours."""
    frequencies, amplitude = amplitude_spectrum(np.abs(signal - signal.mean())[np.newaxis], 1.0 * RATE)
    near = amplitude[0, np.abs(frequencies / rate / order - 1) < 0.01].max()
    return near / np.median(amplitude[0, np.abs(frequencies / rate / order - 1) < 0.3])


@pytest.mark.parametrize(("course", "unit"), [("speed", "rpm"), ("speed", "Hz"), ("tacho", "1"), ("tacho", "16")])
def test_a_run_up_shows_its_fault_line_with_its_course_and_not_without(run_up, course, unit):
    turns = np.cumsum(SHARE) * RPM / 60 / RATE
    values = pulses(turns, int(unit)) if course == "tacho" else SHARE * RPM / (60 if unit == "Hz" else 1)
    even, rpm, sentence = at_equal_angles(run_up, RATE, values, unit)
    # at both ends of 100 turns, up to a pulse that is off by half a sample of 400 in a turn, the speed is taken as constant
    assert rpm == pytest.approx(RPM, rel=1e-6 if course == "speed" else 1e-4)
    # lost are the filter at both ends, which is as long as the highest speed asks, and parts of a turn of two samples
    assert 0 <= run_up.size - 2 * np.ceil(32 * 1.2) - even.size <= 4
    assert height_of_line(even, rpm / 60, BPFO) > 100
    assert height_of_line(run_up, rpm / 60, BPFO) < 10
    if unit == "16":  # a missed pulse is counted
        values[np.abs(turns - 40) < 0.03] = 0
        np.testing.assert_allclose(at_equal_angles(run_up, RATE, values, unit)[0], even, atol=1e-3 * even.std())
    low, high = map(float, re.search("which turns at (.*) to (.*) rpm, 1500", sentence).groups())
    # the mean of the first whole turn of a tacho, which begins up to a turn late; the speed rises by 7.5 rpm in a turn
    assert (low, high) == pytest.approx((1200, 1800), abs=1e-6 if course == "speed" else 1.5 * 7.5 + 1800 / 400)
    assert "so wide a range" in sentence


def test_a_tacho_of_many_pulses_tells_the_range_of_the_speed():
    share = np.linspace(1400, 1600, 12_000)
    tacho = pulses(np.cumsum(share) / 60 / RATE, 60)
    sentence = at_equal_angles(np.sin(np.arange(12_000)), RATE, tacho, "60")[2]
    low, high = map(float, re.search("which turns at (.*) to (.*) rpm, ", sentence).groups())
    assert (low, high) == pytest.approx((1400, 1600), rel=1e-2)
    assert "so wide a range" not in sentence


def test_lines_of_the_shaft_keep_their_height_and_stand_at_their_order():
    rate = 24 * (1 + 0.1 * np.sin(np.linspace(0, 20, 40_000)))
    even, rpm, sentence = at_equal_angles(lines(rate, (1, 7)), FS, rate, "Hz")
    frequencies, amplitude = amplitude_spectrum(even[np.newaxis], FS)
    for order in (1, 7):
        near = np.abs(frequencies * 60 / rpm - order) < 0.1
        assert amplitude[0, near].max() == pytest.approx(1, rel=0.02)
        assert frequencies[near][amplitude[0, near].argmax()] == pytest.approx(order * rpm / 60, rel=2e-3)
    assert "so wide a range" not in sentence


def test_the_signal_of_a_sensor_that_is_not_connected_stays_constant():
    assert set(at_equal_angles(np.full(N, 3.3), FS, X + 1500, "rpm")[0]) == {3.3}


def test_the_diagnosis_of_a_run_up_is_right_with_its_course(run_up, model, tmp_path):
    path = tmp_path / "run_up.csv"
    path.write_text(text(run_up, SHARE * RPM, mark=",", header="x [m/s2],speed [rpm]\n"))
    answer = told(path, "--bearing", "6205", "--rate", RATE, "--speed-column", "speed", "--model", model)
    assert answer["verdict"] == "outer"
    assert answer["shaft_rpm"] == pytest.approx(RPM, rel=1e-2)
    assert any("equal angles of its shaft" in sentence for sentence in answer["warnings"])
    assert not any("states a speed" in sentence for sentence in answer["warnings"])
    # the measured speed is enough to search the catalogue
    searched = told(path, "--rate", RATE, "--speed-column", "speed", "--model", model)
    assert searched["given_rpm"] == answer["given_rpm"]
    assert (
        told(path, "--bearing", "6205", "--rate", RATE, "--channel", 0, "--rpm", RPM, "--model", model)["verdict"]
        != "outer"
    )


def test_an_import_has_the_mean_speed_as_its_label(run_up, tmp_path):
    scipy.io.savemat(tmp_path / "a.mat", {"x": run_up, "speed": SHARE * RPM})
    row = {"path": "a.mat", "variable": "x", "speed_column": "speed", "speed_unit": "rpm"}
    done = import_labelled(tmp_path, [row], **LABELS)
    with open_corpus(done.path) as corpus:
        np.testing.assert_allclose(corpus.shaft_rate, RPM / 60, rtol=1e-4)
        assert corpus.sizes["record"] == 7
    assert (
        "a.mat:x: it is sampled again at equal angles of its shaft, which turns at 1200 to 1800 rpm" in done.warnings[0]
    )
    for keys in ({"shaft_rpm": 1500}, {"recording": "r"}):
        with pytest.raises(CorpusError, match="speed_column: tells the speed of one file; leave shaft_rpm, nominal"):
            import_labelled(tmp_path, [row | keys], **LABELS)


TURNS = np.arange(N) / 40
DOUBLE = np.where(np.abs(TURNS - 7.6) < 0.1, 1, pulses(TURNS))
REFUSED = {  # header of the column, its values, unit, part of the sentence
    "unit": ("speed", X + 20, None, "is no unit that is read; give rpm, Hz, or the pulses in a turn of a tacho with --speed-unit."),
    "other unit": ("speed [m/s]", X + 20, None, "has a speed in 'm/s', which is no unit that is read; give rpm, Hz, or the pulses"),
    "long unit": ("speed", X + 20, "9" * 5000, "9, which is no unit that is read; give rpm, Hz, or the pulses"),
    "two units": ("speed [rpm]", X + 1500, "Hz", "states a speed in rpm in its header, and Hz is given; correct what is given with"),
    "number in the name": ("speed (2)", X + 20, None, "has a speed in '2', which is no unit that is read"),
    "rest": ("speed [Hz]", np.r_[X[:99] + 20, 0, X[100:] + 20], None, "at sample 100, and shafts turn at 0.001 to 10,000,000 rpm; cut"),
    "backwards": ("speed [Hz]", -20 - X, None, "rpm at sample 1, and shafts turn at"),
    "overflow": ("speed [rpm]", np.r_[X[:99] + 1500, 1e300, X[100:] + 1500], None, "has a speed of 1e+300 rpm at sample 100, and"),
    "glitch": ("speed [rpm]", np.r_[X[:99] + 1500, 1e6, X[100:] + 1500], None, "are lost at each end; record longer"),
    "gap": ("speed [Hz]", [*np.round(X[:-1] + 20, 3).tolist(), ""], None, "has no row like the others in line 641"),
    "no pulses": ("tacho", X * 0 + 1, "1", "has no even pulses, or correct the pulses in a turn with --speed-unit."),
    "double pulse": ("tacho", DOUBLE, "1", "has no tacho that can be used: it has an interval of 0."),
    "no such column": ("n", X + 20, "Hz", "and no numbers in speed; choose one with --speed-column."),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_a_course_that_is_none_is_refused_with_one_sentence(tmp_path, name):
    header, values, unit, sentence = REFUSED[name]
    (tmp_path / "a.csv").write_text(text(X, values, header=f"x [g];{header}\n"))
    with pytest.raises(CorpusError) as refused:
        read_signal(
            tmp_path / "a.csv",
            rate=FS,
            speed_column="tacho" if header == "tacho" else "speed",
            speed_unit=unit,
            options=OPTIONS,
        )
    assert sentence in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("unit", ["rpm", "RPM ", "min^-1", "1/min", "U/min"])
def test_a_unit_of_a_speed_is_read_as_headers_write_it(unit):
    assert at_equal_angles(X, FS, X + 1500, unit)[1] == pytest.approx(1500, rel=0.01)


@pytest.mark.parametrize(("size", "unit"), [(1, "rpm"), (8, "1"), (64, "rpm")])
def test_a_recording_of_which_nothing_is_left_is_refused(size, unit):
    with pytest.raises(UnusableError, match=f"has {size} samples, of which 32 are lost at each end .*; record longer"):
        at_equal_angles(X[:size], FS, X[:size] + 1500, unit)


def test_a_course_that_is_shorter_than_its_signal_is_refused(tmp_path):
    scipy.io.savemat(tmp_path / "a.mat", {"x": X, "speed": X[:-9] + 20})
    with pytest.raises(CorpusError, match="has 631 speeds and 640 samples; export one for each sample"):
        read_signal(tmp_path / "a.mat", variable="x", rate=FS, speed_column="speed", speed_unit="Hz")


@pytest.mark.parametrize("value", [np.nan, np.inf])
@pytest.mark.parametrize("unit", ["rpm", "1"])
@pytest.mark.parametrize("which", ["samples", "speeds"])
def test_values_that_are_not_finite_are_told_of_the_signal_or_the_speed_that_has_them(value, unit, which):
    broken = np.where(np.arange(N) == 99, value, X + 1500)
    signal, course = (broken, X + 1500) if which == "samples" else (X, broken)
    with pytest.raises(
        UnusableError, match=f"has 1 {which} of 640 that are not finite numbers, the first is number 100; export"
    ):
        at_equal_angles(signal, FS, course, unit)


def test_an_angle_that_does_not_rise_is_refused():
    # a slow turn is rounded away beside a million of them
    course = np.full(300_000, 1e7)
    course[-1000:] = 1e-3
    with pytest.raises(UnusableError, match=r"does not turn on after sample \d+; cut the recording there"):
        at_equal_angles(np.sin(np.arange(course.size)), FS, course, "rpm")


WITHOUT = {  # file, its keys, part of the sentence
    "only column": ("x.npy", {"speed_column": 0}, "has its speed and its signal in column 0; choose another with speed_column."),
    "long number": ("two.npy", {"column": 0, "speed_column": "9" * 5000}, f"no numbers in {'9' * 60}; choose one with speed_column."),
    "same column": ("two.npy", {"column": 1, "speed_column": 1}, "has its speed and its signal in column 1; choose another"),
    "no such variable": ("a.mat", {"variable": "x", "speed_column": "n"}, "holds speed, two, x, not n; name one with speed_column."),
    "two columns": ("a.mat", {"variable": "x", "speed_column": "two"}, "has 2 columns in two; choose a variable of one with"),
    "integers": ("two.wav", {"column": 0, "speed_column": 1}, "holds integers, whose full scale is not known, and so no speed;"),
}  # fmt: skip


@pytest.mark.parametrize("name", WITHOUT)
def test_a_file_without_a_column_of_the_speed_is_refused(tmp_path, name):
    file, keys, sentence = WITHOUT[name]
    two = np.stack([X, X + 1500], axis=1)
    np.save(tmp_path / "x.npy", X)
    np.save(tmp_path / "two.npy", two)
    scipy.io.savemat(tmp_path / "a.mat", {"speed": X + 1500, "two": two, "x": X})
    wavfile.write(tmp_path / "two.wav", int(FS), two.astype(np.int16))
    with pytest.raises(CorpusError) as refused:
        read_signal(tmp_path / file, rate=FS, speed_unit="rpm", **keys)
    assert sentence in str(refused.value)


@pytest.mark.parametrize("command", ["diagnose", "plot"])
@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--rpm", 1500, "--speed-column", "speed"), "--rpm and --speed-column both tell the speed; leave one"),
        (("--rpm", 1500, "--speed-unit", "rpm"), "--speed-unit is that of --speed-column, which is missing; give"),
    ],
)
def test_a_speed_is_told_once(run, tmp_path, command, words, sentence):
    (tmp_path / "a.csv").write_text(text(X, X + 1500, header="x [g];speed [rpm]\n"))
    output = ("-o", tmp_path / "a.png") if command == "plot" else ()
    result = run(command, tmp_path / "a.csv", "--bearing", "6205", "--rate", FS, *words, *output)
    assert result.exit_code == 2
    assert sentence in result.stderr
