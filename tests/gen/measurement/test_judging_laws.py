"""Laws of the test that says whether a fault can be seen."""

import math

import numpy as np
import pytest
from scipy.signal import fftconvolve

from gen.measurement import judging
from gen.measurement.judging import FALSE_ALARM, judges_of
from gen.measurement.mixing import Parts

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


def parts(fault, healthy, rest, orders=(ORDER,), angles=ANGLES, *, steady=True, impulses=0.0):
    spectrum = impulses * np.abs(np.fft.rfft(IMPULSE)[None]) ** 2
    return Parts(np.stack([rest, healthy, fault]), (0.0,) * 6, spectrum, orders, angles, steady)


def judged(fault, rest, orders=(ORDER,), angles=ANGLES, *, bearing=1.0, **keys):
    (judge,) = judges_of([parts(fault, np.zeros_like(fault), rest, orders, angles, **keys)])
    return judge((bearing, 1.0))


def coloured(signal):
    """The same behind a resonance of 100 Hz width, of unit rms."""
    frequency = np.fft.rfftfreq(signal.shape[1], 1 / FS)
    filtered = np.fft.irfft(np.fft.rfft(signal) / (1 + ((frequency - 2000) / 50) ** 2), signal.shape[1])
    return (filtered / filtered.std()).astype(np.float32)


def modulated(signal):
    return signal * (1 + 0.8 * np.cos(ANGLES) + 0.4 * np.cos(ORDER * ANGLES)).astype(np.float32)


IMPULSE = (np.exp(-500 * np.arange(N) / FS) * np.sin(2 * np.pi * 3000 * np.arange(N) / FS)).astype(np.float32)


def with_impulses(signal):
    """Two of them per record on average, ten times as large as the noise."""
    rng = np.random.default_rng(abs(int(1e6 * signal[0, 0])))
    hits = np.zeros(N)
    np.add.at(hits, rng.integers(0, N, rng.poisson(2)), 10 * rng.standard_normal())
    return signal + fftconvolve(hits, IMPULSE)[:N].astype(np.float32)


@pytest.mark.parametrize(
    ("machine", "impulses"), [(np.asarray, 0), (coloured, 0), (modulated, 0), (with_impulses, 10**2 * math.sqrt(3 * 2))]
)
def test_another_recording_of_a_healthy_machine_gives_an_alarm_as_rarely_as_stated(machine, impulses):
    """What a fault adds may be the difference of two recordings of the machine, which differ in their noise alone."""
    recordings = [(machine(noise(2 * k)), machine(noise(2 * k + 1))) for k in range(200)]
    alarms = sum(judged(other - one, one, impulses=impulses) for other, one in recordings)
    assert alarms <= 200 * FALSE_ALARM + 3 * math.sqrt(200 * FALSE_ALARM) + 1


def test_more_channels_do_not_give_more_false_alarms(monkeypatch):
    monkeypatch.setattr(judging, "FALSE_ALARM", 0.1)
    two = [noise(k, 16 * N).reshape(2, 8, N) for k in range(150)]
    alarms = sum(judged(one - other, other) for one, other in two)
    assert alarms <= 150 * 0.1 + 3 * math.sqrt(150 * 0.1)


def test_a_line_that_the_record_shows_without_its_fault_is_not_the_fault():
    """A machine that knocks at the order of the fault hides a fault that it would show without the knocks."""
    knocking = 3 * ringing(ORDER) + noise(1)
    assert judged(0.5 * ringing(ORDER), noise(1))
    assert not judged(0.001 * ringing(ORDER), knocking)
    assert not judged(0.3 * noise(2), knocking)
    assert judged(2 * ringing(ORDER), knocking)


