"""Laws of the checks of a recording: which signals tell nothing, which are read with care, and what counts as clipped."""

import numpy as np
import pytest

from features.table.indicators import Orders
from raceway.diagnosis.quality import clipped_share, quality_of

FS, RATE = 12_000.0, 29.5
ORDERS = Orders(0.3983, 3.5848, 5.4152, 2.3567)
X = np.random.default_rng(0).standard_normal(36_000)


def test_a_sine_whose_peaks_are_single_samples_is_not_clipped():
    assert clipped_share(np.round(1000 * np.sin(2 * np.pi * np.arange(4000) / 8))) == 0


@pytest.mark.parametrize("limit", [0.5, 1.0, 2.0])
def test_the_share_of_clipped_samples_is_told(limit):
    x = np.random.default_rng(0).standard_normal(4000)
    assert clipped_share(np.clip(x, -limit, limit)) == np.mean(np.abs(x) >= limit)
    assert clipped_share(x) == 0


@pytest.mark.parametrize(
    ("x", "fs", "rate", "sentence", "advice"),
    [
        (X[:600], FS, RATE, "the recording lasts 0.05 s", "record 10 s"),
        (X, FS, 10 / 60, "the recording lasts 3 s", "record 60 s"),
        (X, FS, 0.1, "at 6 rpm the shaft turns fewer than 8 times in the 60 s that are used", "check the speed"),
        (X, FS, 2.6, "in which the shaft turns 7.8 times at 156 rpm, and 3.08 s are the least (8 turns", "record 10 s"),
        (0 * X, FS, RATE, "the signal is constant", "check sensor"),
        (0 * X + 3.7, FS, RATE, "the signal is constant", "check sensor"),
        (np.arange(X.size) / FS, FS, RATE, "only rise or only fall, as in a column of times", "another column"),
        (-np.arange(X.size) / FS, FS, RATE, "only rise or only fall, as in a column of times", "another column"),
        (1e-30 * X, FS, RATE, "is no vibration", "check unit"),
        (1e30 * X, FS, RATE, "is no vibration", "check unit"),
        (X, 12.0, RATE, "of 12 Hz is below 3,000 Hz", "record at 20 kHz or more; if it is 12 kHz, give 12000 Hz"),
        (X, FS, 1500.0, "a fault line lies at 8,123 Hz, and the signal is used up to 5,000 Hz", "check speed"),
    ],
)
def test_a_signal_that_tells_nothing_is_useless_for_a_reason_and_with_advice(x, fs, rate, sentence, advice):
    found = quality_of(x, fs, rate, ORDERS)
    assert sentence in found.useless
    assert advice in found.advice
    assert found.warnings == ()


@pytest.mark.parametrize(
    ("x", "fs", "sentence"),
    [
        (np.clip(X, -0.5, 0.5), FS, "clipped"),
        (1e-4 * X, FS, "implausible"),
        (X[:6000], FS, "The recording is short"),
        (X, 8000.0, "record at 20 kHz or more"),
    ],
)
def test_a_signal_to_be_read_with_care_has_one_warning_and_others_have_none(x, fs, sentence):
    (warning,) = quality_of(x, fs, RATE, ORDERS).warnings
    assert sentence in warning
    assert quality_of(X, FS, RATE, ORDERS) == ("", "", ())


def test_a_short_recording_of_a_slow_shaft_is_told_how_long_is_better():
    (warning,) = quality_of(np.tile(X, 4), FS, 0.8, ORDERS).warnings
    assert "(12 s, 10 shaft revolutions)" in warning
    assert "25 s are better" in warning
