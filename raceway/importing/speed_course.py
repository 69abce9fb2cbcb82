"""A measured course of the speed: the recording is sampled again at equal angles of its shaft.

``speed or tacho at each sample -> angle -> as many samples in a turn as the mean speed has``

A fault line then lies at its order as at a constant speed, and what moves is the resonances: a band of frequencies is smeared as widely
as the speed varies.
"""

import numpy as np

from gen.support.units import from_si, rpm_to_hertz
from raceway.importing.header import key_of
from raceway.importing.refused_files import FloatArray, UnusableError

SLOWEST, FASTEST = 0.001, 1e7  # rpm
_SMEARED = 2 ** (1 / 3)  # highest over lowest speed: a third of an octave, as narrow as bands of features are
_HERTZ = {"hz": 1.0, "1/s": 1.0} | dict.fromkeys(("rpm", "1/min", "min-1", "r/min", "u/min"), rpm_to_hertz(1.0))
_MOST_DIGITS = 6  # of the pulses in a turn


def at_equal_angles(
    signal: FloatArray, fs: float, course: FloatArray, wanted: str | None, stated: str = "", *, absolute: bool = True
) -> tuple[FloatArray, float, str]:
    """Signal at equal angles, shape (time,), its mean speed [rpm], and a sentence without its end.

    ``course`` is the speed at each sample, shape (time,), in a ``wanted`` unit, which is by default the ``stated`` one of the header, or a
    tacho whose wanted unit is the number of its pulses in a turn; values that are not ``absolute`` can only be a tacho. The sample rate is
    kept, and what the filter lacks at both ends is cut.

    Raises
    ------
    UnusableError
        If the unit is not known or another one is stated, or the course is none of a shaft that turns all the time.
    """
    from features.signal.orders import CROSSINGS, angles_from_speed, resample_to_angle

    factor, pulses = _unit(wanted, stated)
    for values, what in ((signal, "samples"), (course, "speeds")):
        wrong = np.flatnonzero(~np.isfinite(values))
        if wrong.size:
            count = f"{wrong.size} {what} of {values.size}"
            raise UnusableError(
                f"has {count} that are not finite numbers, the first is number {wrong[0] + 1}; export it again, or correct its unit"
            )
    if course.size != signal.size:
        raise UnusableError(f"has {course.size} speeds and {signal.size} samples; export one for each sample")
    if signal.size <= 2 * CROSSINGS:
        raise UnusableError(
            f"has {signal.size} samples, of which {CROSSINGS} are lost at each end at equal angles of its shaft; record longer"
        )
    if factor and not absolute:
        raise UnusableError(
            "holds integers, whose full scale is not known, and so no speed; give the pulses in a turn of a tacho",
            "speed_unit",
        )
    rpm = from_si(course * factor, "rpm")
    wrong = np.flatnonzero(~((rpm >= SLOWEST) & (rpm <= FASTEST)) & (pulses == 0))
    if wrong.size:
        where = f"at sample {wrong[0] + 1}, and shafts turn at {SLOWEST:g} to {FASTEST:,.0f} rpm"
        raise UnusableError(
            f"has a speed of {rpm[wrong[0]]:.6g} rpm {where}; cut the recording there, or correct its unit"
        )
    turns = (_angles_of(course, pulses) if pulses else angles_from_speed(course * factor, fs)) / (2 * np.pi)
    # a very slow turn is lost in the rounding of many fast ones
    back = np.flatnonzero(np.diff(turns) <= 4 * np.spacing(np.abs(turns).max()))
    if back.size:
        raise UnusableError(f"has a shaft that does not turn on after sample {back[0] + 1}; cut the recording there")
    mean = (turns[-1] - turns[0]) * fs / (course.size - 1)
    # two samples in each turn of a wheel that turns as much faster as the sample rate asks
    even = resample_to_angle(signal - signal[0], turns * (np.pi * fs / mean), 2)
    if pulses:
        # a pulse is off by a part of a sample, which counts less in a whole turn than between two pulses
        whole = np.interp(np.arange(np.ceil(turns[0]), turns[-1]), turns, np.arange(turns.size))
        rpm = from_si(np.append(fs / np.diff(whole), mean), "rpm")
    low, high, mean_rpm = float(rpm.min()), float(rpm.max()), float(from_si(mean, "rpm"))
    turning = f"turns at {low:.5g} to {high:.5g} rpm"
    end = int(np.ceil(CROSSINGS * high / mean_rpm))
    if even.size <= 2 * end:
        raise UnusableError(
            f"{turning} and has {even.size} samples at equal angles of its shaft, of which {end} are lost at each end; record longer"
        )
    told = f"it is sampled again at equal angles of its shaft, which {turning}, {mean_rpm:.5g} rpm in the mean"
    if high > _SMEARED * low:
        told += "; so wide a range smears resonances over bands of frequencies: trust its orders alone, or cut it into shorter ones"
    # without its offset a constant signal stays one, and is told as such
    return np.asarray(even[end:-end] + signal[0], dtype=np.float64), mean_rpm, told


def _angles_of(tacho: FloatArray, pulses: int) -> FloatArray:
    """Angle of the shaft at each sample [rad], shape (time,), from a tacho of some pulses in a turn."""
    from features.signal.tacho import angles_from_tacho

    try:
        return np.asarray(angles_from_tacho(tacho, pulses), dtype=np.float64)
    except ValueError as error:
        # the advice there is about the arguments of a function
        reason = str(error).removeprefix("tacho: record 0 ").partition(";")[0]
        raise UnusableError(
            f"has no tacho that can be used: it {reason}; cut out what has no even pulses, or correct the pulses in a turn",
            "speed_unit",
        ) from None


def _unit(wanted: str | None, stated: str) -> tuple[float, int]:
    """Unit of a speed [Hz], or 0 and the pulses in a turn of a tacho."""
    said = wanted or stated
    factor, of_header = (_HERTZ.get(key_of(text).casefold(), 0.0) for text in (said, stated))
    pulses = int(wanted) if wanted and wanted.isdecimal() and len(wanted) <= _MOST_DIGITS else 0
    if not factor and not pulses:
        what = f"has a speed in {said!r:.40}, which is no unit that is read" if said else "states no unit of its speed"
        raise UnusableError(f"{what}; give rpm, Hz, or the pulses in a turn of a tacho", "speed_unit")
    if of_header not in (0, factor):
        raise UnusableError(
            f"states a speed in {stated} in its header, and {said} is given; correct what is given", "speed_unit"
        )
    return factor, pulses
