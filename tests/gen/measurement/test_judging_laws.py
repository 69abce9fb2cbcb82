"""Laws of the test that says whether a fault can be seen."""

import math

import numpy as np
import pytest

from gen.measurement import judging
from gen.measurement.judging import FALSE_ALARM, Parts, bands_of, judge_bands, judges_of, parts_seen, spectra_of
from gen.measurement.levels import Gains

FS, N, RATE, ORDER = 12_000, 6000, 30.0, 3.58
ANGLES = 2 * np.pi * RATE * np.arange(N) / FS


def noise(seed, n=N):
    return np.random.default_rng(seed).standard_normal((1, n)).astype(np.float32)


def ringing(order, frequency=3000.0, angles=ANGLES):
    """A decaying oscillation at every passage of a fault, of unit rms, shape (channel, time)."""
    hits = np.zeros(len(angles))
    hits[1:] = np.diff(np.floor(order * angles / (2 * np.pi))) > 0
    time = np.arange(200) / FS
    wave = np.convolve(hits, np.exp(-500 * time) * np.sin(2 * np.pi * frequency * time))[: len(angles)]
    return (wave / wave.std())[None].astype(np.float32)


def judged(fault, rest, orders=(ORDER,), angles=ANGLES, *, steady=True, bearing=1.0):
    return judges_of([Parts(fault, np.zeros_like(fault), rest, orders, angles, steady)])[0].sees(Gains(bearing, 1.0))


def test_noise_in_place_of_a_fault_is_called_a_fault_as_rarely_as_stated():
    """What a fault adds may be noise of the same power as all else; the whole is then Gaussian noise without a line."""
    alarms = sum(judged(noise(2 * k), np.zeros((1, N), np.float32)) for k in range(2000))
    assert alarms <= 2000 * FALSE_ALARM + 3 * math.sqrt(2000 * FALSE_ALARM) + 1


def test_more_channels_do_not_give_more_false_alarms(monkeypatch):
    monkeypatch.setattr(judging, "FALSE_ALARM", 0.1)
    silence = np.zeros((8, N), np.float32)
    alarms = sum(judged(noise(k, 8 * N).reshape(8, N), silence) for k in range(300))
    assert alarms <= 300 * 0.1 + 3 * math.sqrt(300 * 0.1)


def test_a_line_at_the_threshold_has_the_stated_probability_in_the_whole_search():
    fault = np.concatenate([ringing(ORDER), ringing(ORDER)])
    (spectra,), bands = spectra_of([Parts(fault, np.zeros_like(fault), fault, (ORDER,), ANGLES, True)]), bands_of(N)
    searched = 2 * sum(len(cycles) for band in bands for cycles in spectra.searched(band))
    for (low, high), threshold in zip(bands, judge_bands([spectra], bands)[0].thresholds, strict=True):
        assert searched * math.exp(-(high - low) * threshold**2) == pytest.approx(FALSE_ALARM)


def test_the_power_of_a_record_is_that_of_bearing_and_background_together():
    """A background that cancels the healthy bearing leaves the fault alone, and one that adds to it hides the fault."""
    healthy = 30 * noise(1)
    cancelled, hidden = judges_of(
        [Parts(ringing(ORDER), healthy, sign * healthy, (ORDER,), ANGLES, True) for sign in (-1, 1)]
    )
    assert cancelled.sees(Gains(1.0, 1.0))
    assert not hidden.sees(Gains(1.0, 1.0))


def test_a_train_of_impacts_is_seen_down_to_some_level_and_not_below():
    seen = [judged(ringing(ORDER), noise(1), bearing=10 ** (level / 20)) for level in (0, -5, -10, -20, -30, -60)]
    assert seen[:2] == [True, True]
    assert seen[-2:] == [False, False]
    assert seen == sorted(seen, reverse=True)


def test_impacts_at_another_order_are_not_the_line_of_the_class():
    assert not judged(ringing(5.4 * 0.83), noise(1))
    assert judged(ringing(5.4 * 0.83), noise(1), orders=(5.4 * 0.83,))


def test_a_fault_is_seen_by_its_second_or_third_harmonic_alone():
    for harmonic in (2, 3):
        assert judged(ringing(harmonic * ORDER), noise(1))
    assert not judged(ringing(4.5 * ORDER), noise(1))


def test_where_two_parts_are_damaged_each_must_show_its_line():
    other = 5.4 * 0.83
    assert judged(ringing(ORDER) + ringing(other), noise(1), orders=(ORDER, other))
    assert not judged(ringing(ORDER), noise(1), orders=(ORDER, other))
    assert not judged(ringing(other), noise(1), orders=(ORDER, other))


def test_one_loud_channel_does_not_hide_a_fault_that_another_shows():
    fault = np.concatenate([ringing(ORDER), ringing(ORDER)])
    rest = np.concatenate([1000 * noise(1), noise(2)])
    assert judged(fault, rest)


def test_a_fault_that_is_loud_in_one_band_is_seen_behind_noise_in_another():
    time = np.arange(N) / FS
    hum = 30 * np.sin(2 * np.pi * 700 * time)[None].astype(np.float32)
    record = Parts(ringing(ORDER), np.zeros_like(hum), hum, (ORDER,), ANGLES, True)
    spectra, (whole, *quarters) = spectra_of([record]), bands_of(N)
    assert parts_seen(judge_bands(spectra, [whole])[0], Gains(1.0, 1.0)).tolist() == [False]
    assert parts_seen(judge_bands(spectra, quarters)[0], Gains(1.0, 1.0)).tolist() == [True]
    assert judges_of([record])[0].sees(Gains(1.0, 1.0))


def test_a_fault_is_seen_in_a_run_up_by_the_angle_of_the_shaft():
    angles = 2 * np.pi * (10 * np.arange(N) / FS + 40 * (np.arange(N) / FS) ** 2)
    fault = ringing(ORDER, angles=angles)
    assert judged(fault, noise(1), angles=angles, steady=False)
    assert not judged(fault, 3 * noise(1), angles=angles, steady=True)


@pytest.mark.parametrize("n", [64, 1000, 6001])
def test_records_of_any_length_are_judged(n):
    assert judged(noise(1, n), noise(2, n), angles=ANGLES[:1] + 2 * np.pi * RATE * np.arange(n) / FS) in (True, False)


def test_what_is_judged_of_a_record_does_not_depend_on_the_others():
    """Neither on their number, which decides how many are transformed at once, nor on their orders."""
    up = 2 * np.pi * (10 * np.arange(N) / FS + 40 * (np.arange(N) / FS) ** 2)
    records = [
        Parts(ringing(order), noise(k), noise(k + 9), (order,) * parts, ANGLES if steady else up, steady)
        for k, (order, parts, steady) in enumerate(
            [(ORDER, 1, True), (5.0, 2, True), (0.4, 1, False), (90.0, 1, True), (4.0, 0, True)]
        )
    ]
    spectra, bands = spectra_of(records), bands_of(N)
    for record, together in zip(records, judge_bands(spectra, bands), strict=True):
        (alone,) = judge_bands(spectra_of([record]), bands)
        for one, other in zip(alone, together, strict=True):
            np.testing.assert_array_equal(one, other)
