"""Laws of the tacho: a missed pulse changes no angle, and pulses that are not plain are refused."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from features.signal import angles_from_tacho

FS, TURNS = 5000.0, 40
SPEEDS = st.sampled_from([(20.0, 20.0), (10.0, 30.0), (30.0, 10.0)])


def course(first, last):
    """Angle of a shaft [turns] whose rate changes linearly [Hz], for `TURNS` turns."""
    duration = 2 * TURNS / (first + last)
    time = np.arange(round(duration * FS)) / FS
    return first * time + (last - first) / duration * time**2 / 2


def tacho(turns, per_turn, missing=(), extra=()):
    """Pulses a quarter of their distance wide, some of them missing, and others at further places [pulses]."""
    place = turns * per_turn + 0.5
    shape = np.clip(8 * np.cos(2 * np.pi * place) - 4, 0, 1)
    shape[np.isin(np.rint(place), missing)] = 0
    for at in extra:
        shape = np.maximum(shape, np.clip(1 - 20 * np.abs(place - at), 0, 1))
    return shape


@given(
    SPEEDS,
    st.sampled_from([1, 2, 7]),
    st.sampled_from([(), (10,), (10, 25), (10, 11), (10, 12), (10, 11, 12), (1,), (2,), (2, 4), (20, 22, 24, 39)]),
    st.booleans(),
)
@example((20.0, 20.0), 7, (20, 22, 24, 39), False)  # three gaps of one distance are no wheel
def test_missed_pulses_of_a_steady_shaft_and_of_a_run_up_change_no_angle(speeds, per_turn, missing, from_the_end):
    turns = course(*speeds)
    last = int(turns[-1] * per_turn)
    missing = [last - number for number in missing] if from_the_end else missing
    angle = angles_from_tacho(tacho(turns, per_turn, missing), per_turn)
    error = angle / (2 * np.pi) - turns
    # before the first pulse and after the last one the speed is not known
    seen = (turns * per_turn > 3) & (turns * per_turn < last - 3)
    assert np.ptp(error[seen]) < 0.02


def test_a_run_up_within_few_turns_has_no_missed_pulses():
    """The rate triples within five pulses."""
    turns = np.concatenate(
        [
            np.arange(2000) / 200,
            10 + np.cumsum(3 ** (np.arange(1000) / 1000)) / 200,
            10 + 9.1 + np.arange(2000) * 3 / 200,
        ]
    )
    angle = angles_from_tacho(tacho(turns, 1))
    assert (angle[-1] - angle[0]) / (2 * np.pi) == pytest.approx(turns[-1] - turns[0], abs=0.2)


@pytest.mark.parametrize("at", [9.75, 10.5, 10.8])
def test_an_extra_pulse_is_refused_at_its_place(at):
    with pytest.raises(ValueError, match=r"record 0 has an interval of 0.* neither steady nor of missed pulses"):
        angles_from_tacho(tacho(course(20, 20), 1, extra=[at]))


def test_an_interval_between_one_and_two_is_refused():
    turns = course(20, 20)
    with pytest.raises(ValueError, match=r"an interval of 1.6.* times the one beside it"):
        angles_from_tacho(tacho(np.where(turns > 10, np.maximum(10, turns - 0.6), turns), 1))


def test_a_wheel_with_missing_teeth_is_named_unless_its_whole_number_is_given():
    turns = course(2, 2.5)
    wheel = tacho(turns, 60, [60 * turn + tooth for turn in range(TURNS) for tooth in (58, 59)])
    with pytest.raises(ValueError, match=r"a gap every 60 pulses.* give pulses_per_turn=60"):
        angles_from_tacho(wheel, 58)
    whole = angles_from_tacho(tacho(turns, 60), 60)
    np.testing.assert_allclose(angles_from_tacho(wheel, 60), whole, atol=0.02)


def test_a_tacho_that_misses_every_other_pulse_is_refused():
    with pytest.raises(ValueError, match=r"misses .* or its marks are not at equal angles"):
        angles_from_tacho(tacho(course(20, 20), 1, range(5, 35, 2)))


@pytest.mark.parametrize(
    ("still", "told"),
    [
        ([slice(None, 2000)], r"before sample 2\d{3}"),
        ([slice(5000, None)], r"after sample 4\d{3}"),
        ([slice(None, 2000), slice(5000, None)], r"before sample 2\d{3} and after sample 4\d{3}"),
    ],
)
def test_a_tacho_that_is_still_at_an_end_is_refused(still, told):
    signal = tacho(course(10, 30), 1)
    for end in still:
        signal[end] = 0
    with pytest.raises(ValueError, match=f"record 0 has no pulse {told}; cut off what lies there"):
        angles_from_tacho(signal)