def test_an_impulse_that_the_machine_has_at_times_is_no_line():
    """One of a hundred times the noise may be in this record and in no other."""
    hit = 100 * np.roll(IMPULSE, N // 2)[None]
    assert judged(hit, noise(1))
    assert not judged(hit, noise(1), impulses=100**2)


def test_a_record_that_ends_otherwise_than_it_starts_has_no_line_of_that():
    """The transforms join the end of a record to its start."""
    time = np.arange(N) / FS
    other, one = (1000 * np.sin(2 * np.pi * 99.3 * time + phase)[None] for phase in (0.0, 1.5))
    assert not judged((other - one).astype(np.float32), one.astype(np.float32) + noise(1))


def test_the_twin_of_a_record_has_bearing_and_background_together():
    """A background that cancels the healthy bearing leaves the fault alone, and one that adds to it hides the fault."""
    healthy = 30 * noise(1)
    cancelled, hidden = judges_of([parts(ringing(ORDER), healthy, sign * healthy) for sign in (-1, 1)])
    assert cancelled((1.0, 1.0))
    assert not hidden((1.0, 1.0))


def test_a_train_of_impacts_is_seen_down_to_some_level_and_not_below():
    seen = [judged(ringing(ORDER), noise(1), bearing=10 ** (level / 20)) for level in (0, -5, -10, -20, -30, -60)]
    assert seen[:2] == [True, True]
    assert seen[-2:] == [False, False]
    assert seen == sorted(seen, reverse=True)


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


def test_a_fault_that_is_loud_in_one_band_is_seen_behind_noise_in_another(monkeypatch):
    hum = (30 * np.sin(2 * np.pi * 700 * np.arange(N) / FS) + 30 * coloured(noise(3)))[None, 0].astype(np.float32)
    assert judged(ringing(ORDER, 5000.0), hum)
    monkeypatch.setattr(judging, "BANDS", 1)
    assert not judged(ringing(ORDER, 5000.0), hum)


def test_a_fault_is_seen_in_a_run_up_by_the_angle_of_the_shaft():
    angles = 2 * np.pi * (10 * np.arange(N) / FS + 40 * (np.arange(N) / FS) ** 2)
    fault = ringing(ORDER, angles=angles)
    assert judged(fault, noise(1), angles=angles, steady=False)
    assert not judged(fault, 3 * noise(1), angles=angles, steady=True)


@pytest.mark.parametrize("n", [64, 1000, 6001])
def test_records_of_any_length_are_judged(n):
    angles = ANGLES[:1] + 2 * np.pi * RATE * np.arange(n) / FS
    assert not judged(1e-6 * noise(1, n), noise(2, n), angles=angles)


def test_what_is_judged_of_a_record_does_not_depend_on_the_others():
    """Neither on their number, which decides how many are transformed at once, nor on their orders."""
    up = 2 * np.pi * (10 * np.arange(N) / FS + 40 * (np.arange(N) / FS) ** 2)
    records = [
        parts(ringing(order), noise(k), noise(k + 9), (order,) * sites, ANGLES if steady else up, steady=steady)
        for k, (order, sites, steady) in enumerate(
            [(ORDER, 1, True), (5.0, 2, True), (0.4, 1, False), (90.0, 1, True), (4.0, 0, True)]
        )
    ]
    gains = [(10 ** (level / 20), 1.0) for level in range(-40, 20, 2)]
    together = [[judge(gain) for gain in gains] for judge in judges_of(records)]
    alone = [[judges_of([record])[0](gain) for gain in gains] for record in records]
    assert together == alone
    assert any(sum(seen) not in (0, len(gains)) for seen in alone)


def test_a_judge_tells_for_any_gains_what_a_judge_of_the_scaled_parts_tells():
    fault, healthy, background = ringing(ORDER), 0.3 * ringing(2.0), noise(1)
    (judge,) = judges_of([parts(fault, healthy, background)])
    told = []
    for level in range(-40, 20, 2):
        b, n = np.float32(10 ** (level / 20)), np.float32(0.7)
        (scaled,) = judges_of([parts(b * fault, b * healthy, n * background)])
        told.append((judge((float(b), float(n))), scaled((1.0, 1.0))))
    assert {one == other for one, other in told} == {True}
    assert len(set(told)) == 2
