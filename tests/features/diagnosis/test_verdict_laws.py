"""Laws of the verdict: when speed or lines make it unsure, and what each treatment of the speed believes."""

from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from features.band import DEFAULT_BAND
from features.baselines.predictions import UNSURE
from features.diagnosis import diagnose
from features.diagnosis.diagnose import (
    CONTRADICTING,
    LONGEST,
    Diagnosis,
    Recorded,
    _beginning,
    _put_into_words,
    _reconcile,
)
from features.diagnosis.evidence import Line
from features.indicators import Orders, feature_names
from features.recording_table import recording_table, windows_of
from gen.corpus import FAULTS

FS, RATE, FASTER = 12_000.0, 25.0, 26.0
ORDERS = Orders(*map(np.asarray, (0.3983, 3.5848, 5.4152, 2.3567)))
MODEL = SimpleNamespace(
    name="made up", groups=("lines",), features=feature_names(("lines",)), classes=FAULTS[:4], band=DEFAULT_BAND
)
MODULE = import_module("features.diagnosis.diagnose")  # the package has a function of this name


def verdict(name, lines=()):
    probabilities = {fault: 0.91 if fault == name else 0.03 for fault in FAULTS[:4]}
    return Diagnosis(name, probabilities, 0.5, RATE, RATE, tuple(lines), "")


def line(fault, harmonic=1, level=CONTRADICTING + 1, *, sideband=False):
    return Line(fault, f"{harmonic}", harmonic, 3.0 * harmonic, 75.0 * harmonic, level, (1000.0, 3000.0), sideband)


@pytest.mark.parametrize(
    ("found", "labelled", "lines", "expected"),
    [
        ("inner", "inner", [], "inner"),
        ("inner", UNSURE, [], "inner"),
        ("inner", "outer", [], UNSURE),
        ("inner", "outer", [line("outer")], UNSURE),
        ("inner", "outer", [line("inner")], "inner"),
        (UNSURE, "outer", [], UNSURE),
    ],
)
def test_two_classes_at_two_speeds_are_unsure_unless_a_line_decides(found, labelled, lines, expected):
    assert _reconcile(verdict(found), verdict(labelled), lines).verdict == expected


@pytest.mark.parametrize(
    ("name", "lines", "expected"),
    [
        ("healthy", [line("inner"), line("inner", 2)], UNSURE),
        ("outer", [line("inner"), line("inner", 2)], UNSURE),
        ("outer", [line("inner"), line("inner", 2), line("outer", level=10.0)], "outer"),
        ("healthy", [line("inner")], "healthy"),
        ("healthy", [line("inner"), line("inner", sideband=True)], "healthy"),
        ("healthy", [line("inner", level=14.0), line("inner", 2, 14.0)], "healthy"),
        ("healthy", [line("inner", 2), line("inner", 3)], "healthy"),
        ("healthy", [line("inner", 2), line("inner", 3), line("inner", 4)], UNSURE),
    ],
)
def test_a_verdict_falls_to_high_harmonics_of_another_class_alone(name, lines, expected):
    assert _put_into_words(verdict(name, lines), None, "check", 10.0, compared=False).verdict == expected


def recorded(seed, name="recording"):
    return Recorded(np.random.default_rng(seed).standard_normal(round(FS)), FS, RATE, ORDERS, name)


@pytest.fixture
def references(monkeypatch):
    """The lines tell another speed, at which the classifier says inner, and outer at the labelled one."""
    given = []

    def predicted(recording, _, reference):
        given.append(reference)
        return verdict("inner" if recording.shaft_rate == FASTER else "outer")

    monkeypatch.setattr(MODULE, "_speed", lambda _: (FASTER, 0.1))
    monkeypatch.setattr(MODULE, "_predict", predicted)
    return given


@pytest.mark.parametrize(
    ("speed", "expected", "rate"), [("off", "outer", RATE), ("check", UNSURE, FASTER), ("correct", "inner", FASTER)]
)
def test_each_treatment_of_the_speed_believes_another(references, speed, expected, rate):
    found = diagnose(recorded(0), MODEL, speed=speed)
    assert (found.verdict, found.shaft_rate, found.labelled_rate) == (expected, rate, RATE)
    assert references == [None] * (2 if speed == "check" else 1)


def test_the_reference_is_the_healthy_recording(references):
    diagnose(recorded(0), MODEL, healthy=recorded(1, "healthy"), speed="off")
    windows = windows_of(recorded(1).signal, FS)
    expected = recording_table(windows, FS, RATE, ORDERS, 0, ("lines", "bands"))["features"].values
    np.testing.assert_array_equal(references[0]["features"].values, expected)


def test_a_long_recording_is_used_from_its_beginning():
    x = np.arange(round((LONGEST + 5) * 100))
    used, (sentence,) = _beginning(Recorded(x, 100.0, RATE, ORDERS))
    np.testing.assert_array_equal(used, x[:6000])
    assert sentence == "Only the first 60 s of 65 s are used."


def test_windows_follow_each_other_and_a_short_signal_is_one():
    x = np.arange(1300.0)
    np.testing.assert_array_equal(windows_of(x, 1000.0), x[:1000].reshape(2, 500))
    np.testing.assert_array_equal(windows_of(x[:400], 1000.0), x[None, :400])
